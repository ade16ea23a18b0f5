//! Refinement of the free wake: thrust of the rotor of the independent wake over grid, near wake and core.

use std::f64::consts::TAU;

use rotor_wake::reference::{olaf, olaf_flight, olaf_settings, olaf_thrust_newton};
use rotor_wake::{
    BladeElementSolution, CouplingSettings, FreeWakeSettings, NearWakeMotion, ShedVorticity,
    WakeError,
};

/// A change of the wake.
type Change = fn(&mut FreeWakeSettings);

/// What is changed, and how, from steps of 15 deg, 3 turns, a near wake of a revolution that follows the tip, core 0.0762 R
/// and 20 panels.
const ROWS: [(&str, Change); 18] = [
    ("none", |_| ()),
    ("steps of 30 deg", |s| s.azimuths = 12),
    ("steps of 10 deg", |s| s.azimuths = 36),
    ("steps of 5 deg", |s| s.azimuths = 72),
    ("2 turns", |s| s.turns = 2),
    ("4 turns", |s| s.turns = 4),
    ("5 turns", |s| s.turns = 5),
    ("near wake 30 deg", |s| s.near_wake_rad = TAU / 12.0),
    ("near wake 90 deg", |s| s.near_wake_rad = TAU / 4.0),
    ("near wake 180 deg", |s| s.near_wake_rad = TAU / 2.0),
    ("near wake 270 deg", |s| s.near_wake_rad = 0.75 * TAU),
    ("core x 0.5", |s| scale_core(s, 0.5)),
    ("core x 2", |s| scale_core(s, 2.0)),
    ("near wake convected", |s| s.near_wake_motion = NearWakeMotion::Convected),
    ("near wake in the blade plane", |s| s.near_wake_motion = NearWakeMotion::BladePlane),
    ("near wake free", |s| s.near_wake_motion = NearWakeMotion::Free),
    ("velocities at every second age", |s| s.velocity_stride = 2),
    ("shed vorticity left out", |s| s.shed = ShedVorticity::InSections),
];

fn scale_core(settings: &mut FreeWakeSettings, by: f64) {
    settings.core.radius *= by;
    settings.core.near_radius *= by;
}

fn solved(change: Change) -> Result<BladeElementSolution, WakeError> {
    let mut settings = olaf_settings(TAU);
    change(&mut settings);
    let rotor = olaf(20)?;
    let mut wake = rotor.starting_wake(&settings, olaf_flight(), 0.005)?;
    let coupling =
        CouplingSettings { inflow_tolerance: 2e-4, sweeps: 3, ..CouplingSettings::default() };
    rotor.solve(&mut wake, &coupling)
}

/// Mean, and amplitude and phase (deg) of 4/rev, of the thrust, N.
fn thrust(solution: &BladeElementSolution) -> [f64; 3] {
    let sums = solution.rotating_sums(4);
    let count = sums.len() as f64;
    let (mut mean, mut c, mut s) = (0.0, 0.0, 0.0);
    for (i, sum) in sums.iter().enumerate() {
        let (value, angle) = (sum[2] * olaf_thrust_newton(), 4.0 * TAU * i as f64 / count);
        mean += value / count;
        c += 2.0 * value * angle.cos() / count;
        s += 2.0 * value * angle.sin() / count;
    }
    [mean, c.hypot(s), s.atan2(c).to_degrees()]
}

/// The table, row by row to `say`, for the last ones take minutes.
pub fn table(say: impl Fn(&str)) {
    say("| change | mean thrust, N | 4/rev, N | phase, deg |\n|---|---|---|---|\n");
    for (name, change) in ROWS {
        say(&match solved(change) {
            Ok(solution) => {
                let [mean, amplitude, phase] = thrust(&solution);
                format!("| {name} | {mean:.0} | {amplitude:.0} | {phase:.1} |\n")
            }
            Err(error) => format!("| {name} | {error} | | |\n"),
        });
    }
}
