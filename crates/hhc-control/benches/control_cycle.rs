//! Cost of one cycle of the adaptive controller, and of one sample of the analyser.
//!
//! Budget: 20 us a cycle for two flaps with limits that bind, on one core: at one harmonic and at 2 to 5/rev together (16 controls),
//! as plain as the controller can be, and with all that a flight may ask of it: flaps that may fail, a turn to and fro, a trend of
//! Z0, a rate and its weight. The line `ratio to budget` sets them side by side.
#![expect(clippy::print_stdout, reason = "the ratio to the budget is the bench's result")]
#![expect(clippy::unwrap_used, reason = "a bench whose inputs are refused cannot go on")]
#![expect(clippy::disallowed_methods, reason = "a bench reads the clock")]

use criterion::{Criterion, criterion_group, criterion_main};
use hhc_control::{
    ControlLayout, CycleController, EstimatorSettings, HarmonicAnalyser, RelaxedController,
    RelaxedSettings, TMatrix,
};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// The budget of one cycle, us.
const BUDGET_US: f64 = 20.0;

/// What is asked of the controller.
#[derive(Clone, Copy, PartialEq)]
enum Asked {
    Plain,
    All,
    /// Flaps that are counted on and lean on each other, held back in every cycle by what one that stops would leave.
    HeldBack,
}

impl Asked {
    /// Chance that a flap acts, limit of the rate (V), its weight (1/V^2).
    fn of_control(self) -> (f64, f64, f64) {
        match self {
            Self::Plain | Self::HeldBack => (1.0, f64::INFINITY, 0.0),
            Self::All => (0.9, 5.0, 1e-3),
        }
    }

    fn is_held_back(self) -> bool {
        matches!(self, Self::HeldBack)
    }

    fn of_estimate(self) -> EstimatorSettings {
        let plain = EstimatorSettings::in_flight(85.0);
        match self {
            Self::Plain | Self::HeldBack => plain,
            Self::All => EstimatorSettings {
                uncertainty: 0.5,
                drift: 0.25,
                baseline_drift: 0.1,
                trend_drift: 0.05,
                dither_rad: 3.0_f64.to_radians(),
                ..plain
            },
        }
    }
}

/// A rotor of 12 loads, its T of two flaps that are nearly alike.
fn rotor(harmonics: &[u32], asked: Asked) -> (TMatrix, Vec<f64>, CycleController) {
    let layout = ControlLayout::new(2, harmonics.to_vec()).unwrap();
    let columns: Vec<Vec<f64>> = (0..layout.len())
        .map(|j| {
            let flap = j / (2 * harmonics.len());
            let wave = |i: usize| (0.8 * i as f64 + 1.3 * j as f64).sin();
            (0..12).map(|i| wave(i) + 0.2 * (1.9 * (i + flap) as f64).cos()).collect()
        })
        .collect();
    let t = TMatrix::from_columns(&columns).unwrap();
    let z0: Vec<f64> = (0..12).map(|i| 40.0 * (0.7 * f64::from(i)).cos()).collect();
    let (flap_survival, rate_limit_volt, rate_weight) = asked.of_control();
    let settings = RelaxedSettings {
        gain: 0.3,
        amplitude_limit_volt: vec![if asked.is_held_back() { 60.0 } else { 10.0 }; layout.pairs()],
        effort_weight: 1e-3,
        flap_survival,
        rate_limit_volt,
        rate_weight,
        dead_flap_cost: if let Asked::Plain = asked { f64::INFINITY } else { 1.1 },
        ..RelaxedSettings::of_layout(&layout)
    };
    let controller = RelaxedController::new(&layout, 12, settings).unwrap();
    let flying = CycleController::new(controller, &asked.of_estimate(), &t, &z0).unwrap();
    (t, z0, flying)
}

/// So many cycles with the loads of a rotor that answers, in the time of the controller alone.
fn cycles(harmonics: &[u32], asked: Asked, count: u64) -> Duration {
    let (t, z0, mut flying) = rotor(harmonics, asked);
    let (mut taken, mut held_back) = (Duration::ZERO, 0);
    for k in 0..count {
        let change = t.loads_for(flying.control_volt()).unwrap();
        let noise = |i: usize| f64::sin((i * i * 7) as f64 + 13.0 * k as f64);
        let loads: Vec<f64> =
            z0.iter().zip(&change).enumerate().map(|(i, (z, d))| z + d + noise(i)).collect();
        let start = Instant::now();
        black_box(flying.step(black_box(&loads)).unwrap());
        taken += start.elapsed();
        held_back += u64::from(flying.controller().is_held_back());
    }
    // the first cycles only begin to lean
    let is_meant = !asked.is_held_back() || count < 50 || 2 * held_back > count;
    assert!(is_meant, "held back in {held_back} of {count}");
    taken
}

fn controllers(criterion: &mut Criterion) {
    let [one, all] = [&[3][..], &[2, 3, 4, 5]];
    for (name, harmonics, asked) in [
        ("one harmonic", one, Asked::Plain),
        ("one harmonic, all that may be asked", one, Asked::All),
        ("2 to 5 per rev", all, Asked::Plain),
        ("2 to 5 per rev, all that may be asked", all, Asked::All),
        ("2 to 5 per rev, held back", all, Asked::HeldBack),
    ] {
        let each = || 1e6 * cycles(harmonics, asked, 50).as_secs_f64() / 50.0;
        let us = (0..40).map(|_| each()).fold(f64::INFINITY, f64::min);
        println!("cycle, {name}: {us:.2} us, ratio to budget {:.2}", us / BUDGET_US);
        criterion.bench_function(&format!("controller cycle, {name}"), |bench| {
            bench.iter_custom(|count| cycles(harmonics, asked, count));
        });
    }
    let mut analyser = HarmonicAnalyser::new(6, 128, 2, &[4]).unwrap();
    criterion.bench_function("sample of six channels", |bench| {
        bench.iter(|| analyser.push(black_box(&[0.1; 6])).is_ok());
    });
}

criterion_group!(benches, controllers);
criterion_main!(benches);
