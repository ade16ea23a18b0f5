//! A ramp of the advance ratio, noise, and a flap that fails, with an actuator that has memory and lag.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

mod common;

use common::actuator;
use hhc_control::{ControlLayout, EstimatorSettings, RelaxedSettings};
use preisach_dyn::ActuatorModel;
use rotor_case::Bias;
use rotor_case::{Case, FlightValues, HandedSet};
use rotor_flight::{FlapFailure, Flight, FlightPoint, Guidance, RotorPath, fly};

const SEEDS: u64 = 20;
const KNOTS: [f64; 4] = [0.15, 0.20, 0.25, 0.30];

/// The chance that a flap acts which flights count on by default.
fn by_default() -> f64 {
    0.01 * FlightValues::default().flap_survival_percent
}

fn flight<'a>(path: &'a RotorPath, model: &'a ActuatorModel) -> Flight<'a> {
    let layout = ControlLayout::new(2, vec![3]).unwrap();
    let settings = RelaxedSettings {
        gain: 0.5,
        amplitude_limit_volt: vec![70.0; 2],
        rate_limit_volt: 20.0,
        flap_survival: by_default(),
        ..RelaxedSettings::of_layout(&layout)
    };
    Flight {
        path,
        model,
        layout,
        actuator_rev_hz: 5.0,
        bias: Bias::Centred { guess_volt: 65.0 },
        handed_t: None,
        own_actuators: vec![],
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
/// `J` along the ramp over what the loop converges to: scheduled and adaptive.
const SCHEDULED_BAR: f64 = 1.10;
const ADAPTIVE_BAR: f64 = 1.15;
/// The same at 2/rev with a T0 that is off by -80 deg.
const LATE_BAR: f64 = 1.2;

/// `J / J0` about each of the speeds of the ramp over what the loop converges to there.
fn along(points: &[FlightPoint], converged: &[f64]) -> Vec<f64> {
    let each = SPEEDS.iter().zip(converged);
    each.map(|(mu, converged)| {
        let time_s = 10.0 + 20.0 * (mu - 0.15) / 0.15;
        mean(points, time_s - HALF_WINDOW_S, time_s + HALF_WINDOW_S) / converged
    })
    .collect()
}

/// What the loop converges to at each of the speeds with the T of that speed, no noise.
fn converged(flight: &Flight<'_>) -> [f64; 5] {
    SPEEDS.map(|mu| {
        let still = Flight { advance_ratio: vec![(0.0, mu)], noise_share: 0.0, ..flight.clone() };
        mean(&fly(&still, &Guidance::Fixed).unwrap(), 30.0, 40.0)
    })
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// An estimate that takes T0 for good to a half, lets Z0 walk and have a trend, and turns the control to and fro.
fn follows_ramps() -> EstimatorSettings {
    EstimatorSettings {
        uncertainty: 0.5,
        drift: 0.25,
        baseline_drift: 0.1,
        trend_drift: 0.05,
        dither_rad: 3.0_f64.to_radians(),
        ..EstimatorSettings::in_flight(70.0)
    }
}

/// The same flight with the T of its start off by a phase.
fn with_t_off<'a>(flight: &Flight<'a>, phase_deg: f64) -> Flight<'a> {
    let own = flight.identify(flight.state_at(0.0)).unwrap();
    let set = HandedSet {
        harmonics: flight.layout.harmonics().iter().map(|&n| n as usize).collect(),
        advance_ratios: vec![flight.state_at(0.0).advance_ratio],
        columns: vec![own.turned(1.0, phase_deg.to_radians()).unwrap().columns()],
    };
    Flight { handed_t: Some(set), ..flight.clone() }
}

/// Along the ramp an estimated T follows what the loop converges to at each speed, under 20 draws of the noise, whether the T of
/// its start is right or off by 80 deg either way. The same T held fails by factors. A scheduled T follows too. An estimate whose
/// Z0 has no trend books the ramp on a T that it may change so much.
#[test]
fn a_ramp_is_followed() {
    let (path, model) = (RotorPath::new(&Case::default(), &KNOTS).unwrap(), actuator());
    let flight = flight(&path, &model);
    let converged = converged(&flight);
    println!("converged at {SPEEDS:?}: {converged:.3?}");
    let over = |flight: &Flight<'_>, guidance: &Guidance, seed: u64| {
        let points = fly(&Flight { seed, ..flight.clone() }, guidance).unwrap();
        assert!((points[0].cost_ratio - 1.0).abs() < 0.05, "{:?}", points[0]);
        (along(&points, &converged), peak(&points, 5.0))
    };
    let worst = |flight: &Flight<'_>, guidance: &Guidance| {
        (0..SEEDS)
            .map(|seed| over(flight, guidance, seed))
            .fold((0.0_f64, 0.0_f64), |worst, own| {
                (worst.0.max(largest(&own.0)), worst.1.max(own.1))
            })
    };
    let scheduled = worst(&flight, &Guidance::Scheduled);
    println!("scheduled: {scheduled:.3?} over converged and highest");
    assert!(scheduled.0 < SCHEDULED_BAR && scheduled.1 < 0.5, "{scheduled:?}");
    let adaptive = Guidance::Adaptive(follows_ramps());
    for phase_deg in [0.0, 80.0, -80.0] {
        let off = with_t_off(&flight, phase_deg);
        let fixed = over(&off, &Guidance::Fixed, 1);
        let found = worst(&off, &adaptive);
        println!("T off by {phase_deg} deg: fixed {fixed:.3?}, adaptive {found:.3?}");
        assert!(found.0 < ADAPTIVE_BAR && found.1 < 0.7, "{phase_deg}: {found:?}");
        let least = fixed.0.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(phase_deg == 0.0 || least > ADAPTIVE_BAR, "T held passes: {fixed:?}");
    }
    let no_trend = EstimatorSettings { trend_drift: 0.0, ..follows_ramps() };
    let no_trend = over(&flight, &Guidance::Adaptive(no_trend), 1);
    println!("adaptive without a trend of Z0: {no_trend:.3?}");
    assert!(largest(&no_trend.0) > ADAPTIVE_BAR, "{no_trend:?}");
}

