//! Checks of single numbers.

use crate::StageError;
use std::borrow::Cow;
use std::ops::RangeInclusive;

/// Refuses a number unless `holds`, and says what was expected.
pub(crate) fn check_that(
    holds: bool,
    quantity: &'static str,
    value: f64,
    expected: impl Into<Cow<'static, str>>,
) -> Result<(), StageError> {
    if holds {
        return Ok(());
    }
    Err(StageError::OutOfRange { quantity, value, expected: expected.into() })
}

/// Refuses what is not a positive finite number.
pub(crate) fn check_positive(quantity: &'static str, value: f64) -> Result<(), StageError> {
    check_that(value.is_finite() && value > 0.0, quantity, value, "a positive finite number")
}

/// Refuses what is not a finite number `>= 0`.
pub(crate) fn check_not_negative(quantity: &'static str, value: f64) -> Result<(), StageError> {
    let holds = value.is_finite() && value >= 0.0;
    check_that(holds, quantity, value, "a finite number that is not negative")
}

/// Refuses what lies outside a closed range, and NaN.
pub(crate) fn check_within(
    quantity: &'static str,
    value: f64,
    range: RangeInclusive<f64>,
) -> Result<(), StageError> {
    let expected = format!("{} to {}", range.start(), range.end());
    check_that(range.contains(&value), quantity, value, expected)
}

/// Refuses NaN and infinite numbers.
pub(crate) fn check_finite(quantity: &'static str, value: f64) -> Result<(), StageError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(StageError::NotFinite { quantity, index: 0, value })
}
