//! The loop all controllers share.

use crate::controller::{Knowledge, Verified};
use crate::law::Anchor;
use crate::stroke::{Strokes, track_effort};
use crate::{
    ControlError, ControlLayout, ControlLimits, ControlRun, ControlStep, Cost, FeedbackController,
    FeedbackSettings, KktCertificate, LoopEnd, Measurement, Outcome, Plant, PlantCall, RefusedStep,
    RunError, StepLeave, error, layout::as_harmonics,
};
use rotor_base::Harmonic;

/// A step no longer than this part of the step before belongs to a loop that settles.
const SETTLING: f64 = 0.8;

/// Part of the last step that a step goes back by, and square of the cosine between the two, from which the
/// loop is going to and fro.
const BACKWARD: f64 = 0.8;
/// Part of a step within which its end counts as a place where the loop has been.
const CLOSED: f64 = 0.25;
/// Steps of the longest circle that is looked for.
const LONGEST_CIRCLE: usize = 4;

/// Use of the limits above which a state has left them: they move with the control, and a step that kept
/// them as they stood may not keep them as they are now.
const USAGE_LEFT: f64 = 1.0 + 1e-3;

/// Part of the starting cost below which a difference is rounding.
const COST_ROUNDING: f64 = 1e-14;

/// How the loop weights the control.
pub(crate) enum Effort<'a> {
    /// A given `rho`.
    Fixed(f64),
    /// At every step the `rho` for which the step's control has the target stroke.
    Tracked(&'a Strokes),
    /// A given `rho`, and the plant's limits.
    Cone(f64),
}

/// How far a step is trusted: what holds it near where it sets out from.
///
/// ```text
/// kappa |u - u_here|^2 beside the predicted cost
/// ```
/// Where the loads bend and do not vanish, the quadratic that T predicts is too flat, its optimum too far
/// away, and every step would be halved anew. A step that had to be halved `h` times has measured the bend
/// along it: `kappa` grows by `2^h - 1` times the curvature predicted there, so that the next step is of the
/// length that was taken. A step that keeps its promise makes it smaller again.
///
/// Source: the method of Levenberg and Marquardt; the end of it as in J. More, *The Levenberg-Marquardt
/// algorithm*, Lecture Notes in Mathematics 630 (1978): prediction and measurement both small.
#[derive(Debug, Clone, Copy, Default)]
struct Trust {
    /// `kappa`, 1/V^2.
    weight: f64,
}

/// Part of a promise that a step must keep for the next one to be trusted farther.
const PROMISE_KEPT: f64 = 0.75;
/// Factor by which it is then trusted farther.
const TRUST_GAINED: f64 = 4.0;
/// Weight, over the largest singular value squared, below which nothing holds a step any more.
const FREE: f64 = 1e-8;

impl Trust {
    /// Learns from a step: `parts` of it that were halved away, and what it kept of its promise.
    fn learn(&mut self, (halvings, kept): (u32, f64), curvature: f64, authority: f64) {
        if halvings > 0 {
            self.weight += (2.0_f64.powi(halvings.cast_signed()) - 1.0) * curvature;
        } else if kept < 1.0 - PROMISE_KEPT {
            self.weight += curvature;
        } else if kept > PROMISE_KEPT {
            self.weight /= TRUST_GAINED;
            if self.weight < FREE * authority {
                self.weight = 0.0;
            }
        }
    }
}

/// Where a step leads.
#[derive(Clone)]
struct Aim {
    control_volt: Vec<f64>,
    kkt: Option<KktCertificate>,
}

/// The search along one step.
#[derive(Default)]
struct Search {
    taken: Option<ControlStep>,
    shortest: Option<Cost>,
    left_range: bool,
    measurements: usize,
}

/// Where a step sets out from.
struct Departure<'a> {
    here: &'a ControlStep,
    step: &'a [f64],
    /// Largest amplitude of the step.
    asked_volt: f64,
    rho: f64,
    /// Cost without control at this `rho`.
    start_cost: f64,
    /// Whether the step may raise the cost: back into limits that the state has left, or to the fixed point.
    leave: StepLeave,
}

