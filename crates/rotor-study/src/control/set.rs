//! One set of harmonics under control: its plant, its weights and its controller.

use crate::control::drives::Drives;
use crate::control::study::ControlStudy;
use crate::error::StudyError;
use crate::flaps::{FullScale, PlantError};
use crate::loads::{HubLoads, Setting, loads_cost};
use crate::plant::{PlantState, RotorPlant, output_weights};
use crate::rotor::TrimmedRotor;
use hhc_control::{
    Acceptance, AdaptiveSettings, ControlRun, Controller, FeedbackController, FeedbackLaw,
    FeedbackSettings, Plant, RunError, StopReason, TMatrix,
};
use rotor_case::{Case, ControlActuator, ControllerChoice, EffortChoice, HandedTError};
use std::sync::Arc;

/// One set of harmonics under control: the rotor, its drives and how far they reach.
pub(crate) struct ControlSet<'a> {
    pub(crate) case: &'a Case,
    pub(crate) rotor: &'a TrimmedRotor,
    pub(crate) drives: &'a Drives,
    pub(crate) harmonics: &'a [usize],
    /// Full-scale voltage and stroke limit of every harmonic.
    pub(crate) limits: Vec<FullScale>,
}

impl<'a> ControlSet<'a> {
    pub(crate) fn new(
        case: &'a Case,
        rotor: &'a TrimmedRotor,
        drives: &'a Drives,
        harmonics: &'a [usize],
    ) -> Result<Self, StudyError> {
        let limits = harmonics
            .iter()
            .map(|&n| drives.limit(n).map_or_else(|| drives.full_scale(case, n), Ok))
            .collect::<Result<Vec<FullScale>, _>>()?;
        Ok(Self { case, rotor, drives, harmonics, limits })
    }
}

