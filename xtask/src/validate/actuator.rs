//! The actuator: what defines a Preisach operator, and identification on the shipped bench records.

use std::sync::LazyLock;

use preisach_dyn::identify::{Identification, RecordFit, RecordReport, RecordUse, Settings};
use preisach_dyn::{
    EverettStaircase, HysteresisLaw, PlayMap, PlayMemory, PreisachGrid, StartState, StaticPreisach,
    VoltageRange,
};
use sim_driver::SimError;
use sim_driver::files::{Folder, SHIPPED_BENCH, read_bench};
use sim_driver::identification::identify_bench;

use super::CheckError;
use super::check::{Area, Check, Criterion, Repeatability};
use super::reference::worst;

pub(super) const BENCH: &str = "synthetic bench records, fixtures/bench/apa500l_synthetic";

pub(super) const AREA: Area = Area {
    heading: "Actuator (`preisach-dyn`)",
    checks: &[
        Check {
            id: "V-ACT-01",
            quantity: "wiping-out: output after the same outer loop, with and without a past",
            unit: "deg",
            source: "definition",
            criterion: Criterion::AtMost(0.0),
            repeatability: Repeatability::Everywhere,
            measure: wiping_out,
        },
        Check {
            id: "V-ACT-02",
            quantity: "return-point memory: output after a closed minor loop, off where it began",
            unit: "deg",
            source: "definition",
            criterion: Criterion::AtMost(1e-12),
            repeatability: Repeatability::Everywhere,
            measure: return_point,
        },
        Check {
            id: "V-ACT-03",
            quantity: "congruency: minor loops between the same voltages from 5 pasts, largest \
                       difference of shape",
            unit: "deg",
            source: "definition",
            criterion: Criterion::AtMost(1e-12),
            repeatability: Repeatability::Everywhere,
            measure: congruency,
        },
        Check {
            id: "V-ACT-04",
            quantity: "play form against Everett staircase of the same density: largest difference",
            unit: "deg",
            source: "classical Preisach model",
            criterion: Criterion::AtMost(1e-12),
            repeatability: Repeatability::Everywhere,
            measure: staircase,
        },
        Check {
            id: "V-ACT-05",
            quantity: "identification, trained records: largest NRMSE",
            unit: "%",
            source: BENCH,
            criterion: Criterion::AtMost(4.0),
            repeatability: Repeatability::Everywhere,
            measure: || over(|r| r.record_use == RecordUse::Train, 7, nrmse),
        },
        Check {
            id: "V-ACT-06",
            quantity: "identification, held out, 15 and 20 Hz: largest NRMSE",
            unit: "%",
            source: BENCH,
            criterion: Criterion::AtMost(10.0),
            repeatability: Repeatability::Everywhere,
            measure: || over(|r| is_held_out(r) && is_fast(r), 6, nrmse),
        },
        Check {
            id: "V-ACT-07",
            quantity: "identification, held out, 15 and 20 Hz: largest phase error",
            unit: "deg",
            source: BENCH,
            criterion: Criterion::AtMost(3.0),
            repeatability: Repeatability::Everywhere,
            measure: || over(|r| is_held_out(r) && is_fast(r), 6, phase_error),
        },
        Check {
            id: "V-ACT-08",
            quantity: "identification, held out, 5 Hz, middle amplitudes and the mix: largest NRMSE",
            unit: "%",
            source: BENCH,
            criterion: Criterion::AtMost(15.0),
            repeatability: Repeatability::Everywhere,
            measure: || over(|r| is_held_out(r) && !is_fast(r), 6, nrmse),
        },
        Check {
            id: "V-ACT-09",
            quantity: "static model on the 15 Hz records, smallest NRMSE: why a dynamic one is needed",
            unit: "%",
            source: BENCH,
            criterion: Criterion::AtLeast(50.0),
            repeatability: Repeatability::Everywhere,
            measure: static_at_15_hz,
        },
    ],
};

const LOWEST: f64 = -20.0;
const HIGHEST: f64 = 150.0;