/// At 2/rev, where T changes most with speed and both amplitudes are at their limits, the T of 0.15 held misses the bar. A
/// scheduled one does not, nor does an estimated one under 20 draws of the noise, right at the start or off by 80 deg; the other way
/// it takes longer. Without the turn to and fro what a control does not move is not learnt.
#[test]
fn t_is_learnt_where_it_changes_most() {
    let (path, model) = (RotorPath::new(&Case::default(), &KNOTS).unwrap(), actuator());
    let mut flight = flight(&path, &model);
    flight.layout = ControlLayout::new(2, vec![2]).unwrap();
    let converged = converged(&flight);
    let each = |flight: &Flight<'_>, guidance: &Guidance, seeds: u64| -> Vec<f64> {
        let of = |seed| fly(&Flight { seed, ..flight.clone() }, guidance).unwrap();
        (0..seeds).map(|seed| largest(&along(&of(seed), &converged))).collect()
    };
    let fixed = largest(&each(&flight, &Guidance::Fixed, 3));
    let scheduled = largest(&each(&flight, &Guidance::Scheduled, SEEDS));
    println!("2/rev, {converged:.3?}: fixed {fixed:.3}, scheduled {scheduled:.3}");
    assert!(scheduled < SCHEDULED_BAR && fixed > ADAPTIVE_BAR, "{scheduled} {fixed}");
    for (phase_deg, bar) in [(0.0, ADAPTIVE_BAR), (80.0, ADAPTIVE_BAR), (-80.0, LATE_BAR)] {
        let off = with_t_off(&flight, phase_deg);
        let adaptive = largest(&each(&off, &Guidance::Adaptive(follows_ramps()), SEEDS));
        println!("2/rev, T off by {phase_deg} deg: adaptive {adaptive:.3}");
        assert!(adaptive < bar, "{phase_deg}: {adaptive}");
        let at_rest = EstimatorSettings { dither_rad: 0.0, ..follows_ramps() };
        let at_rest = largest(&each(&off, &Guidance::Adaptive(at_rest), SEEDS));
        println!("2/rev, T off by {phase_deg} deg, no turn: adaptive {at_rest:.3}");
        assert!(phase_deg > 0.0 || at_rest > bar, "{phase_deg}: {at_rest}");
    }
}

/// At 4/rev, where the flaps work against each other, an estimated T follows too.
#[test]
fn a_ramp_is_followed_where_flaps_oppose_each_other() {
    let (path, model) = (RotorPath::new(&Case::default(), &KNOTS).unwrap(), actuator());
    let mut flight = flight(&path, &model);
    flight.layout = ControlLayout::new(2, vec![4]).unwrap();
    let converged = converged(&flight);
    let worst = |guidance: &Guidance| {
        let of = |seed| fly(&Flight { seed, ..flight.clone() }, guidance).unwrap();
        largest(&(0..SEEDS).map(|k| largest(&along(&of(k), &converged))).collect::<Vec<f64>>())
    };
    let scheduled = worst(&Guidance::Scheduled);
    let adaptive = worst(&Guidance::Adaptive(follows_ramps()));
    println!("4/rev, {converged:.3?}: scheduled {scheduled:.3}, adaptive {adaptive:.3}");
    assert!(scheduled < SCHEDULED_BAR && adaptive < ADAPTIVE_BAR, "{scheduled} {adaptive}");
}

