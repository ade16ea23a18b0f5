//! `hhc wake`: a case trimmed in its free wake, with the geometry and the inflow to look at.

use crate::SimError;
use crate::case::{
    CirculationChoice, CirculationShape, FreeWakeFile, GeometryChoice, InflowChoice, LoadedCase,
    PrescribedCirculation,
};
use crate::inflow::{descent_warning, passage_warning, wake_warnings};
use crate::output::{Printable, Sheet, table};
use crate::study::TrimmedRotor;
use rotor_wake::{
    BladeLines, CirculationMap, ClosestPassage, FilamentStates, FlightState, FreeWake,
    InducedInflow, SegmentState, Vec3, WakeError, WakeFilament, WakeRotor, momentum_inflow,
};
use serde::Serialize;
use std::fmt::Write as _;
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
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WakeResult {
    /// Advance ratio.
    pub advance_ratio: f64,
    /// Whether inflow, geometry and trim agree to the tolerances.
    pub settled: bool,
    /// Whether wake and trim have parted: what is given is the last good state, no solution.
    pub parted: bool,
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

/// Files of a wake: name and text.
pub type WakeFiles = Vec<(&'static str, String)>;

/// Trims a case in its free wake, or moves a wake of prescribed circulation; a case with another inflow gets the default
/// wake.
///
/// # Errors
/// The errors of the rotor, of the trim and of the wake.
pub fn wake_of_case(loaded: &LoadedCase) -> Result<(WakeResult, WakeFiles), SimError> {
    let doubts = || loaded.value_doubts();
    let (mut result, files) = found_wake(loaded).map_err(|error| error.in_doubt(doubts()))?;
    result.warnings.splice(0..0, doubts());
    Ok((result, files))
}

fn found_wake(loaded: &LoadedCase) -> Result<(WakeResult, WakeFiles), SimError> {
    let mut loaded = loaded.clone();
    let file = match loaded.case.inflow {
        InflowChoice::FreeWake(file) => file,
        _ => FreeWakeFile::default(),
    };
    loaded.case.inflow = InflowChoice::FreeWake(file);
    let of_wake = |source: WakeError| SimError::Response {
        place: loaded.index.place("inflow.model"),
        source: source.into(),
    };
    if let CirculationChoice::Prescribed(given) = file.circulation {
        return prescribed(&loaded, &file, &given).map_err(of_wake);
    }
    let trimmed = TrimmedRotor::new(&loaded, None)?;
    match trimmed.wake() {
        Some(wake) => {
            let result = result_of(&loaded, wake);
            let map = &wake.trim.rotor.inflow;
            let files = files_of(&wake.wake, &wake.moving, map, &result.updates);
            Ok((result, files.map_err(of_wake)?))
        }
        // the inflow has just been made a free wake
        None => Ok((WakeResult::default(), Vec::new())),
    }
}

impl Default for WakeResult {
    fn default() -> Self {
        Self {
            advance_ratio: 0.0,
            settled: false,
            parted: false,
            controls_deg: None,
            ct_sigma: 0.0,
            mean_inflow: 0.0,
            mean_over_glauert: 0.0,
            near_wake_deg: 0.0,
            core_r: 0.0,
            near_core_r: 0.0,
            mutual_core_r: 0.0,
            hub_amplitudes: None,
            closest_passage: None,
            updates: Vec::new(),
            warnings: Vec::new(),
        }
    }
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

fn result_of(loaded: &LoadedCase, wake: &WakeTrim) -> WakeResult {
    let trim = &wake.trim;
    let ct = trim.rotor.thrust_coefficient;
    let mean = trim.rotor.inflow.mean();
    let c = &trim.controls;
    let angles = [c.theta0_rad, c.theta1c_rad, c.theta1s_rad, trim.attitude.shaft_tilt_rad];
    let hub = trim.rotor.hub.harmonic(loaded.case.blades);
    let mut hub_amplitudes = [0.0; 6];
    for (amplitude, pair) in hub_amplitudes.iter_mut().zip(hub.chunks_exact(2)) {
        *amplitude = pair[0].hypot(pair[1]);
    }
    WakeResult {
        settled: wake.outcome == WakeOutcome::Settled,
        parted: wake.outcome.ran_away(),
        controls_deg: Some(angles.map(f64::to_degrees)),
        ct_sigma: ct / loaded.case.rotor_model().solidity(),
        mean_inflow: mean,
        mean_over_glauert: momentum_inflow(&trim.flight, ct).map_or(f64::NAN, |g| mean / g),
        hub_amplitudes: Some(hub_amplitudes),
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
    loaded: &LoadedCase,
    file: &FreeWakeFile,
    given: &PrescribedCirculation,
) -> Result<(WakeResult, WakeFiles), WakeError> {
    let case = &loaded.case;
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
    let files = files_of(&wake, &circulation, &map, &updates)?;
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
    Ok((result, files))
}

fn files_of(
    wake: &FreeWake,
    circulation: &CirculationMap,
    inflow: &InducedInflow,
    updates: &[WakeUpdateLine],
) -> Result<WakeFiles, WakeError> {
    let mut convergence = String::from("azimuths,displacement_r,inflow_change,part,theta0_deg\n");
    for u in updates {
        let theta0 = u.theta0_deg.map(|t| t.to_string()).unwrap_or_default();
        let _ = writeln!(
            convergence,
            "{},{:e},{:e},{},{theta0}",
            u.azimuths, u.displacement_r, u.inflow_change, u.part
        );
    }
    let states = [wake.vortex_states(circulation)?, wake.trailer_states(circulation)?];
    Ok(vec![
        ("wake_geometry.csv", geometry_csv(wake, &states)),
        ("wake.vtk", vtk(wake, circulation, &states)),
        ("inflow_map.csv", inflow_csv(inflow)),
        ("convergence.csv", convergence),
    ])
}

/// Where a filament carries vorticity, and what, at a node: that of the segment behind it, of the last one at its end; none
/// younger than `first`, where the near wake stands for it.
fn at_node(states: &[SegmentState], k: usize, first: usize) -> SegmentState {
    if k < first {
        return SegmentState::default();
    }
    states.get(k.min(states.len().saturating_sub(1))).copied().unwrap_or_default()
}

/// One row per node: the rolled-up vortices, from the age on at which they carry vorticity, and the trailers of the near
/// wake.
fn geometry_csv(wake: &FreeWake, [far, near]: &[Vec<FilamentStates>; 2]) -> String {
    let mut out = String::from(
        "kind,filament,release_r,azimuth_deg,age_deg,x_r,y_r,z_r,circulation,core_r\n",
    );
    let step = wake.settings().step_rad().to_degrees();
    let kinds = [("near", wake.near_wake(), near), ("rolled_up", wake.vortices(), far)];
    for (kind, filaments, states) in kinds {
        for (j, (filament, states)) in filaments.iter().zip(states).enumerate() {
            for (i, (points, states)) in filament.points.iter().zip(states).enumerate() {
                for (k, [x, y, z]) in points.iter().enumerate().skip(filament.first_age) {
                    let (azimuth, age, r) = (i as f64 * step, k as f64 * step, filament.release_r);
                    let SegmentState { circulation, core_radius } =
                        at_node(states, k, filament.first_age);
                    let _ = writeln!(
                        out,
                        "{kind},{j},{r},{azimuth},{age},{x:.6},{y:.6},{z:.6},{circulation:.8},{core_radius:.6}"
                    );
                }
            }
        }
    }
    out
}

/// One row per azimuth and station.
fn inflow_csv(inflow: &InducedInflow) -> String {
    let mut out = String::from("azimuth_deg,r,induced_inflow\n");
    if let InducedInflow::Map(map) = inflow {
        for i in 0..map.azimuths() {
            let azimuth = 360.0 * i as f64 / map.azimuths() as f64;
            for (r, value) in map.stations().iter().zip(map.row(i)) {
                let _ = writeln!(out, "{azimuth},{r:.6},{value:.8}");
            }
        }
    }
    out
}

/// A line of the VTK file: its points, ages of them (deg), kind and what it carries.
struct VtkLine<'a> {
    points: &'a [Vec3],
    step_deg: f64,
    kind: u8,
    states: Vec<SegmentState>,
}

/// The wakes of all blades and the blades with blade 0 over the tail, VTK legacy ASCII: lines with age, kind (0 blade, 1
/// near wake, 2 rolled-up vortex), circulation and core radius at every point.
fn vtk(
    wake: &FreeWake,
    circulation: &CirculationMap,
    [far_states, near_states]: &[Vec<FilamentStates>; 2],
) -> String {
    let azimuths = wake.settings().azimuths;
    let step_deg = wake.settings().step_rad().to_degrees();
    let core_radius = wake.settings().core.near_radius;
    let (near, far): (Vec<WakeFilament>, Vec<WakeFilament>) = (wake.near_wake(), wake.vortices());
    let mut lines: Vec<VtkLine<'_>> = Vec::new();
    for b in 0..wake.rotor().blades() {
        let i = b * azimuths / wake.rotor().blades();
        let bound = circulation.row(i).iter();
        let mut states: Vec<SegmentState> =
            bound.map(|&circulation| SegmentState { circulation, core_radius }).collect();
        states.extend(states.last().copied());
        lines.push(VtkLine { points: wake.lines().at(i), step_deg: 0.0, kind: 0, states });
        for (kind, filaments, of) in [(1, &near, near_states), (2, &far, far_states)] {
            for (filament, states) in filaments.iter().zip(of) {
                let points = &filament.points[i];
                let first = filament.first_age;
                let states = (0..points.len()).map(|k| at_node(&states[i], k, first)).collect();
                lines.push(VtkLine { points, step_deg, kind, states });
            }
        }
    }
    let count: usize = lines.iter().map(|l| l.points.len()).sum();
    let mut out = String::from(
        "# vtk DataFile Version 3.0\nfree wake, lengths in R, X aft, Y starboard, Z up\nASCII\nDATASET POLYDATA\n",
    );
    let _ = writeln!(out, "POINTS {count} double");
    for [x, y, z] in lines.iter().flat_map(|l| l.points) {
        let _ = writeln!(out, "{x:.6} {y:.6} {z:.6}");
    }
    let _ = writeln!(out, "LINES {} {}", lines.len(), lines.len() + count);
    let mut first = 0;
    for line in &lines {
        let _ = write!(out, "{}", line.points.len());
        for k in first..first + line.points.len() {
            let _ = write!(out, " {k}");
        }
        out.push('\n');
        first += line.points.len();
    }
    let _ = writeln!(out, "POINT_DATA {count}");
    let mut scalars = |name: &str, of: &dyn Fn(&VtkLine<'_>, usize) -> String| {
        let _ = writeln!(out, "SCALARS {name} 1\nLOOKUP_TABLE default");
        for line in &lines {
            for k in 0..line.points.len() {
                let _ = writeln!(out, "{}", of(line, k));
            }
        }
    };
    scalars("age_deg double", &|line, k| (k as f64 * line.step_deg).to_string());
    scalars("kind int", &|line, _| line.kind.to_string());
    scalars("circulation double", &|line, k| format!("{:.8}", line.states[k].circulation));
    scalars("core_r double", &|line, k| format!("{:.6}", line.states[k].core_radius));
    out
}

impl Printable for WakeResult {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!(
            "Free wake at mu {:.3}: {}",
            self.advance_ratio,
            match (self.controls_deg, self.settled) {
                (Some(_), true) => "settled with the trim",
                (None, true) => "circulation prescribed, settled",
                (Some(_), false) if self.parted => "parted, the last good state",
                (Some(_), false) => "not settled",
                (None, false) => "circulation prescribed, not settled",
            }
        ));
        if let Some([theta0, theta1c, theta1s, tilt]) = self.controls_deg {
            sheet.line(format_args!(
                "Trim       theta0 {theta0:.4} deg, theta1c {theta1c:.4} deg, theta1s {theta1s:.4} deg, shaft tilt {tilt:.4} deg, C_T/sigma {:.5}",
                self.ct_sigma
            ));
        }
        sheet.line(format_args!(
            "Inflow     mean {:.6}, {:.3} of Glauert's; near wake {:.0} deg, core {:.4} R, near wake {:.4} R, mutual {:.4} R",
            self.mean_inflow,
            self.mean_over_glauert,
            self.near_wake_deg,
            self.core_r,
            self.near_core_r,
            self.mutual_core_r
        ));
        if let Some(p) = self.closest_passage {
            sheet.line(format_args!(
                "Passage    nearest: {:.4} R from the blade at azimuth {:.0} deg, {:.2} R, age {:.0} deg, core {:.4} R",
                p.distance_r, p.azimuth_deg, p.station_r, p.age_deg, p.core_r
            ));
        }
        if let Some(amplitudes) = self.hub_amplitudes {
            let names = ["FX", "FY", "FZ", "MX", "MY", "MZ"];
            let hub: Vec<String> =
                names.iter().zip(amplitudes).map(|(n, a)| format!("{n} {a:.4e}")).collect();
            sheet.line(format_args!("Hub loads  at the blade number per rev: {}", hub.join(", ")));
        }
        sheet.line(format_args!(""));
        sheet.block(&table(
            &["steps", "displacement R", "inflow change", "part", "theta0 deg"],
            self.updates.iter().map(|u| {
                vec![
                    u.azimuths.to_string(),
                    format!("{:.2e}", u.displacement_r),
                    format!("{:.2e}", u.inflow_change),
                    format!("{:.3}", u.part),
                    u.theta0_deg.map_or_else(String::new, |t| format!("{t:.5}")),
                ]
            }),
        ));
        sheet.finish()
    }
}
