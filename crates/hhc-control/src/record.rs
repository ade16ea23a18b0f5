//! The record of a control run.

use crate::layout::{difference, largest_amplitude};
use crate::{
    ControlError, Cost, FeedbackLaw, KktResidual, Measurement, OperatingPoint, TMatrix,
    reduction_percent,
};

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
    /// Backtracks of the line search: how often that change was halved before it was taken.
    pub backtracks: u32,
    /// Why a step was taken that need not lower the cost.
    pub allowed_increase: AllowedIncrease,
}

impl ControlStep {
    /// The control and the outputs measured there.
    pub fn point(&self) -> OperatingPoint<'_> {
        OperatingPoint { control_volt: &self.control_volt, outputs: &self.measurement.outputs }
    }
}

/// What allows a step to raise the cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AllowedIncrease {
    /// Nothing but the small allowance of a contracting full step, [`crate::Acceptance::NonMonotone`].
    #[default]
    None,
    /// Restoration: it leads back into limits that moved with the control.
    Restoration,
    /// The non-monotone line search: no step lowers the cost any more, but full steps contract, on the way to the
    /// fixed point of a constant T. See [`crate::Acceptance::NonMonotone`].
    NonMonotone,
}

/// The next step at the end of a run: how far the run is from its fixed point.
///
/// The step is the undamped one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LoopEnd {
    /// Largest change of a voltage harmonic that is still asked for, V.
    pub asked_volt: f64,
    /// The same of the damped step that the loop would take.
    pub next_volt: f64,
    /// Largest voltage harmonic of the control reached and of the one asked for, V: what the tolerance of the step
    /// refers to.
    pub size_volt: f64,
    /// Decrease of the cost that the undamped step predicts.
    pub promise: f64,
}

/// Changes below a picovolt are rounding, should the optimum be no control at all.
const SMALLEST_CHANGE_VOLT: f64 = 1e-12;

impl LoopEnd {
    /// The step of a law from a state, given by the outputs that the law sees there, to `target_volt`.
    ///
    /// # Errors
    /// Vectors of the wrong length or not finite.
    pub(crate) fn new(
        law: &FeedbackLaw,
        rho: f64,
        from: OperatingPoint<'_>,
        target_volt: &[f64],
    ) -> Result<Self, ControlError> {
        let asked_volt = largest_amplitude(&difference(target_volt, from.control_volt));
        Ok(Self {
            asked_volt,
            next_volt: asked_volt,
            size_volt: largest_amplitude(target_volt).max(largest_amplitude(from.control_volt)),
            promise: law.promise(rho, from, target_volt)?,
        })
    }

    /// Whether a run has converged there: the step is within its tolerance, relative to the largest voltage, and,
    /// with a tolerance of the cost above 0, its predicted decrease within that part of the cost at the start. The
    /// step is then the damped one.
    ///
    /// `tolerances` are those of the step and of the cost, [`crate::FeedbackSettings::step_tolerance`] and
    /// [`crate::Acceptance::cost_tolerance`].
    pub fn is_converged(&self, tolerances: [f64; 2], start_cost: f64) -> bool {
        let [step, cost] = tolerances;
        let within = |volt: f64| volt <= (step * self.size_volt).max(SMALLEST_CHANGE_VOLT);
        if cost > 0.0 {
            within(self.next_volt) && self.promise <= cost * start_cost
        } else {
            within(self.asked_volt)
        }
    }
}

/// Why a control run stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// At the fixed point of eq. (10): it asks for no further change. The next step and, for a controller that
    /// renews T, its predicted decrease of the cost are within their tolerances.
    Converged,
    /// Some steps lowered the cost, but no part of the next one does, and full steps do not contract either: a
    /// constant T0 no longer points downhill. The last state is the best found.
    Stalled,
    /// The next step leads out of the range that the plant admits, and the part of it inside does not lower the
    /// cost.
    OutOfRange,
    /// The allowed number of steps was taken, still moving.
    StepLimit,
    /// Stagnation: five steps in a row have neither brought nor predicted a decrease of the cost
    /// above its tolerance, and they do not become shorter. With a T that is found anew at every step.
    Stagnated,
}

/// A recorded control run.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlRun {
    /// Control weight, `W_u = rho I`, 1/V^2.
    pub rho: f64,
    /// Why it stopped.
    pub stop: StopReason,
    /// The state before the first step.
    pub start: ControlStep,
    /// The accepted steps, in order.
    pub steps: Vec<ControlStep>,
    /// Measurements made: the start, steps, rejected steps, and what learning T took.
    pub measurements: usize,
    /// Backtracks of all steps together, those that were rejected in full included.
    pub backtracks: u32,
    /// Times T was identified again, or the controls were probed.
    pub identifications: usize,
    /// What is asked for where it ended.
    pub end: LoopEnd,
    /// T as known at the end, 1/V.
    pub t: TMatrix,
    /// How exactly what it asks for at the end is the optimum within the limits; none where there were no limits.
    pub kkt: Option<KktResidual>,
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
