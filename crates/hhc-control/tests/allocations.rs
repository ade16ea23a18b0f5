//! Memory taken by a sample and by a cycle of a loop that flies: none. Alone in its file: an allocator counts for the whole
//! process. The thread that waits for the test takes some once, at any moment: of three flights the least is judged.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use hhc_control::{
    ControlLayout, CycleController, EstimatorSettings, HarmonicAnalyser, RelaxedController,
    RelaxedSettings, TMatrix,
};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, Stats, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

const SAMPLES: usize = 128;
const WINDOW_REV: usize = 2;

/// A loop of two flaps at 2 to 5/rev: its analyser of six loads, its controller within limits that bind, its T.
fn flying() -> (HarmonicAnalyser, CycleController, TMatrix) {
    let layout = ControlLayout::new(2, vec![2, 3, 4, 5]).unwrap();
    let column = |j: usize| (0..12).map(|i| (0.8 * f64::from(i) + 1.3 * j as f64).sin()).collect();
    let columns: Vec<Vec<f64>> = (0..layout.len()).map(column).collect();
    let t = TMatrix::from_columns(&columns).unwrap();
    let settings = RelaxedSettings {
        gain: 0.3,
        amplitude_limit_volt: vec![2.0; layout.pairs()],
        rate_limit_volt: 1.0,
        effort_weight: 1e-3,
        flap_survival: 0.9,
        dead_flap_cost: 1.15,
        ..RelaxedSettings::of_layout(&layout)
    };
    let controller = RelaxedController::new(&layout, 12, settings).unwrap();
    let start = [30.0; 12];
    let adaptive = EstimatorSettings { dither_rad: 0.05, ..EstimatorSettings::in_flight(10.0) };
    let flying = CycleController::new(controller, &adaptive, &t, &start).unwrap();
    (HarmonicAnalyser::new(6, SAMPLES, WINDOW_REV, &[4]).unwrap(), flying, t)
}

/// Memory of 39 cycles with noise, a load that is lost and comes back, a jump of the loads and a flap that is lost.
fn of_a_flight() -> Stats {
    let (mut analyser, mut flying, t) = flying();
    let (mut loads, mut cycles, mut limited) = ([0.0; 12], 0, 0);
    let mut region = Region::new(ALLOCATOR);
    for cycle in 0..40 {
        if cycle == 1 {
            // what the thread itself takes once
            region = Region::new(ALLOCATOR);
        }
        match cycle {
            12 => flying.set_load_lost(3, true).unwrap(),
            20 => flying.set_load_lost(3, false).unwrap(),
            30 => flying.lose_flap(1).unwrap(),
            _ => {}
        }
        let jump = if cycle < 25 { 30.0 } else { 90.0 };
        for (i, load) in loads.iter_mut().enumerate() {
            let row = t.as_matrix().row(i);
            let control = flying.controller().control_volt();
            let moved: f64 = row.iter().zip(control).map(|(t, u)| t * u).sum();
            *load = jump + moved + f64::sin((17 * i + 5 * cycle) as f64);
        }
        for k in 0..SAMPLES * WINDOW_REV {
            let (sin, cos) = (k as f64 * 4.0 * std::f64::consts::TAU / SAMPLES as f64).sin_cos();
            let sample: [f64; 6] =
                std::array::from_fn(|c| loads[2 * c].mul_add(cos, loads[2 * c + 1] * sin));
            if let Some(seen) = analyser.push(&sample).unwrap()
                && k + 1 == SAMPLES * WINDOW_REV
            {
                flying.step(seen).unwrap();
                cycles += 1;
                limited += usize::from(flying.controller().is_limited());
            }
        }
    }
    let taken = region.change();
    assert!(cycles == 40 && limited > 0, "{cycles} {limited}");
    taken
}

#[test]
fn a_sample_and_a_cycle_take_no_memory() {
    let taken: Vec<Stats> = (0..3).map(|_| of_a_flight()).collect();
    let least = taken.iter().map(|stats| stats.allocations + stats.reallocations).min();
    assert_eq!(least, Some(0), "{taken:?}");
    // what does take memory is counted
    let (_, _, t) = flying();
    let region = Region::new(ALLOCATOR);
    let copy = t.columns();
    assert!(region.change().allocations > copy.len());
}
