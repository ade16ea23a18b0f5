//! The errors of this crate.

use std::borrow::Cow;

/// What is refused of the parameters of a stage.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StageError {
    /// A parameter lies outside the values it may have.
    #[error("{quantity} is {value}, expected {expected}")]
    OutOfRange {
        /// Name of the parameter, with its unit.
        quantity: &'static str,
        /// The value found.
        value: f64,
        /// What it may be.
        expected: Cow<'static, str>,
    },
    /// A parameter is NaN or infinite.
    #[error("{quantity} at index {index} is {value}, expected a finite number")]
    NotFinite {
        /// Name of the parameter, with its unit.
        quantity: &'static str,
        /// Place in an array; 0 for a single number.
        index: usize,
        /// The value found.
        value: f64,
    },
}
