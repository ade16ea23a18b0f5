//! The wake in hover, and its march in time.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rotor_wake::{
    AttachedPolar, BladeElementRotor, BladeLines, CirculationMap, CoreSettings, CouplingSettings,
    FarTrailers, FlightState, FreeWake, FreeWakeSettings, RigidMotion, WakeMarch, WakeRotor,
    contraction_drift, momentum_inflow,
};
use std::f64::consts::{PI, TAU};

const HOVER: FlightState = FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 };

/// Two untwisted blades at 8 deg. Landgrebe's tip vortex of the same thrust: radius
/// `0.78 + 0.22 exp(-(0.145 + 27 C_T) zeta)`, pitch after the first passage `-1.41 sqrt(C_T/2)` per rad.
#[test]
fn the_tip_vortex_of_a_hovering_rotor_is_landgrebes() {
    let polar = AttachedPolar { zero_lift_drag: 0.008, drag_growth: 0.1 };
    let rotor = BladeElementRotor {
        rotor: WakeRotor::cosine(2, 0.19, 20).unwrap(),
        chord: 0.1905 / 1.143,
        twist_rad: 0.0,
        tip_mach: 0.439,
        motion: RigidMotion { pitch_rad: [8.0_f64.to_radians(), 0.0, 0.0], flap_rad: [0.0; 3] },
        polar: &polar,
    };
    let settings = FreeWakeSettings {
        turns: 3,
        far_turns: 6,
        far: FarTrailers::TipAndRoot,
        core: CoreSettings { radius: 0.03, viscosity: 8.7e-8, ..CoreSettings::default() },
        ..FreeWakeSettings::default()
    };
    let mut wake = rotor.starting_wake(&settings, HOVER, 0.0046).unwrap();
    let coupling = CouplingSettings { updates: 60, sweeps: 4, inflow_tolerance: 3e-4 };
    let solution = rotor.solve(&mut wake, &coupling).unwrap();
    let ct = solution.thrust_coefficient;
    let tip = contraction_drift(&wake);
    for age in [6, 12, 18, 24, 36, 48] {
        let zeta = age as f64 * TAU / 24.0;
        let radius = 0.78 + 0.22 * (-(0.145 + 27.0 * ct) * zeta).exp();
        let got = tip[age][0];
        assert!((got / radius - 1.0).abs() < 0.10, "age {zeta}: radius {got}, Landgrebe {radius}");
    }
    let pitch = (tip[48][1] - tip[12][1]) / (3.0 * PI);
    let landgrebe = -1.41 * (0.5 * ct).sqrt();
    assert!((pitch / landgrebe - 1.0).abs() < 0.10, "pitch {pitch}, Landgrebe {landgrebe}");
}

/// In forward flight the march in time and the periodic sweeps find the same wake, and the blades of the march
/// have wakes alike though each is marched on its own.
#[test]
fn march_and_relaxation_agree_in_forward_flight() {
    let flight = FlightState { advance_ratio: 0.25, shaft_tilt_rad: 0.087 };
    let rotor = WakeRotor::cosine(4, 0.2, 8).unwrap();
    let settings = FreeWakeSettings {
        turns: 2,
        far_turns: 0,
        core: CoreSettings { radius: 0.05, ..CoreSettings::default() },
        tolerance: 1e-6,
        max_iterations: 200,
        ..FreeWakeSettings::default()
    };
    let inflow = momentum_inflow(&flight, 0.0049).unwrap();
    let lines = BladeLines::flat(&rotor, 24);
    let circulation = CirculationMap::constant(24, 8, TAU * 0.0049 / 4.0).unwrap();
    let start = FreeWake::undistorted(rotor, settings, flight, inflow, lines).unwrap();
    let mut relaxed = start.clone();
    relaxed.solve(&circulation).unwrap();
    let mut march = WakeMarch::new(start);
    let changes = march.revolutions(8, &circulation).unwrap();
    assert!(changes[7] < 1e-3 && changes[7] < 0.01 * changes[0], "{changes:?}");
    let points = |wake: &FreeWake| wake.vortices().remove(0).points;
    let (a, b) = (points(&relaxed), points(march.wake()));
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    let sum: f64 = pairs.map(|(p, q)| (0..3).map(|c| (p[c] - q[c]).powi(2)).sum::<f64>()).sum();
    let rms = (sum / (24.0 * 49.0)).sqrt();
    assert!(rms < 0.01, "march and relaxation {rms} R apart");
    assert!(march.asymmetry(&circulation).unwrap() < 5e-3);
}
