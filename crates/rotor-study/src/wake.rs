//! A case trimmed in its free wake, with the geometry and the inflow to look at.

use crate::error::StudyError;
use crate::loads::HubLoads;
use crate::rotor::{DiskLoads, TrimmedRotor, descent_warning, passage_warning, wake_warnings};
use rotor_case::{
    Case, CirculationChoice, CirculationShape, FreeWakeValues, GeometryChoice, InflowChoice,
    InflowValues, PrescribedCirculation,
};
use rotor_wake::{
    BladeLines, CirculationMap, ClosestPassage, FlightState, FreeWake, InducedInflow, WakeError,
    WakeRotor, momentum_inflow,
};
use serde::Serialize;
use trim::{WakeOutcome, WakeTrim};

/// One update of wake and trim.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WakeUpdateLine {
    /// Azimuth steps per revolution.
    pub azimuths: usize,
    /// RMS displacement of the last sweep, radius R.
    pub displacement_r: f64,
    /// Largest change of the inflow, tip speed.
    pub inflow_change: f64,
    /// Part of each sweep that was gone.
    pub part: f64,
    /// Collective, deg; none for a prescribed circulation.
    pub theta0_deg: Option<f64>,
}

/// The nearest approach of a tip vortex to a blade.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PassageLine {
    /// Azimuth of the blade, deg.
    pub azimuth_deg: f64,
    /// Station, radius R.
    pub station_r: f64,
    /// Age of the vortex, deg.
    pub age_deg: f64,
    /// Distance, radius R.
    pub distance_r: f64,
    /// Core radius there as the blade feels it, radius R.
    pub core_r: f64,
}

impl From<ClosestPassage> for PassageLine {
    fn from(passage: ClosestPassage) -> Self {
        Self {
            azimuth_deg: passage.azimuth_rad.to_degrees(),
            station_r: passage.station,
            age_deg: passage.age_rad.to_degrees(),
            distance_r: passage.distance,
            core_r: passage.core_radius,
        }
    }
}

/// A trimmed rotor in its free wake, or a wake of prescribed circulation alone.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct WakeResult {
    /// Advance ratio.
    pub advance_ratio: f64,
    /// Whether inflow, geometry and trim agree to the tolerances.
    pub settled: bool,
    /// Whether wake and trim diverged, or settled on too little inflow: what is given is no solution.
    pub diverged: bool,
    /// Collective, lateral and longitudinal cyclic, shaft tilt, deg; none for a prescribed circulation.
    pub controls_deg: Option<[f64; 4]>,
    /// Thrust coefficient over solidity.
    pub ct_sigma: f64,
    /// Mean induced inflow over the lifting part of the disk.
    pub mean_inflow: f64,
    /// The same over Glauert's at the same thrust.
    pub mean_over_glauert: f64,
    /// Length of the near wake, deg.
    pub near_wake_deg: f64,
    /// Core radius of the rolled-up vortices at release, radius R.
    pub core_r: f64,
    /// Core radius of the near wake, radius R; in the sheet of the own blade no wider than its panels ask for.
    pub near_core_r: f64,
    /// Core radius, at least, with which vortices move each other, radius R.
    pub mutual_core_r: f64,
    /// Amplitudes of the hub forces and moments at the blade number per rev, rotor units; none for a prescribed
    /// circulation.
    pub hub_amplitudes: Option<[f64; 6]>,
    /// Nearest approach of a tip vortex to a blade.
    pub closest_passage: Option<PassageLine>,
    /// Every update.
    pub updates: Vec<WakeUpdateLine>,
    /// What a user should know.
    pub warnings: Vec<String>,
}

/// A wake and what it does: the result, the vortices with their circulation, and the inflow.
#[derive(Debug, Clone)]
pub struct FoundWake {
    /// The numbers.
    pub result: WakeResult,
    /// The wake.
    pub wake: FreeWake,
    /// Circulation that moved it.
    pub circulation: CirculationMap,
    /// Its inflow.
    pub inflow: InducedInflow,
    /// What the disk carries; none for a prescribed circulation, which no section makes.
    pub disk: Option<DiskLoads>,
}

/// Trims a case in its free wake, or moves a wake of prescribed circulation; a case with another inflow gets the default
/// wake.
///
/// # Errors
/// The errors of the rotor, of the trim and of the wake.
pub fn wake_of_case(case: &Case) -> Result<FoundWake, StudyError> {
    let file = case.inflow.model.free_wake().unwrap_or_default();
    let model = InflowChoice::FreeWake(file);
    let case = Case { inflow: InflowValues { model }, ..case.clone() };
    if let CirculationChoice::Prescribed(given) = file.circulation {
        return prescribed(&case, &file, &given).map_err(|source| StudyError::Response {
            field: "inflow.model".to_owned(),
            source: source.into(),
        });
    }
    let trimmed = TrimmedRotor::new(&case, None)?;
    let wake = trimmed.wake().ok_or_else(|| StudyError::Refused {
        field: "inflow.model".to_owned(),
        message: "the rotor was trimmed without a free wake".to_owned(),
    })?;
    let at_wake = |source| StudyError::Response { field: "inflow.model".to_owned(), source };
    let disk = trimmed.disk_loads(case.tip_mach()).map_err(at_wake)?;
    Ok(FoundWake {
        disk: Some(disk),
        result: result_of(&case, wake),
        wake: wake.wake.clone(),
        circulation: wake.moving_of_the_wake(),
        inflow: wake.trim.rotor.inflow.clone(),
    })
}

