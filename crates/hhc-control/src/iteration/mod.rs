//! The method all controllers share: a trust-region step on the predicted cost, a line search on the measured one.
//!
//! One pass through [`Iteration::iterate`] is one step. Its policies stand in files of their own: the subproblem with its
//! damping ([`subproblem`], [`trust_region`]), the damping of cycles ([`cycling`]), acceptance ([`line_search`]), and
//! the test of stagnation ([`stagnation`]). How T is held is [`crate::sensitivity`].

mod cycling;
mod evaluate;
mod line_search;
mod stagnation;
mod subproblem;
mod trust_region;

use crate::effort::{StrokeLimits, track_effort};
use crate::layout::{difference, largest_amplitude};
use crate::sensitivity::{Sensitivity, Verified};
use crate::{
    Acceptance, AllowedIncrease, ControlError, ControlRun, ControlStep, Cost, FeedbackLaw,
    FeedbackSettings, KktResidual, LoopEnd, OperatingPoint, Plant, RunError, StopReason,
};
use cycling::CycleDamping;
use line_search::{Allowance, COST_ROUNDING, Searched};
use stagnation::Stagnation;
use subproblem::{Subproblem, Target, limits_at};
use trust_region::{Experience, TrustRegion};

/// Use of the limits above which a state has left them: they move with the control.
const USAGE_LEFT: f64 = 1.0 + 1e-3;

/// How the control is weighted and limited.
#[derive(Clone, Copy)]
pub(crate) enum Weighting<'a> {
    /// A given `rho`.
    Fixed(f64),
    /// At every step the `rho` for which the step's control has the target stroke.
    Tracked(&'a StrokeLimits),
    /// A given `rho`, and the plant's limits.
    WithinLimits(f64),
}

/// What a run is made with.
#[derive(Clone, Copy)]
pub(crate) struct Method<'a> {
    pub(crate) settings: &'a FeedbackSettings,
    /// The law with T0: its load weights form every cost.
    pub(crate) law: &'a FeedbackLaw,
    pub(crate) weighting: Weighting<'a>,
}

/// The steps taken, and the backtracks on the way.
#[derive(Debug, Clone, Default)]
pub(crate) struct Path {
    pub(crate) steps: Vec<ControlStep>,
    /// Of all steps, those that were rejected in full included.
    pub(crate) backtracks: u32,
}

/// The state from which a non-monotone line search began.
struct Watchdog {
    /// Steps taken by then.
    steps: usize,
    foot: ControlStep,
    /// Cost of the shortest part of the step that was rejected there.
    shortest: Cost,
}

/// A run under way.
pub(crate) struct Iteration<'a, P> {
    plant: &'a mut P,
    method: Method<'a>,
    model: Sensitivity<'a>,
    start: &'a ControlStep,
    here: ControlStep,
    path: Path,
    /// Steps in the path before the first one of this run.
    before: usize,
    measurements: usize,
    trust: TrustRegion,
    cycles: CycleDamping,
    stagnation: Stagnation,
    watchdog: Option<Watchdog>,
    /// Whether the run has gone back to the foot of a non-monotone line search.
    went_back: bool,
    end: LoopEnd,
    kkt: Option<KktResidual>,
}

impl<'a, P: Plant> Iteration<'a, P> {
    /// A run from a measured start, or from the last of some steps taken already; they are in its record.
    pub(crate) fn new(
        plant: &'a mut P,
        method: Method<'a>,
        model: Sensitivity<'a>,
        start: &'a ControlStep,
        path: Path,
    ) -> Self {
        Self {
            plant,
            method,
            model,
            start,
            here: path.steps.last().unwrap_or(start).clone(),
            before: path.steps.len(),
            measurements: 0,
            path,
            trust: TrustRegion::default(),
            cycles: CycleDamping::default(),
            stagnation: Stagnation::default(),
            watchdog: None,
            went_back: false,
            end: LoopEnd::default(),
            kkt: None,
        }
    }

