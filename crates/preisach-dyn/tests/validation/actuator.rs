//! The actuator: what defines a Preisach operator, and identification on the shipped bench records.

use crate::oracles::everett::EverettStaircase;
use preisach_dyn::{
    HysteresisLaw, PlayMap, PlayMemory, PreisachGrid, StartState, StaticPreisach, VoltageRange,
};
use validation::{Check, Failure, row, worst};

pub(crate) const ROWS: &[Check] = &[
    row("V-ACT-01", "wiping-out: output after the same outer loop, with and without a past", "deg")
        .against("definition")
        .at_most(0.0, wiping_out),
    row(
        "V-ACT-02",
        "return-point memory: output after a closed minor loop, off where it began",
        "deg",
    )
    .against("definition")
    .at_most(1e-12, return_point),
    row(
        "V-ACT-03",
        "congruency: minor loops between the same voltages from 5 pasts, largest \
         difference of shape",
        "deg",
    )
    .against("definition")
    .at_most(1e-12, congruency),
    row(
        "V-ACT-04",
        "play form against Everett staircase of the same density: largest \
         difference",
        "deg",
    )
    .against("classical Preisach model")
    .at_most(1e-12, staircase),
];

const LOWEST: f64 = -20.0;
const HIGHEST: f64 = 150.0;

/// A density with structure, 24 levels.
pub(crate) fn grid_and_map() -> Result<(PreisachGrid, PlayMap), Failure> {
    let levels = 24;
    let grid = PreisachGrid::new(VoltageRange::new(LOWEST, HIGHEST)?, levels)?;
    let n = levels as f64;
    let rises: Vec<Vec<f64>> = (0..levels)
        .map(|play| {
            (0..levels - play)
                .map(|cell| {
                    let (s, r) = ((2 * cell + play) as f64 / n - 1.0, play as f64 / n);
                    30.0 / (n * n) * (-3.0 * r).exp() * (1.2 + (4.0 * s).sin())
                })
                .collect()
        })
        .collect();
    let map = PlayMap::from_rises(&grid, 0.5, &rises)?;
    Ok((grid, map))
}

fn static_model() -> Result<StaticPreisach, Failure> {
    let (grid, map) = grid_and_map()?;
    Ok(StaticPreisach::new(grid, map)?)
}

/// Voltages without pattern, from a linear congruential sequence.
pub(crate) fn wander(seed: u64, count: usize) -> Vec<f64> {
    let mut state = seed;
    (0..count)
        .map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            LOWEST + (HIGHEST - LOWEST) * (state >> 11) as f64 / (1_u64 << 53) as f64
        })
        .collect()
}

/// Memory and output after a history from rest.
fn driven(model: &StaticPreisach, history: &[f64]) -> (PlayMemory, f64) {
    let mut memory = PlayMemory::new(model.grid(), 65.0, StartState::Rest);
    let mut output = model.output_deg(&memory);
    for &voltage in history {
        output = model.apply(&mut memory, voltage);
    }
    (memory, output)
}

fn wiping_out() -> Result<f64, Failure> {
    let model = static_model()?;
    let outer = [HIGHEST, LOWEST, 71.3];
    let fresh = driven(&model, &outer).1;
    let differences = (1..=5).map(|seed| {
        let past = [wander(seed, 40), outer.to_vec()].concat();
        Ok((driven(&model, &past).1 - fresh).abs())
    });
    worst("pasts", 5, differences)
}

fn return_point() -> Result<f64, Failure> {
    let model = static_model()?;
    let differences = (1..=5).map(|seed| {
        let (mut memory, before) = driven(&model, &[wander(seed, 40), vec![20.0, 110.0]].concat());
        model.apply(&mut memory, 35.0);
        Ok((model.apply(&mut memory, 110.0) - before).abs())
    });
    worst("pasts", 5, differences)
}

fn congruency() -> Result<f64, Failure> {
    let model = static_model()?;
    let (low, high) = (30.0, 95.0);
    let shape = |seed: u64| -> Vec<f64> {
        let (mut memory, start) =
            driven(&model, &[wander(seed, 40), vec![low, high, low]].concat());
        let up = (1..=13).map(|i| low + (high - low) * f64::from(i) / 13.0);
        let down = (1..=13).map(|i| high - (high - low) * f64::from(i) / 13.0);
        up.chain(down).map(|voltage| model.apply(&mut memory, voltage) - start).collect()
    };
    let first = shape(1);
    let differences = (2..=5).flat_map(|seed| {
        shape(seed).into_iter().zip(first.clone()).map(|(a, b)| Ok((a - b).abs()))
    });
    worst("loop points", 100, differences.collect::<Vec<_>>())
}

fn staircase() -> Result<f64, Failure> {
    let (grid, map) = grid_and_map()?;
    let model = StaticPreisach::new(grid, map)?;
    let classical = EverettStaircase::of(&model);
    let (mut memory, _) = model.start(LOWEST, StartState::RisingFromLowest);
    let (mut turns, _) = classical.start(LOWEST, StartState::RisingFromLowest);
    let differences: Vec<_> = wander(7, 200)
        .into_iter()
        .map(|voltage| {
            let plays = model.step(&mut memory, voltage, 1.0);
            Ok((plays - classical.step(&mut turns, voltage)).abs())
        })
        .collect();
    worst("voltages", 200, differences)
}
