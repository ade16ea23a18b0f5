//! The feedback controller: what is asked of it and what it answers.

use crate::control_loop::{Effort, difference, largest_amplitude};
use crate::{
    ControlError, Controller, Cost, FeedbackLaw, KktCertificate, LoadWeights, Measurement, Plant,
    RunError, TMatrix, error, reduction_percent,
};

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
    /// Above 0 no step may raise the cost (within limits, which move with the control, by this fraction of the cost
    /// at the start if the next step is shorter by a fifth or more), and the loop has converged only where eq. (10) also promises a
    /// fall of the cost by no more than this fraction of the cost at the start. For controllers that renew T. 0
    /// leaves the test of the step alone: a constant T promises what it cannot keep.
    pub cost_tolerance: f64,
    /// How much a full step may raise the cost and still be taken, as a fraction of the cost at the
    /// start, if the next step asked for after it is shorter by a fifth or more. Where T0 is not exact and
    /// the control is weighted, the fixed point of eq. (10) lies a little beside the least cost, and
    /// the last steps to it raise the cost by a trifle: halving those would keep the loop from
    /// settling. A halved step may raise nothing.
    pub cost_rise_allowance: f64,
    /// How high the cost may go, over that of the start, once no part of a step lowers it any more and T is held
    /// constant: full steps are then taken as long as each next one asked for is shorter by a fifth or more. An
    /// ill-conditioned T that is right up to gain and lag leads to its fixed point, where nothing is to be
    /// gained any more, over a hill. If the loop does not settle below the cost it set out from, it goes back
    /// there and ends as stalled. 0 never lets it rise.
    pub settling_cost: f64,
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
            cost_tolerance: 0.0,
            cost_rise_allowance: 1e-2,
            settling_cost: 10.0,
            stroke_tolerance: 1e-3,
        }
    }
}

impl FeedbackSettings {
    fn check(&self) -> Result<(), ControlError> {
        error::check_positive("step tolerance", self.step_tolerance)?;
        error::check_not_negative("cost tolerance", self.cost_tolerance)?;
        error::check_not_negative("cost rise allowance", self.cost_rise_allowance)?;
        error::check_not_negative("settling cost", self.settling_cost)?;
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
    /// Why a step was taken that need not lower the cost.
    pub leave: StepLeave,
}

/// What allows a step to raise the cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StepLeave {
    /// Nothing but the small allowance of a step after which the loop settles.
    #[default]
    None,
    /// It leads back into limits that moved with the control.
    Limits,
    /// No step lowers the cost any more, but full steps grow shorter: on the way to the fixed point of a
    /// constant T, see [`FeedbackSettings::settling_cost`].
    Settling,
}

/// A step no part of which was taken in the end: those whose cost rose or that the plant did not admit, and those
/// that were taken on the way over a hill and given up again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefusedStep {
    /// Steps of the record taken by then.
    pub after_steps: usize,
    /// Largest change of a voltage harmonic that was asked for, V.
    pub asked_volt: f64,
    /// How often it was halved.
    pub halvings: u32,
}

/// What a loop knew where it ended: with T enough to form the next step again.
///
/// The step is the whole one, nothing holding it near the control reached.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LoopEnd {
    /// The loads it aimed from: those measured, or what a filter makes of them.
    pub seen_loads: Vec<f64>,
    /// Control weight, 1/V^2.
    pub rho: f64,
    /// Largest change of a voltage harmonic that is still asked for, V.
    pub asked_volt: f64,
    /// The same of the step that the loop would take: held near the control where steps had to be halved.
    pub next_volt: f64,
    /// Largest voltage harmonic of the control reached and of the one asked for, V: what the tolerance of the step
    /// refers to.
    pub size_volt: f64,
    /// Fall of the cost that the whole step promises.
    pub promise: f64,
}

/// Changes below a picovolt are rounding, should the optimum be no control at all.
const SMALLEST_CHANGE_VOLT: f64 = 1e-12;

impl LoopEnd {
    /// What is asked for at a control by a law that sees given loads there and goes to `aim_volt`, all vectors of
    /// the layout, V.
    ///
    /// # Errors
    /// Vectors of the wrong length or not finite.
    pub fn new(
        law: &FeedbackLaw,
        rho: f64,
        (control_volt, seen_loads): (&[f64], &[f64]),
        aim_volt: &[f64],
    ) -> Result<Self, ControlError> {
        let asked_volt = largest_amplitude(&difference(aim_volt, control_volt));
        Ok(Self {
            seen_loads: seen_loads.to_vec(),
            rho,
            asked_volt,
            next_volt: asked_volt,
            size_volt: largest_amplitude(aim_volt).max(largest_amplitude(control_volt)),
            promise: law.promise(rho, (control_volt, seen_loads), aim_volt)?,
        })
    }

