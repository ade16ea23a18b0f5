//! The line search along one step: backtracking by halves.

use super::subproblem::Subproblem;
use super::{Iteration, Method};
use crate::layout::{difference, largest_amplitude};
use crate::{AllowedIncrease, ControlError, ControlStep, Cost, OperatingPoint, Plant, RunError};

/// Ratio of two successive steps up to which a loop contracts.
const CONTRACTION: f64 = 0.8;

/// Part of the cost at the start below which a difference is rounding.
pub(super) const COST_ROUNDING: f64 = 1e-14;

/// What a line search accepts beside a lower cost.
#[derive(Debug, Clone, Copy)]
pub(super) struct Allowance {
    /// Why; of a restoration any part is accepted.
    pub(super) allowed_increase: AllowedIncrease,
    /// Cost up to which a full step is accepted, if the loop contracts there.
    pub(super) ceiling: f64,
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

impl<P: Plant> Iteration<'_, P> {
    /// The step or the longest part of it, halved and halved again, that is accepted.
    ///
    /// `start_cost` is the cost without control at the same weight.
    pub(super) fn search(
        &mut self,
        problem: &Subproblem,
        step: &[f64],
        allowance: Allowance,
        start_cost: f64,
    ) -> Result<Searched, RunError<P::Error>> {
        let Method { settings, law, .. } = self.method;
        let (asked_volt, rho) = (largest_amplitude(step), problem.rho);
        let mut search = Searched::default();
        for backtracks in 0..=settings.max_backtracks {
            let part = 0.5_f64.powi(backtracks.cast_signed());
            let from = &self.here.control_volt;
            let control_volt: Vec<f64> = from.iter().zip(step).map(|(u, d)| u + part * d).collect();
            if !self.plant.admits(&control_volt) {
                search.left_range = true;
                continue;
            }
            let history = || std::iter::once(self.start).chain(&self.path.steps).cloned().collect();
            let measurement = law.measured(self.plant, &control_volt, history)?;
            search.measurements += 1;
            let there =
                OperatingPoint { control_volt: &control_volt, outputs: &measurement.outputs };
            self.model.observe(there)?;
            let cost = law.cost(&measurement, &control_volt, rho);
            let increase = (cost.total() - self.here.cost.total()) / start_cost;
            let is_lower = increase <= COST_ROUNDING;
            let may_rise = backtracks == 0 && cost.total() <= allowance.ceiling;
            if is_lower
                || allowance.allowed_increase == AllowedIncrease::Restoration
                || (may_rise && self.contracts(problem, there, asked_volt)?)
            {
                let allowed_increase =
                    if is_lower { AllowedIncrease::None } else { allowance.allowed_increase };
                search.taken = Some(ControlStep {
                    control_volt,
                    measurement,
                    rho,
                    cost,
                    asked_volt,
                    backtracks,
                    allowed_increase,
                });
                break;
            }
            search.shortest = Some(cost);
        }
        Ok(search)
    }

    /// Whether the next undamped step is shorter than one of `asked_volt`.
    fn contracts(
        &self,
        problem: &Subproblem,
        there: OperatingPoint<'_>,
        asked_volt: f64,
    ) -> Result<bool, ControlError> {
        let next = problem.target(&self.model, there, 0.0)?.control_volt;
        let next_volt = largest_amplitude(&difference(&next, there.control_volt));
        Ok(next_volt <= CONTRACTION * asked_volt)
    }
}
