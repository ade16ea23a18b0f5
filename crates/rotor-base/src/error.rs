//! The errors of this crate.

/// What can be wrong with values handed to `rotor-base`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BaseError {
    /// A quantity that must be positive and finite is not.
    #[error("{quantity} is {value}, expected a positive finite number")]
    NotPositive {
        /// Name of the quantity, with its unit.
        quantity: &'static str,
        /// The value found.
        value: f64,
    },
    /// A periodic record has too few samples for the harmonics asked of it.
    #[error(
        "{samples} samples per period cannot carry {harmonics} harmonics, at least {needed} are needed"
    )]
    TooFewSamples {
        /// Samples given.
        samples: usize,
        /// Harmonics asked for.
        harmonics: usize,
        /// Samples needed.
        needed: usize,
    },
}
