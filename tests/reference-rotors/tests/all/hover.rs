//! The wake in hover, and its march in time.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use reference_rotors::{BladeElementRotor, BladeElementSolution, CouplingSettings};
use reference_rotors::{
    CARADONNA_TUNG_THRUST, Landgrebe, caradonna_tung, contraction_drift, slender,
};
use rotor_wake::{
    BladeLines, CirculationMap, ControlPoint, CoreModel, CoreSettings, FarTrailers, FlightState,
    FreeWake, FreeWakeSettings, NearWakeMotion, WakeError, WakeMarch, WakeRotor, WakeSymmetry,
};
use std::f64::consts::TAU;

const HOVER: FlightState = FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 };

fn hover(
    rotor: &BladeElementRotor<'_>,
    settings: &FreeWakeSettings,
) -> Result<(BladeElementSolution, FreeWake), WakeError> {
    let mut wake = rotor.starting_wake(settings, HOVER, 0.0046)?;
    let coupling = CouplingSettings { updates: 80, sweeps: 2, inflow_tolerance: 1e-4 };
    Ok((rotor.solve(&mut wake, &coupling)?, wake))
}

/// Thrust over the measured one, less 1.
fn off(pitch_deg: f64, measured: f64, settings: &FreeWakeSettings) -> f64 {
    hover(&caradonna_tung(pitch_deg.to_radians()).unwrap(), settings)
        .map_or(f64::INFINITY, |(solution, _)| solution.thrust_coefficient / measured - 1.0)
}

/// Thrust of the model rotor of F. X. Caradonna and C. Tung, NASA TM 81232 (1981), as quoted since (0.00474 at
/// 8 deg in one transcription).
#[test]
fn the_thrust_of_caradonna_and_tungs_rotor_is_met_at_three_pitches() {
    for (pitch_deg, measured) in CARADONNA_TUNG_THRUST {
        let error = off(pitch_deg, measured, &FreeWakeSettings::hover(CoreModel::Vatistas));
        println!("{pitch_deg} deg: {error:+.4}");
        assert!(error.abs() < 0.05, "{pitch_deg} deg: {error}");
    }
}

/// One vortex at the root in place of the sheet, or the lifting line in place of Weissinger's points: either alone
/// leaves the bound.
#[test]
fn neither_sheet_nor_control_point_can_be_left_out() {
    let settings = FreeWakeSettings::hover(CoreModel::Vatistas);
    let rolled_up = FreeWakeSettings { far: FarTrailers::TipAndRoot, ..settings };
    let line = FreeWakeSettings {
        control_point: ControlPoint::LiftingLine,
        ..FreeWakeSettings::hover(CoreModel::RosenheadMoore)
    };
    let cases = [
        ("rolled up", rolled_up, CARADONNA_TUNG_THRUST[0]),
        ("lifting line", line, CARADONNA_TUNG_THRUST[1]),
    ];
    for (name, settings, (pitch_deg, measured)) in cases {
        let error = off(pitch_deg, measured, &settings);
        println!("{name}: {error:+.4}");
        assert!(error.is_finite() && error.abs() > 0.08, "{name}: {error}");
    }
}

/// Landgrebe's fit of the four slender blades at the thrust reached, and by age the tip vortex over it: radius, and `k1`
/// and `k2` by the height at the first passage and a turn behind it.
fn over_landgrebe(settings: &FreeWakeSettings) -> (Vec<f64>, [f64; 2], f64) {
    let rotor = slender().unwrap();
    let (solution, wake) = hover(&rotor, settings).unwrap();
    let landgrebe = Landgrebe::of(&rotor, solution.thrust_coefficient);
    let (tip, turn) = (contraction_drift(&wake), settings.azimuths);
    let passage = turn / 4;
    let radius = (1..=2 * turn)
        .map(|k| tip[k][0] / landgrebe.radius(k as f64 * settings.step_rad()))
        .collect();
    let k1 = tip[passage][1] / (0.25 * TAU) / landgrebe.k1();
    let k2 = (tip[passage + turn][1] - tip[passage][1]) / TAU / landgrebe.k2();
    (radius, [k1, k2], solution.figure_of_merit())
}

