//! A flap that stops in the flights that cases have by default: at every speed and thrust, at any time of a ramp.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

mod common;

use common::actuator;
use rotor_flight::FlyingCase;
use rotor_study::case::{Case, FailedFlap, FlightValues, Notice, ThrustStep};

/// Highest `J / J0` that is asked for.
const BAR: f64 = 1.2;
/// A flap stops in the cycle that ends after it: the control has settled by then.
const FAILS_S: f64 = 9.0;

/// Highest `J / J0` from the failure on, of each controller.
fn highest(values: &FlightValues) -> Vec<f64> {
    let at_s = values.failed_flap.unwrap().at_s;
    let case = Case::default();
    let model = actuator();
    let flown = FlyingCase::new(&case, values, &model).unwrap().fly(&|| ()).unwrap();
    let after = flown.flights.iter().map(|own| {
        let points = own.points.iter().filter(|point| point.time_s > at_s);
        points.map(|point| point.cost_ratio).fold(0.0, f64::max)
    });
    after.collect()
}

fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

fn level(advance_ratio: f64, flap: usize) -> FlightValues {
    let notice = Notice::Untold;
    FlightValues {
        start_advance_ratio: advance_ratio,
        end_advance_ratio: advance_ratio,
        duration_s: 12.0,
        failed_flap: Some(FailedFlap { flap, at_s: FAILS_S, notice, ..FailedFlap::default() }),
        ..FlightValues::default()
    }
}

/// Steady speeds, all harmonics at once and each alone, nobody told: the hub never shakes by more than 1.2 `J0`. Where the flaps are
/// counted on for good it does, at the slowest speed.
#[test]
fn a_dead_flap_is_borne_at_every_speed() {
    for advance_ratio in [0.15, 0.20, 0.25, 0.30] {
        for harmonics in [vec![2, 3, 4, 5], vec![2], vec![3], vec![4], vec![5]] {
            let each = [1, 2].map(|flap| {
                let values = level(advance_ratio, flap);
                highest(&FlightValues { harmonics: harmonics.clone(), ..values })
            });
            println!("{advance_ratio}, {harmonics:?} per rev: {each:.3?}");
            assert!(each.iter().all(|own| most(own) < BAR), "{each:?}");
        }
    }
    let sure = FlightValues { flap_survival_percent: 100.0, ..level(0.15, 1) };
    let sure = highest(&sure);
    println!("0.15, counted on for good: {sure:.3?}");
    assert!(most(&sure) > 2.0, "{sure:?}");
}

/// The same at any time of a flight from 0.15 to 0.30, and with a tenth more thrust after it.
#[test]
fn a_dead_flap_is_borne_at_any_time_of_a_ramp() {
    for at_s in [2.0, 6.0, 10.0, 14.0, 18.0, 22.0, 26.0] {
        let each = [1, 2].map(|flap| {
            let values = level(0.15, flap);
            let failed_flap = values.failed_flap.map(|failed| FailedFlap { at_s, ..failed });
            highest(&FlightValues {
                end_advance_ratio: 0.30,
                ramp_at_s: 4.0,
                ramp_s: 20.0,
                duration_s: at_s + 3.0,
                knots: 5,
                thrust_step: Some(ThrustStep { at_s: 24.5, ..ThrustStep::default() })
                    .filter(|step| step.at_s < at_s),
                failed_flap,
                ..values
            })
        });
        println!("fails at {at_s} s: {each:.3?}");
        assert!(each.iter().all(|own| most(own) < BAR), "{at_s}: {each:?}");
    }
}
