//! The stroke limit, met through the control weight.

use crate::control_loop::{Effort, Taken};
use crate::controller::Knowledge;
use crate::root::{Bracketed, Trial, root_between};
use crate::{
    ControlError, ControlRun, ControlStep, FeedbackController, Outcome, Plant, PlantCall, RunError,
};

/// Where the larger stroke ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrokeStatus {
    /// Below the limit without weighting the control: `rho = 0`.
    Free,
    /// At the limit, within the tolerance and not above it.
    AtLimit,
    /// Below the limit by more than the tolerance, though a weight smaller by rounding leads above
    /// it: the end of the loop jumps there (its steps are accepted or halved in another pattern).
    BelowJump,
}

/// One control weight and the run from zero control that ended with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffortTrial {
    /// Control weight, 1/V^2.
    pub rho: f64,
    /// Largest stroke at the end of the run, over its limit; infinite if the run was led out of the
    /// plant's range.
    pub stroke_ratio: f64,
    /// How the run ended.
    pub outcome: Outcome,
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
    /// Strokes at the end, degrees.
    pub strokes_deg: Vec<f64>,
    /// Their limits, degrees.
    pub stroke_limits_deg: Vec<f64>,
    /// Largest stroke over its limit.
    pub largest_stroke_ratio: f64,
    /// Every weight that a whole run ended with; one if it settled along with the control.
    pub trials: Vec<EffortTrial>,
    /// Measurements of the plant in all, prediction of `rho` included.
    pub measurements: usize,
}

/// What the search needs to know of the stroke.
pub(crate) struct Strokes {
    limits_deg: Vec<f64>,
    /// The stroke aimed at, over the limit: half the tolerance below 1.
    target: f64,
    /// Relative tolerance on the stroke.
    tolerance: f64,
}

/// A control weight and what goes with it.
#[derive(Debug, Clone)]
struct Weighted<S> {
    rho: f64,
    ratio: f64,
    state: S,
    status: StrokeStatus,
}

/// `ln rho` of the unweighted control.
const UNWEIGHTED: f64 = f64::NEG_INFINITY;

/// `ln rho` beyond which no stroke can be left.
const LARGEST_LN_RHO: f64 = 300.0;

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
        let strokes = Strokes::of(plant, self.settings.stroke_tolerance)?;
        let zero = plant.layout().zero();
        let start = self.start(plant, &zero)?;
        let mut measurements = 1;

        let mut tracked = self.iterate(plant, &start, &mut Effort::Tracked(&strokes))?;
        measurements += tracked.measurements;
        if tracked.outcome == Outcome::Converged {
            let strokes_deg = strokes.ask(plant, &tracked.last().control_volt)?;
            if let Some(status) = strokes.met(tracked.rho, &strokes_deg) {
                // the weight has settled along with the control: the fixed point of eq. (10) for it
                tracked.measurements += 1;
                let (rho, outcome) = (tracked.rho, tracked.outcome);
                let stroke_ratio = strokes.ratio(&strokes_deg);
                return Ok(StrokeLimitedRun {
                    run: tracked,
                    rho,
                    status,
                    strokes_deg,
                    stroke_limits_deg: strokes.limits_deg,
                    largest_stroke_ratio: stroke_ratio,
                    trials: vec![EffortTrial { rho, stroke_ratio, outcome }],
                    measurements,
                });
            }
        }

        // a loop that learns depends on the control alone: each weight goes on from the one before
        let learns = self.settings.cost_tolerance > 0.0;
        let mut taken = Taken::default();
        if learns {
            taken = Taken { steps: tracked.steps, refused: tracked.refused };
        }
        let predicted = (tracked.rho > 0.0).then_some(tracked.rho);
        let otherwise = |_| 1e-3 * self.law.largest_authority();
        let mut trials: Vec<EffortTrial> = Vec::new();
        let found = find_effort(strokes.accepted(0.45), predicted, otherwise, |rho| {
            let run = match self.go_on(plant, (&start, taken.clone()), &mut Effort::Fixed(rho)) {
                // a control out of range is one too large
                Err(RunError::Control(ControlError::NotAdmitted { .. })) => {
                    return Ok((f64::INFINITY, None));
                }
                run => run?,
            };
            measurements += run.measurements;
            if learns {
                taken = Taken { steps: run.steps.clone(), refused: run.refused.clone() };
            }
            let strokes_deg = strokes.ask(plant, &run.last().control_volt)?;
            let outcome = run.outcome;
            let stroke_ratio = match outcome {
                Outcome::OutOfRange => f64::INFINITY,
                _ => strokes.ratio(&strokes_deg),
            };
            trials.push(EffortTrial { rho, stroke_ratio, outcome });
            Ok((stroke_ratio, Some((run, strokes_deg))))
        })?;
        let rho = found.rho;
        let Some((mut run, strokes_deg)) = found.state else {
            let stroke_ratio = found.ratio;
            return Err(
                ControlError::StrokeNotMet { rho, stroke_ratio, trials: trials.len() }.into()
            );
        };
        run.measurements += 1;
        let stroke_ratio = strokes.ratio(&strokes_deg);
        let met = strokes.met(rho, &strokes_deg);
        Ok(StrokeLimitedRun {
            run,
            rho,
            status: match (found.status, met) {
                (StrokeStatus::AtLimit, None) => StrokeStatus::BelowJump,
                (status, _) => status,
            },
            strokes_deg,
            stroke_limits_deg: strokes.limits_deg,
            largest_stroke_ratio: stroke_ratio,
            trials,
            measurements,
        })
    }
}

