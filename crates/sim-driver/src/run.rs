//! `hhc run`: a case trimmed, its baseline vibration, its control.

use crate::SimError;
use crate::actuator::{CaseActuators, case_actuators};
use crate::case::LoadedCase;
use crate::progress::Progress;
use crate::results::{
    Baseline, ControlRecord, Figures, MeanHubLoads, Residuals, RunResult, TrimLine, figures,
};
use crate::sweep::continued_trim;
use rotor_response::StationLoads;
use rotor_study::{
    ControlStudy, Drives, HubLoads, Setting, StabilityLine, StudyError, TrimmedRotor, control_all,
    each_unlike_blade, forecasts, station_lines, unlike_lines, wake_status, wake_warnings,
};
use std::sync::Arc;
use trim::TrimSolution;

/// What a run leaves behind.
#[derive(Debug, Clone)]
pub struct RunOutcome {
    /// What is stored.
    pub result: RunResult,
    /// What its figures share.
    pub setting: Setting,
    /// The actuators used.
    pub actuators: CaseActuators,
    /// The trimmed rotor.
    pub trimmed: TrimmedRotor,
    /// Loads of one blade at the stations of the case, flaps at rest.
    pub blade_loads: Vec<StationLoads>,
    /// The drives of the flaps with their stroke limits.
    pub drives: Drives,
    /// Every control study, in the order of the result.
    pub studies: Vec<ControlStudy>,
}

impl RunOutcome {
    /// The figures of the result.
    pub fn figures(&self) -> Figures {
        figures(&self.result, &self.setting)
    }
}

/// Steps of the progress bar of [`run_case`]: actuator, trim and every control study.
pub fn steps_of(loaded: &LoadedCase) -> usize {
    2 + loaded.case.control.harmonics.len() * loaded.case.control.actuators.len()
}

/// Runs a case.
///
/// # Errors
/// Problems of the data, and failures of identification, trim and response, each with the place of
/// the case that asked for it.
pub fn run_case(loaded: &LoadedCase, progress: &Progress) -> Result<RunOutcome, SimError> {
    progress.doing("actuator");
    let actuators = case_actuators(loaded)?;
    progress.step();
    progress.doing("trim");
    let trimmed = continued_trim(loaded, None)?;
    progress.step();
    run_trimmed(loaded, actuators, trimmed, progress)
}

/// The same from the trim on.
///
/// # Errors
/// As [`run_case`].
pub fn run_trimmed(
    loaded: &LoadedCase,
    actuators: CaseActuators,
    trimmed: TrimmedRotor,
    progress: &Progress,
) -> Result<RunOutcome, SimError> {
    progress.doing("control");
    let failed = |error| loaded.located(error);
    let drives = Drives::new(&loaded.case, actuators.real.clone().map(Arc::new)).map_err(failed)?;
    let at = |field: &str, source| {
        loaded.located(StudyError::Response { field: field.to_owned(), source })
    };
    let stability = trimmed.stability().map_err(|source| at("rotor", source))?;
    let stability = StabilityLine::from(&stability);
    let unstable = || stability.warnings(trimmed.trim().flight.advance_ratio);
    let mut powerless = None;
    // without a converged trim nothing is controlled
    let (studies, forecasts) = if trimmed.wake_diverged() {
        (Vec::new(), Vec::new())
    } else {
        match control_all(&loaded.case, &trimmed, &drives, &|| progress.step()) {
            Ok(studies) => (studies, forecasts(&loaded.case, &trimmed, &drives).map_err(failed)?),
            // the baseline can be had all the same
            Err(error) if error.is_powerless() => {
                powerless = Some(format!("{error}. The baseline is given without control"));
                (Vec::new(), Vec::new())
            }
            Err(error) => return Err(failed(error).in_doubt(unstable())),
        }
    };
    let blade_loads = trimmed
        .station_loads(&loaded.case.load_stations_r())
        .map_err(|source| at("response.load_stations_r", source))?;
    let disk = trimmed.disk_loads(loaded.case.tip_mach()).map_err(|source| at("rotor", source))?;
    let mut warnings = loaded.warnings.clone();
    warnings.extend(powerless);
    warnings.extend(actuators.warnings.iter().cloned());
    let found = trimmed.trim();
    let (theta0_rad, most) = (found.controls.theta0_rad, trimmed.largest_section_lift());
    let warned = loaded.case.warnings_in_flight(trimmed.rotor(), theta0_rad, &found.rotor, most);
    warnings.extend(loaded.in_words(warned.map_err(failed)?));
    warnings.extend(trimmed.wake().into_iter().flat_map(wake_warnings));
    warnings.extend(unstable());
    let each_unlike = each_unlike_blade(&loaded.case, &trimmed).map_err(failed)?;
    warnings.extend(each_unlike.iter().flat_map(|line| line.warnings(found.flight.advance_ratio)));
    let baseline = HubLoads::from_parts(found.rotor.hub.harmonic(loaded.case.rotor.blades));
    let setting = Setting::of_case(&loaded.case, &baseline);
    let unlike_blades = unlike_lines(&loaded.case, &trimmed, &studies).map_err(failed)?;
    // flaps at rest stand first; with every blade alike there is no line
    let mean = unlike_blades.first().map_or_else(|| found.rotor.hub.mean(), |rest| rest.mean);
    let result = RunResult {
        mean_loads: Some(MeanHubLoads { hub: mean }),
        trim: trim_line(loaded, found),
        wake: trimmed.wake().map(wake_status),
        residuals: residuals(found),
        baseline: Baseline { hub_nb_per_rev: baseline },
        blade_loads: station_lines(&blade_loads, &loaded.case.scales()),
        disk: Some(disk),
        stability,
        unlike_blades,
        each_unlike_blade: each_unlike,
        control: studies.iter().map(|s| ControlRecord::of(s, loaded.case.rotor.blades)).collect(),
        forecasts,
        warnings,
        ..RunResult::default()
    };
    Ok(RunOutcome { result, setting, actuators, trimmed, blade_loads, drives, studies })
}

fn trim_line(loaded: &LoadedCase, solution: &TrimSolution) -> TrimLine {
    let (controls, attitude) = (&solution.controls, &solution.attitude);
    let case = &loaded.case;
    let model = case.rotor_model();
    TrimLine {
        theta0_deg: controls.theta0_rad.to_degrees(),
        theta1c_deg: controls.theta1c_rad.to_degrees(),
        theta1s_deg: controls.theta1s_rad.to_degrees(),
        alpha_s_deg: attitude.shaft_tilt_rad.to_degrees(),
        phi_s_deg: attitude.roll_rad.to_degrees(),
        tail_thrust: attitude.tail_thrust,
        ct_sigma: solution.rotor.thrust_coefficient / model.solidity(),
        induced_inflow: solution.rotor.inflow.mean(),
        iterations: solution.iterations,
    }
}

fn residuals(solution: &TrimSolution) -> Residuals {
    Residuals {
        trim: solution.residual,
        periodicity: solution.rotor.residuals.periodicity,
        inflow: solution.rotor.residuals.inflow,
    }
}
