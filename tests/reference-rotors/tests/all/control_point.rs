//! Where the sections feel the wake: lifting line against Weissinger's method.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use reference_rotors::{AttachedPolar, BladeElementRotor, RigidMotion};
use rotor_wake::{
    CirculationMap, ControlPoint, CoreSettings, FlightState, FreeWakeSettings, WakeRotor,
};

/// Lift-curve slope, per rad, of a blade `aspect_ratio` chords long at the end of an arm nine times as long, in
/// the undistorted wake of an inflow that takes it three spans away per turn.
fn slope(aspect_ratio: f64, control_point: ControlPoint) -> f64 {
    let polar = AttachedPolar { zero_lift_drag: 0.0, drag_growth: 0.0 };
    let incidence_rad = 0.02;
    let rotor = BladeElementRotor {
        rotor: WakeRotor::cosine(1, 0.9, 20).unwrap(),
        chord: 0.1 / aspect_ratio,
        twist_rad: 0.0,
        tip_mach: 0.0,
        motion: RigidMotion { pitch_rad: [incidence_rad, 0.0, 0.0], flap_rad: [0.0; 3] },
        polar: &polar,
    };
    let core = CoreSettings {
        radius: 1e-4,
        near_radius: 1e-4,
        panel_share: 0.1,
        viscosity: 0.0,
        ..CoreSettings::default()
    };
    let settings = FreeWakeSettings {
        azimuths: 24,
        turns: 1,
        far_turns: 0,
        core,
        control_point,
        ..FreeWakeSettings::default()
    };
    let flight = FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 };
    let wake = rotor.starting_wake(&settings, flight, 0.005).unwrap();
    let circulation = CirculationMap::constant(24, 20, 1e-3).unwrap();
    let induction = wake.line_induction(&circulation).unwrap();
    let still = rotor.circulation_in(&flight, &induction, &vec![0.0; 24 * 20]).unwrap();
    // lift of the row at rest against that of the same speeds in two-dimensional flow
    let (r, dr) = (rotor.rotor.stations(), rotor.rotor.widths());
    let row = still.circulation.row(0);
    let lift: f64 = (0..20).map(|s| row[s] * r[s] * dr[s]).sum();
    let flat: f64 = (0..20).map(|s| 0.5 * rotor.chord * r[s] * r[s] * dr[s]).sum();
    lift / flat / incidence_rad
}

/// Vortex lattices of rectangular wings with one horseshoe along the chord at a quarter of it and the same 20
/// cosine panels along the span, solved elsewhere: Weissinger's method. Many along the chord give 3.718 and 4.316.
#[test]
fn control_points_behind_the_line_give_weissingers_lift() {
    for (aspect_ratio, weissinger) in [(4.0, 3.7013), (6.0, 4.3087)] {
        let [line, behind] = [ControlPoint::LiftingLine, ControlPoint::ThreeQuarterChord]
            .map(|at| slope(aspect_ratio, at));
        println!(
            "{aspect_ratio}: lifting line {line}, three-quarter chord {behind}, lattice {weissinger}"
        );
        assert!((behind / weissinger - 1.0).abs() < 0.01, "{behind} {weissinger}");
        assert!(line / weissinger > 1.05, "{line} {weissinger}");
    }
}
