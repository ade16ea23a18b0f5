//! `hhc run`: a case trimmed, its baseline vibration, its control.

use crate::SimError;
use crate::actuator::{CaseActuators, case_actuators};
use crate::case::LoadedCase;
use crate::problem::{Fault, Problem};
use crate::progress::Progress;
use crate::results::{
    Baseline, BenchPart, ControlRecord, CurveLine, Figures, MeanHubLoads, MeasuredPart, Residuals,
    RunResult, StoredResult, TrimLine, figures, same_station,
};
use crate::sweep::continued_trim;
use rotor_response::{StationAirloads, StationLoads, TipMotion};
use rotor_study::{
    CURVE_AZIMUTHS, ControlStudy, Drives, HubLoads, Setting, StabilityLine, StudyError,
    TrimmedRotor, VortexComparison, compare_vortices, computed_curves, control_all, control_costs,
    each_unlike_blade, forecasts, fronts, station_lines, unlike_lines, unlike_warnings,
    wake_status, wake_warnings,
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
    /// Air on the sections at every degree: at those stations of the case and of its measured data that carry air.
    pub airloads: Vec<StationAirloads>,
    /// Motion of the blade tip, every degree.
    pub tip: Vec<TipMotion>,
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
    let stability = StabilityLine::from(stability);
    let unstable = || stability.warnings(trimmed.trim().flight.advance_ratio);
    let mut powerless = None;
    // without a converged trim nothing is controlled
    let (studies, forecasts, fronts) = if trimmed.wake_diverged() {
        (Vec::new(), Vec::new(), Vec::new())
    } else {
        match control_all(&loaded.case, &trimmed, &drives, &|| progress.step()) {
            Ok(studies) => {
                let beforehand = forecasts(&loaded.case, &trimmed, &drives).map_err(failed)?;
                (studies, beforehand, fronts(&loaded.case, &trimmed, &drives))
            }
            // the baseline can be had all the same
            Err(error) if error.is_powerless() => {
                powerless = Some(format!("{error}. The baseline is given without control"));
                (Vec::new(), Vec::new(), Vec::new())
            }
            Err(error) => return Err(failed(error).in_doubt(unstable())),
        }
    };
    let blade_loads = trimmed
        .station_loads(&loaded.case.load_stations_r())
        .map_err(|source| at("response.load_stations_r", source))?;
    let disk = trimmed.disk_loads(loaded.case.tip_mach()).map_err(|source| at("rotor", source))?;
    let stations = airload_stations_r(loaded);
    let found = trimmed.airloads(&stations, loaded.case.tip_mach(), CURVE_AZIMUTHS);
    let (airloads, tip) = found.map_err(|source| at("response.load_stations_r", source))?;
    let curves = computed_curves(&airloads, &tip);
    let vortices = vortex_comparison(loaded, &trimmed);
    let mut warnings = loaded.warnings.clone();
    warnings.extend(vortices.is_none().then(|| no_vortices(loaded)).flatten());
    warnings.extend(powerless);
    warnings.extend(actuators.warnings.iter().cloned());
    let found = trimmed.trim();
    let (theta0_rad, most) = (found.controls.theta0_rad, trimmed.largest_section_lift());
    let warned = loaded.case.warnings_in_flight(trimmed.rotor(), theta0_rad, &found.rotor, most);
    warnings.extend(loaded.in_words(warned.map_err(|error| loaded.located(error))?));
    warnings.extend(trimmed.wake().into_iter().flat_map(wake_warnings));
    warnings.extend(unstable());
    let each_unlike = each_unlike_blade(&loaded.case, &trimmed).map_err(failed)?;
    warnings.extend(each_unlike.iter().flat_map(|line| line.warnings(found.flight.advance_ratio)));
    let alone = trimmed_result(loaded, &trimmed);
    let setting = Setting::of_case(&loaded.case, &alone.baseline.hub_nb_per_rev);
    let costs = control_costs(&loaded.case, &trimmed, &drives, &studies).map_err(failed)?;
    let unlike_blades = unlike_lines(&loaded.case, &trimmed, &studies).map_err(failed)?;
    warnings.extend(unlike_warnings(&unlike_blades, &studies));
    // flaps at rest stand first; with every blade alike there is no line
    let unlike = unlike_blades.first().map(|rest| MeanHubLoads { hub: rest.mean });
    let result = RunResult {
        mean_loads: unlike.or(alone.mean_loads),
        blade_loads: station_lines(&blade_loads, &loaded.case.scales()),
        disk: Some(disk),
        curves: curves.iter().map(CurveLine::of).collect(),
        measured: MeasuredPart::of(&loaded.measured, &curves, vortices),
        stability,
        unlike_blades,
        each_unlike_blade: each_unlike,
        control: studies.iter().map(|s| ControlRecord::of(s, loaded.case.rotor.blades)).collect(),
        forecasts,
        costs: (!studies.is_empty()).then_some(costs),
        fronts,
        warnings,
        ..alone
    };
    Ok(RunOutcome {
        result,
        setting,
        actuators,
        trimmed,
        blade_loads,
        airloads,
        tip,
        drives,
        studies,
    })
}

