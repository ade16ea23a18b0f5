//! Memory taken by a sample of an actuator and of its inverse: none. Alone in its file: an allocator counts for the whole
//! process. The thread that waits for the test takes some once, at any moment: of three runs the least is judged.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, Calibration, Lag, LinkageStage, LogCreep, PlayMap,
    PlayMemory, PreisachGrid, StartState, StaticPreisach, VoltageRange,
};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, Stats, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

const STEP_S: f64 = 1e-3;
const LEVELS: usize = 20;

fn law() -> StaticPreisach {
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), LEVELS).unwrap();
    let rise = |j: usize, k: usize| 0.02 * (1.5 + ((j * k) as f64).sin());
    let rises: Vec<Vec<f64>> =
        (0..LEVELS).map(|j| (0..LEVELS - j).map(|k| rise(j, k)).collect()).collect();
    StaticPreisach::new(grid, PlayMap::from_rises(&grid, 0.0, &rises).unwrap()).unwrap()
}

/// A thousand samples of a mix, forward through a chain, and back through the inverse of the law.
fn of_samples(law: &StaticPreisach, model: &ActuatorModel) -> Stats {
    let volt = |i: i32| {
        let t = f64::from(i) * STEP_S;
        65.0 + 40.0 * (31.4 * t).sin() + 20.0 * (75.0 * t).cos()
    };
    let stepper = model.stepper(STEP_S).unwrap();
    let mut chain = model.start(volt(0), StartState::Rest).unwrap();
    let mut forward = PlayMemory::new(law.grid(), volt(0), StartState::Rest);
    let mut backward = forward.clone();
    let region = Region::new(ALLOCATOR);
    let mut worst_deg = 0.0_f64;
    for i in 1..1000 {
        stepper.step(&mut chain, volt(i), 0.0).unwrap();
        let wanted_deg = law.apply(&mut forward, volt(i));
        law.inverse(&mut backward, wanted_deg).unwrap();
        worst_deg = worst_deg.max((law.output_deg(&backward) - wanted_deg).abs());
    }
    let taken = region.change();
    assert!(worst_deg < 1e-9, "{worst_deg}");
    taken
}

#[test]
fn a_sample_forward_and_back_takes_no_memory() {
    let law = law();
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
    let mut model = ActuatorModel::new(
        ActuatorLaw::StaticPreisach(law.clone()),
        VoltageRange::amplified_stack(),
        calibration,
    );
    model.amplifier = vec![AmplifierStage::Lag(Lag { tau_s: 2e-3 })];
    model.linkage = vec![LinkageStage::LogCreep(LogCreep::new(0.015))];
    let taken: Vec<Stats> = (0..3).map(|_| of_samples(&law, &model)).collect();
    let least = taken.iter().map(|stats| stats.allocations + stats.reallocations).min();
    assert_eq!(least, Some(0), "{taken:?}");
}
