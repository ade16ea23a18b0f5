//! The control weight with which the loads end at a given cost.

#[cfg(doc)]
use crate::ControlStep;
use crate::effort::find_effort;
use crate::iteration::{Path, Weighting};
use crate::{ControlRun, FeedbackController, Plant, RunError, error};

/// Accuracy of the fall of `J_Z`, relative.
const FALL_TOLERANCE: f64 = 1e-5;

impl FeedbackController {
    /// Runs the loop from zero control with the control weight for which `J_Z` ends at a given value: the control of
    /// least effort that makes this reduction. Two actuations are compared so at equal benefit.
    ///
    /// ```text
    /// find rho:  J_Z(0) - J_Z(u(rho))  =  J_Z(0) - loads_cost
    /// ```
    /// `ln rho` is searched from what T predicts; the run comes with its `rho` (1/V^2). Where `J_Z` stays above
    /// `loads_cost` without a weight, the run is that of `rho = 0`: compare [`ControlStep::cost`] at its end.
    ///
    /// | argument | meaning | range |
    /// |---|---|---|
    /// | `loads_cost` | `J_Z` to end at, to 1e-5 of its fall | at least 0, below `J_Z` without control |
    ///
    /// # Errors
    /// As [`FeedbackController::run`]; [`crate::ControlError::OutOfRange`] for a cost that needs no control;
    /// [`crate::ControlError::StrokeNotMet`] if no weight brings the reduction down to the one asked for.
    pub fn run_to_cost<P: Plant>(
        &self,
        plant: &mut P,
        loads_cost: f64,
    ) -> Result<(ControlRun, f64), RunError<P::Error>> {
        let zero = plant.layout().zero();
        let start = self.law.start(plant, &zero)?;
        let wanted = start.cost.loads - loads_cost;
        let (what, expected) = ("cost of the loads to end at", "0 to below that without control");
        error::check_range(loads_cost >= 0.0 && wanted > 0.0, what, loads_cost, expected)?;
        // a fall may be none, or a rise: a small part of the one wanted serves the search as well
        let part = |cost: f64| ((start.cost.loads - cost) / wanted).max(f64::MIN_POSITIVE);
        let anywhere = |_| 1e-3 * self.law.largest_authority();
        let asked = [1.0, FALL_TOLERANCE];
        let target = self.law.modal_target(start.point())?;
        let predict =
            |rho| Ok((part(self.law.predicted_loads_cost(rho, &target, start.cost.loads)), ()));
        let (predicted, _) = find_effort::<_, P::Error>(asked, None, anywhere, predict)?;
        let guess = (predicted.rho > 0.0).then_some(predicted.rho);
        let (found, _) = find_effort(asked, guess, anywhere, |rho| {
            let mut run = self.iterate(plant, &start, Path::default(), Weighting::Fixed(rho))?;
            run.measurements += 1;
            Ok((part(run.last().cost.loads), run))
        })?;
        Ok((found.state, found.rho))
    }
}
