//! What can go wrong.

use crate::{ConeStatus, ControlStep, Cost};

/// Rejected input and numerical failures of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ControlError {
    /// A vector of the wrong length.
    #[error("{what}: found {found} numbers, expected {expected}")]
    Length {
        /// What was counted.
        what: &'static str,
        /// Length found.
        found: usize,
        /// Length expected.
        expected: usize,
    },
    /// NaN or infinity where a number is needed.
    #[error("{what}: element {index} (from 0) is {value}, expected a finite number")]
    NotFinite {
        /// Name of the quantity, with its unit.
        what: &'static str,
        /// Position in the vector.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A number outside its range.
    #[error("{what} is {value}, expected {expected}")]
    OutOfRange {
        /// Name of the quantity, with its unit.
        what: &'static str,
        /// The value found.
        value: f64,
        /// The range expected.
        expected: &'static str,
    },
    /// The control does not move the weighted loads at all.
    #[error(
        "the weighted T matrix is zero: no control moves a weighted load; check the load weights and \
         the voltage step of the identification"
    )]
    NoAuthority,
    /// The singular value decomposition of the weighted T matrix did not converge.
    #[error(
        "singular values of the weighted T matrix ({rows} x {columns}) not found in {iterations} \
         iterations; are its columns of wildly different size?"
    )]
    SingularValues {
        /// Loads.
        rows: usize,
        /// Controls.
        columns: usize,
        /// Iterations made.
        iterations: usize,
    },
    /// The first control step raises the cost, however short it is made.
    #[error(
        "control diverges with rho = {rho:e} 1/V^2: no part of the first step down to 1/{divisor} lowers the \
         cost {} (the shortest gives {}); T0 points the wrong way (a phase error above 90 deg?): \
         identify it again, with a larger voltage step or about another control",
        start.total(), shortest.total()
    )]
    Diverges {
        /// Control weight, 1/V^2.
        rho: f64,
        /// The shortest step tried was `1/divisor` of the step of eq. (10).
        divisor: u64,
        /// Cost where the run started.
        start: Cost,
        /// Cost of the shortest step tried.
        shortest: Cost,
        /// What was recorded: the start.
        history: Vec<ControlStep>,
    },
    /// No part of the first control step can be measured.
    #[error(
        "with rho = {rho:e} 1/V^2 no part of the first control step down to 1/{divisor} lies in the range \
         the plant admits; set a stroke limit, or weight the control more"
    )]
    NotAdmitted {
        /// Control weight, 1/V^2.
        rho: f64,
        /// The shortest step tried was `1/divisor` of the step of eq. (10).
        divisor: u64,
        /// What was recorded: the start.
        history: Vec<ControlStep>,
    },
    /// The optimum within the limits was not found.
    #[error(
        "the optimum within the limits was not found in {iterations} iterations ({status:?}, KKT residual \
         {kkt:e}); are the limits of wildly different size, or the controls more than the loads with rho = 0?"
    )]
    ConeProgram {
        /// Why.
        status: ConeStatus,
        /// Iterations of the interior-point method.
        iterations: u32,
        /// Largest KKT residual reached; NaN if there was no point to judge.
        kkt: f64,
    },
    /// T cannot be identified about a control because neither side of it is in the plant's range.
    #[error(
        "control {control} (from 0) can be moved by {step_volt} V neither up nor down inside the range the \
         plant admits, so T cannot be identified there: take a smaller step"
    )]
    NoRoomToIdentify {
        /// The control, from 0.
        control: usize,
        /// The step, V.
        step_volt: f64,
    },
    /// No control weight was found that brings the stroke to its limit.
    #[error(
        "no control weight up to rho = {rho:e} 1/V^2 brings the largest stroke to its limit (still at \
         {stroke_ratio} of it after {trials} trials); is the stroke zero at zero voltage?"
    )]
    StrokeNotMet {
        /// The last weight tried, 1/V^2.
        rho: f64,
        /// Largest stroke over its limit there.
        stroke_ratio: f64,
        /// Weights tried.
        trials: usize,
    },
    /// The mean flap angle does not vanish in the allowed range of bias.
    #[error(
        "no bias in {low_volt} V..{high_volt} V makes the mean flap angle vanish: it is {low_deg} deg and \
         {high_deg} deg at the ends; widen the range or lower the harmonic voltage"
    )]
    BiasOutOfRange {
        /// Lowest bias allowed, volt.
        low_volt: f64,
        /// Highest bias allowed, volt.
        high_volt: f64,
        /// Mean flap angle at the lowest bias, degrees.
        low_deg: f64,
        /// Mean flap angle at the highest bias, degrees.
        high_deg: f64,
    },
    /// The mean flap angle jumps over zero.
    #[error(
        "the mean flap angle jumps from {below_deg} deg to {above_deg} deg at a bias of {bias_volt} V, so it \
         cannot be brought within {tolerance_deg} deg of zero"
    )]
    BiasJump {
        /// Bias of the jump, volt.
        bias_volt: f64,
        /// Mean flap angle on one side, degrees.
        below_deg: f64,
        /// Mean flap angle on the other side, degrees.
        above_deg: f64,
        /// What was asked, degrees.
        tolerance_deg: f64,
    },
}

