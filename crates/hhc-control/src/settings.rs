//! Settings of the feedback loop.

use crate::{ControlError, error};

/// Settings of the feedback loop.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackSettings {
    /// Accepted control steps at most.
    pub max_steps: usize,
    /// Backtracks of one line search at most, up to 60; each costs a measurement.
    pub max_backtracks: u32,
    /// The loop has converged when eq. (10) asks for a change of no voltage harmonic by more than this fraction of
    /// the largest one.
    pub step_tolerance: f64,
    /// Part of the cost at the start that a converged step may still predict as its decrease; above 0 for
    /// controllers that renew T. No step may then raise the cost, but a contracting one within limits, which move
    /// with the control, by this fraction. 0 leaves the test of the step alone: a constant T does not keep its
    /// predictions.
    pub cost_tolerance: f64,
    /// How much a contracting full step may raise the cost, as a fraction of the cost at the start: one after which
    /// the next step is shorter by a fifth or more. Where T0 is not exact and the control is weighted, the fixed
    /// point of eq. (10) lies a little beside the least cost, and the last steps to it raise the cost slightly.
    pub allowed_increase: f64,
    /// Largest cost of a non-monotone line search, over the cost at the start. With a constant T of which no part of
    /// a step lowers the cost any more, full steps are taken as long as they contract: an ill-conditioned T that is
    /// right up to gain and lag leads to its fixed point only over higher costs. If that does not converge below the
    /// cost where it began, the run goes back there and ends as stalled. 0 keeps the line search monotone.
    pub non_monotone_cost: f64,
    /// Relative tolerance on the stroke: the larger stroke ends between `1 - stroke_tolerance` and 1
    /// times its limit.
    pub stroke_tolerance: f64,
}

impl Default for FeedbackSettings {
    fn default() -> Self {
        Self {
            max_steps: 30,
            max_backtracks: 6,
            step_tolerance: 1e-4,
            cost_tolerance: 0.0,
            allowed_increase: 1e-2,
            non_monotone_cost: 10.0,
            stroke_tolerance: 1e-3,
        }
    }
}

impl FeedbackSettings {
    pub(crate) fn check(&self) -> Result<(), ControlError> {
        error::check_positive("step tolerance", self.step_tolerance)?;
        error::check_not_negative("cost tolerance", self.cost_tolerance)?;
        error::check_not_negative("allowed increase of the cost", self.allowed_increase)?;
        error::check_not_negative("largest cost of a non-monotone search", self.non_monotone_cost)?;
        error::check_positive("stroke tolerance", self.stroke_tolerance)?;
        let backtracks = f64::from(self.max_backtracks);
        error::check_range(backtracks <= 60.0, "number of backtracks", backtracks, "0 to 60")
    }
}
