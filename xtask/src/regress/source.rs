//! Computes a case of the sweep with the program.

use std::sync::{Arc, LazyLock};

use preisach_dyn::ActuatorModel;
use sim_driver::SimError;
use sim_driver::actuator::case_actuators;
use sim_driver::case::{ControlActuator, InflowChoice, LoadedCase, PAPER_CASE, shipped_case};
use sim_driver::study::{Drives, StudyError, TrimmedRotor, control_set};

use super::sweep::{SweepPoint, SweepResult, TrimChannels};

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

/// The paper's case with its identified actuator.
struct Paper {
    loaded: LoadedCase,
    actuator: Option<Arc<ActuatorModel>>,
}

/// Identified once: all cases of the sweep share it.
static PAPER: LazyLock<Result<Paper, SimError>> = LazyLock::new(|| {
    let loaded = shipped_case(PAPER_CASE)?;
    let actuator = case_actuators(&loaded)?.real.map(Arc::new);
    Ok(Paper { loaded, actuator })
});

/// Computes one case: the paper's rotor with Drees inflow at another advance ratio, one harmonic of
/// control, the identified actuator.
///
/// # Errors
/// [`SweepError`]: what the driver or the study could not do.
pub fn sweep_point(point: SweepPoint) -> Result<SweepResult, SweepError> {
    let paper = PAPER.as_ref().map_err(Clone::clone)?;
    let harmonics = [point.harmonic_per_rev as usize];
    let mut loaded = paper.loaded.clone();
    let case = &mut loaded.case;
    case.advance_ratio = point.advance_ratio;
    case.inflow = InflowChoice::Drees;
    case.control.harmonics = vec![harmonics.to_vec()];
    case.control.actuators = vec![ControlActuator::Hysteretic];
    let rotor = TrimmedRotor::new(&loaded, None)?;
    let case = &loaded.case;
    let drives = Drives::new(case, paper.actuator.clone())?;
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
        baseline_loads: trim.rotor.hub.harmonic(case.blades),
        controlled_loads: study.state.rotor.hub.harmonic(case.blades),
        j_before: study.j_before,
        j_after: study.j_after,
        t_matrix_norm_per_volt: study.t_norm,
        counts: vec![
            ("trim_iterations", trim.iterations),
            ("response_iterations", counts.response_iterations),
            ("inflow_iterations", counts.inflow_iterations),
            ("control_steps", study.steps()),
            ("control_halvings", study.halvings() as usize),
        ],
    })
}
