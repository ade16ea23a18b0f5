//! The wake in forward flight: prescribed helices, and the rotor of an independent free wake.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use common::harmonic;
use reference_rotors::{BladeElementSolution, CouplingSettings};
use reference_rotors::{olaf, olaf_flight, olaf_settings, olaf_thrust_newton};
use rotor_wake::{
    BladeLines, CirculationMap, CoreModel, FarField, FlightState, FreeWake, FreeWakeSettings,
    SegmentSet, Vec3, WakeError, WakeRotor, induced_velocities, momentum_inflow,
};
use std::f64::consts::TAU;

const THRUST: f64 = 0.0049;

/// Mean over the disk, by area, of the inflow of undistorted tip helices of constant circulation at the blade
/// that turns through it, over Glauert's: 40 stations in the middle of rings, 3 turns, 5 deg, core 0.02.
fn helices_over_glauert(advance_ratio: f64, stations: usize) -> f64 {
    let flight = FlightState { advance_ratio, shaft_tilt_rad: 5.0_f64.to_radians() };
    let inflow = momentum_inflow(&flight, THRUST).unwrap();
    let rotor = WakeRotor::uniform(4, 0.2, 20).unwrap();
    let azimuths = 72;
    let settings = FreeWakeSettings { azimuths, turns: 3, ..FreeWakeSettings::default() };
    let lines = BladeLines::flat(&rotor, azimuths);
    let wake = FreeWake::undistorted(rotor, settings, flight, inflow, lines).unwrap();
    let tip = wake.vortices().remove(0).points;
    let (mut sum, mut area) = (0.0, 0.0);
    for i in 0..azimuths {
        let mut set = SegmentSet::new(CoreModel::Vatistas);
        for b in 0..4 {
            for ends in tip[(i + 18 * b) % azimuths].windows(2) {
                set.push(ends[0], ends[1], TAU * THRUST / 4.0, 0.02);
            }
        }
        let (sin, cos) = (TAU * i as f64 / azimuths as f64).sin_cos();
        let radii: Vec<f64> = (0..stations).map(|k| (k as f64 + 0.5) / stations as f64).collect();
        let targets: Vec<Vec3> = radii.iter().map(|r| [r * cos, r * sin, 0.0]).collect();
        for (r, v) in radii.iter().zip(induced_velocities(&targets, &set)) {
            sum -= r * v[2];
            area += r;
        }
    }
    sum / area / inflow
}

#[test]
fn prescribed_helices_give_the_stated_mean_inflow() {
    for (mu, expected) in [(0.1, 1.06), (0.2, 1.10), (0.3, 1.21), (0.35, 1.24)] {
        let got = helices_over_glauert(mu, 40);
        assert!((got / expected - 1.0).abs() < 0.02, "mu {mu}: {got} for {expected}");
    }
}

fn reference(near_wake_deg: f64) -> BladeElementSolution {
    let rotor = olaf(20).unwrap();
    let settings = olaf_settings(near_wake_deg.to_radians());
    let mut wake = rotor.starting_wake(&settings, olaf_flight(), 0.005).unwrap();
    let coupling = CouplingSettings { inflow_tolerance: 2e-4, sweeps: 3, ..Default::default() };
    rotor.solve(&mut wake, &coupling).unwrap()
}

/// `fixtures/reference/wake/full72_lastrev.csv`: mean 18770 N, 4/rev 1127.4 N at -60.7 deg.
#[test]
fn the_reference_rotor_has_its_mean_and_vibratory_thrust() {
    let solution = reference(360.0);
    let thrust: Vec<f64> =
        solution.rotating_sums(4).iter().map(|sum| sum[2] * olaf_thrust_newton()).collect();
    let [mean, amplitude, phase] = harmonic(&thrust, 4);
    assert!((mean / 18770.5 - 1.0).abs() < 0.02, "mean {mean}");
    assert!((amplitude / 1127.4 - 1.0).abs() < 0.10, "4/rev {amplitude}");
    assert!((phase + 60.7).abs() < 10.0, "phase {phase}");
    // sums that must vanish in rotating axes with four alike blades: odd harmonics of the thrust, mean and
    // even harmonics in the plane
    let scale = solution.thrust_coefficient;
    let sums = solution.rotating_sums(4);
    for n in [1, 2, 3] {
        let z: Vec<f64> = sums.iter().map(|s| s[2]).collect();
        assert!(harmonic(&z, n)[1] < 1e-6 * scale, "thrust {n}/rev");
    }
    for component in [0, 1] {
        let f: Vec<f64> = sums.iter().map(|s| s[component]).collect();
        assert!(harmonic(&f, 1)[0].abs() < 1e-6 * scale);
        for n in [2, 4] {
            assert!(harmonic(&f, n)[1] < 1e-6 * scale, "in plane {n}/rev");
        }
    }
}

