//! The stroke limit, met through the control weight.

use crate::effort::{StrokeLimits, find_effort};
use crate::iteration::{Path, Weighting};
use crate::{
    ControlError, ControlRun, FeedbackController, Plant, RunError, StopReason, StrokeStatus,
};

/// One control weight and the run from zero control that ended with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffortTrial {
    /// Control weight, 1/V^2.
    pub rho: f64,
    /// Largest stroke at the end of the run, over its limit; infinite if the run was led out of the
    /// plant's range.
    pub stroke_ratio: f64,
    /// Why the run stopped.
    pub stop: StopReason,
}

/// A control run whose larger stroke is at its limit, or free.
#[derive(Debug, Clone, PartialEq)]
pub struct StrokeLimitedRun {
    /// The recorded run from zero control; each of its steps says with which weight its cost is formed.
    pub run: ControlRun,
    /// The control weight found, `W_u = rho I`, 1/V^2.
    pub rho: f64,
    /// Where the larger stroke ended.
    pub status: StrokeStatus,
    /// Largest stroke over its limit.
    pub largest_stroke_ratio: f64,
    /// Every weight that a whole run ended with; one if it converged along with the control.
    pub trials: Vec<EffortTrial>,
    /// Measurements of the plant in all, prediction of `rho` included.
    pub measurements: usize,
}

impl FeedbackController {
    /// Runs the loop with the control weight `rho >= 0` for which the larger stroke, where the loop
    /// ends, is at its limit; `rho = 0` if it stays below without.
    ///
    /// ```text
    /// find rho:  max_p  stroke_p(u(rho)) / limit_p  =  1 - stroke_tolerance / 2
    /// ```
    /// The weight is found along with the control: in a loop in which `rho` is adjusted at every step
    /// so that the step's control has the target stroke; that takes the cheap [`Plant::strokes_deg`]
    /// alone, so the dear measurements are those of a single run, and no step leads out of the range.
    /// Where it converges with the stroke at its limit, control and weight are a fixed point of eq. (10)
    /// together, and that run is the answer. If not, the weight is predicted by where it ended, and
    /// `ln rho` is searched by a bracketed root find over whole runs with a fixed `rho`: from zero control, or, for
    /// a controller that learns T, whose end is that of the control alone, from the end of the run before.
    ///
    /// Never does this clip a control to its limit: a clipped optimum is not the optimum of the
    /// clipped problem, and can be worse than no control. On a linear plant the result is the exact
    /// constrained optimum, `rho` being the Lagrange multiplier, when the strokes are a multiple of
    /// `|u|`: one flap at one harmonic, or several alike. In general one `rho` weights every flap,
    /// so the flap that could still move is held back along with the one at its limit, and the result
    /// is *not* the optimum under separate limits; nor do the flaps end with equal amplitudes.
    /// Where several weights meet the limit, one of them is found.
    ///
    /// # Errors
    /// As [`FeedbackController::run`]; [`ControlError::StrokeNotMet`] if no weight brings the stroke
    /// below its limit; strokes or limits that are not numbers.
    ///
    /// Source: eq. (7) and (10); the choice of `W_u` is this project's (the paper states none).
    pub fn run_within_stroke<P: Plant>(
        &self,
        plant: &mut P,
    ) -> Result<StrokeLimitedRun, RunError<P::Error>> {
        let strokes = StrokeLimits::of(plant, self.settings.stroke_tolerance)?;
        let zero = plant.layout().zero();
        let start = self.law.start(plant, &zero)?;
        let mut measurements = 1;

        let mut tracked =
            self.iterate(plant, &start, Path::default(), Weighting::Tracked(&strokes))?;
        measurements += tracked.measurements;
        if tracked.stop == StopReason::Converged {
            let (rho, stop) = (tracked.rho, tracked.stop);
            let stroke_ratio = strokes.ratio(plant, &tracked.last().control_volt)?;
            if let Some(status) = strokes.met(rho, stroke_ratio) {
                // the weight has converged along with the control: the fixed point of eq. (10) for it
                tracked.measurements += 1;
                return Ok(StrokeLimitedRun {
                    run: tracked,
                    rho,
                    status,
                    largest_stroke_ratio: stroke_ratio,
                    trials: vec![EffortTrial { rho, stroke_ratio, stop }],
                    measurements,
                });
            }
        }

        // a loop that learns depends on the control alone: each weight goes on from the one before
        let learns = self.settings.acceptance.trusts_predictions();
        let predicted = (tracked.rho > 0.0).then_some(tracked.rho);
        let mut taken = Path::default();
        if learns {
            taken = Path { steps: tracked.steps, backtracks: tracked.backtracks };
        }
        let otherwise = |_| 1e-3 * self.law.largest_authority();
        let mut trials: Vec<EffortTrial> = Vec::new();
        let (found, status) = find_effort(strokes.accepted(0.45), predicted, otherwise, |rho| {
            let run = match self.iterate(plant, &start, taken.clone(), Weighting::Fixed(rho)) {
                // a control out of range is one too large
                Err(RunError::Control(ControlError::NotAdmitted { .. })) => {
                    return Ok((f64::INFINITY, None));
                }
                run => run?,
            };
            measurements += run.measurements;
            if learns {
                taken = Path { steps: run.steps.clone(), backtracks: run.backtracks };
            }
            let (stop, ratio) = (run.stop, strokes.ratio(plant, &run.last().control_volt)?);
            let stroke_ratio = if stop == StopReason::OutOfRange { f64::INFINITY } else { ratio };
            trials.push(EffortTrial { rho, stroke_ratio, stop });
            Ok((stroke_ratio, Some((run, ratio))))
        })?;
        let rho = found.rho;
        let Some((mut run, largest_stroke_ratio)) = found.state else {
            let stroke_ratio = found.ratio;
            return Err(
                ControlError::StrokeNotMet { rho, stroke_ratio, trials: trials.len() }.into()
            );
        };
        run.measurements += 1;
        let status = match (status, strokes.met(rho, largest_stroke_ratio)) {
            (StrokeStatus::AtLimit, None) => StrokeStatus::BelowJump,
            (status, _) => status,
        };
        Ok(StrokeLimitedRun { run, rho, status, largest_stroke_ratio, trials, measurements })
    }
}
