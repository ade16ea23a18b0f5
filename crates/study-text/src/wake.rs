//! A free wake as a table and as files to look at.

use crate::revolution::{Revolution, at_nodes, revolution_files};
use report_page::{Sheet, csv_of, table_of};
use rotor_case::Case;
use rotor_study::{FoundWake, HubLoads, WakeResult};
use rotor_wake::{
    CirculationMap, FilamentStates, FreeWake, InducedInflow, SegmentState, Vec3, VortexCrossing,
    WakeError,
};
use std::fmt::Write as _;

/// Files of a wake: name, with a folder where it has one, and text.
pub type WakeFiles = Vec<(String, String)>;

/// Where the tip vortices of all blades cut planes of constant `Y` (R, starboard positive), as CSV text: a row for each
/// crossing, by azimuth, plane, blade and age.
///
/// | column | meaning | reference and sign |
/// |---|---|---|
/// | `blade_azimuth_deg` | azimuth of blade 1, deg: the instant | 0 over the tail, counter-clockwise seen from above |
/// | `plane_y_r` | the plane, `Y / R` | hub centre; starboard positive |
/// | `age_deg` | age of the vortex at the crossing, deg of azimuth | since it left its blade, of whatever number |
/// | `x_m`, `y_m`, `z_m` | the crossing, m, in hub axes that do not turn | hub centre; aft, starboard, up along the shaft positive |
///
/// At an instant blade `k` is `(k - 1) 360 / N_b` deg ahead of blade 1; the vortices of all of them stand in the rows of that
/// instant.
pub fn vortices_csv(wake: &FreeWake, planes_y_r: &[f64], radius_m: f64) -> String {
    let step_deg = wake.settings().step_rad().to_degrees();
    let instants =
        (0..wake.settings().azimuths).flat_map(|i| planes_y_r.iter().map(move |y| (i, *y)));
    let rows = instants.flat_map(|(i, plane)| {
        let crossings = wake.tip_vortex_crossings(i, plane);
        crossings.into_iter().map(move |crossing| (i as f64 * step_deg, plane, crossing))
    });
    let metres = |crossing: &VortexCrossing, axis: usize| radius_m * crossing.point[axis];
    csv_of(
        rows,
        &[
            ("blade_azimuth_deg", &|(azimuth, ..)| azimuth.to_string()),
            ("plane_y_r", &|(_, plane, _)| plane.to_string()),
            ("age_deg", &|(.., c)| format!("{:.4}", c.age_rad.to_degrees())),
            ("x_m", &|(.., c)| format!("{:.6}", metres(c, 0))),
            ("y_m", &|(.., c)| format!("{:.6}", metres(c, 1))),
            ("z_m", &|(.., c)| format!("{:.6}", metres(c, 2))),
        ],
    )
}

/// The files of a found wake: geometry, vortices, inflow and convergence as CSV, the wake as VTK, and the revolution with the
/// loads of the disk for `ParaView`.
///
/// # Errors
/// [`WakeError`] of a circulation that does not fit the wake.
pub fn wake_files(found: &FoundWake, case: &Case) -> Result<WakeFiles, WakeError> {
    let FoundWake { result, wake, circulation, inflow, disk } = found;
    let convergence = csv_of(
        &result.updates,
        &[
            ("azimuths", &|u| u.azimuths.to_string()),
            ("displacement_r", &|u| format!("{:e}", u.displacement_r)),
            ("inflow_change", &|u| format!("{:e}", u.inflow_change)),
            ("part", &|u| u.part.to_string()),
            ("theta0_deg", &|u| u.theta0_deg.map(|t| t.to_string()).unwrap_or_default()),
        ],
    );
    let states = [wake.vortex_states(circulation)?, wake.trailer_states(circulation)?];
    let planes = case.vortex_planes_y_r();
    let named = |name: &str, text: String| (name.to_owned(), text);
    let mut files = vec![
        named("wake_geometry.csv", geometry_csv(wake, &states)),
        named("wake.vtk", vtk(wake, circulation, &states)),
        named("vortices.csv", vortices_csv(wake, &planes, case.rotor.radius_m)),
        named("inflow_map.csv", inflow_csv(inflow)),
        named("convergence.csv", convergence),
    ];
    if let Some(disk) = disk {
        let scales = case.scales();
        files.extend(revolution_files(&Revolution { wake, states: &states, disk, scales }));
    }
    Ok(files)
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
            for (i, points) in filament.points.iter().enumerate() {
                let nodes = points.iter().zip(at_nodes(filament, states, i)).enumerate();
                for (k, ([x, y, z], state)) in nodes.skip(filament.first_age) {
                    let (azimuth, age, r) = (i as f64 * step, k as f64 * step, filament.release_r);
                    let SegmentState { circulation, core_radius } = state;
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
    let (near, far) = (wake.near_wake(), wake.vortices());
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
                let states = at_nodes(filament, states, i);
                lines.push(VtkLine { points: &filament.points[i], step_deg, kind, states });
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

/// A wake for people: trim, inflow, passages, hub loads and the updates.
pub fn wake_text(wake: &WakeResult) -> String {
    let mut sheet = Sheet::default();
    sheet.line(format_args!(
        "Free wake at mu {:.3}: {}",
        wake.advance_ratio,
        match (wake.controls_deg, wake.settled) {
            (Some(_), true) => "settled with the trim",
            (None, true) => "circulation prescribed, settled",
            (Some(_), false) if wake.diverged => "diverged, no solution: see the warning",
            (Some(_), false) => "not settled",
            (None, false) => "circulation prescribed, not settled",
        }
    ));
    if let Some([theta0, theta1c, theta1s, tilt]) = wake.controls_deg {
        sheet.line(format_args!(
            "Trim       theta0 {theta0:.4} deg, theta1c {theta1c:.4} deg, theta1s {theta1s:.4} deg, shaft tilt {tilt:.4} deg, C_T/sigma {:.5}",
            wake.ct_sigma
        ));
    }
    sheet.line(format_args!(
        "Inflow     mean {:.6}, {:.3} of Glauert's; near wake {:.0} deg, core {:.4} R, near wake {:.4} R, mutual {:.4} R",
        wake.mean_inflow,
        wake.mean_over_glauert,
        wake.near_wake_deg,
        wake.core_r,
        wake.near_core_r,
        wake.mutual_core_r
    ));
    if let Some(p) = wake.closest_passage {
        sheet.line(format_args!(
            "Passage    nearest: {:.4} R from the blade at azimuth {:.0} deg, {:.2} R, age {:.0} deg, core {:.4} R",
            p.distance_r, p.azimuth_deg, p.station_r, p.age_deg, p.core_r
        ));
    }
    if let Some(amplitudes) = wake.hub_amplitudes {
        let loads = HubLoads::NAMES.iter().zip(amplitudes);
        let hub: Vec<String> =
            loads.map(|(name, a)| format!("{} {a:.4e}", name.to_uppercase())).collect();
        sheet.line(format_args!("Hub loads  at the blade number per rev: {}", hub.join(", ")));
    }
    sheet.line("");
    sheet.block(&table_of(
        &wake.updates,
        &[
            ("steps", &|u| u.azimuths.to_string()),
            ("displacement R", &|u| format!("{:.2e}", u.displacement_r)),
            ("inflow change", &|u| format!("{:.2e}", u.inflow_change)),
            ("part", &|u| format!("{:.3}", u.part)),
            ("theta0 deg", &|u| u.theta0_deg.map_or(String::new(), |t| format!("{t:.5}"))),
        ],
    ));
    sheet.finish()
}