/// The `rho` for which the next control of the law has the target stroke, from cheap calls alone.
pub(crate) fn track_effort<P: Plant>(
    known: &Knowledge<'_>,
    plant: &mut P,
    strokes: &Strokes,
    here: &ControlStep,
) -> Result<f64, RunError<P::Error>> {
    let target = known.target(&here.control_volt, &here.measurement.hub_loads)?;
    let law = &known.law;
    let guess = (here.rho > 0.0).then_some(here.rho);
    // The first guess takes strokes to be in proportion to the norm of the control.
    let from_norm = |ratio: f64| {
        let shrink = if ratio.is_finite() { strokes.target / ratio } else { 0.1 };
        law.effort_for_norm(shrink * law.optimum_norm(0.0, &target), &target)
    };
    let found = find_effort(strokes.accepted(0.2), guess, from_norm, |rho| {
        let strokes_deg = strokes.ask(plant, &law.optimum_of(rho, &target))?;
        Ok((strokes.ratio(&strokes_deg), ()))
    })?;
    Ok(found.rho)
}

impl Strokes {
    fn of<P: Plant>(plant: &P, tolerance: f64) -> Result<Self, ControlError> {
        let limits_deg = plant.stroke_limits_deg();
        for (index, &value) in limits_deg.iter().enumerate() {
            if value.is_nan() || value <= 0.0 {
                let what = "stroke limit (deg)";
                return Err(if value.is_nan() {
                    ControlError::NotFinite { what, index, value }
                } else {
                    ControlError::OutOfRange { what, value, expected: "above 0" }
                });
            }
        }
        Ok(Self { limits_deg, target: 1.0 - 0.5 * tolerance, tolerance })
    }

    /// Target ratio, and the accepted distance from it as a part of the tolerance.
    fn accepted(&self, part: f64) -> [f64; 2] {
        [self.target, part * self.tolerance]
    }

    /// The strokes at a control vector, degrees, checked; infinity is an answer, NaN is not.
    fn ask<P: Plant>(
        &self,
        plant: &mut P,
        control_volt: &[f64],
    ) -> Result<Vec<f64>, RunError<P::Error>> {
        let strokes_deg = plant.strokes_deg(control_volt).map_err(|source| RunError::Plant {
            call: PlantCall::Strokes { control_volt: control_volt.to_vec() },
            history: Vec::new(),
            source,
        })?;
        let (what, found, expected) = ("strokes", strokes_deg.len(), self.limits_deg.len());
        if found != expected {
            Err(ControlError::Length { what, found, expected })?;
        }
        if let Some(index) = strokes_deg.iter().position(|stroke| stroke.is_nan()) {
            let (what, value) = ("stroke (deg)", strokes_deg[index]);
            Err(ControlError::NotFinite { what, index, value })?;
        }
        Ok(strokes_deg)
    }