/// Where no part of a step lowers the cost and it begins to be let rise.
struct Hill {
    /// Steps taken by then.
    taken: usize,
    /// The state there.
    foot: ControlStep,
    /// Cost of the shortest part tried.
    shortest: Cost,
}

/// Steps taken before a loop that goes on from there, and those refused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Taken {
    pub(crate) steps: Vec<ControlStep>,
    pub(crate) refused: Vec<RefusedStep>,
}

/// What a loop has done so far and where it stands.
struct Walk {
    here: ControlStep,
    /// Steps taken, those before it included.
    steps: Vec<ControlStep>,
    /// How many were taken before it.
    before: usize,
    measurements: usize,
    halvings: u32,
    refused: Vec<RefusedStep>,
    kkt: Option<KktCertificate>,
    end: LoopEnd,
    trust: Trust,
    hill: Option<Hill>,
    /// Whether it has given up steps and stands where it stood before them.
    went_back: bool,
    /// Part of a step that is gone: halved wherever it would close a circle.
    share: f64,
    /// What was asked for at the last states in a row that neither brought nor promised a fall worth the name, V.
    quiet_volt: Vec<f64>,
    /// Steps taken when a state was last looked at for that.
    looked_at: Option<usize>,
}

/// Steps that have to bring nothing, one after the other, for a loop that wanders along a flat to end.
pub const FLAT_STEPS: usize = 5;
/// Part of the first of these steps that the last one asks for: below it they become shorter, and the loop will
/// converge.
const WANDERING: f64 = 0.5;

impl Walk {
    fn from(start: &ControlStep, taken: Taken) -> Self {
        let Taken { steps, refused } = taken;
        let halved = steps.iter().map(|s| s.halvings).chain(refused.iter().map(|r| r.halvings));
        Self {
            halvings: halved.sum(),
            here: steps.last().unwrap_or(start).clone(),
            before: steps.len(),
            steps,
            measurements: 0,
            refused,
            kkt: None,
            end: LoopEnd::default(),
            trust: Trust::default(),
            hill: None,
            went_back: false,
            share: 1.0,
            quiet_volt: Vec::new(),
            looked_at: None,
        }
    }

    /// Takes note of a state newly reached; whether the loop wanders along a flat: several steps in a row have brought
    /// no more than `fall`, none is promised, and what they ask for does not become less.
    fn wanders(&mut self, fall: f64) -> bool {
        let cost = |step: &ControlStep| step.cost.total();
        let brought = match self.steps.as_slice() {
            [.., before, here] => cost(before) - cost(here),
            _ => f64::INFINITY,
        };
        if brought > fall || self.end.promise > fall {
            self.quiet_volt.clear();
            return false;
        }
        self.quiet_volt.push(self.end.asked_volt);
        let quiet = self.quiet_volt.len();
        quiet >= FLAT_STEPS
            && self.quiet_volt[quiet - 1] > WANDERING * self.quiet_volt[quiet - FLAT_STEPS]
    }

    fn take(&mut self, step: ControlStep) {
        self.steps.push(step.clone());
        self.here = step;
    }

    /// Whether a step leads back along the last one, and about as far.
    fn turns_back(&self, step: &[f64]) -> bool {
        let [.., before, here] = self.steps.as_slice() else { return false };
        let last = difference(&here.control_volt, &before.control_volt);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (square, along) = (dot(&last, &last), dot(step, &last));
        along < -BACKWARD * square && along * along > BACKWARD * square * dot(step, step)
    }

    /// Whether a step leads to where the loop stood a few steps ago: limits that move with the control can send
    /// it round and round.
    fn closes_a_circle(&self, step: &[f64]) -> bool {
        let [earlier @ .., _before, here] = self.steps.as_slice() else { return false };
        let next: Vec<f64> = here.control_volt.iter().zip(step).map(|(u, d)| u + d).collect();
        let near = CLOSED * largest_amplitude(step);
        let since = earlier.len().saturating_sub(LONGEST_CIRCLE - 1);
        let limits_moved = self.steps[since..].iter().any(|step| step.leave == StepLeave::Limits);
        limits_moved
            && earlier[since..]
                .iter()
                .any(|there| largest_amplitude(&difference(&next, &there.control_volt)) < near)
    }
}

