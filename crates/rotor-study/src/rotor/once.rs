//! What is made when it is first asked for and shared by all clones.

use std::sync::{Arc, OnceLock};

/// A value that is made once, whoever of the clones asks first.
#[derive(Debug)]
pub(super) struct Once<T> {
    cell: Arc<OnceLock<T>>,
}

impl<T> Default for Once<T> {
    fn default() -> Self {
        Self { cell: Arc::default() }
    }
}

impl<T> Clone for Once<T> {
    fn clone(&self) -> Self {
        Self { cell: Arc::clone(&self.cell) }
    }
}

impl<T> Once<T> {
    /// The value, made if nobody has asked for it before; a failure is not kept.
    pub(super) fn found<E>(&self, make: impl FnOnce() -> Result<T, E>) -> Result<&T, E> {
        if let Some(known) = self.cell.get() {
            return Ok(known);
        }
        let found = make()?;
        Ok(self.cell.get_or_init(|| found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_share_what_is_found_and_failures_are_tried_again() {
        let once = Once::default();
        assert_eq!(once.found(|| Err::<i32, _>("lost")), Err("lost"));
        assert_eq!(once.clone().found(|| Ok::<_, &str>(1)), Ok(&1));
        assert_eq!(once.found(|| Ok::<_, &str>(2)), Ok(&1));
    }
}
