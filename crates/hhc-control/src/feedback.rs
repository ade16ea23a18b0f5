//! The feedback form of the global controller, eq. (8)-(10).

use crate::stroke::{Strokes, track_effort};
use crate::{
    ControlError, ControlLayout, Cost, FeedbackLaw, LoadWeights, Measurement, Plant, PlantCall,
    RunError, TMatrix, error, layout::as_harmonics, reduction_percent,
};
use rotor_base::Harmonic;

/// Settings of the feedback loop.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackSettings {
    /// Accepted control steps at most.
    pub max_steps: usize,
    /// Halvings of one step at most, up to 60; each costs a measurement.
    pub max_halvings: u32,
    /// The loop has converged when eq. (10) asks for a change of no voltage harmonic by more than
    /// this fraction of the largest one.
    pub step_tolerance: f64,
    /// How much a full step may raise the cost and still be taken, as a fraction of the cost at the
    /// start, if the next step asked for after it is shorter by a fifth or more. Where T0 is not exact and
    /// the control is weighted, the fixed point of eq. (10) lies a little beside the least cost, and
    /// the last steps to it raise the cost by a trifle: halving those would keep the loop from
    /// settling. A halved step may raise nothing.
    pub cost_rise_allowance: f64,
    /// Relative tolerance on the stroke: the larger stroke ends between `1 - stroke_tolerance` and 1
    /// times its limit.
    pub stroke_tolerance: f64,
}

impl Default for FeedbackSettings {
    fn default() -> Self {
        Self {
            max_steps: 30,
            max_halvings: 6,
            step_tolerance: 1e-4,
            cost_rise_allowance: 1e-2,
            stroke_tolerance: 1e-3,
        }
    }
}

impl FeedbackSettings {
    fn check(&self) -> Result<(), ControlError> {
        error::check_positive("step tolerance", self.step_tolerance)?;
        error::check_not_negative("cost rise allowance", self.cost_rise_allowance)?;
        error::check_positive("stroke tolerance", self.stroke_tolerance)?;
        let (value, expected) = (f64::from(self.max_halvings), "0 to 60");
        if self.max_halvings > 60 {
            return Err(ControlError::OutOfRange { what: "number of halvings", value, expected });
        }
        Ok(())
    }
}

/// One recorded state of a control run: the start or an accepted step.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlStep {
    /// The control vector `u`, volt.
    pub control_volt: Vec<f64>,
    /// What the plant answered.
    pub measurement: Measurement,
    /// Control weight with which the cost is formed, 1/V^2.
    pub rho: f64,
    /// The cost `J = J_Z + J_u`.
    pub cost: Cost,
    /// Largest change of a voltage harmonic that eq. (10) asked for on the way here, volt.
    pub asked_volt: f64,
    /// How often that change was halved before it was taken.
    pub halvings: u32,
}

/// How a control run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Eq. (10) asks for no further change: its fixed point.
    Converged,
    /// Some steps lowered the cost, but no part of the next one does: near the least cost, where a
    /// constant T0 no longer points downhill. The last state is the best found.
    Stalled,
    /// The next step leads out of the range that the plant admits, and what part of it stays inside
    /// does not lower the cost.
    OutOfRange,
    /// The allowed number of steps was taken, still moving.
    StepLimit,
}

/// A recorded control run.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlRun {
    /// Control weight, `W_u = rho I`, 1/V^2.
    pub rho: f64,
    /// How it ended.
    pub outcome: Outcome,
    /// The state before the first step.
    pub start: ControlStep,
    /// The accepted steps, in order.
    pub steps: Vec<ControlStep>,
    /// Measurements made, rejected steps and the start included.
    pub measurements: usize,
}

impl ControlRun {
    /// The state at the end.
    pub fn last(&self) -> &ControlStep {
        self.steps.last().unwrap_or(&self.start)
    }

    /// Start and accepted steps.
    pub fn history(&self) -> impl Iterator<Item = &ControlStep> {
        std::iter::once(&self.start).chain(&self.steps)
    }