/// What the choices of a wake are.
fn settings_of(wake: &FreeWake) -> WakeResult {
    let settings = wake.settings();
    WakeResult {
        advance_ratio: wake.flight().advance_ratio,
        near_wake_deg: (settings.near_steps() as f64 * settings.step_rad()).to_degrees(),
        core_r: settings.core.radius,
        near_core_r: settings.core.near_radius,
        mutual_core_r: settings.core.mutual_radius,
        ..WakeResult::default()
    }
}

fn result_of(case: &Case, wake: &WakeTrim) -> WakeResult {
    let trim = &wake.trim;
    let ct = trim.rotor.thrust_coefficient;
    let mean = trim.rotor.inflow.mean();
    let c = &trim.controls;
    let angles = [c.theta0_rad, c.theta1c_rad, c.theta1s_rad, trim.attitude.shaft_tilt_rad];
    let hub = HubLoads::from_parts(trim.rotor.hub.harmonic(case.rotor.blades));
    WakeResult {
        settled: wake.outcome == WakeOutcome::Settled,
        diverged: wake.outcome.is_diverged(),
        controls_deg: Some(angles.map(f64::to_degrees)),
        ct_sigma: ct / case.rotor_model().solidity(),
        mean_inflow: mean,
        mean_over_glauert: momentum_inflow(&trim.flight, ct).map_or(f64::NAN, |g| mean / g),
        hub_amplitudes: Some(hub.amplitudes()),
        closest_passage: wake.closest_passage.map(PassageLine::from),
        updates: wake
            .updates
            .iter()
            .map(|u| WakeUpdateLine {
                azimuths: u.azimuths,
                displacement_r: u.displacement,
                inflow_change: u.inflow_change,
                part: u.part,
                theta0_deg: Some(u.theta0_rad.to_degrees()),
            })
            .collect(),
        warnings: wake_warnings(wake),
        ..settings_of(&wake.wake)
    }
}

/// A wake alone, of given circulation on straight blades in the plane of the hub: as it is, or moved by single sweeps until
/// it rests.
fn prescribed(
    case: &Case,
    file: &FreeWakeValues,
    given: &PrescribedCirculation,
) -> Result<FoundWake, WakeError> {
    let (model, mu) = (case.rotor_model(), case.advance_ratio);
    let coupling = case.wake_trim_settings(file);
    let flight =
        FlightState { advance_ratio: mu, shaft_tilt_rad: given.shaft_tilt_deg.to_radians() };
    let ct = given.ct_sigma * model.solidity();
    let glauert = momentum_inflow(&flight, ct)?;
    let azimuths = coupling.wake.azimuths;
    let rotor = WakeRotor::uniform(model.blades, model.root_cutout, file.panels)?;
    let circulation = match given.shape {
        CirculationShape::Constant => {
            let gamma = std::f64::consts::TAU * ct / model.blades as f64;
            CirculationMap::constant(azimuths, file.panels, gamma)?
        }
        CirculationShape::Elliptic => CirculationMap::elliptic(&rotor, azimuths, ct, mu)?,
    };
    let lines = BladeLines::flat(&rotor, azimuths);
    let mut wake = FreeWake::undistorted(rotor, coupling.wake, flight, glauert, lines)?;
    let mut inflow = wake.line_induction(&circulation)?.inflow(&circulation)?;
    let mut updates = Vec::new();
    let mut settled = given.geometry == GeometryChoice::Undistorted;
    while !settled && updates.len() < file.updates {
        let displacement_r = wake.carry_on(coupling.method, 1, &circulation)?;
        let next = wake.line_induction(&circulation)?.inflow(&circulation)?;
        let pairs = next.values().iter().zip(inflow.values());
        let inflow_change = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        let line =
            WakeUpdateLine { azimuths, displacement_r, inflow_change, part: 1.0, theta0_deg: None };
        updates.push(line);
        settled =
            displacement_r <= file.displacement_tolerance_r && inflow_change <= file.tolerance;
        inflow = next;
    }
    let mut warnings = Vec::new();
    if !settled {
        warnings.push(format!(
            "the free wake of prescribed circulation has not settled in {} sweeps; what is given is the last one. Remedy: more `updates`, `mutual_core_r` of 0.1",
            updates.len()
        ));
    }
    warnings.extend(descent_warning(&flight, ct, settled));
    let passage = wake.closest_passage(&circulation)?;
    warnings.extend(passage.and_then(passage_warning));
    let map = InducedInflow::Map(inflow);
    let result = WakeResult {
        settled,
        ct_sigma: given.ct_sigma,
        mean_inflow: map.mean(),
        mean_over_glauert: map.mean() / glauert,
        closest_passage: passage.map(PassageLine::from),
        updates,
        warnings,
        ..settings_of(&wake)
    };
    Ok(FoundWake { result, wake, circulation, inflow: map, disk: None })
}
