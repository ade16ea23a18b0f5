//! What is made when it is first asked for and shared by all clones.

use std::sync::{Arc, OnceLock};

/// A value that is made once, whoever of the clones asks first.
pub type Once<T> = Arc<OnceLock<T>>;

/// The value, made if nobody has asked for it before; a failure is not kept.
///
/// # Errors
/// That of `make`.
pub fn found<T, E>(once: &Once<T>, make: impl FnOnce() -> Result<T, E>) -> Result<&T, E> {
    if let Some(known) = once.get() {
        return Ok(known);
    }
    let made = make()?;
    Ok(once.get_or_init(|| made))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_share_what_is_found_and_failures_are_tried_again() {
        let once = Once::default();
        assert_eq!(found(&once, || Err::<i32, _>("lost")), Err("lost"));
        assert_eq!(found(&once.clone(), || Ok::<_, &str>(1)), Ok(&1));
        assert_eq!(found(&once, || Ok::<_, &str>(2)), Ok(&1));
    }
}