impl ControlSet<'_> {
    pub(crate) fn failed(
        &self,
        actuator: ControlActuator,
        source: RunError<PlantError>,
    ) -> StudyError {
        StudyError::Control {
            harmonics: self.harmonics.to_vec(),
            actuator: actuator.name(),
            source: Box::new(source),
        }
    }

    pub(crate) fn plant(&self, actuator: ControlActuator) -> Result<RotorPlant, StudyError> {
        let mut full_scale = self.limits.clone();
        let drive = if actuator == ControlActuator::Ideal {
            let amplitude = self.case.control.amplitude_volt;
            let per_deg = amplitude / self.case.actuator.ideal_amplitude_deg;
            for limit in &mut full_scale {
                limit.amplitude_volt = limit.stroke_deg * per_deg;
                limit.reach_volt = limit.amplitude_volt;
            }
            &self.drives.ideal
        } else {
            let missing = StudyError::NoActuator { actuator: actuator.name() };
            self.drives.hysteretic.as_ref().ok_or(missing)?
        };
        let plant = RotorPlant::new(self.rotor.clone(), drive.clone(), self.harmonics, &full_scale)
            .map_err(|e| self.failed(actuator, e))?;
        let control = &self.case.control;
        plant
            .with_power(control.power_limit_watt, control.power_weight_per_watt)
            .map_err(RunError::plant("linearised", &[]))
            .map_err(|e| self.failed(actuator, e))
    }

    /// Weight of each load: those of the case, over the squared baseline amplitude if it asks for that.
    pub(crate) fn load_weights(&self) -> [f64; 6] {
        let baseline = self.rotor.trim().rotor.hub.harmonic(self.case.rotor.blades);
        Setting::of_case(self.case, &HubLoads::from_parts(baseline)).load_weights()
    }

    /// The step of the T matrix, V.
    pub(super) fn step_volt(&self) -> f64 {
        self.case.t_step_volt()
    }

    /// The same for every control of a plant.
    pub(super) fn step_volts(&self, plant: &RotorPlant) -> Vec<f64> {
        vec![self.step_volt(); plant.layout().len()]
    }

    /// T0 of the local controller: its T is that of the linearised rotor at every control, and so at none.
    pub(super) fn t_at_rest(&self, plant: &RotorPlant) -> Result<TMatrix, RunError<PlantError>> {
        let found = plant.t_at_rest(self.step_volt());
        found.map_err(RunError::plant("linearised", &plant.layout().zero()))
    }

    /// T that the case hands in for a plant, its power outputs beside; none for an actuator that it is not of.
    ///
    /// # Errors
    /// [`StudyError::Refused`] for a set or an advance ratio that it does not hold.
    pub(super) fn handed_t(
        &self,
        actuator: ControlActuator,
        plant: &RotorPlant,
    ) -> Result<Option<TMatrix>, StudyError> {
        let driven = match self.drives.hysteretic {
            Some(_) => ControlActuator::Hysteretic,
            None => ControlActuator::Ideal,
        };
        let Some(handed) = self.case.control.handed_t.as_ref().filter(|_| actuator == driven)
        else {
            return Ok(None);
        };
        let refused = |error: HandedTError| StudyError::Refused {
            field: "control.t_file".to_owned(),
            message: error.to_string(),
        };
        let own = handed.set(self.harmonics).map_err(refused)?;
        let t = own.at(self.rotor.trim().flight.advance_ratio).map_err(refused)?;
        let power = plant.power_outputs();
        let columns = t.columns().into_iter().enumerate();
        let columns: Vec<Vec<f64>> = columns
            .map(|(control, loads)| loads.into_iter().chain(power.along(control)).collect())
            .collect();
        TMatrix::from_columns(&columns).map(Some).map_err(|error| refused(error.into()))
    }

    /// How a controller of the case knows T.
    pub(super) fn t_policy(&self, choice: ControllerChoice, step_volt: Vec<f64>) -> Controller {
        match choice {
            ControllerChoice::Global => Controller::Renewed { step_volt, renewals: RENEWALS },
            ControllerChoice::Local => Controller::Local { step_volt },
            ControllerChoice::Adaptive => Controller::Adaptive(AdaptiveSettings::of_full_scale(
                self.case.control.amplitude_volt,
            )),
        }
    }

    /// T0 of a plant and the controller of the case, `way` of knowing T and of weighting the control included.
    pub(super) fn controller(
        &self,
        t: &TMatrix,
        way: Controller,
        effort: EffortChoice,
    ) -> Result<FeedbackController, RunError<PlantError>> {
        let control = &self.case.control;
        let settings = FeedbackSettings {
            max_steps: control.max_steps,
            step_tolerance: control.step_tolerance,
            acceptance: acceptance(&way, effort),
            ..FeedbackSettings::default()
        };
        let weights = output_weights(&self.load_weights(), t.loads());
        Ok(FeedbackController::new(t, &weights, settings)?.with_controller(way)?)
    }

    pub(super) fn study(
        &self,
        actuator: ControlActuator,
        plant: &RotorPlant,
        control_volt: Vec<f64>,
        state: PlantState,
    ) -> Result<ControlStudy, StudyError> {
        let blades = self.case.rotor.blades;
        let before = self.rotor.trim().rotor.hub.harmonic(blades);
        let target = self.case.trim_target();
        let trim_imbalance = self
            .rotor
            .imbalance(&target, &state.rotor)
            .map_err(|source| StudyError::Trim { field: "trim".to_owned(), source })?;
        let load_weights = self.load_weights();
        let after = state.rotor.hub.harmonic(blades);
        Ok(ControlStudy {
            power: plant.power_outputs(),
            harmonics: self.harmonics.to_vec(),
            actuator,
            trim_imbalance,
            control_volt,
            run: None,
            t: None,
            rho: 0.0,
            t_at_end: None,
            step_tolerance: self.case.control.step_tolerance,
            cost_tolerance: 0.0,
            wanted_deg: Vec::new(),
            motion_share: None,
            reach_share: None,
            voltage_share: None,
            stroke_limit_deg: self.limits.iter().map(|l| l.stroke_deg).collect(),
            at_stroke_deg: self.limits.iter().map(|l| l.motion_deg).collect(),
            load_weights,
            j_before: loads_cost(&load_weights, &before),
            j_after: loads_cost(&load_weights, &after),
            state,
        })
    }

    /// The state at a control vector.
    pub(super) fn state(
        &self,
        actuator: ControlActuator,
        plant: &RotorPlant,
        control_volt: &[f64],
    ) -> Result<PlantState, StudyError> {
        let found = plant.state_measured(control_volt);
        let found = found.map_err(RunError::plant("measured", control_volt));
        found.map(Arc::unwrap_or_clone).map_err(|error| self.failed(actuator, error))
    }
}

