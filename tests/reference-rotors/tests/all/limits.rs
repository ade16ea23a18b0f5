//! Where a free wake ends: a vortex nearer to a blade than its core, descent into the own wake, a wake that is lost.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use reference_rotors::slender;
use rotor_wake::{
    BladeLines, CirculationMap, CoreSettings, FlightState, FreeWake, FreeWakeSettings, WakeError,
    WakeMethod, WakeRotor,
};
use std::f64::consts::{FRAC_PI_2, TAU};

const HOVER: FlightState = FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 };

/// Undistorted helices that an inflow carries down.
fn helices(flight: FlightState, inflow: f64) -> FreeWake {
    helices_of(flight, inflow, (24, 0.02))
}

fn helices_of(flight: FlightState, inflow: f64, (azimuths, radius): (usize, f64)) -> FreeWake {
    let rotor = WakeRotor::cosine(4, 0.2, 8).unwrap();
    let settings = FreeWakeSettings {
        azimuths,
        turns: 2,
        core: CoreSettings { radius, ..CoreSettings::default() },
        ..FreeWakeSettings::default()
    };
    let lines = BladeLines::flat(&rotor, settings.azimuths);
    FreeWake::undistorted(rotor, settings, flight, inflow, lines).unwrap()
}

fn circulation() -> CirculationMap {
    CirculationMap::constant(24, 8, TAU * 0.0049 / 4.0).unwrap()
}

fn is_finite(wake: &FreeWake) -> bool {
    wake.vortices().iter().all(|f| f.points.iter().flatten().flatten().all(|x| x.is_finite()))
}

/// In hover the tip vortex of the blade before passes a quarter of a revolution old, below the tip by what the inflow
/// has carried it meanwhile: beyond its core or within.
#[test]
fn the_nearest_passage_is_that_of_the_helix() {
    for inflow in [0.08, 0.05, 0.02, 0.01, 0.0] {
        let passage = helices(HOVER, inflow).closest_passage(&circulation()).unwrap().unwrap();
        // below the tip stands a node; the segment that ends there rises inboard of it, at 7.5 deg to the blade's normal
        let half = 0.5 * TAU / 24.0;
        let (across, rise) = (half.cos(), inflow * half / half.sin());
        let distance = inflow * FRAC_PI_2 * across / across.hypot(rise);
        assert!((passage.distance - distance).abs() < 1e-12, "{inflow}: {passage:?}");
        assert!((passage.station - 1.0).abs() < 2e-3, "{passage:?}");
        assert_eq!(passage.core_radius.to_bits(), 0.05_f64.to_bits());
        assert_eq!(passage.within_core(), distance < 0.05, "{inflow}: {passage:?}");
        if inflow > 0.0 {
            assert!((passage.age_rad - FRAC_PI_2).abs() < 0.02, "{passage:?}");
        }
    }
}

/// Vortices that lie in the plane of the disk cut the blades: named as within the core, and all velocities are numbers.
#[test]
fn vortices_on_the_blades_are_named_and_give_numbers() {
    let flight = FlightState { advance_ratio: 0.15, shaft_tilt_rad: 0.0 };
    let mut wake = helices(flight, 0.0);
    let circulation = circulation();
    let passage = wake.closest_passage(&circulation).unwrap().unwrap();
    // cut between two nodes, 0.01 R away at their nearest
    assert!(passage.within_core() && passage.distance < 1e-12, "{passage:?}");
    assert!(passage.station < 1.0 && passage.age_rad > 0.2, "{passage:?}");
    let inflow = wake.line_induction(&circulation).unwrap().inflow(&circulation).unwrap();
    assert!(inflow.values().iter().all(|x| x.is_finite()));
    for _ in 0..5 {
        wake.sweep(&circulation).unwrap();
    }
    assert!(is_finite(&wake));
    // lifted clear of the blades by a forward tilt, it is no longer
    let tilted = FlightState { shaft_tilt_rad: 0.3, ..flight };
    let clear = helices(tilted, 0.02).closest_passage(&circulation).unwrap().unwrap();
    assert!(!clear.within_core(), "{clear:?}");
}

/// Descent at the induced velocity of hover: neither momentum theory nor a wake has an answer.
#[test]
fn vortex_ring_descent_is_named() {
    let rotor = slender().unwrap();
    let induced = (0.5_f64 * 0.0048).sqrt();
    let settings = FreeWakeSettings { turns: 2, ..FreeWakeSettings::default() };
    let descent = |speed: f64| FlightState {
        advance_ratio: 1e-3,
        shaft_tilt_rad: -(speed * induced / 1e-3).atan(),
    };
    let refused = rotor.starting_wake(&settings, descent(1.0), 0.0048);
    assert!(matches!(refused, Err(WakeError::VortexRingState { .. })), "{refused:?}");
    assert!(rotor.starting_wake(&settings, descent(0.1), 0.0048).is_ok());
}

/// A strength that leaves the numbers: an error, and the wake is the one before, relaxed or marched.
#[test]
fn a_lost_wake_is_the_one_before() {
    let start = {
        let mut wake = helices(FlightState { advance_ratio: 0.2, shaft_tilt_rad: 0.1 }, 0.01);
        wake.carry_on(WakeMethod::Relaxed, 1, &circulation()).unwrap();
        wake
    };
    // of the strengths between, some leave the numbers well within the revolution, when the grid already holds new shapes
    for (method, powers) in
        [(WakeMethod::Relaxed, vec![250]), (WakeMethod::Marched, vec![52, 53, 56, 70, 130, 250])]
    {
        let mut lost = 0;
        for power in powers {
            let strong = CirculationMap::constant(24, 8, 10_f64.powi(power)).unwrap();
            let mut wake = start.clone();
            if let Err(error) = wake.carry_on(method, 1, &strong) {
                assert!(matches!(error, WakeError::WakeLost { .. }), "{error}");
                assert!(wake == start && is_finite(&wake), "{method:?} 1e{power}");
                lost = power;
            }
        }
        assert_eq!(lost, 250, "{method:?}");
    }
}

/// Marched on, a relaxed wake in forward flight stays where it is but for the difference of two schemes, which falls
/// faster than the step.
#[test]
fn march_and_relaxation_agree_in_forward_flight() {
    let flight = FlightState { advance_ratio: 0.25, shaft_tilt_rad: 0.087 };
    let apart = [24, 48].map(|azimuths| {
        let mut wake = helices_of(flight, 0.01, (azimuths, 0.15));
        let circulation = CirculationMap::constant(azimuths, 8, TAU * 0.0049 / 4.0).unwrap();
        let settled = wake.carry_on(WakeMethod::Relaxed, 40, &circulation).unwrap();
        let relaxed = wake.clone();
        let moved = wake.carry_on(WakeMethod::Marched, 4, &circulation).unwrap();
        assert!(settled < 1e-6 && moved < 2e-3, "{settled} {moved}");
        let pairs = wake.vortices().into_iter().zip(relaxed.vortices());
        let (sum, count) = pairs
            .flat_map(|(a, b)| a.points.into_iter().flatten().zip(b.points.into_iter().flatten()))
            .map(|(p, q)| (0..3).map(|c| (p[c] - q[c]).powi(2)).sum::<f64>())
            .fold((0.0, 0.0), |(sum, count), d| (sum + d, count + 1.0));
        f64::sqrt(sum / count)
    });
    println!("apart {apart:?}");
    assert!(apart[0] < 0.2 && apart[1] < 0.4 * apart[0], "{apart:?}");
}
