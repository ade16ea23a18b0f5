//! Stops: duality with plays, wiping-out, closed loops, and the fit to loops that lead.
#![expect(clippy::float_cmp, reason = "results are claimed to be equal to the last bit")]
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use crate::common;

use common::stored;
use preisach_dyn::identify::{
    BenchRecord, Candidates, Family, RecordUse, Settings, compare_models,
};
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, Calibration, HysteresisLaw, PrandtlIshlinskii, PrandtlParameters,
    PrandtlStop, StartState, StopParameters, VoltageRange, WeightedPlay, WeightedStop,
};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn range() -> VoltageRange {
    VoltageRange::new(-1.0, 1.0).unwrap()
}

fn law(stops: &[(f64, f64)], elastic: f64, viscosity: f64) -> PrandtlStop {
    let stop = |&(threshold_volt, stiffness_deg_per_volt): &(f64, f64)| WeightedStop {
        threshold_volt,
        stiffness_deg_per_volt,
    };
    PrandtlStop::new(StopParameters {
        range_volt: range(),
        stiffness_deg_per_volt: elastic,
        stops: stops.iter().map(stop).collect(),
        viscosity_deg_s_per_volt: viscosity,
        offset_deg: 0.0,
    })
    .unwrap()
}

fn friction() -> PrandtlStop {
    law(&[(0.0625, 1.0), (0.125, 0.5), (0.25, 2.0), (0.5, 0.25)], 0.1, 0.0)
}

/// `integral y du` by the trapezoidal rule over a path that begins where the memory is.
fn work(law: &PrandtlStop, path: &[f64], time_step_s: f64) -> f64 {
    let (mut memory, mut last_y) = law.start(path[0], StartState::Rest);
    let mut last_u = path[0];
    let mut sum = 0.0;
    for &u in &path[1..] {
        let y = law.step(&mut memory, u, time_step_s);
        sum += 0.5 * (y + last_y) * (u - last_u);
        (last_u, last_y) = (u, y);
    }
    sum
}

/// A triangle between `-steps` and `steps` sixty-fourths, `cycles` times, from 0.
fn triangle(steps: i32, cycles: usize) -> Vec<f64> {
    let mut path = vec![0.0];
    for _ in 0..cycles {
        path.extend((1..=steps).map(|i| f64::from(i) / 64.0));
        path.extend((-steps..steps).rev().map(|i| f64::from(i) / 64.0));
        path.extend((-steps + 1..=0).map(|i| f64::from(i) / 64.0));
    }
    path
}

#[test]
fn the_area_of_a_loop_is_that_of_its_parallelograms() {
    let law = friction();
    for steps in [2, 8, 24, 48, 64] {
        let amplitude = f64::from(steps) / 64.0;
        // the second cycle is steady; every corner lies on a sample, so the rule is exact
        let steady = work(&law, &triangle(steps, 2), 1.0) - work(&law, &triangle(steps, 1), 1.0);
        let closed = law.loop_area_deg_volt(amplitude);
        assert!((steady - closed).abs() < 1e-12, "{amplitude}: {steady} {closed}");
    }
    assert_eq!(law.loop_area_deg_volt(0.0625), 0.0);
    assert!(law.loop_area_deg_volt(1.0) > 1.0);
}

#[test]
fn a_viscous_part_takes_pi_c_omega_a_squared() {
    let (viscosity, hz, amplitude) = (0.3, 2.0, 0.5);
    let law = law(&[], 1.0, viscosity);
    let exact = PI * viscosity * TAU * hz * amplitude * amplitude;
    // first differences and the trapezoidal rule: sinc of a step, second order
    let error = |samples: usize| {
        let step = 1.0 / (hz * samples as f64);
        let path: Vec<f64> = (0..=2 * samples)
            .map(|i| amplitude * (TAU * i as f64 / samples as f64).sin())
            .collect();
        (work(&law, &path, step) - work(&law, &path[..=samples], step)) / exact - 1.0
    };
    let (coarse, fine) = (error(200).abs(), error(400).abs());
    assert!(coarse < 1e-3 && (3.8..4.2).contains(&(coarse / fine)), "{coarse} {fine}");
}