/// A short near wake moves the vibratory thrust; without the in-plane induced velocity and a full revolution
/// of it the bounds above do not hold.
#[test]
fn a_short_near_wake_is_seen_in_the_vibratory_thrust() {
    let short = reference(90.0);
    let thrust: Vec<f64> =
        short.rotating_sums(4).iter().map(|s| s[2] * olaf_thrust_newton()).collect();
    let [mean, amplitude, _] = harmonic(&thrust, 4);
    assert!((mean / 18770.5 - 1.0).abs() > 0.02, "mean {mean}");
    assert!(amplitude < 0.92 * 1127.4, "4/rev {amplitude}");
}

fn small_wake(settings: FreeWakeSettings, mu: f64) -> Result<FreeWake, WakeError> {
    let rotor = WakeRotor::cosine(4, 0.2, 8).unwrap();
    let flight = FlightState { advance_ratio: mu, shaft_tilt_rad: 0.087 };
    let lines = BladeLines::flat(&rotor, settings.azimuths);
    FreeWake::undistorted(rotor, settings, flight, 0.01, lines)
}

/// Sweeps until the wake stays within `1e-5 R`; the displacement of the first one.
fn settle(wake: &mut FreeWake, circulation: &CirculationMap) -> f64 {
    let first = wake.sweep(circulation).unwrap();
    let mut displacement = first;
    for _ in 1..60 {
        if displacement <= 1e-5 {
            return first;
        }
        displacement = wake.sweep(circulation).unwrap();
    }
    panic!("not settled: {displacement}");
}

fn relaxed(settings: FreeWakeSettings) -> FreeWake {
    let azimuths = settings.azimuths;
    let mut wake = small_wake(settings, 0.2).unwrap();
    let circulation = CirculationMap::constant(azimuths, 8, TAU * THRUST / 4.0).unwrap();
    settle(&mut wake, &circulation);
    wake
}

/// Sweeps settle, the finer grid starts near its end, and interpolated velocities are near the full ones.
#[test]
fn grids_in_sequence_and_interpolated_velocities() {
    let settings = FreeWakeSettings { azimuths: 12, turns: 2, ..Default::default() };
    let coarse = relaxed(settings.clone());
    let circulation = CirculationMap::constant(24, 8, TAU * THRUST / 4.0).unwrap();
    let lines = BladeLines::flat(coarse.rotor(), 24);
    let mut sequenced = coarse.on_grid(24, lines).unwrap();
    let fine = relaxed(settings.with_azimuths(24));
    let from_coarse = settle(&mut sequenced, &circulation);
    let mut cold = small_wake(settings.with_azimuths(24), 0.2).unwrap();
    let from_cold = settle(&mut cold, &circulation);
    assert!(from_coarse < 0.5 * from_cold, "first displacement {from_coarse}, cold {from_cold}");
    let distance = |a: &FreeWake, b: &FreeWake| {
        let (a, b) = (a.vortices().remove(0).points, b.vortices().remove(0).points);
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        let sum: f64 = pairs.map(|(p, q)| (0..3).map(|c| (p[c] - q[c]).powi(2)).sum::<f64>()).sum();
        (sum / (24.0 * 49.0)).sqrt()
    };
    assert!(distance(&sequenced, &fine) < 1e-3, "{}", distance(&sequenced, &fine));
    let thinned = relaxed(FreeWakeSettings { velocity_stride: 2, ..settings.with_azimuths(24) });
    assert!(distance(&thinned, &fine) < 0.01, "{}", distance(&thinned, &fine));
    assert!(distance(&thinned, &fine) > 1e-6, "interpolation did nothing");
}

