//! Results kept for a while: what several searches ask for with the same effects is found once.

use std::sync::{Arc, Mutex};

/// The results of the last keys asked for. What is kept decides how long a search takes, never what
/// it finds: a result depends on its key alone.
#[derive(Debug)]
pub struct Memo<K, T> {
    kept: Mutex<Vec<(K, Arc<T>)>>,
    most: usize,
}

impl<K: PartialEq, T> Memo<K, T> {
    /// A memo of `most` results.
    pub fn new(most: usize) -> Self {
        Self { kept: Mutex::new(Vec::new()), most }
    }

    /// The result of a key: kept, or made and kept in the place of the one not asked for the longest.
    ///
    /// # Errors
    /// Those of `make`; nothing is kept then.
    pub fn get<E>(&self, key: K, make: impl FnOnce() -> Result<T, E>) -> Result<Arc<T>, E> {
        if let Some(found) = self.look_up(&key) {
            return Ok(found);
        }
        // no lock is held while it is made: two threads may make the same, with the same bits
        let made = Arc::new(make()?);
        // a poisoned lock: a thread died while it held it; nothing is kept then
        if let Ok(mut kept) = self.kept.lock() {
            kept.insert(0, (key, Arc::clone(&made)));
            kept.truncate(self.most);
        }
        Ok(made)
    }

    fn look_up(&self, key: &K) -> Option<Arc<T>> {
        let mut kept = self.kept.lock().ok()?;
        let place = kept.iter().position(|(own, _)| own == key)?;
        kept[..=place].rotate_right(1);
        kept.first().map(|(_, found)| Arc::clone(found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_keys_are_kept_and_the_oldest_forgotten() {
        let memo = Memo::new(2);
        let mut made = 0;
        for (value, so_far) in [(1, 1), (2, 2), (1, 2), (3, 3), (1, 3), (2, 4)] {
            let result: Result<_, ()> = memo.get(value, || {
                made += 1;
                Ok(10 * value)
            });
            assert_eq!(result.map(|found| *found), Ok(10 * value));
            assert_eq!(made, so_far, "after {value}");
        }
    }
}
