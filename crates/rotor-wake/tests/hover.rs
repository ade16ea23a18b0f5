//! The wake in hover, and its march in time.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rotor_wake::{
    AttachedPolar, BladeElementRotor, BladeLines, CirculationMap, CoreSettings, CouplingSettings,
    FarTrailers, FlightState, FreeWake, FreeWakeSettings, RigidMotion, WakeMarch, WakeRotor,
    contraction_drift,
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
        core: CoreSettings {
            radius: 0.03,
            panel_share: 0.3,
            viscosity: 8.7e-8,
            ..CoreSettings::default()
        },
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

fn march(azimuths: usize, strength: f64) -> (FreeWake, WakeMarch, CirculationMap) {
    let flight = FlightState { advance_ratio: 0.25, shaft_tilt_rad: 0.087 };
    let rotor = WakeRotor::cosine(4, 0.2, 8).unwrap();
    let settings = FreeWakeSettings {
        azimuths,
        turns: 2,
        far_turns: 0,
        core: CoreSettings { radius: 0.05, ..CoreSettings::default() },
        ..FreeWakeSettings::default()
    };
    let lines = BladeLines::flat(&rotor, azimuths);
    let circulation = CirculationMap::constant(azimuths, 8, strength).unwrap();
    let start = FreeWake::undistorted(rotor, settings, flight, 0.0, lines).unwrap();
    (start.clone(), WakeMarch::new(start), circulation)
}

/// Without circulation the exact wake is the helix it starts from: the march leaves it by its own error, of
/// second order in the step.
#[test]
fn the_march_is_of_second_order() {
    let error = |azimuths: usize| {
        let (exact, mut march, circulation) = march(azimuths, 1e-12);
        march.revolutions(4, &circulation).unwrap();
        let points = |wake: &FreeWake| wake.vortices().remove(0).points;
        let (a, b) = (points(&exact), points(march.wake()));
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        let (count, sum) = pairs.fold((0.0, 0.0), |(count, sum), (p, q)| {
            (count + 1.0, sum + (0..3).map(|c| (p[c] - q[c]).powi(2)).sum::<f64>())
        });
        f64::sqrt(sum / count)
    };
    let errors = [48, 96].map(error);
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 2.0).abs() < 0.2, "{errors:?}, order {order}");
}

/// In forward flight the march becomes periodic, and the wakes of the blades alike though each is marched on its
/// own.
#[test]
fn the_march_becomes_periodic_in_forward_flight() {
    let (_, mut march, circulation) = march(24, TAU * 0.0049 / 4.0);
    let changes = march.revolutions(8, &circulation).unwrap();
    assert!(changes[7] < 1e-3 && changes[7] < 0.01 * changes[0], "{changes:?}");
    assert!(march.asymmetry(&circulation).unwrap() < 5e-3);
}