    /// Whether it is the end of a loop that has converged: the step asked for within its tolerance, relative to the
    /// largest voltage, and, with a tolerance of the cost above 0, its promise within that part of the cost at the
    /// start. Where steps had to be halved because the loads bend, the step is the one that the loop would take.
    pub fn is_settled(&self, [step, cost]: [f64; 2], start_cost: f64) -> bool {
        let within = |volt: f64| volt <= (step * self.size_volt).max(SMALLEST_CHANGE_VOLT);
        if cost > 0.0 {
            within(self.next_volt) && self.promise <= cost * start_cost
        } else {
            within(self.asked_volt)
        }
    }
}

/// How a control run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Eq. (10) asks for no further change: its fixed point. The step asked for and, for a controller that
    /// renews T, the fall that it promises are both within their tolerances.
    Converged,
    /// Some steps lowered the cost, but no part of the next one does, and full steps do not settle either: a
    /// constant T0 no longer points downhill. The last state is the best found.
    Stalled,
    /// The next step leads out of the range that the plant admits, and what part of it stays inside
    /// does not lower the cost.
    OutOfRange,
    /// The allowed number of steps was taken, still moving.
    StepLimit,
    /// Five steps in a row have brought no fall of the cost worth the name, none is promised, and what they ask for
    /// does not become less: the control wanders along a flat of the cost. With a T that is found anew at every step.
    Flat,
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
    /// Measurements made: the start, steps, rejected steps, and what learning T took.
    pub measurements: usize,
    /// Halvings of all steps together, those included of which no part was taken.
    pub halvings: u32,
    /// Steps of which no part is in the record.
    pub refused: Vec<RefusedStep>,
    /// Times T was identified again, or the controls were probed.
    pub identifications: usize,
    /// Steps taken by each of those times.
    pub identified_after: Vec<usize>,
    /// What is asked for where it ended.
    pub end: LoopEnd,
    /// T as known at the end, 1/V.
    pub t: TMatrix,
    /// What shows how exactly what it asks for at the end is the optimum within the limits; none where there were no limits.
    pub kkt: Option<KktCertificate>,
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
}

/// The control loop of eq. (8)-(10), fed back with the measured loads: with one constant T0 as in the
/// paper, or with any other [`Controller`].
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
    pub(crate) controller: Controller,
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
        let law = FeedbackLaw::new(t0, load_weights)?;
        Ok(Self { law, settings, controller: Controller::Global })
    }

    /// The same with another way to know T: re-identified, or adaptive.
    ///
    /// # Errors
    /// Settings of the way outside their range.
    pub fn with_controller(self, controller: Controller) -> Result<Self, ControlError> {
        match &controller {
            Controller::Global => {}
            Controller::Local { step_volt } | Controller::Renewed { step_volt, .. } => {
                let controls = self.law.shape().1;
                error::check_vector("voltage steps of the T matrix (volt)", step_volt, controls)?;
                for &step in step_volt {
                    error::check_positive("voltage step of the T matrix (volt)", step)?;
                }
            }
            Controller::Adaptive(settings) => settings.check()?,
        }
        Ok(Self { controller, ..self })
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
        self.run_with(plant, Effort::Fixed(rho), start_volt)
    }

    /// Runs the loop from another control vector (volt) to the optimum within the plant's limits, as
    /// [`FeedbackController::run_constrained`].
    ///
    /// # Errors
    /// As [`FeedbackController::run_constrained`].
    pub fn run_constrained_from<P: Plant>(
        &self,
        plant: &mut P,
        rho: f64,
        start_volt: &[f64],
    ) -> Result<ControlRun, RunError<P::Error>> {
        self.run_with(plant, Effort::Cone(rho), start_volt)
    }

    fn run_with<P: Plant>(
        &self,
        plant: &mut P,
        mut effort: Effort<'_>,
        start_volt: &[f64],
    ) -> Result<ControlRun, RunError<P::Error>> {
        if let Effort::Fixed(rho) | Effort::Cone(rho) = effort {
            error::check_not_negative("control weight rho (1/V^2)", rho)?;
        }
        let start = self.start(plant, start_volt)?;
        let mut run = self.iterate(plant, &start, &mut effort)?;
        run.measurements += 1;
        Ok(run)
    }

    /// Runs the loop from zero control to the optimum within the plant's limits ([`Plant::limits`]):
    /// every step aims at the optimum of a second-order cone program, never at a clipped one.
    ///
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `rho` | `rho` | 1/V^2 | >= 0; above 0 with more controls than loads |
    ///
    /// # Errors
    /// As [`FeedbackController::run`], and [`ControlError::ConeProgram`].
    pub fn run_constrained<P: Plant>(
        &self,
        plant: &mut P,
        rho: f64,
    ) -> Result<ControlRun, RunError<P::Error>> {
        let zero = plant.layout().zero();
        self.run_constrained_from(plant, rho, &zero)
    }
}
