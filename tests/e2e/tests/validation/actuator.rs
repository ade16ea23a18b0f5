//! The actuator identified on the shipped bench records.

use std::sync::LazyLock;

use bench_study::identification::identify_bench;
use preisach_dyn::identify::{Identification, RecordFit, RecordReport, RecordUse, Settings};
use preisach_dyn::{ActuatorLaw, HysteresisLaw, StartState};
use sim_driver::files::{SHIPPED_BENCH, read_bench, shipped};
use validation::{Check, Failure, row, shared, too_few, worst};

pub(crate) const BENCH: &str = "synthetic bench records, fixtures/bench/apa500l_synthetic";

pub(crate) const ROWS: &[Check] = &[
    row("V-ACT-05", "identification, trained records: largest NRMSE", "%")
        .against(BENCH)
        .at_most(4.0, || over(|r| r.record_use == RecordUse::Train, 7, nrmse)),
    row("V-ACT-06", "identification, held out, 15 and 20 Hz: largest NRMSE", "%")
        .against(BENCH)
        .at_most(10.0, || over(|r| is_held_out(r) && is_fast(r), 6, nrmse)),
    row("V-ACT-07", "identification, held out, 15 and 20 Hz: largest phase error", "deg")
        .against(BENCH)
        .at_most(3.0, || over(|r| is_held_out(r) && is_fast(r), 6, phase_error)),
    row(
        "V-ACT-08",
        "identification, held out, 5 Hz, middle amplitudes and the mix: largest \
         NRMSE",
        "%",
    )
    .against(BENCH)
    .at_most(15.0, || over(|r| is_held_out(r) && !is_fast(r), 6, nrmse)),
    row(
        "V-ACT-09",
        "static model on the 15 Hz records, smallest NRMSE: why a dynamic one is \
         needed",
        "%",
    )
    .against(BENCH)
    .at_least(50.0, static_at_15_hz),
    row("V-ACT-11", "identified dynamic model, 10^6 random voltages: steps with G1 >= 0", "steps")
        .against("well-posedness of eq. (5); synthetic bench records")
        .at_most(0.0, bad_steps),
];

/// The shipped records, identified once for all checks.
static IDENTIFIED: LazyLock<Result<Identification, Failure>> = LazyLock::new(|| {
    let data = read_bench(&shipped(SHIPPED_BENCH))?;
    Ok(identify_bench(&data, &Settings::default(), None)?.identification)
});

pub(crate) fn identified() -> Result<&'static Identification, Failure> {
    shared(&IDENTIFIED)
}

fn records() -> Result<&'static [RecordReport], Failure> {
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
) -> Result<f64, Failure> {
    let chosen = records()?.iter().filter(|record| wanted(record));
    worst("records", needed, chosen.map(|record| Ok(figure(&record.dynamic))))
}

fn static_at_15_hz() -> Result<f64, Failure> {
    let at_15 = |record: &&RecordReport| (record.drive.base_hz - 15.0).abs() < 0.5;
    let figures = records()?.iter().filter(at_15).map(|record| record.static_only.nrmse_percent());
    let (smallest, found) =
        figures.fold((f64::INFINITY, 0), |(smallest, n), figure| (figure.min(smallest), n + 1));
    let needed = 3;
    if found < needed { Err(too_few("records", found, needed)) } else { Ok(smallest) }
}

/// Voltages without pattern, from a linear congruential sequence.
fn wander(seed: u64, count: usize) -> Vec<f64> {
    let (lowest, highest) = (-20.0, 150.0);
    let mut state = seed;
    (0..count)
        .map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            lowest + (highest - lowest) * (state >> 11) as f64 / (1_u64 << 53) as f64
        })
        .collect()
}

fn bad_steps() -> Result<f64, Failure> {
    let ActuatorLaw::DynamicPreisach(law) = &identified()?.dynamic.law else {
        return Ok(f64::NAN);
    };
    let (mut memory, _) = law.start(65.0, StartState::Rest);
    for state in 1..=1000 {
        for voltage in wander(state, 1000) {
            HysteresisLaw::step(law, &mut memory, voltage, 1e-3);
        }
    }
    Ok(law.counts(&memory).g1_not_negative as f64)
}