/// The result of a run with its case and the hashes of its inputs, as it is stored.
///
/// # Errors
/// As [`StoredResult::new`], and [`BenchError::Actuator`](bench_study::BenchError::Actuator) if a model cannot follow a bench record.
pub fn stored_of(loaded: &LoadedCase, outcome: &RunOutcome) -> Result<StoredResult, SimError> {
    let bench = BenchPart::of(&outcome.actuators)?;
    let tables = loaded.table_hashes()?;
    let inputs = [&outcome.actuators.inputs, &loaded.measured.inputs, &tables].map(Vec::as_slice);
    let inputs = inputs.concat();
    StoredResult::new(&loaded.case, inputs, bench, outcome.result.clone())
}

/// Stations of the case that carry air, and those of its measured airloads.
fn airload_stations_r(loaded: &LoadedCase) -> Vec<f64> {
    let mut stations = loaded.case.load_stations_r();
    stations.retain(|station| *station >= loaded.case.rotor.root_cutout_r);
    for measured in loaded.measured.curves.iter().filter_map(|curve| curve.station_r) {
        if !stations.iter().any(|own| same_station(Some(*own), Some(measured))) {
            stations.push(measured);
        }
    }
    stations
}

/// Measured centres of vortices beside the tip vortices of the wake; none without either.
fn vortex_comparison(loaded: &LoadedCase, trimmed: &TrimmedRotor) -> Option<VortexComparison> {
    let centres = &loaded.measured.vortex_centres;
    let found = compare_vortices(centres, &trimmed.wake()?.wake);
    (found.compared > 0).then_some(found)
}

/// Why measured vortices are compared with nothing, if there are any.
fn no_vortices(loaded: &LoadedCase) -> Option<String> {
    let message = "no computed tip vortex is near a measured centre: nothing is compared; give inflow: (model: FreeWake()), and centres in m, hub axes (aft, starboard, up)";
    let place = loaded.index.place("measured.vortex_centres");
    let problem = Problem::new(place, Fault::Other(message.to_owned()));
    (!loaded.measured.vortex_centres.is_empty()).then(|| problem.to_string())
}

/// What the trim of a case says without control: controls, residuals, wake, loads on the hub of like blades.
pub fn trimmed_result(loaded: &LoadedCase, trimmed: &TrimmedRotor) -> RunResult {
    let found = trimmed.trim();
    let loads = HubLoads::from_parts(found.rotor.hub.harmonic(loaded.case.rotor.blades));
    RunResult {
        mean_loads: Some(MeanHubLoads { hub: found.rotor.hub.mean() }),
        trim: trim_line(loaded, found),
        wake: trimmed.wake().map(wake_status),
        residuals: residuals(found),
        baseline: Baseline { hub_nb_per_rev: loads },
        ..RunResult::default()
    }
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
