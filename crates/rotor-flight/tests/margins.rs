//! How wrong T may be along the speeds of a flight, flown; and draws of the noise.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

mod common;

use common::actuator;
use preisach_dyn::{ActuatorLaw, ActuatorModel, Calibration, LinearGain, VoltageRange};
use rotor_case::{Case, FlightController, FlightValues, HandedSet, HandedT};
use rotor_flight::{FlightState, FlownCase, FlyingCase, Guidance, MarginPoint, fly};
use std::sync::Arc;

/// An ideal actuator whose voltage may grow for long.
fn ideal() -> ActuatorModel {
    let range = VoltageRange::new(-1e9, 1e9).unwrap();
    let law = ActuatorLaw::Linear(LinearGain { gain_deg_per_volt: 0.04, bias_volt: 0.0 });
    ActuatorModel::new(law, range, Calibration { deg_per_um: 0.04, zero_um: 0.0 })
}

fn case() -> Case {
    let mut case = Case::default();
    case.actuator.range_volt = (-1e9, 1e9);
    case
}

fn values(harmonics: &[usize]) -> FlightValues {
    FlightValues {
        start_advance_ratio: 0.15,
        end_advance_ratio: 0.35,
        knots: 3,
        harmonics: harmonics.to_vec(),
        noise_percent: 0.0,
        duration_s: 20.0,
        controllers: vec![FlightController::Fixed, FlightController::Adaptive],
        thrust_step: None,
        failed_flap: None,
        // theory knows the radius of flaps that all act, and of steps that nothing shortens
        flap_survival_percent: 100.0,
        dead_flap_percent: 1e6,
        ..FlightValues::default()
    }
}