    /// Reduction of the load cost from start to end, percent: see [`reduction_percent`].
    pub fn reduction_percent(&self) -> f64 {
        reduction_percent(self.start.cost.loads, self.last().cost.loads)
    }

    /// Halvings of all accepted steps together.
    pub fn halvings(&self) -> u32 {
        self.steps.iter().map(|step| step.halvings).sum()
    }
}

/// The controller of eq. (8)-(10): one constant T0, fed back with the measured loads.
///
/// At each step the control goes to the optimum that [`FeedbackLaw`] sees from the last measurement.
/// A step whose measured cost is higher than the present one, *with the same* `rho`, is halved, and
/// so is one that the plant does not admit ([`Plant::admits`]).
///
/// On a linear plant with exact T0 the first step reaches the optimum. With T0 wrong by a complex
/// factor `g exp(i phi)` (voltage harmonics as complex numbers) and `rho = 0` the error of the control
/// shrinks per full step by
///
/// ```text
/// |1 - exp(-i phi) / g|
/// ```
/// so that full steps converge for `|phi| < 60 deg` if the gain is right. Whether they also lower the
/// cost depends on the condition number `k` of T: sure they do, once halved enough, for
///
/// ```text
/// |phi| < 2 arctan(1 / k)
/// ```
/// which is 90 deg for `k = 1`, but 37 deg for `k = 3`. If no part of the first step lowers the cost,
/// that is an error, [`ControlError::Diverges`]. A control weight `rho` of the order of the smaller
/// singular values squared takes the edge off an ill-conditioned T.
///
/// With `rho = 0` an error of that kind does not move the fixed point. With `rho > 0` it does: the
/// fixed point solves `rho u = -T0' W_Z Z`, which is the least cost only where T0 is exact.
///
/// Source: eq. (8)-(10).
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackController {
    pub(crate) law: FeedbackLaw,
    pub(crate) settings: FeedbackSettings,
}

/// Changes below a picovolt are rounding, should the optimum be no control at all.
const SMALLEST_CHANGE_VOLT: f64 = 1e-12;

/// A step no longer than this part of the step before belongs to a loop that settles.
const SETTLING: f64 = 0.8;

/// Part of the starting cost below which a difference is rounding.
const COST_ROUNDING: f64 = 1e-14;

/// How the loop weights the control.
pub(crate) enum Effort<'a> {
    /// A given `rho`.
    Fixed(f64),
    /// At every step the `rho` for which the step's control has the target stroke.
    Tracked(&'a Strokes),
}

impl FeedbackController {
    /// A controller from T0 (1/V), load weights and settings.
    ///
    /// # Errors
    /// What [`FeedbackLaw::new`] refuses, and settings outside their range.
    pub fn new(
        t0: &TMatrix,
        load_weights: &LoadWeights,
        settings: FeedbackSettings,
    ) -> Result<Self, ControlError> {
        settings.check()?;
        Ok(Self { law: FeedbackLaw::new(t0, load_weights)?, settings })
    }

    /// The control law with its singular values.
    pub fn law(&self) -> &FeedbackLaw {
        &self.law
    }

    /// Runs the loop from zero control with a given control weight.
    ///
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `rho` | `rho` | 1/V^2 | >= 0 |
    ///
    /// # Errors
    /// [`RunError::Plant`] if the plant fails, [`ControlError::Diverges`] if no part of the first
    /// step lowers the cost, [`ControlError::NotAdmitted`] if none can be measured; all with the
    /// history. A run that stalls later or meets its step limit is not an error: see [`Outcome`].
    pub fn run<P: Plant>(&self, plant: &mut P, rho: f64) -> Result<ControlRun, RunError<P::Error>> {
        let zero = plant.layout().zero();
        self.run_from(plant, rho, &zero)
    }

