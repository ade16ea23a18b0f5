//! Checks of single numbers.

use crate::PreisachError;

/// Refuses what is not a positive finite number.
pub(crate) fn check_positive(quantity: &'static str, value: f64) -> Result<(), PreisachError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(PreisachError::NotPositive { quantity, value })
    }
}

/// Refuses what is not a finite number `>= 0`.
pub(crate) fn check_not_negative(quantity: &'static str, value: f64) -> Result<(), PreisachError> {
    if value.is_finite() && value >= 0.0 {
        Ok(())
    } else {
        Err(PreisachError::Negative { quantity, value })
    }
}
