//! `hhc wake`: a case trimmed in its free wake, with the geometry and the inflow to look at.

use crate::SimError;
use crate::case::{FreeWakeFile, InflowChoice, LoadedCase};
use crate::inflow::wake_warnings;
use crate::output::{Printable, Sheet, table};
use crate::study::TrimmedRotor;
use rotor_wake::{FreeWake, InducedInflow, Vec3, WakeFilament, momentum_inflow};
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
    /// Collective, deg.
    pub theta0_deg: f64,
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
}

/// A trimmed rotor in its free wake.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WakeResult {
    /// Advance ratio.
    pub advance_ratio: f64,
    /// Whether inflow and trim agree to the tolerance.
    pub settled: bool,
    /// Collective, lateral and longitudinal cyclic, shaft tilt, deg.
    pub controls_deg: [f64; 4],
    /// Thrust coefficient over solidity.
    pub ct_sigma: f64,
    /// Mean induced inflow over the lifting part of the disk.
    pub mean_inflow: f64,
    /// The same over Glauert's at the same thrust.
    pub mean_over_glauert: f64,
    /// Length of the near wake, deg.
    pub near_wake_deg: f64,
    /// Core radius at release, radius R.
    pub core_r: f64,
    /// Amplitudes of the hub forces and moments at the blade number per rev, rotor units.
    pub hub_amplitudes: [f64; 6],
    /// Nearest approach of a tip vortex to a blade.
    pub closest_passage: Option<PassageLine>,
    /// Every update.
    pub updates: Vec<WakeUpdateLine>,
    /// What a user should know.
    pub warnings: Vec<String>,
}