/// Four slender blades with -8 deg of twist, of the kind Landgrebe's fit is for: radius `0.78 + 0.22 exp(-(0.145 + 27
/// C_T) zeta)`, descent `k1` per rad up to the first passage and `k2` behind it, `J. Am. Helicopter Soc.` 17 (1972).
#[test]
fn the_tip_vortex_of_a_hovering_rotor_is_landgrebes() {
    let settings = FreeWakeSettings::hover_rolling_up(CoreModel::RosenheadMoore);
    let (radius, [k1, k2], merit) = over_landgrebe(&settings);
    assert!(radius.iter().all(|r| (r - 1.0).abs() < 0.04), "{radius:?}");
    assert!((k1 - 1.0).abs() < 0.10 && (k2 - 1.0).abs() < 0.10, "k1 {k1}, k2 {k2}");
    // momentum theory is the least power there is; the drag of the sections takes some more
    assert!((0.6..0.85).contains(&merit), "figure of merit {merit}");
}

/// A sheet that follows the tip vortex, as in forward flight, does not take it down before the first passage.
#[test]
fn the_sheet_that_rolls_up_takes_the_tip_vortex_down() {
    let follows = FreeWakeSettings {
        near_wake_motion: NearWakeMotion::FollowsTip,
        ..FreeWakeSettings::hover_rolling_up(CoreModel::RosenheadMoore)
    };
    let (_, [k1, _], _) = over_landgrebe(&follows);
    assert!((0.2..0.75).contains(&k1), "{k1}");
}

/// Slopes on either side of the first passage come back from heights made with them.
#[test]
fn two_slopes_are_fitted_as_landgrebe_did() {
    let heights: Vec<f64> = (0..30)
        .map(|k| {
            let age = 0.1 * f64::from(k);
            -0.02 * age.min(1.57) - 0.06 * (age - 1.57).max(0.0)
        })
        .collect();
    let [k1, k2] = Landgrebe::fitted(&heights, 0.1, 1.57).unwrap();
    assert!((k1 + 0.02).abs() < 1e-12 && (k2 + 0.06).abs() < 1e-12, "{k1} {k2}");
    assert_eq!(Landgrebe::fitted(&heights[..10], 0.1, 1.57), None);
}

/// What turns with the rotor comes to rest: two hundred sweeps later nothing has moved.
#[test]
fn an_axial_wake_does_not_drift() {
    let settings = FreeWakeSettings::hover(CoreModel::RosenheadMoore);
    let (solution, mut wake) = hover(&slender().unwrap(), &settings).unwrap();
    let sweep = |wake: &mut FreeWake, count: usize| {
        (0..count).fold(0.0, |_, _| wake.sweep(&solution.circulation).unwrap())
    };
    sweep(&mut wake, 40);
    let before = contraction_drift(&wake);
    let last = sweep(&mut wake, 200);
    assert!(last < 1e-12, "{last:e}");
    for (a, b) in before.iter().zip(contraction_drift(&wake)) {
        assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9, "{a:?} {b:?}");
    }
}

/// The reduced sums of an axial wake are those of the full grid.
#[test]
fn an_axial_wake_is_the_periodic_one_computed_once() {
    let axial = FreeWakeSettings::hover(CoreModel::RosenheadMoore);
    let periodic = FreeWakeSettings { symmetry: WakeSymmetry::Periodic, ..axial.clone() };
    let rotor = slender().unwrap();
    let circulation =
        CirculationMap::from_fn(24, rotor.rotor.panels(), |_, s| 0.01 * (1.0 + s as f64).ln())
            .unwrap();
    let [a, b] = [axial, periodic].map(|settings| {
        let mut wake = rotor.starting_wake(&settings, HOVER, 0.0046).unwrap();
        for _ in 0..3 {
            wake.sweep(&circulation).unwrap();
        }
        let inflow = wake.line_induction(&circulation).unwrap().inflow(&circulation).unwrap();
        (wake.vortices(), inflow)
    });
    for (x, y) in a.1.values().iter().zip(b.1.values()) {
        assert!((x - y).abs() < 1e-12, "{x} {y}");
    }
    for (f, g) in a.0.iter().zip(&b.0) {
        for (p, q) in f.points.iter().flatten().zip(g.points.iter().flatten()) {
            assert!(p.iter().zip(q).all(|(x, y)| (x - y).abs() < 1e-12), "{p:?} {q:?}");
        }
    }
}

