//! A ramp of the advance ratio, noise, and a flap that fails, with an actuator that has memory and lag.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

mod common;

use common::actuator;
use hhc_control::{ControlLayout, EstimatorSettings, RelaxedSettings};
use preisach_dyn::ActuatorModel;
use rotor_flight::{FlapFailure, Flight, FlightPoint, Guidance, RotorPath, fly};
use rotor_study::Bias;
use rotor_study::case::Case;

const SEEDS: u64 = 20;
const KNOTS: [f64; 4] = [0.15, 0.20, 0.25, 0.30];

fn flight<'a>(path: &'a RotorPath, model: &'a ActuatorModel) -> Flight<'a> {
    let layout = ControlLayout::new(2, vec![3]).unwrap();
    let settings = RelaxedSettings {
        gain: 0.5,
        amplitude_limit_volt: vec![70.0; 2],
        rate_limit_volt: 20.0,
        ..RelaxedSettings::of_layout(&layout)
    };
    Flight {
        path,
        model,
        layout,
        actuator_rev_hz: 5.0,
        bias: Bias::Centred { guess_volt: 65.0 },
        handed_t: None,
        rotor_rev_hz: 383.0 / 60.0,
        advance_ratio: vec![(0.0, 0.15), (10.0, 0.15), (30.0, 0.30)],
        thrust_share: vec![],
        duration_s: 40.0,
        // 30 dB
        noise_share: 0.0316,
        seed: 1,
        failure: None,
        cycle_rev: [1, 2],
        step_volt: 10.0,
        settings,
    }
}

fn mean(points: &[FlightPoint], from_s: f64, to_s: f64) -> f64 {
    let within = points.iter().filter(|p| p.time_s > from_s && p.time_s <= to_s);
    let (count, sum) = within.fold((0, 0.0), |(n, sum), p| (n + 1, sum + p.cost_ratio));
    sum / f64::from(count)
}

fn peak(points: &[FlightPoint], from_s: f64) -> f64 {
    points.iter().filter(|p| p.time_s > from_s).map(|p| p.cost_ratio).fold(0.0, f64::max)
}

/// Advance ratios at which the loop is flown until it stays, and half the width of a window of the ramp about each.
const SPEEDS: [f64; 5] = [0.17, 0.20, 0.225, 0.25, 0.28];
const HALF_WINDOW_S: f64 = 1.5;

