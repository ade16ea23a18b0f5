//! Tip vortex of a hovering rotor over grid, near wake, cores and load, against Landgrebe's fit.

use std::f64::consts::{PI, TAU};

use reference_rotors::{CouplingSettings, Landgrebe, contraction_drift, slender};
use rotor_wake::{
    ControlPoint, CoreModel, FarTrailers, FlightState, FreeWakeSettings, NearWakeMotion, WakeError,
    WakeRotor,
};

/// A hovering rotor and its wake.
struct Hover {
    blades: usize,
    panels: usize,
    pitch_deg: f64,
    twist_deg: f64,
    wake: FreeWakeSettings,
}

/// A change of the rotor or of its wake.
type Change = fn(&mut Hover);

/// What is changed, and how, from four slender blades in their free near wake, steps of 7.5 deg.
const ROWS: [(&str, Change); 23] = [
    ("none", |_| ()),
    ("steps of 15 deg", |h| h.wake.azimuths = 24),
    ("steps of 10 deg", |h| h.wake.azimuths = 36),
    ("steps of 6 deg", |h| h.wake.azimuths = 60),
    ("steps of 5 deg", |h| h.wake.azimuths = 72),
    ("near wake of 60 deg", |h| h.wake.near_wake_rad = TAU / 6.0),
    ("near wake of 120 deg", |h| h.wake.near_wake_rad = TAU / 3.0),
    ("near wake follows the tip", |h| h.wake.near_wake_motion = NearWakeMotion::FollowsTip),
    ("mutual cores of 0.04 R", |h| h.wake.core.mutual_radius = 0.04),
    ("mutual cores of 0.06 R", |h| h.wake.core.mutual_radius = 0.06),
    ("cores of 0.02 R", |h| h.wake.core.radius = 0.02),
    ("Vatistas's cores", |h| h.wake.core.model = CoreModel::Vatistas),
    ("16 panels", |h| h.panels = 16),
    ("24 panels", |h| h.panels = 24),
    ("4 turns", |h| h.wake.turns = 4),
    ("sheet as 3 vortices", |h| h.wake.far = FarTrailers::Stations(vec![0.4, 0.6, 0.75])),
    ("Weissinger's points", |h| h.wake.control_point = ControlPoint::ThreeQuarterChord),
    ("pitch 7 deg", |h| h.pitch_deg = 7.0),
    ("pitch 10 deg", |h| h.pitch_deg = 10.0),
    ("no twist", |h| h.twist_deg = 0.0),
    ("twist -14 deg", |h| h.twist_deg = -14.0),
    ("2 blades", |h| h.blades = 2),
    ("3 blades", |h| h.blades = 3),
];

/// Thrust over solidity; `k1` and `k2` fitted to the first turn, by the height at the passage and a turn behind it, and the
/// radius where it is farthest off within two turns: all over Landgrebe's.
fn line(change: Change) -> Result<String, WakeError> {
    let mut rotor = slender()?;
    let mut hover = Hover {
        blades: rotor.rotor.blades(),
        panels: rotor.rotor.panels(),
        pitch_deg: rotor.motion.pitch_rad[0].to_degrees(),
        twist_deg: rotor.twist_rad.to_degrees(),
        wake: FreeWakeSettings::hover_rolling_up(CoreModel::RosenheadMoore).with_azimuths(48),
    };
    change(&mut hover);
    let Hover { wake: settings, .. } = hover;
    rotor.rotor = WakeRotor::cosine(hover.blades, rotor.rotor.nodes()[0], hover.panels)?;
    rotor.motion.pitch_rad[0] = hover.pitch_deg.to_radians();
    rotor.twist_rad = hover.twist_deg.to_radians();
    let still = FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 };
    let mut wake = rotor.starting_wake(&settings, still, 0.0046)?;
    let coupling = CouplingSettings { updates: 200, ..CouplingSettings::default() };
    let solution = rotor.solve(&mut wake, &coupling)?;
    let landgrebe = Landgrebe::of(&rotor, solution.thrust_coefficient);
    let (tip, turn, step) = (contraction_drift(&wake), settings.azimuths, settings.step_rad());
    let (passage, blades) = (turn / rotor.rotor.blades(), rotor.rotor.blades() as f64);
    let heights: Vec<f64> = tip.iter().map(|at| at[1]).collect();
    let fitted = Landgrebe::fitted(&heights[..=turn], step, TAU / blades);
    let [k1, k2] = fitted.unwrap_or([f64::NAN; 2]);
    let direct = [
        heights[passage] / (passage as f64 * step) / landgrebe.k1(),
        (heights[passage + turn] - heights[passage]) / TAU / landgrebe.k2(),
    ];
    let radius = (passage..=2 * turn)
        .map(|age| tip[age][0] / landgrebe.radius(age as f64 * step))
        .fold(1.0, |worst: f64, r| if (r - 1.0).abs() > (worst - 1.0).abs() { r } else { worst });
    let solidity = blades * rotor.chord / PI;
    Ok(format!(
        "{:.4} | {:.2}, {:.2} | {:.2}, {:.2} | {radius:.3}",
        solution.thrust_coefficient / solidity,
        k1 / landgrebe.k1(),
        k2 / landgrebe.k2(),
        direct[0],
        direct[1],
    ))
}

/// The table, row by row to `say`.
pub fn table(say: impl Fn(&str)) {
    say(
        "| change | C_T/sigma | k1, k2 fitted to the first turn | k1, k2 by the height at the passage | radius |\n",
    );
    say("|---|---|---|---|---|\n");
    for (name, change) in ROWS {
        say(&match line(change) {
            Ok(line) => format!("| {name} | {line} |\n"),
            Err(error) => format!("| {name} | {error} | | | |\n"),
        });
    }
}