impl FeedbackController {
    /// The state before the first step, measured.
    pub(crate) fn start<P: Plant>(
        &self,
        plant: &mut P,
        start_volt: &[f64],
    ) -> Result<ControlStep, RunError<P::Error>> {
        let (_, controls) = self.law.shape();
        let layout = plant.layout();
        if layout.len() != controls {
            Err(ControlError::Length {
                what: "controls of the plant, against columns of the T matrix",
                found: layout.len(),
                expected: controls,
            })?;
        }
        layout.check(start_volt)?;
        let measurement = self.measured(plant, start_volt, &[])?;
        let cost = self.cost(&measurement, start_volt, 0.0);
        let control_volt = start_volt.to_vec();
        let leave = StepLeave::None;
        let (rho, asked_volt, halvings) = (0.0, 0.0, 0);
        Ok(ControlStep { control_volt, measurement, rho, cost, asked_volt, halvings, leave })
    }

    /// The loop itself, from a measured start; counts no measurement for the start.
    pub(crate) fn iterate<P: Plant>(
        &self,
        plant: &mut P,
        start: &ControlStep,
        effort: &mut Effort<'_>,
    ) -> Result<ControlRun, RunError<P::Error>> {
        self.go_on(plant, (start, Taken::default()), effort)
    }

    /// The loop from the last of some steps that were taken already; they are in its record.
    pub(crate) fn go_on<P: Plant>(
        &self,
        plant: &mut P,
        (start, taken): (&ControlStep, Taken),
        effort: &mut Effort<'_>,
    ) -> Result<ControlRun, RunError<P::Error>> {
        let mut walk = Walk::from(start, taken);
        let mut known = Knowledge::new(&self.controller, &self.law, &walk.here);
        let outcome = loop {
            let ended = self
                .walk(plant, &mut known, effort, (start, &mut walk))
                .and_then(|ended| Ok(self.beyond_the_hill(ended, &mut walk)?));
            let lost = match &ended {
                Ok(outcome) => *outcome == Outcome::Stalled,
                Err(error) => matches!(error, RunError::Control(ControlError::Diverges { .. })),
            };
            if !lost || !known.renew(plant, &walk.here)? {
                break ended?;
            }
            walk.hill = None;
        };
        if walk.went_back {
            let limits = match effort {
                Effort::Cone(_) => Some(limits_at(plant, &walk.here.control_volt)?),
                _ => None,
            };
            let rho = walk.here.rho;
            let aim = aim_of(&known, (rho, Trust::default()), &walk.here, limits.as_ref())?;
            walk.end = Self::end_at(&known, rho, &walk.here, &aim.control_volt)?;
            walk.kkt = aim.kkt;
        }
        Ok(ControlRun {
            rho: walk.here.rho,
            outcome,
            start: self.weighed(start, walk.here.rho),
            steps: walk.steps,
            measurements: walk.measurements + known.measurements,
            halvings: walk.halvings,
            refused: walk.refused,
            identifications: known.identified_after.len(),
            t: known.t()?,
            identified_after: known.identified_after,
            end: walk.end,
            kkt: walk.kkt,
        })
    }

