//! Cost of one sample at 40 levels, on an input that sweeps and reverses like a bench mix.
//!
//! Budget: static model 100 ns per sample, dynamic model (three maps, second order in time) 300 ns.
//! Prints the best figure of all batches beside its bar.
#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![expect(clippy::print_stdout, reason = "a benchmark reports")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use preisach_dyn::{
    DynamicParameters, DynamicPreisach, OutputHistory, PlayMap, PlayMemory, PreisachError,
    PreisachGrid, RateForm, StartState, StaticPreisach, StepCounts, TimeOrder, VoltageRange,
};
use std::hint::black_box;
use std::time::{Duration, Instant};

const LEVELS: usize = 40;
const STATIC_BAR_NS: f64 = 100.0;
const DYNAMIC_BAR_NS: f64 = 300.0;
const TIME_STEP_S: f64 = 2.5e-4;

fn voltages() -> Vec<f64> {
    (0..4000)
        .map(|i| {
            let t = f64::from(i) * TIME_STEP_S;
            65.0 + 30.0 * (62.8 * t).cos() + 30.0 * (94.2 * t).sin() + 24.0 * (125.7 * t).cos()
        })
        .collect()
}

fn map(grid: &PreisachGrid, size: f64) -> Result<PlayMap, PreisachError> {
    let rises: Vec<Vec<f64>> = (0..grid.levels())
        .map(|j| (0..grid.levels() - j).map(|k| size * (1.5 + ((j * k) as f64).sin())).collect())
        .collect();
    PlayMap::from_rises(grid, 0.0, &rises)
}

fn models() -> Result<(StaticPreisach, DynamicPreisach), PreisachError> {
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), LEVELS)?;
    let g0_deg = map(&grid, 0.02)?;
    let mut g1_s = map(&grid, 1e-6)?;
    g1_s.constant = -0.02;
    let dynamic = DynamicPreisach::new(DynamicParameters {
        grid,
        g0_deg: g0_deg.clone(),
        g1_s,
        g2_s2_per_deg: map(&grid, 1e-9)?,
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 500.0,
        time_order: TimeOrder::Second,
    })?;
    Ok((StaticPreisach::new(grid, g0_deg)?, dynamic))
}

/// Times batches for criterion and keeps the best.
fn timed(rounds: u64, samples: usize, best_ns: &mut f64, mut run: impl FnMut()) -> Duration {
    let mut total = Duration::ZERO;
    for _ in 0..rounds {
        let start = Instant::now();
        run();
        let spent = start.elapsed();
        *best_ns = best_ns.min(spent.as_secs_f64() * 1e9 / samples as f64);
        total += spent;
    }
    total
}

fn report(name: &str, best_ns: f64, bar_ns: f64) {
    println!(
        "{name}: {best_ns:.1} ns per sample, {:.2} of the bar of {bar_ns} ns",
        best_ns / bar_ns
    );
}

fn samples(c: &mut Criterion) {
    let Ok((fixed, dynamic)) = models() else {
        return;
    };
    let volts = voltages();
    let mut group = c.benchmark_group("sample at 40 levels");
    group.throughput(Throughput::Elements(volts.len() as u64));

    let mut memory = PlayMemory::new(fixed.grid(), 65.0, StartState::Rest);
    let mut best = f64::INFINITY;
    group.bench_function("static", |b| {
        b.iter_custom(|rounds| {
            timed(rounds, volts.len(), &mut best, || {
                let sum: f64 = volts.iter().map(|&u| fixed.apply(&mut memory, black_box(u))).sum();
                black_box(sum);
            })
        });
    });
    report("static", best, STATIC_BAR_NS);

    let mut memory = PlayMemory::new(dynamic.grid(), 65.0, StartState::Rest);
    let mut history = OutputHistory::at_rest(0.0);
    let mut counts = StepCounts::default();
    let mut best = f64::INFINITY;
    group.bench_function("dynamic", |b| {
        b.iter_custom(|rounds| {
            timed(rounds, volts.len(), &mut best, || {
                for &u in &volts {
                    let u = black_box(u);
                    black_box(dynamic.step(&mut memory, &mut history, &mut counts, u, TIME_STEP_S));
                }
            })
        });
    });
    report("dynamic", best, DYNAMIC_BAR_NS);
    group.finish();
}

criterion_group!(benches, samples);
criterion_main!(benches);
