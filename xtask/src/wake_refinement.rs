//! Refinement of the free wake over grid, near wake and core: the paper's rotor trimmed in it, and the thrust of the rotor
//! of the independent wake.

use std::f64::consts::TAU;
use std::sync::Arc;

use reference_rotors::{BladeElementSolution, CouplingSettings};
use reference_rotors::{olaf, olaf_flight, olaf_settings, olaf_thrust_newton};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Discretisation, ResponseError, ResponseTolerances, Rotor, RotorModel, RotorSolver,
};
use rotor_wake::{
    CoreModel, FreeWakeSettings, NearWakeMotion, ShedVorticity, WakeError, momentum_inflow,
};
use trim::{
    TrimError, TrimSettings, TrimTarget, Vehicle, WakeOutcome, WakeTrim, WakeTrimSettings,
    trim_in_free_wake,
};

/// A change of the wake of the paper's rotor and of the response in it.
pub(crate) type PaperChange = fn(&mut WakeTrimSettings, &mut Discretisation);

/// Core of the near wake of the paper's rotor, R: its chord.
pub(crate) const PAPER_CHORD: f64 = 0.055;

/// What is changed, and how, from the defaults of a case.
const PAPER_ROWS: [(&str, PaperChange); 31] = [
    ("none", |_, _| ()),
    ("steps of 30 deg", |s, _| s.wake.azimuths = 12),
    ("steps of 15 deg", |s, _| s.wake.azimuths = 24),
    ("steps of 10 deg, 12 time points", |s, d| steps(s, d, (36, 12))),
    ("steps of 7.5 deg, 12 time points", |s, d| steps(s, d, (48, 12))),
    ("steps of 5 deg, 16 time points", |s, d| steps(s, d, (72, 16))),
    ("2 turns", |s, _| s.wake.turns = 2),
    ("5 turns", |s, _| s.wake.turns = 5),
    ("near wake 30 deg", |s, _| s.wake.near_wake_rad = TAU / 12.0),
    ("near wake 90 deg", |s, _| s.wake.near_wake_rad = TAU / 4.0),
    ("near wake 120 deg", |s, _| s.wake.near_wake_rad = TAU / 3.0),
    ("near wake 180 deg", |s, _| s.wake.near_wake_rad = TAU / 2.0),
    ("near wake 270 deg", |s, _| s.wake.near_wake_rad = 0.75 * TAU),
    ("near wake 720 deg", |s, _| s.wake.near_wake_rad = 2.0 * TAU),
    ("near wake 1440 deg", |s, _| s.wake.near_wake_rad = 4.0 * TAU),
    ("near core x 0.5", |s, _| s.wake.core.near_radius *= 0.5),
    ("near core x 0.5, steps of 7.5 deg", |s, d| {
        s.wake.core.near_radius *= 0.5;
        steps(s, d, (48, 12));
    }),
    ("near core x 2", |s, _| s.wake.core.near_radius *= 2.0),
    ("near core x 2, steps of 7.5 deg", |s, d| {
        s.wake.core.near_radius *= 2.0;
        steps(s, d, (48, 12));
    }),
    ("own sheet with the near core too", |s, _| s.wake.core.panel_share = 1e6),
    ("share of the panels 0.15", |s, _| s.wake.core.panel_share = 0.15),
    ("share of the panels 0.5", |s, _| s.wake.core.panel_share = 0.5),
    ("14 panels", |s, _| s.panels = 14),
    ("30 panels, stations twice as dense", |s, d| panels(s, d, 30)),
    ("40 panels, stations twice as dense", |s, d| panels(s, d, 40)),
    ("core of the rolled-up vortices x 0.5", |s, _| s.wake.core.radius *= 0.5),
    ("core of the rolled-up vortices x 2", |s, _| s.wake.core.radius *= 2.0),
    ("near wake convected", |s, _| s.wake.near_wake_motion = NearWakeMotion::Convected),
    ("mutual cores x 0.5", |s, _| s.wake.core.mutual_radius *= 0.5),
    ("mutual cores x 2", |s, _| s.wake.core.mutual_radius *= 2.0),
    ("corrected cores", |s, _| s.wake.core.model = CoreModel::RosenheadMoore),
];

fn steps(settings: &mut WakeTrimSettings, response: &mut Discretisation, grid: (usize, usize)) {
    (settings.wake.azimuths, response.time_gauss_points) = grid;
}

fn panels(settings: &mut WakeTrimSettings, response: &mut Discretisation, count: usize) {
    settings.panels = count;
    response.span_points_per_piece *= 2;
}

/// The paper's rotor trimmed in level flight at an advance ratio in a changed free wake.
pub(crate) fn paper_trimmed(
    advance_ratio: f64,
    change: PaperChange,
) -> Result<WakeTrim, TrimError> {
    let (mut settings, mut response) = (WakeTrimSettings::default(), Discretisation::default());
    settings.wake.core.near_radius = PAPER_CHORD;
    change(&mut settings, &mut response);
    let blade = BladeProperties::new(BladeSpec::table_1()).map_err(ResponseError::from)?;
    let rotor = Rotor::new(RotorModel::paper_case(), &blade, response)?;
    let tolerances = ResponseTolerances::default();
    let mut solver = RotorSolver::new(Arc::new(rotor), advance_ratio, tolerances)?;
    let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
    let trim_settings = TrimSettings::default();
    trim_in_free_wake(&mut solver, &settings, advance_ratio, &target, &trim_settings)
}

/// Mean inflow over Glauert's, collective, and the 4/rev forces and moments of the hub.
fn paper_line(wake: &WakeTrim) -> String {
    let rotor = &wake.trim.rotor;
    let glauert = momentum_inflow(&wake.trim.flight, rotor.thrust_coefficient);
    let mean = glauert.map_or(f64::NAN, |g| rotor.inflow.mean() / g);
    let z = rotor.hub.harmonic(4);
    let amplitudes = z.chunks_exact(2).map(|p| format!("{:.3}", 1e3 * p[0].hypot(p[1])));
    let amplitudes: Vec<String> = amplitudes.collect();
    let settled = if wake.outcome == WakeOutcome::Settled { "" } else { " (not settled)" };
    format!(
        "{mean:.3}{settled} | {:.3} | {} | {:.1}",
        wake.trim.controls.theta0_rad.to_degrees(),
        amplitudes.join(", "),
        z[5].atan2(z[4]).to_degrees()
    )
}

/// The table of the paper's rotor, row by row to `say`.
pub fn paper_table(say: impl Fn(&str)) {
    say(
        "| change | mean inflow over Glauert's | theta0, deg | FX, FY, FZ, MX, MY, MZ at 4/rev, 1e-3 | phase of FZ, deg |\n",
    );
    say("|---|---|---|---|---|\n");
    for (name, change) in PAPER_ROWS {
        say(&match paper_trimmed(0.3, change) {
            Ok(wake) => format!("| {name} | {} |\n", paper_line(&wake)),
            Err(error) => format!("| {name} | {error} | | | |\n"),
        });
    }
}

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