/// The same flight with 2 to 5/rev at once and up to 20 V each.
fn at_once<'a>(flight: &Flight<'a>, gain: f64) -> Flight<'a> {
    let layout = ControlLayout::new(2, vec![2, 3, 4, 5]).unwrap();
    let settings = RelaxedSettings {
        gain,
        amplitude_limit_volt: vec![20.0; layout.pairs()],
        rate_limit_volt: 10.0,
        flap_survival: by_default(),
        ..RelaxedSettings::of_layout(&layout)
    };
    Flight { layout, settings, ..flight.clone() }
}

/// An estimate that takes T0 for good to a tenth; Z0 walks and has a trend that may change.
fn knows_t0(trend_drift: f64) -> EstimatorSettings {
    EstimatorSettings {
        uncertainty: 0.1,
        drift: 0.05,
        baseline_drift: 0.1,
        trend_drift,
        ..EstimatorSettings::in_flight(85.0)
    }
}

/// 2 to 5/rev at once with up to 20 V each, as the shipped flight has them: T0 good to a tenth. A loop that counts on all flaps
/// leans them against each other; with `g = 0.5` it is too slow for the bar of a T that is known, and an estimate whose Z0 has no trend
/// errs.
#[test]
fn a_ramp_is_followed_at_four_harmonics_at_once() {
    let (path, model) = (RotorPath::new(&Case::default(), &KNOTS).unwrap(), actuator());
    let one = flight(&path, &model);
    let worst = |(gain, flap_survival): (f64, f64), guidance: &Guidance| {
        let mut flight = at_once(&one, gain);
        flight.settings.flap_survival = flap_survival;
        let converged = converged(&flight);
        let of = |seed| fly(&Flight { seed, ..flight.clone() }, guidance).unwrap();
        largest(&(0..SEEDS).map(|k| largest(&along(&of(k), &converged))).collect::<Vec<f64>>())
    };
    for gain in [0.7, 0.5] {
        let own = (gain, by_default());
        let scheduled = worst(own, &Guidance::Scheduled);
        let adaptive = worst(own, &Guidance::Adaptive(knows_t0(0.05)));
        println!("2 to 5/rev, gain {gain}: scheduled {scheduled:.3}, adaptive {adaptive:.3}");
        assert!(scheduled < SCHEDULED_BAR && adaptive < ADAPTIVE_BAR, "{scheduled} {adaptive}");
    }
    let slow = worst((0.5, 1.0), &Guidance::Scheduled);
    let no_trend = worst((0.7, 1.0), &Guidance::Adaptive(knows_t0(0.0)));
    println!("counted on: scheduled, gain 0.5 {slow:.3}; adaptive without a trend {no_trend:.3}");
    assert!(slow > SCHEDULED_BAR && no_trend > ADAPTIVE_BAR, "{slow} {no_trend}");
}

/// Amplitude limit at which no flap that fails raises `J` beyond 1.2 `J0`, and one at which it does, V.
const SAFE_VOLT: f64 = 50.0;
const FULL_VOLT: f64 = 70.0;

/// When a flap fails, s: at the end of a cycle, so that the whole window of the next one sees it before anything can answer.
const FAILS_S: f64 = 15.05;
/// A flight on which a flap stops.
fn failing(
    flight: &Flight<'_>,
    guidance: &Guidance,
    flap: usize,
    time_s: f64,
    is_told: bool,
) -> Vec<FlightPoint> {
    let failure = Some(FlapFailure {
        flap,
        time_s,
        stuck_deg: 0.0,
        kept_share: 0.0,
        is_told,
        is_on_one_blade: false,
    });
    fly(&Flight { failure, ..flight.clone() }, guidance).unwrap()
}

/// A flight within a limit of the amplitudes, under a draw of the noise.
fn within<'a>(flight: &Flight<'a>, limit_volt: f64, seed: u64) -> Flight<'a> {
    let mut flight = Flight { seed, ..flight.clone() };
    flight.settings.amplitude_limit_volt = vec![limit_volt; 2];
    flight
}