/// Files of a wake: name and text.
pub type WakeFiles = Vec<(&'static str, String)>;

/// Trims a case in its free wake; a case with another inflow gets the default wake.
///
/// # Errors
/// The errors of the rotor and of the trim.
pub fn wake_of_case(loaded: &LoadedCase) -> Result<(WakeResult, WakeFiles), SimError> {
    let mut loaded = loaded.clone();
    if !matches!(loaded.case.inflow, InflowChoice::FreeWake(_)) {
        loaded.case.inflow = InflowChoice::FreeWake(FreeWakeFile::default());
    }
    let trimmed = TrimmedRotor::new(&loaded, None)?;
    match trimmed.wake() {
        Some(wake) => Ok((result_of(&loaded, wake), files_of(wake))),
        // the inflow has just been made a free wake
        None => Ok((WakeResult::default(), Vec::new())),
    }
}

impl Default for WakeResult {
    fn default() -> Self {
        Self {
            advance_ratio: 0.0,
            settled: false,
            controls_deg: [0.0; 4],
            ct_sigma: 0.0,
            mean_inflow: 0.0,
            mean_over_glauert: 0.0,
            near_wake_deg: 0.0,
            core_r: 0.0,
            hub_amplitudes: [0.0; 6],
            closest_passage: None,
            updates: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

fn result_of(loaded: &LoadedCase, wake: &WakeTrim) -> WakeResult {
    let (trim, settings) = (&wake.trim, wake.wake.settings());
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
        advance_ratio: loaded.case.advance_ratio,
        settled: wake.outcome == WakeOutcome::Settled,
        controls_deg: angles.map(f64::to_degrees),
        ct_sigma: ct / loaded.case.rotor_model().solidity(),
        mean_inflow: mean,
        mean_over_glauert: momentum_inflow(&trim.flight, ct).map_or(f64::NAN, |g| mean / g),
        near_wake_deg: (settings.near_steps() as f64 * settings.step_rad()).to_degrees(),
        core_r: settings.core.radius,
        hub_amplitudes,
        closest_passage: wake.closest_passage.map(|p| PassageLine {
            azimuth_deg: p.azimuth_rad.to_degrees(),
            station_r: p.station,
            age_deg: p.age_rad.to_degrees(),
            distance_r: p.distance,
        }),
        updates: wake
            .updates
            .iter()
            .map(|u| WakeUpdateLine {
                azimuths: u.azimuths,
                displacement_r: u.displacement,
                inflow_change: u.inflow_change,
                theta0_deg: u.theta0_rad.to_degrees(),
            })
            .collect(),
        warnings: wake_warnings(wake),
    }
}

fn files_of(wake: &WakeTrim) -> WakeFiles {
    let mut convergence = String::from("azimuths,displacement_r,inflow_change,theta0_rad\n");
    for u in &wake.updates {
        let _ = writeln!(
            convergence,
            "{},{:e},{:e},{}",
            u.azimuths, u.displacement, u.inflow_change, u.theta0_rad
        );
    }
    vec![
        ("wake_geometry.csv", geometry_csv(&wake.wake)),
        ("wake.vtk", vtk(&wake.wake)),
        ("inflow_map.csv", inflow_csv(&wake.trim.rotor.inflow)),
        ("convergence.csv", convergence),
    ]
}

/// One row per node of the rolled-up vortices.
fn geometry_csv(wake: &FreeWake) -> String {
    let mut out = String::from("vortex,release_r,azimuth_deg,age_deg,x_r,y_r,z_r\n");
    let step = wake.settings().step_rad().to_degrees();
    for (j, vortex) in wake.vortices().iter().enumerate() {
        for (i, points) in vortex.points.iter().enumerate() {
            for (k, [x, y, z]) in points.iter().enumerate() {
                let (azimuth, age) = (i as f64 * step, k as f64 * step);
                let r = vortex.release_r;
                let _ = writeln!(out, "{j},{r},{azimuth},{age},{x:.6},{y:.6},{z:.6}");
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

/// The wakes of all blades and the blades with blade 0 over the tail, VTK legacy ASCII: lines with the age and
/// the kind (0 blade, 1 near wake, 2 rolled-up vortex) at every point.
fn vtk(wake: &FreeWake) -> String {
    let azimuths = wake.settings().azimuths;
    let step = wake.settings().step_rad().to_degrees();
    let mut points: Vec<(Vec3, f64, u8)> = Vec::new();
    let mut lines: Vec<(usize, usize)> = Vec::new();
    let mut add = |line: &[Vec3], aged: bool, kind: u8| {
        let first = points.len();
        let ages = (0..line.len()).map(|k| if aged { k as f64 * step } else { 0.0 });
        points.extend(line.iter().zip(ages).map(|(p, age)| (*p, age, kind)));
        lines.push((first, line.len()));
    };
    let (near, far): (Vec<WakeFilament>, Vec<WakeFilament>) = (wake.near_wake(), wake.vortices());
    for b in 0..wake.rotor().blades() {
        let i = b * azimuths / wake.rotor().blades();
        add(wake.lines().at(i), false, 0);
        for filament in &near {
            add(&filament.points[i], true, 1);
        }
        for filament in &far {
            add(&filament.points[i], true, 2);
        }
    }
    let mut out = String::from(
        "# vtk DataFile Version 3.0\nfree wake, lengths in R, X aft, Y starboard, Z up\nASCII\nDATASET POLYDATA\n",
    );
    let _ = writeln!(out, "POINTS {} double", points.len());
    for ([x, y, z], ..) in &points {
        let _ = writeln!(out, "{x:.6} {y:.6} {z:.6}");
    }
    let _ = writeln!(out, "LINES {} {}", lines.len(), lines.len() + points.len());
    for (first, count) in &lines {
        let _ = write!(out, "{count}");
        for k in 0..*count {
            let _ = write!(out, " {}", first + k);
        }
        out.push('\n');
    }
    let _ = writeln!(
        out,
        "POINT_DATA {}\nSCALARS age_deg double 1\nLOOKUP_TABLE default",
        points.len()
    );
    for (_, age, _) in &points {
        let _ = writeln!(out, "{age}");
    }
    out.push_str("SCALARS kind int 1\nLOOKUP_TABLE default\n");
    for (.., kind) in &points {
        let _ = writeln!(out, "{kind}");
    }
    out
}

impl Printable for WakeResult {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        let [theta0, theta1c, theta1s, tilt] = self.controls_deg;
        sheet.line(format_args!(
            "Free wake at mu {:.3}: {}",
            self.advance_ratio,
            if self.settled { "settled with the trim" } else { "not settled" }
        ));
        sheet.line(format_args!(
            "Trim       theta0 {theta0:.4} deg, theta1c {theta1c:.4} deg, theta1s {theta1s:.4} deg, shaft tilt {tilt:.4} deg, C_T/sigma {:.5}",
            self.ct_sigma
        ));
        sheet.line(format_args!(
            "Inflow     mean {:.6}, {:.3} of Glauert's; near wake {:.0} deg, core {:.4} R",
            self.mean_inflow, self.mean_over_glauert, self.near_wake_deg, self.core_r
        ));
        if let Some(p) = self.closest_passage {
            sheet.line(format_args!(
                "Passage    nearest: {:.4} R from the blade at azimuth {:.0} deg, {:.2} R, age {:.0} deg",
                p.distance_r, p.azimuth_deg, p.station_r, p.age_deg
            ));
        }
        let names = ["FX", "FY", "FZ", "MX", "MY", "MZ"];
        let hub: Vec<String> =
            names.iter().zip(self.hub_amplitudes).map(|(n, a)| format!("{n} {a:.4e}")).collect();
        sheet.line(format_args!("Hub loads  at the blade number per rev: {}\n", hub.join(", ")));
        sheet.block(&table(
            &["steps", "displacement R", "inflow change", "theta0 deg"],
            self.updates.iter().map(|u| {
                vec![
                    u.azimuths.to_string(),
                    format!("{:.2e}", u.displacement_r),
                    format!("{:.2e}", u.inflow_change),
                    format!("{:.5}", u.theta0_deg),
                ]
            }),
        ));
        sheet.finish()
    }
}