/// A density with structure, 24 levels.
pub(super) fn grid_and_map() -> Result<(PreisachGrid, PlayMap), CheckError> {
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

fn static_model() -> Result<StaticPreisach, CheckError> {
    let (grid, map) = grid_and_map()?;
    Ok(StaticPreisach::new(grid, map)?)
}

/// Voltages without pattern, from a linear congruential sequence.
pub(super) fn wander(seed: u64, count: usize) -> Vec<f64> {
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

fn wiping_out() -> Result<f64, CheckError> {
    let model = static_model()?;
    let outer = [HIGHEST, LOWEST, 71.3];
    let fresh = driven(&model, &outer).1;
    let differences = (1..=5).map(|seed| {
        let past = [wander(seed, 40), outer.to_vec()].concat();
        Ok((driven(&model, &past).1 - fresh).abs())
    });
    worst("pasts", 5, differences)
}

fn return_point() -> Result<f64, CheckError> {
    let model = static_model()?;
    let differences = (1..=5).map(|seed| {
        let (mut memory, before) = driven(&model, &[wander(seed, 40), vec![20.0, 110.0]].concat());
        model.apply(&mut memory, 35.0);
        Ok((model.apply(&mut memory, 110.0) - before).abs())
    });
    worst("pasts", 5, differences)
}

fn congruency() -> Result<f64, CheckError> {
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

fn staircase() -> Result<f64, CheckError> {
    let (grid, map) = grid_and_map()?;
    let model = StaticPreisach::new(grid, map.clone())?;
    let classical = EverettStaircase::new(grid, map)?;
    let (mut memory, _) = model.start(LOWEST, StartState::RisingFromLowest);
    let (mut turns, _) = classical.start(LOWEST, StartState::RisingFromLowest);
    let differences: Vec<_> = wander(7, 200)
        .into_iter()
        .map(|voltage| {
            let plays = model.step(&mut memory, voltage, 1.0);
            Ok((plays - classical.step(&mut turns, voltage, 1.0)).abs())
        })
        .collect();
    worst("voltages", 200, differences)
}

/// The shipped records, identified once for all checks.
static IDENTIFIED: LazyLock<Result<Identification, SimError>> = LazyLock::new(|| {
    let data = read_bench(&Folder::Shipped(SHIPPED_BENCH.to_owned()))?;
    Ok(identify_bench(&data, &Settings::default())?.identification)
});

pub(super) fn identified() -> Result<&'static Identification, CheckError> {
    IDENTIFIED.as_ref().map_err(|error| CheckError::Driver(error.clone()))
}

fn records() -> Result<&'static [RecordReport], CheckError> {
    Ok(&identified()?.records)
}

fn is_held_out(record: &RecordReport) -> bool {
    record.record_use == RecordUse::HeldOut
}

/// A single sine at 15 or 20 Hz.
fn is_fast(record: &RecordReport) -> bool {
    record.drive.base_hz > 14.0
}

fn nrmse(fit: &RecordFit) -> f64 {
    fit.nrmse_percent()
}

/// Magnitude of the phase error; a record without one cannot pass.
fn phase_error(fit: &RecordFit) -> f64 {
    fit.phase_error_deg.map_or(f64::NAN, f64::abs)
}

/// The largest figure of the dynamic model over some of the records.
fn over(
    wanted: fn(&RecordReport) -> bool,
    needed: usize,
    figure: fn(&RecordFit) -> f64,
) -> Result<f64, CheckError> {
    let chosen = records()?.iter().filter(|record| wanted(record));
    worst("records", needed, chosen.map(|record| Ok(figure(&record.dynamic))))
}

fn static_at_15_hz() -> Result<f64, CheckError> {
    let at_15 = |record: &&RecordReport| (record.drive.base_hz - 15.0).abs() < 0.5;
    let figures = records()?.iter().filter(at_15).map(|record| record.static_only.nrmse_percent());
    let (smallest, found) =
        figures.fold((f64::INFINITY, 0), |(smallest, n), figure| (figure.min(smallest), n + 1));
    let needed = 3;
    if found < needed {
        Err(CheckError::TooFew { what: "records", found, needed })
    } else {
        Ok(smallest)
    }
}