    /// Iterates until the run stops, a constant T being renewed where it no longer lowers the cost.
    pub(crate) fn run(mut self) -> Result<ControlRun, RunError<P::Error>> {
        let stop = loop {
            let ended = self.iterate().and_then(|stop| Ok(self.end_non_monotone(stop)?));
            let is_lost = matches!(
                ended,
                Ok(StopReason::Stalled) | Err(RunError::Control(ControlError::Diverges { .. }))
            );
            if !is_lost || !self.model.renew(self.plant, &self.here)? {
                break ended?;
            }
            self.watchdog = None;
        };
        if self.went_back {
            let problem = self.subproblem_with(self.here.rho)?;
            let target = problem.target(&self.model, self.here.point(), 0.0)?;
            self.end = self.next_step(&problem, &target)?;
            self.kkt = target.kkt;
        }
        Ok(ControlRun {
            rho: self.here.rho,
            stop,
            start: self.method.law.weighed(self.start, self.here.rho),
            steps: self.path.steps,
            measurements: self.measurements + self.model.counts.measurements,
            backtracks: self.path.backtracks,
            identifications: self.model.counts.identifications,
            t: self.model.law.t().clone(),
            end: self.end,
            kkt: self.kkt,
        })
    }

    /// Steps until the run stops with the T it has, or with what it learns on the way.
    fn iterate(&mut self) -> Result<StopReason, RunError<P::Error>> {
        let Method { settings, law, weighting } = self.method;
        loop {
            self.model.refresh(self.plant, &self.here)?;
            let rho = match weighting {
                Weighting::Fixed(rho) | Weighting::WithinLimits(rho) => rho,
                Weighting::Tracked(strokes) => {
                    track_effort(&self.model, self.plant, strokes, &self.here)?
                }
            };
            self.here = law.weighed(&self.here, rho);
            let here = self.here.clone();
            let start_cost = law.weighed(self.start, rho).cost.total();
            let problem = self.subproblem_with(rho)?;
            let target = problem.target(&self.model, here.point(), self.trust.weight)?;
            let undamped = if self.trust.weight > 0.0 {
                problem.target(&self.model, here.point(), 0.0)?
            } else {
                target.clone()
            };
            let mut step = difference(&target.control_volt, &here.control_volt);
            self.went_back = false;
            self.end = self.next_step(&problem, &undamped)?;
            self.end.next_volt = largest_amplitude(&step);
            self.kkt = undamped.kkt.or(self.kkt);
            let predicted = self.model.predicted_decrease(rho, &here, &target.control_volt)?;
            // inside the limits their optimum is never worse than the present state
            let restores = match &problem.limits {
                Some(limits) => {
                    limits.usage(&here.control_volt)? > USAGE_LEFT
                        || predicted < -COST_ROUNDING * start_cost
                }
                None => false,
            };
            let cost_tolerance = settings.acceptance.cost_tolerance();
            let tolerances = [settings.step_tolerance, cost_tolerance];
            if self.end.is_converged(tolerances, start_cost) {
                match self.model.verify(self.plant, &here, &undamped.control_volt)? {
                    Verified::Yes => return Ok(StopReason::Converged),
                    Verified::Anew => continue,
                    Verified::Cannot => return Ok(StopReason::Stalled),
                }
            }
            if self.path.steps.len() - self.before >= settings.max_steps {
                return Ok(StopReason::StepLimit);
            }
            let decrease = cost_tolerance * start_cost;
            if self.model.is_local()
                && self.stagnation.detect(&self.path.steps, &self.end, decrease)
            {
                return Ok(StopReason::Stagnated);
            }
            if problem.limits.is_some() {
                self.cycles.shorten(&mut step, &self.path.steps);
            }
            let allowance = self.allowance(&problem, restores, start_cost);
            let found = self.search(&problem, &step, allowance, start_cost)?;
            self.measurements += found.measurements;
            if found.taken.is_some() {
                self.accept(found, predicted);
            } else if let Some(stop) = self.reject(&found, &target)? {
                return Ok(stop);
            }
        }
    }

    /// The subproblem of the present state.
    fn subproblem_with(&mut self, rho: f64) -> Result<Subproblem, RunError<P::Error>> {
        let limits = match self.method.weighting {
            Weighting::WithinLimits(_) => Some(limits_at(self.plant, &self.here.control_volt)?),
            _ => None,
        };
        Ok(Subproblem { rho, limits })
    }

    /// The step from the present state to a target.
    fn next_step(&self, problem: &Subproblem, target: &Target) -> Result<LoopEnd, ControlError> {
        let outputs = self.model.seen_outputs(self.here.point());
        let from = OperatingPoint { outputs: &outputs, ..self.here.point() };
        LoopEnd::new(&self.model.law, problem.rho, from, &target.control_volt)
    }