    /// Whether a control of a given weight meets the limit: below it without a weight, at it with one.
    fn met(&self, rho: f64, strokes_deg: &[f64]) -> Option<StrokeStatus> {
        let ratio = self.ratio(strokes_deg);
        if ratio > 1.0 {
            None
        } else if rho == 0.0 {
            Some(StrokeStatus::Free)
        } else {
            (ratio >= 1.0 - self.tolerance).then_some(StrokeStatus::AtLimit)
        }
    }

    /// Largest stroke over its limit.
    fn ratio(&self, strokes_deg: &[f64]) -> f64 {
        strokes_deg
            .iter()
            .zip(&self.limits_deg)
            .filter(|(_, limit)| limit.is_finite())
            .map(|(stroke, limit)| stroke / limit)
            .fold(0.0, f64::max)
    }
}

/// Searches `ln rho` for the target stroke; `evaluate` gives the stroke ratio of a weight.
///
/// The stroke falls to zero as `rho` grows; if it is within its limit at `rho = 0`, that is the
/// answer, and otherwise there is a root above 0.
fn find_effort<S, E: std::error::Error + 'static>(
    [target, tolerance]: [f64; 2],
    guess: Option<f64>,
    first_guess: impl FnOnce(f64) -> f64,
    mut evaluate: impl FnMut(f64) -> Result<(f64, S), RunError<E>>,
) -> Result<Weighted<S>, RunError<E>> {
    let mut at = |x: f64| -> Result<Trial<(f64, S)>, RunError<E>> {
        let (ratio, state) = evaluate(x.exp())?;
        Ok(Trial { x, f: (ratio / target).ln(), state: (ratio, state) })
    };
    let weighted = |t: Trial<(f64, S)>, status| {
        let (ratio, state) = t.state;
        Weighted { rho: t.x.exp(), ratio, state, status }
    };
    let guessed = guess.map(|rho| at(rho.ln())).transpose()?;
    let mut here = match guessed {
        Some(guessed) if guessed.f >= -tolerance => guessed,
        below => {
            let free = at(UNWEIGHTED)?;
            if free.state.0 <= 1.0 {
                return Ok(weighted(free, StrokeStatus::Free));
            }
            below.map_or_else(|| at(first_guess(free.state.0).ln()), Ok)?
        }
    };
    let mut stride: f64 = 0.1;
    let mut trials = 1;
    loop {
        if here.f.abs() <= tolerance {
            return Ok(weighted(here, StrokeStatus::AtLimit));
        }
        let upward = here.f > 0.0;
        if upward && here.x > LARGEST_LN_RHO {
            let (rho, stroke_ratio) = (here.x.exp(), here.state.0);
            Err(ControlError::StrokeNotMet { rho, stroke_ratio, trials })?;
        }
        // The stroke of a linear actuator falls no faster than 1 / rho: the root is |f| away or more.
        stride = (2.0 * stride).max(if here.f.is_finite() { 1.5 * here.f.abs() } else { 1.0 });
        let next = at(if upward { here.x + stride } else { here.x - stride })?;
        if next.f.abs() > tolerance && (next.f > 0.0) != upward {
            let found = root_between((here, next), tolerance, |x| at(x).map(|t| (t.f, t.state)))?;
            return Ok(match found {
                Bracketed::Root(root) => weighted(root, StrokeStatus::AtLimit),
                Bracketed::Jump { negative, .. } => weighted(negative, StrokeStatus::BelowJump),
            });
        }
        here = next;
        trials += 1;
    }
}