/// A control run that failed: by the plant, or by the control.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError<E: std::error::Error + 'static> {
    /// The plant did not answer.
    #[error(
        "the plant failed when {call} at {at_volt:.4?} V, after {} recorded control steps: {source}",
        history.len()
    )]
    Plant {
        /// What it was asked, such as `measured` or `linearised`.
        call: &'static str,
        /// The control vector it was asked at, or the bias, V.
        at_volt: Vec<f64>,
        /// What had been recorded: start and accepted steps.
        history: Vec<ControlStep>,
        /// Its own error.
        source: E,
    },
    /// The control failed.
    #[error(transparent)]
    Control(#[from] ControlError),
}

impl<E: std::error::Error + 'static> RunError<E> {
    /// Makes the error of a plant that did not answer a call, such as `measured`, at a control vector (V); without a
    /// history.
    pub fn plant(call: &'static str, at_volt: &[f64]) -> impl FnOnce(E) -> Self {
        move |source| Self::Plant { call, at_volt: at_volt.to_vec(), history: Vec::new(), source }
    }
}

/// Accepts a count that is the expected one.
pub(crate) fn check_length(
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), ControlError> {
    if found == expected { Ok(()) } else { Err(ControlError::Length { what, found, expected }) }
}

/// Accepts a vector of the expected length whose elements are finite.
pub(crate) fn check_vector(
    what: &'static str,
    values: &[f64],
    expected: usize,
) -> Result<(), ControlError> {
    check_length(what, values.len(), expected)?;
    match values.iter().position(|v| !v.is_finite()) {
        Some(index) => Err(ControlError::NotFinite { what, index, value: values[index] }),
        None => Ok(()),
    }
}

/// Accepts a number that fits its range.
pub(crate) fn check_range(
    fits: bool,
    what: &'static str,
    value: f64,
    expected: &'static str,
) -> Result<(), ControlError> {
    if fits { Ok(()) } else { Err(ControlError::OutOfRange { what, value, expected }) }
}

/// Accepts the part of the way that a step goes.
pub(crate) fn check_gain(gain: f64) -> Result<(), ControlError> {
    check_range(gain > 0.0 && gain <= 1.0, "relaxation gain", gain, "above 0, at most 1")
}

/// Accepts the chance that a flap acts.
pub(crate) fn check_chance(chance: f64) -> Result<(), ControlError> {
    let (what, expected) =
        ("chance that a flap acts", "above 0 and at most 1, 1 for flaps that last");
    check_range(chance > 0.0 && chance <= 1.0, what, chance, expected)
}

/// Accepts a finite number above zero.
pub(crate) fn check_positive(what: &'static str, value: f64) -> Result<(), ControlError> {
    check_range(value.is_finite() && value > 0.0, what, value, "a finite number above 0")
}

/// Accepts a finite number, zero or above.
pub(crate) fn check_not_negative(what: &'static str, value: f64) -> Result<(), ControlError> {
    check_range(value.is_finite() && value >= 0.0, what, value, "a finite number, 0 or above")
}