/// One flap dead from 15 s on, told or not, under 20 draws of the noise, the T of the start right or off by 80 deg: `J` never above
/// 1.2 `J0` within the safe limit, and at the end where the other flap alone gets it. A T that is off and held fails.
#[test]
fn a_failure_is_taken_up() {
    let (path, model) = (RotorPath::new(&Case::default(), &[0.30]).unwrap(), actuator());
    let level = Flight { advance_ratio: vec![(0.0, 0.30)], ..flight(&path, &model) };
    let adaptive = Guidance::Adaptive(follows_ramps());
    let mut held_fails = 0_usize;
    for flap in [0, 1] {
        let safe = within(&level, SAFE_VOLT, 1);
        let alone = mean(&failing(&safe, &Guidance::Fixed, flap, 0.0, true), 30.0, 41.0);
        for (phase_deg, is_told) in
            [(0.0, true), (0.0, false), (80.0, true), (80.0, false), (-80.0, true), (-80.0, false)]
        {
            let off = with_t_off(&level, phase_deg);
            // highest J once T could be learnt, J at the end above what is best, from 20 s after the failure on, J before it
            let found = |guidance: &Guidance, seed: u64| {
                let flight = within(&off, SAFE_VOLT, seed);
                let points = failing(&flight, guidance, flap, FAILS_S, is_told);
                let before = mean(&points, 10.0, 15.0);
                (peak(&points, 5.0), mean(&points, 35.0, 41.0) - alone, before)
            };
            let (mut highest, mut end, mut before) = (0.0_f64, f64::NEG_INFINITY, 1.0_f64);
            for seed in 0..SEEDS {
                let own = found(&adaptive, seed);
                (highest, end, before) = (highest.max(own.0), end.max(own.1), before.min(own.2));
            }
            let held = found(&Guidance::Fixed, 1);
            println!(
                "{flap} {is_told}, T off by {phase_deg} deg: {before:.3}, peak {highest:.3}, end {end:.3} above {alone:.3}; held {held:.3?}"
            );
            assert!(highest < 1.2 && end < 0.05, "{flap} {is_told} {phase_deg}: {highest} {end}");
            assert!(alone > before + 0.02, "{alone} {before}");
            held_fails += usize::from(phase_deg != 0.0 && (held.0 > 1.2 || held.1 > 0.05));
        }
    }
    println!("T held fails in {held_fails} of the 8 cases in which it is off");
    assert!(held_fails >= 4, "{held_fails}");
    // no guidance comes before the cycle of the failure: only a lower amplitude or a control that counts on it does
    for limit_volt in [20.0, 40.0, 45.0, SAFE_VOLT, 55.0, 60.0, FULL_VOLT, 85.0] {
        let of = |q: f64| {
            let mut still = Flight { noise_share: 0.0, ..within(&level, limit_volt, 1) };
            still.settings.flap_survival = q;
            let points = failing(&still, &Guidance::Fixed, 1, FAILS_S, true);
            (mean(&points, 10.0, 15.0), peak(&points, FAILS_S))
        };
        let each = [1.0, 0.9, 0.8, 0.7, 0.6].map(of);
        println!("{limit_volt} V, q 1 to 0.6: J/J0 before and highest {each:.3?}");
        assert!(limit_volt < FULL_VOLT || each[0].1 > 1.2, "{each:?}");
    }
}

/// 2 to 5/rev at once, advance ratio 0.15: flaps lean on each other, and one that fails brings more than 2 `J0` whatever is known of T,
/// for that `J` is of the control before. A control that counts on flaps that may fail stays below 1.2 `J0`, told or not, under
/// 20 draws of the noise, for three points of `J0`.
#[test]
fn a_control_that_counts_on_failures_bears_them() {
    let (path, model) = (RotorPath::new(&Case::default(), &[0.15]).unwrap(), actuator());
    let level = at_once(&Flight { advance_ratio: vec![(0.0, 0.15)], ..flight(&path, &model) }, 0.7);
    let adaptive = Guidance::Adaptive(knows_t0(0.05));
    // J before the failure, and the highest after it, of both flaps
    let found = |flight: &Flight<'_>, q: f64, guidance: &Guidance, is_told| {
        let mut flight = flight.clone();
        flight.settings.flap_survival = q;
        let each = [0, 1].map(|flap| failing(&flight, guidance, flap, FAILS_S, is_told));
        let highest = each.iter().map(|points| peak(points, FAILS_S)).fold(0.0, f64::max);
        (mean(&each[0], 10.0, FAILS_S), highest)
    };
    let still = Flight { noise_share: 0.0, ..level.clone() };
    let before = found(&still, 1.0, &Guidance::Fixed, true).0;
    for guidance in [Guidance::Fixed, Guidance::Scheduled, adaptive.clone()] {
        let highest = found(&still, 1.0, &guidance, true).1;
        println!("{before:.3} before, {highest:.3} highest");
        assert!(highest > 2.0, "{highest}");
    }
    for is_told in [true, false] {
        let each = (0..SEEDS)
            .map(|seed| found(&Flight { seed, ..level.clone() }, 0.9, &adaptive, is_told));
        let (own, highest) =
            each.fold((0.0_f64, 0.0_f64), |worst, own| (worst.0.max(own.0), worst.1.max(own.1)));
        println!("told {is_told}: {own:.3} at most before, {highest:.3} highest");
        assert!(highest < 1.2 && own < before + 0.03, "{is_told}: {own} {highest}");
    }
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
