//! Settings of the feedback loop.

use crate::{ControlError, error};

/// Which steps a run accepts, and with that when it has converged. The method is the same for all: a trust-region step
/// on the predicted cost, halved until it is accepted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Acceptance {
    /// Steps that lower the cost; for a T that is renewed. Within limits, which move with the control, a contracting
    /// one may raise it by `cost_tolerance`.
    Monotone {
        /// Part of the cost at the start that a converged step may still predict as its decrease.
        cost_tolerance: f64,
    },
    /// Contracting full steps too, after which the next step is shorter by a fifth or more; for a constant T. Such a T
    /// does not keep its predictions, so they neither set the radius of the trust region, which stays unbounded, nor
    /// say that the run has converged: the length of the step alone does.
    NonMonotone {
        /// How much such a step may raise the cost, as a fraction of the cost at the start. Where T0 is not exact and
        /// the control is weighted, the fixed point of eq. (10) lies a little beside the least cost, and the last
        /// steps to it raise the cost slightly.
        allowed_increase: f64,
        /// Largest cost, over that at the start, once no part of a step lowers it any more: an ill-conditioned T that
        /// is right up to gain and lag leads to its fixed point only over higher costs. If that does not converge
        /// below the cost where it began, the run goes back there and ends as stalled. 0: never.
        largest_cost: f64,
    },
}

impl Acceptance {
    /// The tolerance of the cost; 0 where the length of the step alone is tested.
    pub fn cost_tolerance(self) -> f64 {
        match self {
            Self::Monotone { cost_tolerance } => cost_tolerance,
            Self::NonMonotone { .. } => 0.0,
        }
    }

    /// Whether predictions that were kept or not set the radius of the trust region.
    pub(crate) fn trusts_predictions(self) -> bool {
        matches!(self, Self::Monotone { .. })
    }

    /// Largest cost of a search that goes over higher costs, over that at the start; 0 where there is none.
    pub(crate) fn largest_cost(self) -> f64 {
        match self {
            Self::Monotone { .. } => 0.0,
            Self::NonMonotone { largest_cost, .. } => largest_cost,
        }
    }

    fn check(self) -> Result<(), ControlError> {
        match self {
            Self::Monotone { cost_tolerance } => {
                error::check_positive("cost tolerance", cost_tolerance)
            }
            Self::NonMonotone { allowed_increase, largest_cost } => {
                error::check_not_negative("allowed increase of the cost", allowed_increase)?;
                error::check_not_negative("largest cost of a non-monotone search", largest_cost)
            }
        }
    }
}

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
    /// Which steps are accepted.
    pub acceptance: Acceptance,
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
            acceptance: Acceptance::NonMonotone { allowed_increase: 1e-2, largest_cost: 10.0 },
            stroke_tolerance: 1e-3,
        }
    }
}

impl FeedbackSettings {
    pub(crate) fn check(&self) -> Result<(), ControlError> {
        error::check_positive("step tolerance", self.step_tolerance)?;
        self.acceptance.check()?;
        error::check_positive("stroke tolerance", self.stroke_tolerance)?;
        let backtracks = f64::from(self.max_backtracks);
        error::check_range(backtracks <= 60.0, "number of backtracks", backtracks, "0 to 60")
    }
}