    /// What the next line search accepts beside a lower cost.
    fn allowance(&self, problem: &Subproblem, restores: bool, start_cost: f64) -> Allowance {
        let here = self.here.cost.total();
        let acceptance = self.method.settings.acceptance;
        let ceiling = match acceptance {
            Acceptance::NonMonotone { largest_cost, .. } if self.watchdog.is_some() => {
                largest_cost * start_cost
            }
            Acceptance::NonMonotone { allowed_increase, .. } => {
                here + allowed_increase * start_cost
            }
            Acceptance::Monotone { cost_tolerance } if problem.limits.is_some() => {
                here + cost_tolerance * start_cost
            }
            Acceptance::Monotone { .. } => here,
        };
        let allowed_increase = match (restores, &self.watchdog) {
            (true, _) => AllowedIncrease::Restoration,
            (false, Some(_)) => AllowedIncrease::NonMonotone,
            (false, None) => AllowedIncrease::None,
        };
        Allowance { allowed_increase, ceiling }
    }

    /// Takes the part of a step that a line search accepted, `predicted` being the decrease of the whole.
    fn accept(&mut self, found: Searched, predicted: f64) {
        let Some(step) = found.taken else { return };
        self.path.backtracks += step.backtracks;
        let decrease = self.here.cost.total() - step.cost.total();
        // a part that was taken because the whole leaves the plant's range says nothing of T
        let is_tested = step.backtracks == 0 || found.measurements > 1;
        if is_tested && self.method.settings.acceptance.trusts_predictions() {
            let moved = difference(&step.control_volt, &self.here.control_volt);
            self.trust.update(&Experience {
                backtracks: step.backtracks,
                gain_ratio: if predicted > 0.0 { decrease / predicted } else { 1.0 },
                curvature: self.model.law.curvature(step.rho, &moved) + self.trust.weight,
                authority: self.model.law.largest_authority(),
            });
        }
        self.path.steps.push(step.clone());
        self.here = step;
    }

    /// After a step that was rejected in full: why the run stops; none if it goes on with what it has learnt, or with
    /// a non-monotone line search.
    fn reject(
        &mut self,
        found: &Searched,
        target: &Target,
    ) -> Result<Option<StopReason>, RunError<P::Error>> {
        let settings = self.method.settings;
        self.path.backtracks += settings.max_backtracks;
        let here = self.here.clone();
        if self.model.learn(self.plant, &here, &target.control_volt)? {
            return Ok(None);
        }
        let may_rise = self.model.is_constant() && settings.acceptance.largest_cost() > 0.0;
        if let (Some(shortest), true, None) = (found.shortest, may_rise, &self.watchdog) {
            self.watchdog = Some(Watchdog { steps: self.path.steps.len(), foot: here, shortest });
            return Ok(None);
        }
        if self.path.steps.is_empty() {
            return Err(self.diverged(&here, found.shortest).into());
        }
        let rose = self.watchdog.as_ref().is_some_and(|w| w.steps < self.path.steps.len());
        let is_out = found.left_range && !rose;
        Ok(Some(if is_out { StopReason::OutOfRange } else { StopReason::Stalled }))
    }

    /// The end of a non-monotone line search: where it converged, if that is better, or its foot.
    fn end_non_monotone(&mut self, stop: StopReason) -> Result<StopReason, ControlError> {
        let Some(Watchdog { steps, foot, shortest }) = self.watchdog.take() else {
            return Ok(stop);
        };
        let before = self.method.law.weighed(&foot, self.here.rho).cost.total();
        if stop == StopReason::Converged && self.here.cost.total() <= before {
            return Ok(stop);
        }
        if steps == 0 {
            return Err(self.diverged(&foot, Some(shortest)));
        }
        self.path.steps.truncate(steps);
        (self.here, self.went_back) = (foot, true);
        Ok(if stop == StopReason::OutOfRange { stop } else { StopReason::Stalled })
    }

    /// The error of a first step of which no part lowers the cost.
    fn diverged(&self, here: &ControlStep, shortest: Option<Cost>) -> ControlError {
        let (rho, start, history) = (here.rho, here.cost, vec![here.clone()]);
        let divisor = 1_u64 << self.method.settings.max_backtracks;
        match shortest {
            Some(shortest) => ControlError::Diverges { rho, divisor, start, shortest, history },
            None => ControlError::NotAdmitted { rho, divisor, history },
        }
    }
}