    /// Steps until the loop ends with the T it has, or with what it learns on the way.
    fn walk<P: Plant>(
        &self,
        plant: &mut P,
        known: &mut Knowledge<'_>,
        effort: &mut Effort<'_>,
        (start, walk): (&ControlStep, &mut Walk),
    ) -> Result<Outcome, RunError<P::Error>> {
        let strict = self.strict();
        loop {
            known.steps_taken = walk.steps.len();
            known.refresh(plant, &walk.here)?;
            let rho = match effort {
                Effort::Fixed(rho) | Effort::Cone(rho) => *rho,
                Effort::Tracked(strokes) => track_effort(known, plant, strokes, &walk.here)?,
            };
            walk.here = self.weighed(&walk.here, rho);
            let here = walk.here.clone();
            let start_cost = self.weighed(start, rho).cost.total();
            let limits = match effort {
                Effort::Cone(_) => Some(limits_at(plant, &here.control_volt)?),
                _ => None,
            };
            let aim = aim_of(known, (rho, walk.trust), &here, limits.as_ref())?;
            let whole = if walk.trust.weight > 0.0 {
                aim_of(known, (rho, Trust::default()), &here, limits.as_ref())?
            } else {
                aim.clone()
            };
            walk.went_back = false;
            walk.end = Self::end_at(known, rho, &here, &whole.control_volt)?;
            walk.kkt = whole.kkt.or(walk.kkt.take());
            let mut step = difference(&aim.control_volt, &here.control_volt);
            walk.end.next_volt = largest_amplitude(&step);
            let promise = if strict { known.promise(rho, &here, &aim.control_volt)? } else { 0.0 };
            // inside the limits their optimum is never worse than where the loop stands
            let back = match &limits {
                Some(limits) => {
                    limits.usage(&here.control_volt)? > USAGE_LEFT
                        || promise < -COST_ROUNDING * start_cost
                }
                None => false,
            };
            if self.is_settled(&walk.end, start_cost) {
                match known.verify(plant, &here, &whole.control_volt)? {
                    Verified::Yes => return Ok(Outcome::Converged),
                    Verified::Anew => continue,
                    Verified::Cannot => return Ok(Outcome::Stalled),
                }
            }
            if walk.steps.len() - walk.before >= self.settings.max_steps {
                return Ok(Outcome::StepLimit);
            }
            let is_new = known.is_local() && walk.looked_at != Some(walk.steps.len());
            walk.looked_at = Some(walk.steps.len());
            if is_new && walk.wanders(self.settings.cost_tolerance * start_cost) {
                return Ok(Outcome::Flat);
            }
            if limits.is_some() && walk.turns_back(&step) {
                // out of limits that move with the control and back again: what is sought lies between
                for d in &mut step {
                    *d *= 0.5;
                }
            }
            if limits.is_some() {
                if walk.closes_a_circle(&step) {
                    walk.share *= 0.5;
                }
                for d in &mut step {
                    *d *= walk.share;
                }
            }
            let asked_volt = largest_amplitude(&step);
            let history = || -> Vec<ControlStep> {
                std::iter::once(start).chain(&walk.steps).cloned().collect()
            };
            let leave = match (back, &walk.hill) {
                (true, _) => StepLeave::Limits,
                (false, Some(_)) => StepLeave::Settling,
                (false, None) => StepLeave::None,
            };
            let from = Departure { here: &here, step: &step, asked_volt, rho, start_cost, leave };
            let search = self.search(plant, known, &from, (limits.as_ref(), &history))?;
            walk.measurements += search.measurements;
            walk.halvings +=
                search.taken.as_ref().map_or(self.settings.max_halvings, |s| s.halvings);
            let Some(step) = search.taken else {
                let (after_steps, halvings) = (walk.steps.len(), self.settings.max_halvings);
                walk.refused.push(RefusedStep { after_steps, asked_volt, halvings });
                if known.learn(plant, &here, &aim.control_volt)? {
                    continue;
                }
                match self.refused(&search, known, walk)? {
                    Some(outcome) => return Ok(outcome),
                    None => continue,
                }
            };
            let fall = here.cost.total() - step.cost.total();
            // a part of a step that brings little does not say that the whole would not
            let (whole, halved) = (step.halvings == 0, step.halvings);
            let moved = difference(&step.control_volt, &here.control_volt);
            walk.take(step);
            // a part that was taken because the whole leaves the plant's range says nothing of T
            let measured = whole || search.measurements > 1;
            if strict && measured && !matches!(effort, Effort::Tracked(_)) {
                let curvature = known.law.curvature(rho, &moved) + walk.trust.weight;
                let kept = if promise > 0.0 { fall / promise } else { 1.0 };
                walk.trust.learn((halved, kept), curvature, known.law.largest_authority());
            }
        }
    }

    /// What becomes of a loop no part of whose step was taken and that learnt nothing; none if it goes on over
    /// the hill.
    fn refused(
        &self,
        search: &Search,
        known: &Knowledge<'_>,
        walk: &mut Walk,
    ) -> Result<Option<Outcome>, ControlError> {
        let may_rise = known.is_constant() && !self.strict() && self.settings.settling_cost > 0.0;
        if let (Some(shortest), true, None) = (search.shortest, may_rise, &walk.hill) {
            let (taken, foot) = (walk.steps.len(), walk.here.clone());
            walk.hill = Some(Hill { taken, foot, shortest });
            return Ok(None);
        }
        if walk.steps.is_empty() {
            return Err(self.diverged(&walk.here, search.shortest));
        }
        let beyond = walk.hill.as_ref().is_some_and(|hill| hill.taken < walk.steps.len());
        let out = search.left_range && !beyond;
        Ok(Some(if out { Outcome::OutOfRange } else { Outcome::Stalled }))
    }

