//! Checks of single numbers, and the extremes of many.

use crate::PreisachError;
use std::borrow::Cow;
use std::ops::RangeInclusive;

/// Refuses a number unless `holds`, and says what was expected.
pub(crate) fn check_that(
    holds: bool,
    quantity: &'static str,
    value: f64,
    expected: impl Into<Cow<'static, str>>,
) -> Result<(), PreisachError> {
    if holds {
        return Ok(());
    }
    Err(PreisachError::OutOfRange { quantity, value, expected: expected.into() })
}

/// Refuses what is not a positive finite number.
pub(crate) fn check_positive(quantity: &'static str, value: f64) -> Result<(), PreisachError> {
    check_that(value.is_finite() && value > 0.0, quantity, value, "a positive finite number")
}

/// Refuses what is not a finite number `>= 0`.
pub(crate) fn check_not_negative(quantity: &'static str, value: f64) -> Result<(), PreisachError> {
    let holds = value.is_finite() && value >= 0.0;
    check_that(holds, quantity, value, "a finite number that is not negative")
}

/// Refuses what lies outside a closed range, and NaN.
pub(crate) fn check_within(
    quantity: &'static str,
    value: f64,
    range: RangeInclusive<f64>,
) -> Result<(), PreisachError> {
    let expected = format!("{} to {}", range.start(), range.end());
    check_that(range.contains(&value), quantity, value, expected)
}

/// Refuses numbers of which one is NaN or infinite, and names the first.
pub(crate) fn check_finite(
    quantity: &'static str,
    values: impl IntoIterator<Item = f64>,
) -> Result<(), PreisachError> {
    match values.into_iter().enumerate().find(|(_, value)| !value.is_finite()) {
        Some((index, value)) => Err(PreisachError::NotFinite { quantity, index, value }),
        None => Ok(()),
    }
}

/// What is wrong with a sample of input and output of which one is NaN or infinite, and that one.
pub(crate) fn not_finite(input: f64, output: f64) -> Option<(&'static str, f64)> {
    if !input.is_finite() {
        return Some(("the input is not a finite number", input));
    }
    (!output.is_finite()).then_some(("the output is not a finite number", output))
}

/// Refuses a count that is too small to mean anything.
pub(crate) fn check_count(
    quantity: &'static str,
    value: usize,
    least: usize,
) -> Result<(), PreisachError> {
    check_that(value >= least, quantity, value as f64, format!("at least {least}"))
}

/// Smallest and largest of some numbers; infinite ones of none.
pub(crate) fn extremes(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold(none, |[low, high], v| [low.min(v), high.max(v)])
}

/// Place and value of the largest of some numbers, the first of equals; place 0 and the floor where
/// none is above that.
pub(crate) fn largest_above(floor: f64, values: impl IntoIterator<Item = f64>) -> (usize, f64) {
    let places = values.into_iter().enumerate();
    places.fold((0, floor), |best, now| if now.1 > best.1 { now } else { best })
}