    /// Runs the loop from another control vector (volt); the reduction then counts from there.
    ///
    /// # Errors
    /// As [`FeedbackController::run`].
    pub fn run_from<P: Plant>(
        &self,
        plant: &mut P,
        rho: f64,
        start_volt: &[f64],
    ) -> Result<ControlRun, RunError<P::Error>> {
        error::check_not_negative("control weight rho (1/V^2)", rho)?;
        let start = self.start(plant, start_volt)?;
        let mut run = self.iterate(plant, &start, &mut Effort::Fixed(rho))?;
        run.measurements += 1;
        Ok(run)
    }

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
        Ok(ControlStep { control_volt, measurement, rho: 0.0, cost, asked_volt: 0.0, halvings: 0 })
    }

    /// The loop itself, from a measured start; counts no measurement for the start.
    pub(crate) fn iterate<P: Plant>(
        &self,
        plant: &mut P,
        start: &ControlStep,
        effort: &mut Effort<'_>,
    ) -> Result<ControlRun, RunError<P::Error>> {
        let mut here = start.clone();
        let mut steps: Vec<ControlStep> = Vec::new();
        let mut measurements = 0;
        let outcome = loop {
            let rho = match effort {
                Effort::Fixed(rho) => *rho,
                Effort::Tracked(strokes) => track_effort(&self.law, plant, strokes, &here)?,
            };
            here = self.weighed(&here, rho);
            let start_cost = self.weighed(start, rho).cost.total();
            let (aim, step) = self.step(rho, &here.control_volt, &here.measurement)?;
            let asked_volt = largest_amplitude(&step);
            let size = largest_amplitude(&aim).max(largest_amplitude(&here.control_volt));
            if asked_volt <= (self.settings.step_tolerance * size).max(SMALLEST_CHANGE_VOLT) {
                break Outcome::Converged;
            }
            if steps.len() >= self.settings.max_steps {
                break Outcome::StepLimit;
            }
            let history =
                || -> Vec<ControlStep> { std::iter::once(start).chain(&steps).cloned().collect() };
            let mut taken = None;
            let mut shortest = None;
            let mut left_range = false;
            for halvings in 0..=self.settings.max_halvings {
                let part = 0.5_f64.powi(halvings.cast_signed());
                let control_volt: Vec<f64> =
                    here.control_volt.iter().zip(&step).map(|(u, d)| u + part * d).collect();
                if !plant.admits(&control_volt) {
                    left_range = true;
                    continue;
                }
                let measurement = self.measured(plant, &control_volt, &history())?;
                measurements += 1;
                let cost = self.cost(&measurement, &control_volt, rho);
                let rise = (cost.total() - here.cost.total()) / start_cost;
                let settles = halvings == 0
                    && rise <= self.settings.cost_rise_allowance
                    && largest_amplitude(&self.step(rho, &control_volt, &measurement)?.1)
                        <= SETTLING * asked_volt;
                if rise <= COST_ROUNDING || settles {
                    taken = Some(ControlStep {
                        control_volt,
                        measurement,
                        rho,
                        cost,
                        asked_volt,
                        halvings,
                    });
                    break;
                }
                shortest = Some(cost);
            }
            if let Some(step) = taken {
                steps.push(step.clone());
                here = step;
                continue;
            }
            if !steps.is_empty() {
                break if left_range { Outcome::OutOfRange } else { Outcome::Stalled };
            }
            let divisor = 1_u64 << self.settings.max_halvings;
            let history = vec![here.clone()];
            Err(match shortest {
                Some(shortest) => {
                    let start = here.cost;
                    ControlError::Diverges { rho, divisor, start, shortest, history }
                }
                None => ControlError::NotAdmitted { rho, divisor, history },
            })?;
        };
        let start = self.weighed(start, here.rho);
        Ok(ControlRun { rho: here.rho, outcome, start, steps, measurements })
    }

    /// The control eq. (10) aims at from a measured state, and the step there, volt.
    fn step(
        &self,
        rho: f64,
        control_volt: &[f64],
        measurement: &Measurement,
    ) -> Result<(Vec<f64>, Vec<f64>), ControlError> {
        let aim = self.law.optimum_volt(rho, control_volt, &measurement.hub_loads)?;
        let step = aim.iter().zip(control_volt).map(|(a, u)| a - u).collect();
        Ok((aim, step))
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
fn largest_amplitude(control_volt: &[f64]) -> f64 {
    as_harmonics(control_volt).iter().map(Harmonic::amplitude).fold(0.0, f64::max)
}