#[test]
fn memory_and_model_can_be_stored_and_go_on_with_the_same_bits() {
    let law = friction();
    let (mut memory, _) = law.start(0.1, StartState::RisingFromLowest);
    for u in [0.4, -0.3, 0.22] {
        law.step(&mut memory, u, 0.01);
    }
    let (copy, mut later) = (stored(&law), stored(&memory));
    assert_eq!((&copy, &later), (&law, &memory));
    for u in [0.5, 0.1, -0.9] {
        assert_eq!(law.step(&mut memory, u, 0.01), copy.step(&mut later, u, 0.01));
    }
    assert!(law.check_memory(&memory).is_ok());
    assert!(self::law(&[], 1.0, 0.0).check_memory(&memory).is_err());
}

#[test]
fn negative_numbers_are_refused() {
    let good = friction().parameters().clone();
    let refused = |change: &dyn Fn(&mut StopParameters)| {
        let mut bad = good.clone();
        change(&mut bad);
        PrandtlStop::new(bad).is_err()
    };
    assert!(refused(&|p| p.stops[1].stiffness_deg_per_volt = -1e-9));
    assert!(refused(&|p| p.stops[0].threshold_volt = f64::NAN));
    assert!(refused(&|p| p.stiffness_deg_per_volt = -1.0));
    assert!(refused(&|p| p.viscosity_deg_s_per_volt = f64::INFINITY));
    assert!(refused(&|p| p.offset_deg = f64::NAN));
}

proptest! {
    /// Against the stop's own rule, `s <- clamp(s + du)`, and the plays of the other law.
    #[test]
    fn stop_and_play_add_up_to_the_input(path in prop::collection::vec(-1.0..1.0_f64, 1..200)) {
        let radii = [0.0, 0.05, 0.3, 0.8];
        for &r in &radii {
            let stop = law(&[(r, 1.0)], 0.0, 0.0);
            let play = PrandtlIshlinskii::new(PrandtlParameters {
                range_volt: range(),
                gain_deg_per_volt: 0.0,
                plays: vec![WeightedPlay { threshold_volt: r, weight_deg_per_volt: 1.0 }],
                threshold_growth_s: 0.0,
                envelope: preisach_dyn::Envelope::default(),
            })
            .unwrap();
            let (mut of_stop, _) = stop.start(0.0, StartState::Rest);
            let (mut of_play, _) = play.start(0.0, StartState::Rest);
            let (mut own, mut last) = (0.0_f64, 0.0);
            for &u in &path {
                own = (own + (u - last)).clamp(-r, r);
                last = u;
                let s = stop.step(&mut of_stop, u, 1.0);
                let p = play.step(&mut of_play, u, 1.0);
                prop_assert!((s - own).abs() < 1e-12, "{} {}", s, own);
                prop_assert!((s + p - u).abs() < 1e-12, "{} + {} != {}", s, p, u);
            }
        }
    }

    #[test]
    fn a_larger_excursion_wipes_out_the_history(path in prop::collection::vec(-0.7..0.7_f64, 0..40)) {
        let law = friction();
        let (mut with, _) = law.start(0.0, StartState::Rest);
        let (mut without, _) = law.start(0.0, StartState::Rest);
        for u in path {
            law.step(&mut with, u, 1.0);
        }
        for u in [0.8, -0.8] {
            law.step(&mut with, u, 1.0);
            law.step(&mut without, u, 1.0);
        }
        prop_assert_eq!(with, without);
    }

    /// What a closed path takes is never negative.
    #[test]
    fn every_closed_path_takes_energy(path in prop::collection::vec(-64..=64_i32, 1..40)) {
        let law = friction();
        // in steps of 1/64, twice round: the second time the path is closed in the memory too
        let mut once = vec![0.0];
        let mut here = 0;
        for goal in path.into_iter().chain([0]) {
            while here != goal {
                here += (goal - here).signum();
                once.push(f64::from(here) / 64.0);
            }
        }
        let twice: Vec<f64> = once.iter().chain(&once[1..]).copied().collect();
        let taken = work(&law, &twice, 1.0) - work(&law, &once, 1.0);
        prop_assert!(taken >= -1e-12, "{}", taken);
    }
}

fn actuator(law: ActuatorLaw) -> ActuatorModel {
    ActuatorModel::new(law, range(), Calibration { deg_per_um: 1.0, zero_um: 0.0 })
}