/// Runs the loop from zero control as the case weights the control; with the weight found, 1/V^2.
pub(super) fn close_loop<P: Plant>(
    controller: &FeedbackController,
    plant: &mut P,
    effort: EffortChoice,
) -> Result<(ControlRun, f64), RunError<P::Error>> {
    Ok(match effort {
        EffortChoice::MeetStroke => {
            let limited = controller.run_within_stroke(plant)?;
            (limited.run, limited.rho)
        }
        EffortChoice::Limits => {
            let rho = least_effort(controller.law());
            (controller.run_constrained(plant, rho)?, rho)
        }
        EffortChoice::Given { rho } => (controller.run(plant, rho)?, rho),
    })
}

/// Times that a constant T which leads nowhere is identified again.
const RENEWALS: u32 = 4;

/// Fall of J that may be left to a loop that has converged, as a part of the uncontrolled J.
const COST_TOLERANCE: f64 = 1e-5;

/// Which steps a loop accepts: a constant T promises what it cannot keep, its end is that of the paper's loop; that of
/// the ideal actuator is right wherever the loop ends, limits or not.
pub(super) fn acceptance(way: &Controller, effort: EffortChoice) -> Acceptance {
    match (way, effort) {
        (Controller::Global, EffortChoice::Limits)
        | (Controller::Local { .. } | Controller::Adaptive(_), _) => {
            Acceptance::Monotone { cost_tolerance: COST_TOLERANCE }
        }
        (Controller::Global | Controller::Renewed { .. }, _) => {
            FeedbackSettings::default().acceptance
        }
    }
}

/// Weight of the control, over the largest singular value of T squared, that picks the least voltage
/// where the optimum is not unique.
const LEAST_EFFORT: f64 = 1e-8;

/// Control weight of a cone program, 1/V^2: with more controls than loads the optimum is one of many, and the least
/// voltage is taken.
pub fn least_effort(law: &FeedbackLaw) -> f64 {
    let scale = law.singular_values().first().map_or(0.0, |s| s * s);
    if law.has_surplus_controls() { LEAST_EFFORT * scale } else { 0.0 }
}

/// Name of the end of a loop.
pub(super) fn stop_name(stop: StopReason) -> &'static str {
    match stop {
        StopReason::Converged => "converged",
        StopReason::Stalled => "stalled",
        StopReason::OutOfRange => "out-of-range",
        StopReason::StepLimit => "step-limit",
        StopReason::Stagnated => "stagnated",
    }
}

/// Name of the end of a study: a loop whose last step is within the tolerances but that could not look at T again is
/// stalled.
pub fn control_status(study: &ControlStudy) -> &'static str {
    let Some(run) = &study.run else { return "taken-over" };
    let tolerances = [study.step_tolerance, study.cost_tolerance];
    let converged = run.end.is_converged(tolerances, run.start.cost.loads);
    match (run.stop, converged) {
        (StopReason::Converged, false) => "not converged",
        (StopReason::Converged, true) => "converged",
        (_, true) => "stalled",
        (stop, false) => stop_name(stop),
    }
}
