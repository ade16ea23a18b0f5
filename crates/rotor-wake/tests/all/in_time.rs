//! The wake in time against the periodic one.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use approx::assert_abs_diff_eq;
use nalgebra::DVector;
use rotor_wake::{
    BladeLines, BladePlace, CirculationMap, CoreModel, FlightState, FreeWake, FreeWakeSettings,
    NearWakeMotion, WakeError, WakeInTime, WakeRotor, momentum_inflow,
};
use std::f64::consts::TAU;

const MU: f64 = 0.25;

/// A wake that sweeps have settled, and its circulation.
fn settled(settings: FreeWakeSettings, sweeps: usize) -> (FreeWake, CirculationMap) {
    let rotor = WakeRotor::uniform(4, 0.2, 8).unwrap();
    let flight = FlightState { advance_ratio: MU, shaft_tilt_rad: 0.1 };
    let circulation = CirculationMap::elliptic(&rotor, settings.azimuths, 0.006, MU).unwrap();
    let mean = momentum_inflow(&flight, 0.006).unwrap();
    let lines = BladeLines::flat(&rotor, settings.azimuths);
    let mut wake = FreeWake::undistorted(rotor, settings, flight, mean, lines).unwrap();
    let mut displacement = 0.0;
    for _ in 0..sweeps {
        displacement = wake.sweep(&circulation).unwrap();
    }
    assert!(sweeps < 40 || displacement < 1e-11, "{displacement:e}");
    (wake, circulation)
}

/// Without repeated turns behind the free ones, which follow the mean of the blades of an instant, not of all azimuths.
fn settings() -> FreeWakeSettings {
    FreeWakeSettings { turns: 2, far_turns: 0, ..FreeWakeSettings::default() }
}

/// Places and circulation of the blades of a periodic wake after some steps.
fn periodic(
    wake: &FreeWake,
    circulation: &CirculationMap,
    step: usize,
) -> (Vec<BladePlace>, DVector<f64>) {
    let (azimuths, blades) = (wake.settings().azimuths, wake.rotor().blades());
    let at = |blade: usize| (step + blade * azimuths / blades) % azimuths;
    let place = |blade: usize| {
        let azimuth = TAU * at(blade) as f64 / azimuths as f64;
        BladePlace::deflected(wake.rotor(), azimuth, |_| [0.0; 2], |_| 0.0, |_| 0.0)
    };
    let rows = (0..blades).flat_map(|blade| circulation.row(at(blade)).to_vec());
    ((0..blades).map(place).collect(), DVector::from_vec(rows.collect()))
}

/// A settled periodic wake is one in time: it stays as it is, and its blades feel what they felt, whatever the motion of the
/// near wake and the core model, the more corrections of a step the better. Under half the circulation it does not stay.
#[test]
fn a_periodic_wake_stays_as_it_is() {
    let free = FreeWakeSettings { near_wake_motion: NearWakeMotion::Free, ..settings() };
    let mut moore = settings();
    moore.core.model = CoreModel::RosenheadMoore;
    moore.core.mutual_radius = 0.15;
    let plane = FreeWakeSettings {
        near_wake_motion: NearWakeMotion::BladePlane,
        near_wake_rad: 0.5,
        ..settings()
    };
    for settings in [settings(), free, moore, plane] {
        let (wake, circulation) = settled(settings, 40);
        let felt_before = wake.line_induction(&circulation).unwrap().inflow(&circulation).unwrap();
        let apart = |corrections: usize, share: f64| {
            let march = WakeInTime::new(wake.clone(), &circulation).unwrap();
            let mut march = march.with_corrections(corrections);
            let mut felt_apart = 0.0_f64;
            for step in 1..=wake.settings().azimuths {
                let (places, carried) = periodic(&wake, &circulation, step);
                march.move_on(*wake.flight(), places).unwrap();
                let felt = march.felt().velocities(&carried);
                let panels = wake.rotor().panels();
                for (blade, of_blade) in felt[0].as_slice().chunks(panels).enumerate() {
                    let azimuths = wake.settings().azimuths;
                    let row = felt_before.row((step + blade * azimuths / 4) % azimuths);
                    for (a, b) in of_blade.iter().zip(row) {
                        felt_apart = felt_apart.max((a - b).abs());
                    }
                }
                march.put_circulation(&(carried * share)).unwrap();
            }
            let start = WakeInTime::new(wake.clone(), &circulation).unwrap();
            let pairs = start.vortices(1).iter().flatten().zip(march.vortices(1).iter().flatten());
            let moved = pairs.flat_map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).abs()));
            (moved.fold(0.0_f64, f64::max), felt_apart)
        };
        let (moved, felt) = apart(9, 1.0);
        assert!(moved < 1e-9 && felt < 1e-9, "{moved:e} {felt:e}");
        let (moved, felt) = apart(2, 1.0);
        assert!(moved < 3e-3 && felt < 3e-5, "{moved:e} {felt:e}");
        let (moved, felt) = apart(9, 0.5);
        assert!(moved > 1e-2 && felt > 1e-3, "{moved:e} {felt:e}");
    }
}

/// What the blades feel is linear in what they carry now; the rest is of the past.
#[test]
fn what_is_felt_is_linear_in_the_present_circulation() {
    let (wake, circulation) = settled(settings(), 3);
    let mut march = WakeInTime::new(wake.clone(), &circulation).unwrap();
    let (places, carried) = periodic(&wake, &circulation, 1);
    march.move_on(*wake.flight(), places).unwrap();
    let felt = march.felt();
    march.put_circulation(&(&carried * 2.0)).unwrap();
    assert_eq!(march.circulation(), &carried * 2.0);
    let again = march.felt();
    for (a, b) in felt.rest[0].iter().zip(&again.rest[0]) {
        assert_abs_diff_eq!(*a, *b, epsilon = 1e-15);
    }
    let half_a_turn_ago = felt.velocities(&DVector::zeros(carried.len()));
    assert_eq!(half_a_turn_ago[0], felt.rest[0]);
    assert!(felt.rest[0].amax() > 1e-3);
}

#[test]
fn what_does_not_fit_is_refused() {
    let (wake, circulation) = settled(settings(), 1);
    let other = CirculationMap::constant(12, 8, 0.01).unwrap();
    assert!(matches!(WakeInTime::new(wake.clone(), &other), Err(WakeError::BadInput { .. })));
    let mut march = WakeInTime::new(wake.clone(), &circulation).unwrap();
    let (mut places, carried) = periodic(&wake, &circulation, 1);
    places.pop();
    let refused = march.move_on(*wake.flight(), places);
    assert!(matches!(refused, Err(WakeError::BadInput { .. })));
    let short = carried.rows(0, 5).into_owned();
    assert!(matches!(march.put_circulation(&short), Err(WakeError::BadInput { .. })));
    let mut bad = carried;
    bad[3] = f64::NAN;
    assert!(matches!(march.put_circulation(&bad), Err(WakeError::BadInput { .. })));
    let hover = FreeWakeSettings::hover(CoreModel::Vatistas);
    let rotor = WakeRotor::uniform(2, 0.2, 8).unwrap();
    let lines = BladeLines::flat(&rotor, hover.azimuths);
    let circulation = CirculationMap::constant(hover.azimuths, 8, 0.01).unwrap();
    let flight = FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 };
    let axial = FreeWake::undistorted(rotor, hover, flight, 0.05, lines).unwrap();
    assert!(matches!(WakeInTime::new(axial, &circulation), Err(WakeError::BadInput { .. })));
}