fn run(model: &ActuatorModel, hz: f64, amplitude: f64) -> BenchRecord {
    let time_step_s = 1.0 / (400.0 * hz);
    let voltage_volt: Vec<f64> =
        (0..1200).map(|i| amplitude * (TAU * hz * time_step_s * f64::from(i)).sin()).collect();
    let output_deg = model.simulate(&voltage_volt, time_step_s).unwrap().output_deg;
    let id = format!("{hz} Hz {amplitude}");
    BenchRecord { id, time_step_s, voltage_volt, output_deg, ..BenchRecord::default() }
}

fn settings() -> Settings {
    let zero = preisach_dyn::identify::FlapZero::AsRecorded;
    Settings { range_volt: range(), levels: 8, zero, ..Settings::default() }
}

#[test]
fn loops_that_lead_are_fitted_by_stops_and_their_viscosity_is_found() {
    let truth = actuator(ActuatorLaw::PrandtlStop(law(&[(0.25, 2.0), (0.5, 0.5)], 0.1, 0.02)));
    let records: Vec<BenchRecord> =
        [(0.25, 1.0), (0.25, 0.5), (1.0, 0.9), (1.0, 0.4), (1.0, 0.7), (2.0, 0.8)]
            .map(|(hz, amplitude)| run(&truth, hz, amplitude))
            .to_vec();
    let families = vec![Family::Linear, Family::PrandtlStop, Family::StaticPreisach];
    let candidates = Candidates { families, orders: Vec::new(), ..Candidates::default() };
    let table = compare_models(&records, &settings(), &candidates, &|| ()).unwrap();
    let best = table.best().unwrap();
    assert_eq!(best.family, Family::PrandtlStop);
    let (_, worst) = table.error_over(best, RecordUse::HeldOut).unwrap();
    assert!(worst < 1e-3, "{worst}");
    let ActuatorLaw::PrandtlStop(found) = &table.model().unwrap().law else { panic!("law") };
    let viscosity = found.parameters().viscosity_deg_s_per_volt;
    assert!((viscosity / 0.02 - 1.0).abs() < 0.01, "{viscosity}");
    let of_loop = found.loop_area_deg_volt(0.9)
        / law(&[(0.25, 2.0), (0.5, 0.5)], 0.1, 0.0).loop_area_deg_volt(0.9);
    assert!((of_loop - 1.0).abs() < 1e-3, "{of_loop}");
    // rising plays cannot lead
    let error = |row: usize| table.error_over(&table.rows[row], RecordUse::Train).unwrap().0;
    assert!(error(2) > 0.3 && error(1) < 1e-3, "{} {}", error(2), error(1));
}

#[test]
fn one_frequency_says_nothing_about_viscosity() {
    let truth = actuator(ActuatorLaw::PrandtlStop(law(&[(0.25, 2.0)], 0.0, 0.1)));
    let records = [run(&truth, 0.25, 1.0), run(&truth, 0.25, 0.5)];
    let candidates = Candidates {
        families: vec![Family::PrandtlStop],
        orders: Vec::new(),
        ..Candidates::default()
    };
    let table = compare_models(&records, &settings(), &candidates, &|| ()).unwrap();
    let ActuatorLaw::PrandtlStop(found) = &table.model().unwrap().law else { panic!("law") };
    assert_eq!(found.parameters().viscosity_deg_s_per_volt, 0.0);
    // two loops: each is predicted from the other
    assert!(table.rows[0].cross_validation.is_some());
}

#[test]
fn an_output_that_lags_is_refused_with_its_reason() {
    let play = WeightedPlay { threshold_volt: 0.2, weight_deg_per_volt: 1.0 };
    let truth = actuator(ActuatorLaw::PrandtlIshlinskii(
        PrandtlIshlinskii::new(PrandtlParameters {
            range_volt: range(),
            gain_deg_per_volt: 1.0,
            plays: vec![play],
            threshold_growth_s: 0.0,
            envelope: preisach_dyn::Envelope::default(),
        })
        .unwrap(),
    ));
    let records = [run(&truth, 0.25, 1.0), run(&truth, 0.25, 0.5)];
    let families = vec![Family::PrandtlStop, Family::StaticPreisach];
    let candidates = Candidates { families, orders: Vec::new(), ..Candidates::default() };
    let table = compare_models(&records, &settings(), &candidates, &|| ()).unwrap();
    let message = table.rows[0].fitted.as_ref().unwrap_err().to_string();
    assert!(message.contains("the output lags the input"), "{message}");
    assert_eq!(table.best().unwrap().family, Family::StaticPreisach);
}