#[test]
fn an_axial_wake_is_refused_in_forward_flight_and_with_flapping_blades() {
    let settings = FreeWakeSettings::hover(CoreModel::Vatistas);
    let mut rotor = slender().unwrap();
    let forward = FlightState { advance_ratio: 0.1, shaft_tilt_rad: 0.0 };
    let refused = rotor.starting_wake(&settings, forward, 0.0046);
    assert!(matches!(refused, Err(WakeError::BadInput { .. })));
    rotor.motion.flap_rad = [0.05, 0.01, 0.0];
    let refused = rotor.starting_wake(&settings, HOVER, 0.0046);
    assert!(matches!(refused, Err(WakeError::BadInput { .. })));
}

/// Blades that move a little become their mean, which turns; circulation likewise. More is refused.
#[test]
fn an_axial_wake_takes_the_mean_of_the_blades() {
    let rotor = slender().unwrap().rotor;
    let flapping = |size: f64| {
        BladeLines::deflected(&rotor, 24, |i, n| {
            let azimuth = TAU * i as f64 / 24.0;
            [rotor.nodes()[n] * (0.05 + size * azimuth.cos()), 0.0]
        })
    };
    let mean = flapping(0.003).axial().unwrap();
    let still = flapping(0.0);
    for i in 0..24 {
        for (p, q) in mean.at(i).iter().zip(still.at(i)) {
            assert!((0..3).all(|c| (p[c] - q[c]).abs() < 1e-12), "{p:?} {q:?}");
        }
    }
    assert!(matches!(flapping(0.02).axial(), Err(WakeError::BadInput { .. })));
    let uneven = CirculationMap::from_fn(24, 20, |i, s| {
        0.01 * (1.0 + s as f64 + 0.1 * (TAU * i as f64 / 24.0).cos())
    });
    let even = uneven.unwrap().axial();
    for i in 0..24 {
        assert!(even.row(i).iter().zip(1..).all(|(g, s)| (g - 0.01 * f64::from(s)).abs() < 1e-12));
    }
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

/// The slender rotor in a climb (tip speed), its wake undistorted at first, with the circulation of hover.
fn climb(speed: f64) -> (WakeMarch, CirculationMap) {
    let settings = FreeWakeSettings {
        turns: 2,
        far_turns: 2,
        symmetry: WakeSymmetry::Periodic,
        ..FreeWakeSettings::hover(CoreModel::RosenheadMoore)
    };
    let flight = FlightState { advance_ratio: 1e-6, shaft_tilt_rad: (speed / 1e-6).atan() };
    let rotor = slender().unwrap();
    let stations = rotor.rotor.stations();
    let circulation = CirculationMap::from_fn(24, stations.len(), |_, s| {
        let x = (stations[s] - 0.19) / 0.81;
        0.012 * (0.3 + 0.7 * x) * (x * (1.0 - x.powi(24))).sqrt()
    });
    let wake = rotor.starting_wake(&settings, flight, 0.0048).unwrap();
    (WakeMarch::new(wake), circulation.unwrap())
}

/// Far from its own turns a wake comes to rest: in a climb at a tenth of the tip speed. What alternates from step to
/// step, as the start leaves it, dies out; differences about the middle of the cell would keep some of it.
#[test]
fn the_march_comes_to_rest_in_a_climb() {
    let (mut march, circulation) = climb(0.1);
    let changes = march.revolutions(6, &circulation).unwrap();
    assert!(changes[5] < 1e-3 && changes[5] < 0.5 * changes[4], "{changes:?}");
    let tip = march.wake().vortices().pop().unwrap().points;
    for age in [3, 12, 24] {
        let height: Vec<f64> = tip.iter().map(|points| points[age][2]).collect();
        let alternating = common::harmonic(&height, 12)[1];
        assert!(alternating < 1e-6, "age {age}: {alternating:e}");
    }
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