/// Growth of the change of the control in a cycle of whole steps, where T is that of one speed and the flight is at another.
fn growth(flying: &FlyingCase<'_>, harmonic: usize, of: f64, at: f64) -> f64 {
    let mut flight = flying.flight_at(&[harmonic]).unwrap();
    flight.advance_ratio = vec![(0.0, of), (1e-3, at)];
    flight.settings.gain = 1.0;
    flight.settings.effort_weight = 0.0;
    flight.settings.amplitude_limit_volt = vec![1e8; 2];
    flight.settings.rate_limit_volt = 1e8;
    let points = fly(&flight, &Guidance::Fixed).unwrap();
    let moved = |k: usize| {
        let pair = points[k + 1].control_volt.iter().zip(&points[k].control_volt);
        pair.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    (moved(30) / moved(10)).powf(1.0 / 20.0)
}

/// The radius of a T that is right is that of theory, and at the speed up to which a T is said to hold its flights begin to
/// diverge, within 5 %.
#[test]
fn a_t_of_one_speed_holds_as_far_as_its_flights_do() {
    let (case, values) = (case(), values(&[4]));
    let flying = FlyingCase::new(&case, &values, &ideal()).unwrap();
    let study = flying.margins().unwrap();
    assert_eq!(study.sets.len(), 1);
    let points: &[MarginPoint] = &study.sets[0].points;
    for (k, point) in points.iter().enumerate() {
        // the control weighs next to nothing
        assert!((point.radius[k] - (1.0 - study.gain)).abs() < 1e-3, "{point:?}");
        assert!(point.whole_step_radius[k] < 1e-3, "{point:?}");
        let theory = (0.5 * study.gain).acos().to_degrees();
        assert!((point.common_phase_deg - theory).abs() < 1.0, "{point:?}");
        assert!(point.load_phase_deg.iter().all(|deg| *deg >= point.common_phase_deg - 1.0));
    }
    let slowest = &points[0];
    let flown = growth(&flying, 4, 0.15, 0.35);
    let radius = slowest.whole_step_radius[2];
    println!("T of 0.15 at 0.35: radius {radius:.3}, flown {flown:.3}; {:?}", slowest.holds_within);
    assert!(radius > 1.0 && (flown / radius - 1.0).abs() < 0.05, "{radius} {flown}");
    let end = slowest.holds_within[1].unwrap();
    let [inside, outside] = [0.95, 1.05].map(|share| growth(&flying, 4, 0.15, share * end));
    println!("holds up to {end:.4}: flown {inside:.3} below and {outside:.3} above");
    assert!(slowest.holds_within[0].is_none() && (0.15..0.35).contains(&end));
    assert!(inside < 1.0 && outside > 1.0, "{inside} {outside}");
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// A loop that counts on flaps that may fail, as flights do by default, has another radius, and flies by it. All flaps may err by a
/// little less, one alone by much more.
#[test]
fn the_radius_knows_flaps_that_may_fail() {
    let case = case();
    let by_default = FlightValues::default().flap_survival_percent;
    let of = |harmonic: usize, flap_survival_percent: f64| {
        let values = FlightValues { flap_survival_percent, ..values(&[harmonic]) };
        let flying = FlyingCase::new(&case, &values, &ideal()).unwrap();
        let point = flying.margins().unwrap().sets.remove(0).points.remove(0);
        (point.whole_step_radius[1], growth(&flying, harmonic, 0.15, 0.25), point)
    };
    // at 2/rev the loop diverges there, slowly: what it flies is neither rounding nor its limits
    for (survival_percent, other) in [(by_default, 100.0), (100.0, by_default)] {
        let (radius, flown, _) = of(2, survival_percent);
        let (of_other, ..) = of(2, other);
        println!(
            "{survival_percent} %: radius {radius:.3}, flown {flown:.3}; {other} % {of_other:.3}"
        );
        assert!(radius > 1.0 && (flown / radius - 1.0).abs() < 0.02, "{radius} {flown}");
        assert!((of_other / flown - 1.0).abs() > 0.05, "{of_other} {flown}");
    }
    let ((.., sure), (.., own)) = (of(4, 100.0), of(4, by_default));
    let (phase, of_sure) = (own.common_phase_deg, sure.common_phase_deg);
    assert!(phase < of_sure - 1.0 && phase > of_sure - 10.0, "{phase} {of_sure}");
    let (least, of_sure) = (least(&own.flap_overshoot_deg), least(&sure.flap_overshoot_deg));
    println!(
        "J overshoots with one flap off by {least:.0} deg, {of_sure:.0} of flaps that all act"
    );
    assert!(least > 2.0 * of_sure, "{least} {of_sure}");
    assert!((own.radius[0] - 0.5).abs() < 1e-3, "T that is right: {own:?}");
}

/// A T that is handed in is that of the loop, not of the rotor: one that is turned by 60 deg has the radius of theory.
#[test]
fn a_t_that_is_handed_in_meets_the_rotor_as_it_is() {
    let (mut case, values) = (case(), FlightValues { knots: 2, ..values(&[3, 4]) });
    let own = FlyingCase::new(&case, &values, &ideal()).unwrap();
    let t_of = |advance_ratio: f64| {
        let state = FlightState { advance_ratio, thrust_share: 0.0 };
        let flight = own.flight_at(&[3]).unwrap();
        let t = flight.identify(state).unwrap();
        t.turned(1.0, f64::to_radians(60.0)).unwrap().columns()
    };
    let set = HandedSet {
        harmonics: vec![3],
        advance_ratios: vec![0.15, 0.35],
        columns: vec![t_of(0.15), t_of(0.35)],
    };
    let handed = HandedT { sets: vec![set], ..HandedT::default() };
    case.control.handed_t = Some(Arc::new(handed));
    let values = FlightValues { harmonics: vec![3], ..values };
    let study = FlyingCase::new(&case, &values, &ideal()).unwrap().margins().unwrap();
    for (k, point) in study.sets[0].points.iter().enumerate() {
        // |1 - exp(60 deg i)| = 1
        assert!((point.whole_step_radius[k] - 1.0).abs() < 2e-3, "{point:?}");
    }
}

/// A T of the wrong sign drives the rotor the wrong way at once: no phase, gain or speed is left, though one knot alone is known.
#[test]
fn a_t_of_the_wrong_sign_has_no_margins() {
    let mut case = case();
    let values = FlightValues { end_advance_ratio: 0.15, ..values(&[3]) };
    let own = FlyingCase::new(&case, &values, &ideal()).unwrap();
    let right = own.margins().unwrap().sets[0].points[0].clone();
    let theory = (0.5 * own.margins().unwrap().gain).acos().to_degrees();
    assert!((right.common_phase_deg - theory).abs() < 1.0, "{right:?}");
    assert_eq!(right.holds_within, [None; 2]);
    let state = FlightState { advance_ratio: 0.15, thrust_share: 0.0 };
    let t = own.flight_at(&[3]).unwrap().identify(state).unwrap();
    let columns = t.turned(-1.0, 0.0).unwrap().columns();
    let set = HandedSet { harmonics: vec![3], advance_ratios: vec![0.15], columns: vec![columns] };
    case.control.handed_t = Some(Arc::new(HandedT { sets: vec![set], ..HandedT::default() }));
    let study = FlyingCase::new(&case, &values, &ideal()).unwrap().margins().unwrap();
    let [point] = &study.sets[0].points[..] else { panic!("one knot") };
    assert!((point.whole_step_radius[0] - 2.0).abs() < 2e-3, "{point:?}");
    let phases = [point.common_phase_deg, point.common_overshoot_deg];
    let phases = [&phases[..], &point.flap_overshoot_deg, &point.load_phase_deg].concat();
    assert!(phases.iter().all(|deg| deg.to_bits() == 0), "{point:?}");
    let gains = [&[point.common_gain][..], &point.load_gain].concat();
    assert!(gains.iter().all(|gain| gain.to_bits() == 1.0_f64.to_bits()), "{point:?}");
    assert_eq!(point.holds_within, [Some(0.15); 2]);
}

/// A weight of the change slows the loop, and the radius knows it: by `(1 - gain)` of the way without one, hardly at all with
/// one that outweighs T. The flight takes the smaller steps.
#[test]
fn a_weight_of_the_change_slows_the_loop() {
    let case = case();
    let of = |rate_weight: f64| {
        let values = FlightValues { rate_weight, knots: 2, ..values(&[3]) };
        let flying = FlyingCase::new(&case, &values, &ideal()).unwrap();
        let radius = flying.margins().unwrap().sets[0].points[0].radius[0];
        let flown = flying.fly(&|| ()).unwrap();
        let first = flown.flights[0].points[1].control_volt.iter().map(|u| u * u).sum::<f64>();
        (radius, first.sqrt())
    };
    let (free, weighed) = (of(0.0), of(1e-6));
    println!("radius and first step, V: {free:?} without, {weighed:?} with a weight");
    assert!((free.0 - 0.5).abs() < 1e-3 && weighed.0 > 0.99, "{free:?} {weighed:?}");
    assert!(weighed.1 < 0.1 * free.1 && weighed.1 > 0.0, "{free:?} {weighed:?}");
}

/// The draws of every controller are those of the same seeds, and the spread is that of its flights.
#[test]
fn draws_are_common_and_their_spread_is_that_of_the_flights() {
    let case = Case::default();
    let values = FlightValues { noise_percent: 3.0, duration_s: 6.0, knots: 2, ..values(&[3]) };
    let flying = FlyingCase::new(&case, &values, &actuator()).unwrap();
    let drawn = flying.draws(5, &|| ()).unwrap();
    let seeded = (0..5).map(|draw| {
        let values = FlightValues { seed: values.seed + draw, ..values.clone() };
        FlyingCase::new(&case, &values, &actuator()).unwrap().fly(&|| ()).unwrap()
    });
    let seeded: Vec<FlownCase> = seeded.collect();
    // the flights of the seeds, one by one, for either controller
    for (k, (drawn, name)) in drawn.controllers.iter().zip(["fixed", "adaptive"]).enumerate() {
        assert_eq!(drawn.controller, name);
        let mut last: Vec<f64> =
            seeded.iter().map(|flown| flown.flights[k].points.last().unwrap().cost_ratio).collect();
        last.sort_by(f64::total_cmp);
        let (_, spread) = drawn.cycles.last().unwrap();
        assert_eq!(spread.map(f64::to_bits), [last[0], last[2], last[4]].map(f64::to_bits));
        assert!(spread[0] < spread[2], "{name}: {spread:?}");
    }
    assert!(flying.draws(0, &|| ()).is_err());
}