    /// The end of a loop that let the cost rise: where it settled, if that is better, or where it set out from.
    fn beyond_the_hill(&self, ended: Outcome, walk: &mut Walk) -> Result<Outcome, ControlError> {
        let Some(Hill { taken, foot, shortest }) = walk.hill.take() else { return Ok(ended) };
        let before = self.weighed(&foot, walk.here.rho).cost.total();
        if ended == Outcome::Converged && walk.here.cost.total() <= before {
            return Ok(ended);
        }
        if taken == 0 {
            return Err(self.diverged(&foot, Some(shortest)));
        }
        for step in walk.steps.drain(taken..) {
            let (asked_volt, halvings) = (step.asked_volt, step.halvings);
            walk.refused.push(RefusedStep { after_steps: taken, asked_volt, halvings });
        }
        (walk.here, walk.went_back) = (foot, true);
        Ok(if ended == Outcome::OutOfRange { ended } else { Outcome::Stalled })
    }

    /// The error of a first step of which no part lowers the cost.
    fn diverged(&self, here: &ControlStep, shortest: Option<Cost>) -> ControlError {
        let (rho, start, history) = (here.rho, here.cost, vec![here.clone()]);
        let divisor = 1_u64 << self.settings.max_halvings;
        match shortest {
            Some(shortest) => ControlError::Diverges { rho, divisor, start, shortest, history },
            None => ControlError::NotAdmitted { rho, divisor, history },
        }
    }

    /// Whether what is still asked for at a state is within the tolerances of the step and, for a loop that may
    /// not raise the cost, of its fall.
    fn is_settled(&self, end: &LoopEnd, start_cost: f64) -> bool {
        let FeedbackSettings { step_tolerance, cost_tolerance, .. } = self.settings;
        end.is_settled([step_tolerance, cost_tolerance], start_cost)
    }

    /// What a loop knows at a state from which it is to go to a control.
    fn end_at(
        known: &Knowledge<'_>,
        rho: f64,
        here: &ControlStep,
        aim_volt: &[f64],
    ) -> Result<LoopEnd, ControlError> {
        LoopEnd::new(&known.law, rho, (&here.control_volt, &known.seen_loads(here)), aim_volt)
    }

    /// Whether no step may raise the cost.
    fn strict(&self) -> bool {
        self.settings.cost_tolerance > 0.0
    }

    /// The step or the longest part of it, halved and halved again, that lowers the cost.
    fn search<P: Plant>(
        &self,
        plant: &mut P,
        known: &mut Knowledge<'_>,
        from: &Departure<'_>,
        (limits, history): (Option<&ControlLimits>, &dyn Fn() -> Vec<ControlStep>),
    ) -> Result<Search, RunError<P::Error>> {
        let Departure { here, step, asked_volt, rho, start_cost, leave } = *from;
        let strict = self.strict();
        let mut search = Search::default();
        for halvings in 0..=self.settings.max_halvings {
            let part = 0.5_f64.powi(halvings.cast_signed());
            let control_volt: Vec<f64> =
                here.control_volt.iter().zip(step).map(|(u, d)| u + part * d).collect();
            if !plant.admits(&control_volt) {
                search.left_range = true;
                continue;
            }
            let measurement = self.measured(plant, &control_volt, &history())?;
            search.measurements += 1;
            known.observe(&control_volt, &measurement.hub_loads);
            let cost = self.cost(&measurement, &control_volt, rho);
            let rise = (cost.total() - here.cost.total()) / start_cost;
            let settles = || -> Result<bool, ControlError> {
                let there = (control_volt.as_slice(), measurement.hub_loads.as_slice());
                let next = aim_from(known, (rho, Trust::default()), there, limits)?.control_volt;
                Ok(largest_amplitude(&difference(&next, &control_volt)) <= SETTLING * asked_volt)
            };
            let allowed = match (leave, strict, limits) {
                (StepLeave::Settling, false, _) => {
                    cost.total() <= self.settings.settling_cost * start_cost
                }
                (_, false, _) => rise <= self.settings.cost_rise_allowance,
                // limits move with the control: the last steps that follow them may cost a trifle
                (_, true, Some(_)) => rise <= self.settings.cost_tolerance,
                (_, true, None) => false,
            };
            let allowed = allowed && halvings == 0;
            if leave == StepLeave::Limits || rise <= COST_ROUNDING || (allowed && settles()?) {
                search.taken = Some(ControlStep {
                    control_volt,
                    measurement,
                    rho,
                    cost,
                    asked_volt,
                    halvings,
                    leave: if rise > COST_ROUNDING { leave } else { StepLeave::None },
                });
                break;
            }
            search.shortest = Some(cost);
        }
        Ok(search)
    }

