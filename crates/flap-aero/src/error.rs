//! Errors of the section aerodynamics.

/// What can be wrong with a question to the section aerodynamics.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AeroError {
    /// A Mach number outside the subsonic linear theory.
    #[error(
        "Mach number {mach}: the attached-flow models are subsonic linear theory, defined from 0 \
         to {limit}; lower the speed or limit the local Mach number"
    )]
    MachOutOfRange {
        /// The value found.
        mach: f64,
        /// Largest value accepted.
        limit: f64,
    },
    /// A flap chord ratio that is no flap.
    #[error(
        "flap chord ratio {ratio}: expected 0 (no flap) or more, and less than 1 chord; 0.15 to \
         0.25 is usual on a rotor blade"
    )]
    FlapChordOutOfRange {
        /// The value found.
        ratio: f64,
    },
    /// A flap chord ratio outside the calibration.
    #[error(
        "flap chord ratio {ratio}: the calibrated model holds for {from} to {to}, or 0 (no flap); \
         choose another model for other flaps"
    )]
    FlapChordNotCalibrated {
        /// The value found.
        ratio: f64,
        /// Smallest flap chord of the calibration.
        from: f64,
        /// Largest flap chord of the calibration.
        to: f64,
    },
    /// A hinge that is not on the chord.
    #[error(
        "hinge position {semichords} semichords aft of mid-chord: expected -1 (leading edge) to 1 \
         (trailing edge)"
    )]
    HingeOutOfRange {
        /// The value found.
        semichords: f64,
    },
    /// A compressible flow was asked of the incompressible model.
    #[error(
        "the incompressible model holds at Mach 0 only, got Mach {mach}; set the Mach number to 0 \
         or choose the calibrated or the Hariharan-Leishman model"
    )]
    CompressibleFlow {
        /// The Mach number asked for.
        mach: f64,
    },
    /// A C81 file is not understood.
    #[error("C81 table, line {line}, column {column}: expected {expected}")]
    C81Text {
        /// Line of the file, from 1.
        line: usize,
        /// Column of the line, from 1.
        column: usize,
        /// What should have been there.
        expected: String,
    },
    /// An axis of a table does not ascend, is empty, or has a number that is none.
    #[error("C81 table: the {what} must ascend, entry {index} (from 0) does not; sort them")]
    C81Order {
        /// The axis.
        what: &'static str,
        /// First entry that is not above the one before it.
        index: usize,
    },
    /// A table has too few values, too many, or some that are not finite.
    #[error("C81 table: {found} finite values for {expected} pairs of incidence and Mach number")]
    C81Shape {
        /// Finite values found.
        found: usize,
        /// Pairs of the axes.
        expected: usize,
    },
    /// An aerofoil cannot be written in the format.
    #[error("C81 table: cannot write {what}; round the aerofoil first")]
    C81NotWritable {
        /// What the format cannot hold.
        what: &'static str,
    },
    /// A state was used with coefficients of another structure.
    #[error(
        "the section state has {state} lag states, the coefficients have {coefficients} lag \
         channels; start the state from the coefficients it is used with"
    )]
    StateMismatch {
        /// Lag states of the state.
        state: usize,
        /// Lag channels of the coefficients.
        coefficients: usize,
    },
    /// An input of a time step is not a number, or the step goes backward.
    #[error("{quantity} is {value}: expected {expected}")]
    BadInput {
        /// Name of the quantity.
        quantity: &'static str,
        /// The value found.
        value: f64,
        /// What it should have been.
        expected: &'static str,
    },
}

/// Refuses the first of some named numbers that does not fit.
pub(crate) fn check(
    numbers: &[(&'static str, f64)],
    expected: &'static str,
    fits: impl Fn(f64) -> bool,
) -> Result<(), AeroError> {
    match numbers.iter().find(|(_, value)| !fits(*value)) {
        Some(&(quantity, value)) => Err(AeroError::BadInput { quantity, value, expected }),
        None => Ok(()),
    }
}