/// `J / J0` about each of the speeds of the ramp over what the loop converges to there.
fn along(points: &[FlightPoint], converged: &[f64]) -> Vec<f64> {
    let each = SPEEDS.iter().zip(converged);
    each.map(|(mu, converged)| {
        let time_s = 10.0 + 20.0 * (mu - 0.15) / 0.15;
        mean(points, time_s - HALF_WINDOW_S, time_s + HALF_WINDOW_S) / converged
    })
    .collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Along the ramp a scheduled T and an estimated one follow what the loop converges to at each speed, under 20 draws of the
/// noise.
#[test]
fn a_ramp_is_followed() {
    let (path, model) = (RotorPath::new(&Case::default(), &KNOTS).unwrap(), actuator());
    let flight = flight(&path, &model);
    let converged = SPEEDS.map(|mu| {
        let still = Flight { advance_ratio: vec![(0.0, mu)], noise_share: 0.0, ..flight.clone() };
        mean(&fly(&still, &Guidance::Scheduled).unwrap(), 30.0, 40.0)
    });
    println!("converged at {SPEEDS:?}: {converged:.3?}");
    let over = |guidance: &Guidance, seed: u64| {
        let points = fly(&Flight { seed, ..flight.clone() }, guidance).unwrap();
        assert!((points[0].cost_ratio - 1.0).abs() < 0.05, "{:?}", points[0]);
        (along(&points, &converged), peak(&points, 5.0))
    };
    println!("fixed T: {:.3?}", over(&Guidance::Fixed, 1).0);
    let worst = |guidance: &Guidance| {
        (0..SEEDS).map(|seed| over(guidance, seed)).fold((0.0_f64, 0.0_f64), |worst, found| {
            (worst.0.max(largest(&found.0)), worst.1.max(found.1))
        })
    };
    let scheduled = worst(&Guidance::Scheduled);
    println!("scheduled: {scheduled:.3?} over converged and highest");
    assert!(scheduled.0 < 1.10 && scheduled.1 < 0.5, "{scheduled:?}");
    let adaptive = |baseline_drift| {
        Guidance::Adaptive(EstimatorSettings {
            uncertainty: 0.1,
            drift: 0.05,
            baseline_drift,
            ..EstimatorSettings::in_flight(70.0)
        })
    };
    // Z0 changes faster than a filter expects that lets it walk by 1 % a cycle: it takes the ramp for failures
    let most = worst(&adaptive(0.2));
    let narrow = over(&adaptive(0.01), 1);
    println!("adaptive: {most:.3?}; with a walk of 1 %: {narrow:.3?}");
    assert!(most.0 < 1.15 && most.1 < 0.5, "{most:?}");
    assert!(largest(&narrow.0) > 1.15 || narrow.1 > 0.5, "{narrow:?}");
}

/// Amplitude limit at which no flap that fails raises `J` beyond 1.2 `J0`, and one at which it does, V.
const SAFE_VOLT: f64 = 60.0;
const FULL_VOLT: f64 = 70.0;

/// One flap dead at 15 s, told or not, under 20 draws of the noise: `J` never above 1.2 `J0` within the safe limit, and at the
/// end where the other flap alone gets it.
#[test]
fn a_failure_is_taken_up() {
    let (path, model) = (RotorPath::new(&Case::default(), &[0.30]).unwrap(), actuator());
    let level = Flight { advance_ratio: vec![(0.0, 0.30)], ..flight(&path, &model) };
    let adaptive = Guidance::Adaptive(EstimatorSettings::in_flight(70.0));
    let within = |limit_volt: f64, seed: u64| {
        let mut flight = Flight { seed, ..level.clone() };
        flight.settings.amplitude_limit_volt = vec![limit_volt; 2];
        flight
    };
    let failing = |flight: &Flight<'_>, flap, time_s: f64, is_told| {
        let failure = Some(FlapFailure {
            flap,
            time_s,
            stuck_deg: 0.0,
            kept_share: 0.0,
            is_told,
            is_on_one_blade: false,
        });
        fly(&Flight { failure, ..flight.clone() }, &adaptive).unwrap()
    };
    for flap in [0, 1] {
        let alone = mean(&failing(&within(SAFE_VOLT, 1), flap, 0.0, true), 30.0, 41.0);
        for is_told in [true, false] {
            let (mut highest, mut end, mut before) = (0.0_f64, 0.0_f64, 1.0_f64);
            for seed in 0..SEEDS {
                let points = failing(&within(SAFE_VOLT, seed), flap, 15.0, is_told);
                highest = highest.max(peak(&points, 15.0));
                end = end.max(mean(&points, 35.0, 41.0));
                before = before.min(mean(&points, 10.0, 15.0));
            }
            println!("{flap} {is_told}: {before:.3}, peak {highest:.3}, end {end:.3} ({alone:.3})");
            assert!(
                highest < 1.2 && end - alone < 0.05,
                "{flap} {is_told}: {highest} {end} {alone}"
            );
            assert!(alone > before + 0.02, "{alone} {before}");
        }
    }
    let beyond = peak(&failing(&within(FULL_VOLT, 1), 1, 15.0, true), 15.0);
    println!("peak with up to {FULL_VOLT} V: {beyond:.3}");
    assert!(beyond > 1.2, "{beyond}");
}

/// Flights that cannot be are refused.
#[test]
fn impossible_flights_are_refused() {
    assert!(RotorPath::new(&Case::default(), &[]).is_err());
    assert!(RotorPath::new(&Case::default(), &[0.3, 0.2]).is_err());
    let (path, model) = (RotorPath::new(&Case::default(), &[0.30]).unwrap(), actuator());
    let flight = flight(&path, &model);
    for bad in [
        Flight { cycle_rev: [1, 0], ..flight.clone() },
        Flight { duration_s: f64::NAN, ..flight.clone() },
        Flight { step_volt: 0.0, ..flight.clone() },
        Flight { advance_ratio: vec![], ..flight },
    ] {
        assert!(fly(&bad, &Guidance::Fixed).is_err());
    }
}
