//! Results kept for a while: what several searches ask for with the same effects is simulated once.

use model_gap::{Effect, GapError};
use std::sync::{Arc, Mutex};

/// Candidates and the bits of their values.
pub(super) type Key = Vec<(usize, Vec<u64>)>;

/// The key of effects.
pub(super) fn key<'a>(effects: impl IntoIterator<Item = &'a Effect>) -> Key {
    effects
        .into_iter()
        .map(|e| (e.candidate, e.values.iter().map(|v| v.to_bits()).collect()))
        .collect()
}

/// The results of the last keys asked for. What is kept decides how long a search takes, never what
/// it finds: a result depends on its key alone.
#[derive(Debug)]
pub(super) struct Memo<T> {
    kept: Mutex<Vec<(Key, Arc<T>)>>,
    most: usize,
}

impl<T> Memo<T> {
    pub(super) fn new(most: usize) -> Self {
        Self { kept: Mutex::new(Vec::new()), most }
    }

    /// The result of a key: kept, or made and kept in the place of the one not asked for the longest.
    pub(super) fn get(
        &self,
        key: Key,
        make: impl FnOnce() -> Result<T, GapError>,
    ) -> Result<Arc<T>, GapError> {
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

    fn look_up(&self, key: &Key) -> Option<Arc<T>> {
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
        let effect = |value: f64| Effect { candidate: 0, values: vec![value] };
        let mut made = 0;
        for (value, so_far) in [(1.0, 1), (2.0, 2), (1.0, 2), (3.0, 3), (1.0, 3), (2.0, 4)] {
            let result = memo.get(key([&effect(value)]), || {
                made += 1;
                Ok(10.0 * value)
            });
            assert!((*result.unwrap() - 10.0 * value).abs() < 1e-12);
            assert_eq!(made, so_far, "after {value}");
        }
    }
}