/// Old vortices in single precision: the settled wake is the same within a few millionths of the radius.
#[test]
fn a_far_field_in_single_precision_gives_the_same_wake() {
    let settings = FreeWakeSettings { azimuths: 12, turns: 2, ..Default::default() };
    let [double, single] = [FarField::Double, FarField::Single].map(|far_field| {
        let wake = relaxed(FreeWakeSettings { far_field, ..settings.clone() });
        wake.vortices().remove(0).points
    });
    let pairs = double.iter().flatten().flatten().zip(single.iter().flatten().flatten());
    let worst = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    println!("largest distance {worst:.1e} R");
    assert!(worst < 1e-5 && worst > 0.0, "{worst:e}");
}

#[test]
fn settings_that_are_none_are_refused() {
    let refused = |settings| {
        assert!(matches!(small_wake(settings, 0.2), Err(WakeError::BadInput { .. })));
    };
    refused(FreeWakeSettings { azimuths: 22, ..Default::default() });
    refused(FreeWakeSettings { turns: 0, ..Default::default() });
    refused(FreeWakeSettings { near_wake_rad: f64::NAN, ..Default::default() });
    refused(FreeWakeSettings { velocity_stride: 0, ..Default::default() });
    refused(FreeWakeSettings { relaxation: 0.0, ..Default::default() });
}

/// A circulation no rotor has tears the wake apart: its sweeps never settle, or say that it is lost; numbers are left
/// behind.
#[test]
fn a_wake_that_runs_away_is_reported_and_stays_finite() {
    let mut wake = small_wake(FreeWakeSettings::default(), 0.05).unwrap();
    let circulation =
        CirculationMap::from_fn(24, 8, |i, _| if i % 2 == 0 { 1.0 } else { -0.5 }).unwrap();
    for _ in 0..25 {
        match wake.sweep(&circulation) {
            Ok(displacement) => assert!(displacement > 1e-2, "{displacement}"),
            Err(error) => {
                assert!(matches!(error, WakeError::WakeLost { .. }), "{error}");
                break;
            }
        }
    }
    let finite =
        |f: &rotor_wake::WakeFilament| f.points.iter().flatten().flatten().all(|x| x.is_finite());
    assert!(wake.vortices().iter().all(finite));
}

#[test]
fn a_descent_into_the_own_wake_is_named() {
    let rotor = olaf(8).unwrap();
    let flight = FlightState { advance_ratio: 0.01, shaft_tilt_rad: -1.35 };
    let error = rotor.starting_wake(&olaf_settings(TAU), flight, 0.005).unwrap_err();
    assert!(matches!(error, WakeError::VortexRingState { .. }), "{error}");
}

/// Vortices that move each other by thin cores go back and forth for ever at mu 0.2, sweeps in part or not; with cores of
/// 0.05 R between them whole sweeps come to rest, and so do parts of sweeps at the same place.
#[test]
fn mutual_cores_bring_the_sweeps_to_rest() {
    let flight = FlightState { advance_ratio: 0.2, shaft_tilt_rad: 0.048 };
    let circulation = CirculationMap::constant(24, 8, TAU * THRUST / 4.0).unwrap();
    let after = |mutual_radius: f64, part: f64, count: usize| {
        let rotor = WakeRotor::cosine(4, 0.2, 8).unwrap();
        let mut settings = FreeWakeSettings::default();
        settings.core.mutual_radius = mutual_radius;
        let lines = BladeLines::flat(&rotor, 24);
        let mut wake = FreeWake::undistorted(rotor, settings, flight, 0.012, lines).unwrap();
        let mut displacement = f64::INFINITY;
        for _ in 0..count {
            displacement = wake.sweep_in_part(&circulation, part).unwrap();
        }
        (displacement, wake)
    };
    let (wandering, _) = after(0.0, 1.0, 40);
    let (settled, whole) = after(0.05, 1.0, 40);
    let (slowly, in_part) = after(0.05, 0.5, 60);
    assert!(wandering > 1e-2 && settled < 1e-6 && slowly < 1e-6, "{wandering} {settled} {slowly}");
    let ends = |wake: &FreeWake| wake.vortices()[0].points.concat();
    let apart = ends(&whole).into_iter().zip(ends(&in_part));
    let apart = apart.flat_map(|(a, b)| (0..3).map(move |c| (a[c] - b[c]).abs()));
    assert!(apart.fold(0.0, f64::max) < 1e-4);
}
