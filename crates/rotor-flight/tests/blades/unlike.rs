//! Blades unlike the rest and flaps with actuators of their own in flight, against the nonlinear rotor blade by blade.

use crate::common::actuator;
use crate::{ADVANCE_RATIO, BLADES, case, of_order, size};
use preisach_dyn::{ActuatorLaw, ActuatorModel, Calibration, LinearGain, VoltageRange};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::{Case, DissimilarBlade, FlapActuator, FlightController, FlightValues, Notice};
use rotor_flight::{FlightPoint, FlightState, FlyingCase, RotorPath};
use rotor_study::{TrimmedRotor, scaled};
use std::sync::Arc;

fn unlike() -> Vec<DissimilarBlade> {
    let heavy =
        DissimilarBlade { blade: 3, mass: 1.03, pitch_deg: 0.3, ..DissimilarBlade::default() };
    let weak = DissimilarBlade { blade: 2, flap_motion: 0.5, ..DissimilarBlade::default() };
    vec![heavy, weak]
}

fn still() -> Vec<HarmonicSeries> {
    vec![HarmonicSeries::zero(0); 2]
}

/// Two blades unlike the rest: at every order what they add, at rest and with flaps that move, is that of the nonlinear rotor.
/// Blades whose flaps move as the others' would not be taken for it.
#[test]
fn unlike_blades_add_what_the_nonlinear_rotor_says() {
    let case = case();
    let mut own = case.clone();
    own.rotor.dissimilar_blades = unlike();
    let path = RotorPath::new(&case, &[ADVANCE_RATIO]).unwrap().with_blades(&own, &[]).unwrap();
    let state = FlightState { advance_ratio: ADVANCE_RATIO, thrust_share: 0.0 };
    let mut moved = HarmonicSeries { mean: 0.2, ..HarmonicSeries::zero(4) };
    moved.set_harmonic(2, Harmonic { cosine: 0.6, sine: -0.3 });
    moved.set_harmonic(4, Harmonic { cosine: -0.2, sine: 0.4 });
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let about = &rotor.trim().rotor;
    let truth = |flaps_deg: &[HarmonicSeries]| {
        let rad: Vec<_> = flaps_deg.iter().map(|own| scaled(own, 1f64.to_radians())).collect();
        let mut solvers = rotor.unlike_solvers(&own).unwrap();
        let whole = rotor.unlike_hub_loads(&mut solvers, &rad, about).unwrap();
        let alike = rotor.unlike_hub_loads(&mut [], &rad, about).unwrap();
        move |n: usize| -> Vec<f64> {
            whole.harmonic(n).iter().zip(alike.harmonic(n)).map(|(own, like)| own - like).collect()
        }
    };
    let parts: Vec<f64> = path.own_blades().iter().map(|own| own.flap_motion).collect();
    assert_eq!(parts, [0.5, 1.0], "in the order of the blades");
    let moving = vec![moved.clone(), scaled(&moved, -0.5)];
    let each = |part: f64| moving.iter().map(|flap| scaled(flap, part)).collect::<Vec<_>>();
    let own: Vec<Vec<HarmonicSeries>> = parts.iter().map(|part| each(*part)).collect();
    let loads = |like: &[HarmonicSeries], own: &[Vec<HarmonicSeries>]| {
        path.own_blade_loads(state, like, own).unwrap()
    };
    let (rest, found) = (loads(&still(), &[]), loads(&moving, &own));
    let alike = loads(&moving, &[each(1.0), each(1.0)]);
    let (true_rest, truth) = (truth(&still()), truth(&moving));
    for n in 1..2 * BLADES {
        let off = |found: &[f64], truth: &[f64]| size(&difference(found, truth)) / size(truth);
        let of_motion = |loads: &[f64]| difference(&loads[of_order(n)], &rest[of_order(n)]);
        let exact = difference(&truth(n), &true_rest(n));
        let (at_rest, moved) =
            (off(&rest[of_order(n)], &true_rest(n)), off(&of_motion(&found), &exact));
        let as_others = off(&of_motion(&alike), &exact);
        println!("{n}/rev: off {at_rest:.1e} at rest, {moved:.1e} moving, {as_others:.1e} alike");
        // at 7/rev there is little, and less of it linear
        let most = if n == 7 { 0.1 } else { 0.05 };
        assert!(at_rest < 1e-6 && moved < most, "{n}/rev: {at_rest} {moved}");
        assert!(as_others > 0.05, "{n}/rev: {as_others}");
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn level(controllers: Vec<FlightController>) -> FlightValues {
    FlightValues {
        start_advance_ratio: ADVANCE_RATIO,
        end_advance_ratio: ADVANCE_RATIO,
        harmonics: vec![3],
        noise_percent: 0.0,
        duration_s: 14.0,
        amplitude_limit_volt: 60.0,
        controllers,
        dead_flap_percent: 1e6,
        ..FlightValues::default()
    }
}

/// The end of a flight of 3/rev at one speed.
fn end(case: &Case, values: &FlightValues, model: &ActuatorModel) -> FlightPoint {
    let flying = FlyingCase::new(case, values, model).unwrap();
    flying.fly(&|| ()).unwrap().flights.swap_remove(0).points.pop().unwrap()
}

/// A flight of dissimilar blades feels them: loads off the blade number with control and without, and another `J`.
#[test]
fn a_flight_feels_blades_unlike_the_rest() {
    let (mut case, model) = (case(), actuator());
    let values = level(vec![FlightController::Fixed]);
    let alike = end(&case, &values, &model);
    assert!(alike.other_ratio == 0.0 && alike.off_blade_number_at_rest.iter().all(|j| *j == 0.0));
    case.rotor.dissimilar_blades = unlike();
    let own = end(&case, &values, &model);
    let [once, others] = own.off_blade_number_at_rest;
    println!(
        "J {:.3} alike, {:.3}; 1/rev {once:.3} to {:.3}, others {others:.3} to {:.3} J0",
        alike.cost_ratio, own.cost_ratio, own.once_per_rev_ratio, own.other_ratio
    );
    assert!(once > 0.01 && others > 0.01, "{once} {others}");
    assert!(
        own.other_ratio > others + 0.01,
        "the weak blade's flaps are felt: {}",
        own.other_ratio
    );
    assert!((own.cost_ratio - alike.cost_ratio).abs() > 1e-3);
}

fn linear(deg_per_volt: f64) -> ActuatorModel {
    let range = VoltageRange::new(-20.0, 150.0).unwrap();
    let law = ActuatorLaw::Linear(LinearGain { gain_deg_per_volt: deg_per_volt, bias_volt: 65.0 });
    ActuatorModel::new(law, range, Calibration { deg_per_um: 0.04, zero_um: 0.0 })
}

/// An actuator of one flap moves that flap. T of controllers knows it where it is told, and not where it is not; nobody told of
/// one of another sign, a held T diverges.
#[test]
fn a_flap_has_its_own_actuator() {
    let (case, model) = (case(), linear(0.1));
    let own = |gain: f64, blade, notice| FlightValues {
        flap_actuators: vec![FlapActuator {
            flap: 2,
            blade,
            notice,
            model: Some(Arc::new(linear(gain))),
            ..FlapActuator::default()
        }],
        ..level(vec![FlightController::Fixed])
    };
    let t = |values: &FlightValues| {
        let flying = FlyingCase::new(&case, values, &model).unwrap();
        let flight = flying.flight_at(&[3]).unwrap();
        flight.identify(flight.state_at(0.0)).unwrap().columns()
    };
    let common = t(&level(vec![FlightController::Fixed]));
    let (told, untold) = (t(&own(0.05, None, Notice::Told)), t(&own(0.05, None, Notice::Untold)));
    for control in 0..4 {
        // the outboard flap moves half as far for a volt
        let part = if control < 2 { 1.0 } else { 0.5 };
        for (load, exact) in common[control].iter().enumerate() {
            let (told, untold) = (told[control][load], untold[control][load]);
            assert!((told - part * exact).abs() < 1e-6 * size(&common[control]), "{told} {exact}");
            assert!((untold - exact).abs() < 1e-12 * size(&common[control]));
        }
    }
    let like = end(&case, &level(vec![FlightController::Fixed]), &model);
    let [told, untold] =
        [Notice::Told, Notice::Untold].map(|notice| end(&case, &own(0.05, None, notice), &model));
    for point in [&told, &untold] {
        let volt =
            |flap: usize| point.control_volt[2 * flap].hypot(point.control_volt[2 * flap + 1]);
        for (flap, gain) in [(0, 0.1), (1, 0.05)] {
            let deg = point.flap_deg[flap][2];
            assert!((deg - gain * volt(flap)).abs() < 1e-3 * deg, "{flap}: {deg} {}", volt(flap));
        }
        assert!(point.other_ratio == 0.0, "blades are alike");
    }
    println!(
        "J/J0 {:.3}; half a gain outboard told {:.3}, not told {:.3}",
        like.cost_ratio, told.cost_ratio, untold.cost_ratio
    );
    assert!(told.cost_ratio > like.cost_ratio + 0.01, "{} {}", told.cost_ratio, like.cost_ratio);
    let turned = end(&case, &own(-0.1, None, Notice::Untold), &model).cost_ratio;
    let known = end(&case, &own(-0.1, None, Notice::Told), &model).cost_ratio;
    println!("turned, told {known:.3}, not told {turned:.3}");
    assert!((known - like.cost_ratio).abs() < 1e-3 && turned > known + 0.1, "{known} {turned}");
    // of one blade: felt off the blade number, and in no T
    let one = own(0.05, Some(4), Notice::Told);
    assert_eq!(t(&one), common);
    let one = end(&case, &one, &model);
    println!("of one blade: J {:.3}, others {:.4} J0", one.cost_ratio, one.other_ratio);
    assert!(one.other_ratio > 1e-3 && one.off_blade_number_at_rest.iter().all(|j| *j == 0.0));
    assert!((one.flap_deg[1][2] - like.flap_deg[1][2]).abs() < 0.2 * like.flap_deg[1][2]);
    // one that nobody has read is refused
    let mut missing = own(0.05, None, Notice::Told);
    missing.flap_actuators[0].model = None;
    let error = FlyingCase::new(&case, &missing, &model).unwrap().flight_at(&[3]).unwrap_err();
    assert!(error.to_string().contains("flap_actuators[0]"), "{error}");
}