    /// One checked measurement.
    fn measured<P: Plant>(
        &self,
        plant: &mut P,
        control_volt: &[f64],
        history: &[ControlStep],
    ) -> Result<Measurement, RunError<P::Error>> {
        let measurement = plant.measure(control_volt).map_err(|source| RunError::Plant {
            call: PlantCall::Measure { control_volt: control_volt.to_vec() },
            history: history.to_vec(),
            source,
        })?;
        let (loads, _) = self.law.shape();
        error::check_vector("measured hub loads", &measurement.hub_loads, loads)?;
        let layout: &ControlLayout = plant.layout();
        if measurement.flap_motion_deg.len() != layout.pairs() {
            Err(ControlError::Length {
                what: "measured flap harmonics",
                found: measurement.flap_motion_deg.len(),
                expected: layout.pairs(),
            })?;
        }
        error::check_vector("mean flap angle (deg)", &measurement.mean_flap_deg, layout.flaps())?;
        Ok(measurement)
    }

    fn cost(&self, measurement: &Measurement, control_volt: &[f64], rho: f64) -> Cost {
        Cost::of(&measurement.hub_loads, self.law.load_weights(), control_volt, rho)
    }

    /// The same state with its cost formed with another weight.
    fn weighed(&self, step: &ControlStep, rho: f64) -> ControlStep {
        let cost = self.cost(&step.measurement, &step.control_volt, rho);
        ControlStep { rho, cost, ..step.clone() }
    }
}

/// Largest amplitude of the harmonics of a control vector, volt.
pub(crate) fn largest_amplitude(control_volt: &[f64]) -> f64 {
    as_harmonics(control_volt).iter().map(Harmonic::amplitude).fold(0.0, f64::max)
}

pub(crate) fn difference(to: &[f64], from: &[f64]) -> Vec<f64> {
    to.iter().zip(from).map(|(a, b)| a - b).collect()
}

/// The control the law aims at from a recorded state.
fn aim_of(
    known: &Knowledge<'_>,
    how: (f64, Trust),
    here: &ControlStep,
    limits: Option<&ControlLimits>,
) -> Result<Aim, ControlError> {
    let there = (here.control_volt.as_slice(), here.measurement.hub_loads.as_slice());
    aim_from(known, how, there, limits)
}

/// The control the law aims at from a measured state `(u, Z)`.
fn aim_from(
    known: &Knowledge<'_>,
    (rho, trust): (f64, Trust),
    (control_volt, hub_loads): (&[f64], &[f64]),
    limits: Option<&ControlLimits>,
) -> Result<Aim, ControlError> {
    let target = known.target(control_volt, hub_loads)?;
    let anchor = Anchor { weight: trust.weight, control_volt };
    Ok(match limits {
        None => Aim { control_volt: known.law.optimum_near(rho, &target, anchor), kkt: None },
        Some(limits) => {
            let found = known.law.optimum_of_target_within(rho, (&target, anchor), limits)?;
            Aim { control_volt: found.control_volt, kkt: Some(found.certificate) }
        }
    })
}

fn limits_at<P: Plant>(
    plant: &mut P,
    control_volt: &[f64],
) -> Result<ControlLimits, RunError<P::Error>> {
    plant.limits(control_volt).map_err(|source| RunError::Plant {
        call: PlantCall::Limits { control_volt: control_volt.to_vec() },
        history: Vec::new(),
        source,
    })
}
