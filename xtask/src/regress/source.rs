//! Computes a case of the sweep with the program.

use std::sync::Arc;

use preisach_dyn::ActuatorModel;
use rotor_study::{Drives, StudyError, TrimmedRotor, control_set};
use sim_driver::SimError;
use sim_driver::actuator::case_actuators;
use sim_driver::case::{
    ControlActuator, ControllerChoice, EffortChoice, FreeWakeValues, InflowChoice, LoadedCase,
    PAPER_CASE, shipped_case,
};

use super::sweep::{SweepInflow, SweepPoint, SweepResult, TrimChannels};

/// Why a case could not be computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The shipped case, its actuator, or the trim.
    #[error(transparent)]
    Driver(#[from] SimError),
    /// The control.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The study answered without the control that was asked for.
    #[error("{point}: the study has no control with the hysteretic actuator")]
    NoControl {
        /// The case.
        point: SweepPoint,
    },
}

/// The program, ready to compute the cases of the sweep.
///
/// Holds the paper's case and the actuator identified for it. Both are made once, before cases run in
/// parallel: the identification is parallel itself.
#[derive(Debug, Clone)]
pub struct Program {
    paper: LoadedCase,
    actuator: Option<Arc<ActuatorModel>>,
}

impl Program {
    /// Reads the paper's case and identifies its actuator.
    ///
    /// # Errors
    /// [`SimError`] if the shipped files are at fault or the identification fails.
    pub fn new() -> Result<Self, SimError> {
        let paper = shipped_case(PAPER_CASE)?;
        let actuator = case_actuators(&paper)?.real.map(Arc::new);
        Ok(Self { paper, actuator })
    }

    /// Computes one case: the paper's rotor in the inflow of the case at another advance ratio, one harmonic of
    /// control, the identified actuator, constant T0 and a tuned control weight as in the paper.
    ///
    /// # Errors
    /// [`SweepError`]: what the driver or the study could not do.
    pub fn sweep_point(&self, point: SweepPoint) -> Result<SweepResult, SweepError> {
        let harmonics = [point.harmonic_per_rev as usize];
        let mut loaded = self.paper.clone();
        loaded.case.advance_ratio = point.advance_ratio;
        loaded.case.inflow.model = match point.inflow {
            SweepInflow::Drees => InflowChoice::Drees,
            SweepInflow::FreeWake => InflowChoice::FreeWake(FreeWakeValues::default()),
        };
        loaded.case.control.harmonics = vec![harmonics.to_vec()];
        loaded.case.control.actuators = vec![ControlActuator::Hysteretic];
        // the paper's controller, which sees every change of plant and law
        loaded.case.control.controller = ControllerChoice::Global;
        loaded.case.control.effort = EffortChoice::MeetStroke;
        let case = &loaded.case;
        let rotor = TrimmedRotor::new(case, None)?;
        let drives = Drives::new(case, self.actuator.clone())?;
        let studies = control_set(case, &rotor, &drives, &harmonics, &|| ())?;
        let study = studies.first().ok_or(SweepError::NoControl { point })?;
        let trim = rotor.trim();
        let counts = &trim.rotor.residuals;
        Ok(SweepResult {
            trim: TrimChannels {
                theta0_deg: trim.controls.theta0_rad.to_degrees(),
                theta1c_deg: trim.controls.theta1c_rad.to_degrees(),
                theta1s_deg: trim.controls.theta1s_rad.to_degrees(),
                alpha_s_deg: trim.attitude.shaft_tilt_rad.to_degrees(),
                phi_s_deg: trim.attitude.roll_rad.to_degrees(),
                inflow: trim.flight.normal_inflow() + trim.rotor.inflow.mean(),
            },
            baseline_loads: trim.rotor.hub.harmonic(case.rotor.blades),
            controlled_loads: study.state.rotor.hub.harmonic(case.rotor.blades),
            j_before: study.j_before,
            j_after: study.j_after,
            t_matrix_norm_per_volt: study.t_norm(),
            counts: rotor
                .wake()
                .map(|wake| ("wake_updates", wake.updates.len()))
                .into_iter()
                .chain([
                    ("trim_iterations", trim.iterations),
                    ("inflow_iterations", counts.inflow_iterations),
                    ("control_steps", study.steps()),
                    ("control_halvings", study.backtracks() as usize),
                ])
                .collect(),
        })
    }
}
