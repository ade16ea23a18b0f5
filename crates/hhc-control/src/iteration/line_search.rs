//! The line search along one step: backtracking by halves.

use super::subproblem::Subproblem;
use crate::layout::{difference, largest_amplitude};
use crate::sensitivity::Sensitivity;
use crate::{
    AllowedIncrease, ControlError, ControlStep, Cost, FeedbackLaw, OperatingPoint, Plant, RunError,
};

/// Ratio of two successive steps up to which a loop contracts.
const CONTRACTION: f64 = 0.8;

/// Part of the cost at the start below which a difference is rounding.
pub(super) const COST_ROUNDING: f64 = 1e-14;

/// Which parts of a step are accepted.
#[derive(Debug, Clone, Copy)]
pub(super) struct Acceptance {
    /// What the step may raise the cost for; of a restoration any part is accepted.
    pub(super) allowed_increase: AllowedIncrease,
    /// Bound on the cost of a full step that does not lower it, if the loop contracts there.
    pub(super) bound: Bound,
}

/// A bound on the cost, relative to the cost at the start.
#[derive(Debug, Clone, Copy)]
pub(super) enum Bound {
    /// On its increase.
    Increase(f64),
    /// On the cost itself.
    Cost(f64),
}

/// A step, and what is known where it sets out from.
pub(super) struct LineSearch<'a> {
    /// Whose load weights form the cost.
    pub(super) law: &'a FeedbackLaw,
    pub(super) problem: &'a Subproblem,
    pub(super) here: &'a ControlStep,
    pub(super) step: &'a [f64],
    /// Largest amplitude of the step, V.
    pub(super) asked_volt: f64,
    /// Cost without control at the same weight.
    pub(super) start_cost: f64,
    pub(super) acceptance: Acceptance,
    pub(super) max_backtracks: u32,
}

/// What a line search found.
#[derive(Default)]
pub(super) struct Searched {
    /// The part of the step that was accepted; none if it was rejected in full.
    pub(super) taken: Option<ControlStep>,
    /// Cost of the shortest part measured.
    pub(super) shortest: Option<Cost>,
    /// Whether a part lay outside the range of the plant.
    pub(super) left_range: bool,
    pub(super) measurements: usize,
}

impl LineSearch<'_> {
    /// The step or the longest part of it, halved and halved again, that is accepted.
    pub(super) fn run<P: Plant>(
        &self,
        plant: &mut P,
        model: &mut Sensitivity<'_>,
        history: impl Fn() -> Vec<ControlStep>,
    ) -> Result<Searched, RunError<P::Error>> {
        let here = self.here;
        let Acceptance { allowed_increase, .. } = self.acceptance;
        let mut search = Searched::default();
        for backtracks in 0..=self.max_backtracks {
            let part = 0.5_f64.powi(backtracks.cast_signed());
            let control_volt: Vec<f64> =
                here.control_volt.iter().zip(self.step).map(|(u, d)| u + part * d).collect();
            if !plant.admits(&control_volt) {
                search.left_range = true;
                continue;
            }
            let measurement = self.law.measured(plant, &control_volt, &history)?;
            search.measurements += 1;
            let there =
                OperatingPoint { control_volt: &control_volt, outputs: &measurement.outputs };
            model.observe(there);
            let cost = self.law.cost(&measurement, &control_volt, self.problem.rho);
            let increase = (cost.total() - here.cost.total()) / self.start_cost;
            let is_bounded = match self.acceptance.bound {
                Bound::Increase(largest) => increase <= largest,
                Bound::Cost(largest) => cost.total() <= largest * self.start_cost,
            };
            if allowed_increase == AllowedIncrease::Restoration
                || increase <= COST_ROUNDING
                || (is_bounded && backtracks == 0 && self.contracts(model, there)?)
            {
                let raised = increase > COST_ROUNDING;
                search.taken = Some(ControlStep {
                    control_volt,
                    measurement,
                    rho: self.problem.rho,
                    cost,
                    asked_volt: self.asked_volt,
                    backtracks,
                    allowed_increase: if raised { allowed_increase } else { AllowedIncrease::None },
                });
                break;
            }
            search.shortest = Some(cost);
        }
        Ok(search)
    }

    /// Whether the next undamped step is shorter than this one.
    fn contracts(
        &self,
        model: &Sensitivity<'_>,
        there: OperatingPoint<'_>,
    ) -> Result<bool, ControlError> {
        let next = self.problem.target(model, there, 0.0)?.control_volt;
        let next_volt = largest_amplitude(&difference(&next, there.control_volt));
        Ok(next_volt <= CONTRACTION * self.asked_volt)
    }
}
