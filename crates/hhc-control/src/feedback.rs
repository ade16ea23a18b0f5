//! The feedback controller: eq. (8)-(10) as a trust-region method with a line search.

#[cfg(doc)]
use crate::StopReason;
use crate::iteration::{Iteration, Method, Path, Weighting};
use crate::sensitivity::Sensitivity;
use crate::{
    ControlError, ControlRun, ControlStep, Controller, FeedbackLaw, FeedbackSettings, LoadWeights,
    Plant, RunError, TMatrix, error,
};

/// The control loop of eq. (8)-(10), fed back with the measured loads: with one constant T0 as in the
/// paper, or with any other [`Controller`].
///
/// At each step the control goes to the optimum that [`FeedbackLaw`] sees from the last measurement.
/// A step whose measured cost is higher than the present one, *with the same* `rho`, is halved (backtracking), and
/// so is one that the plant does not admit ([`Plant::admits`]).
///
/// On a linear plant with exact T0 the first step reaches the optimum. With T0 wrong by a complex
/// factor `g exp(i phi)` (voltage harmonics as complex numbers) and `rho = 0` the error of the control
/// contracts per full step by
///
/// ```text
/// |1 - exp(-i phi) / g|
/// ```
/// so that full steps converge for `|phi| < 60 deg` if the gain is right. Whether they also lower the
/// cost depends on the condition number `k` of T: sure they do, after enough backtracks, for
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
            Controller::Adaptive(settings) => settings.estimator.check()?,
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
    /// history. A run that stalls later or meets its step limit is not an error: see [`StopReason`].
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
        self.run_with(plant, Weighting::Fixed(rho), start_volt)
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
        self.run_with(plant, Weighting::WithinLimits(rho), start_volt)
    }

    fn run_with<P: Plant>(
        &self,
        plant: &mut P,
        weighting: Weighting<'_>,
        start_volt: &[f64],
    ) -> Result<ControlRun, RunError<P::Error>> {
        if let Weighting::Fixed(rho) | Weighting::WithinLimits(rho) = weighting {
            error::check_not_negative("control weight rho (1/V^2)", rho)?;
        }
        let start = self.law.start(plant, start_volt)?;
        let mut run = self.iterate(plant, &start, Path::default(), weighting)?;
        run.measurements += 1;
        Ok(run)
    }

    /// The loop from a measured start, or from the last of some steps that were taken already; counts no measurement
    /// for the start.
    pub(crate) fn iterate<P: Plant>(
        &self,
        plant: &mut P,
        start: &ControlStep,
        taken: Path,
        weighting: Weighting<'_>,
    ) -> Result<ControlRun, RunError<P::Error>> {
        let here = taken.steps.last().unwrap_or(start);
        let model = Sensitivity::new(&self.controller, &self.law, here)?;
        let method = Method { settings: &self.settings, law: &self.law, weighting };
        Iteration::new(plant, method, model, start, taken).run()
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
