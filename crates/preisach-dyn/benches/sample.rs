//! Cost of one sample at 40 levels, on an input that sweeps and reverses like a bench mix.
//!
//! Budget: static model 100 ns per sample, dynamic model (three maps, second order in time) 300 ns.
//! The other laws, the stages and the batch have no bar of their own: theirs is the bar of the law.
//! Prints the best figure of all batches beside its bar.
#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![expect(clippy::print_stdout, reason = "a benchmark reports")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, Backlash, BoucWen, BoucWenParameters, Calibration,
    CurrentLimit, Drive, DynamicParameters, DynamicPreisach, Envelope, HysteresisLaw, Lag,
    LinkageStage, LogCreep, PlayMap, PlayMemory, PrandtlIshlinskii, PrandtlParameters, PrandtlStop,
    PreisachError, PreisachGrid, RateForm, Resonance, StartState, StaticPreisach, StopParameters,
    TimeOrder, VoltageRange, WeightedPlay, WeightedStop,
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

fn models(levels: usize) -> Result<(StaticPreisach, DynamicPreisach), PreisachError> {
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), levels)?;
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
    if best_ns.is_infinite() {
        return; // left out by the filter of the command line
    }
    println!(
        "{name}: {best_ns:.1} ns per sample, {:.2} of the bar of {bar_ns} ns",
        best_ns / bar_ns
    );
}

/// Times a law through the whole actuator, without stages and with some.
fn actuators(c: &mut Criterion) {
    let Ok((fixed, dynamic)) = models(LEVELS) else {
        return;
    };
    let volts = voltages();
    let range_volt = fixed.grid().range();
    let plain = |law| {
        let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
        ActuatorModel::new(law, range_volt, calibration)
    };
    let stages = |law| ActuatorModel {
        amplifier: vec![
            AmplifierStage::Lag(Lag { tau_s: 5e-4 }),
            AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: 4000.0 }),
        ],
        linkage: vec![
            LinkageStage::Resonance(Resonance { frequency_hz: 150.0, damping_ratio: 0.02 }),
            LinkageStage::Backlash(Backlash { width_um: 1.0 }),
        ],
        ..plain(law)
    };
    let plays = (1..LEVELS)
        .map(|i| WeightedPlay { threshold_volt: i as f64, weight_deg_per_volt: 1e-3 })
        .collect();
    let prandtl = PrandtlIshlinskii::new(PrandtlParameters {
        range_volt,
        gain_deg_per_volt: 0.06,
        plays,
        threshold_growth_s: 1e-4,
        envelope: Envelope::default(),
    });
    let bouc_wen = BoucWen::new(BoucWenParameters {
        range_volt,
        gain_deg_per_volt: 0.12,
        half_height_deg: 0.9,
        rise_volt: 30.0,
        sigma: 0.8,
        exponent: 1.0,
        envelope: Envelope::default(),
    });
    let stop = |i: usize| WeightedStop { threshold_volt: i as f64, stiffness_deg_per_volt: 1e-3 };
    let stops = PrandtlStop::new(StopParameters {
        range_volt,
        stiffness_deg_per_volt: 0.01,
        stops: (1..LEVELS).map(stop).collect(),
        viscosity_deg_s_per_volt: 1e-5,
        offset_deg: 0.0,
    });
    let (Ok(prandtl), Ok(bouc_wen), Ok(stops)) = (prandtl, bouc_wen, stops) else {
        return;
    };
    let fixed = ActuatorLaw::StaticPreisach(fixed);
    let dynamic = ActuatorLaw::DynamicPreisach(dynamic);
    let creep = ActuatorModel {
        linkage: vec![LinkageStage::LogCreep(LogCreep::new(0.015))],
        ..plain(fixed.clone())
    };
    let table = [
        ("actuator: static", plain(fixed.clone()), STATIC_BAR_NS),
        ("actuator: static, four stages", stages(fixed), STATIC_BAR_NS),
        ("actuator: static, creep of 8 lags", creep, STATIC_BAR_NS),
        ("actuator: Prandtl", plain(ActuatorLaw::PrandtlIshlinskii(prandtl)), STATIC_BAR_NS),
        ("actuator: stops", plain(ActuatorLaw::PrandtlStop(stops)), STATIC_BAR_NS),
        ("actuator: Bouc-Wen", plain(ActuatorLaw::BoucWen(bouc_wen)), STATIC_BAR_NS),
        ("actuator: dynamic", plain(dynamic.clone()), DYNAMIC_BAR_NS),
        ("actuator: dynamic, four stages", stages(dynamic), DYNAMIC_BAR_NS),
    ];
    let mut group = c.benchmark_group("sample at 40 levels");
    group.throughput(Throughput::Elements(volts.len() as u64));
    for (name, model, bar_ns) in table {
        let mut best = f64::INFINITY;
        group.bench_function(name, |b| {
            b.iter_custom(|rounds| {
                timed(rounds, volts.len(), &mut best, || {
                    black_box(model.simulate(black_box(&volts), TIME_STEP_S).is_ok());
                })
            });
        });
        report(name, best, bar_ns);
    }
    group.finish();
}

/// A batch on all cores, against the same histories one after another.
fn batches(c: &mut Criterion) {
    let Ok((fixed, dynamic)) = models(LEVELS) else {
        return;
    };
    let volts = voltages();
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
    let law = ActuatorLaw::DynamicPreisach(dynamic);
    let model = ActuatorModel::new(law, fixed.grid().range(), calibration);
    let mut group = c.benchmark_group("sample at 40 levels");
    let drives = [Drive::new(&volts, TIME_STEP_S); BATCH];
    let samples = BATCH * volts.len();
    let (mut single, mut batch) = (f64::INFINITY, f64::INFINITY);
    group.throughput(Throughput::Elements(samples as u64));
    group.bench_function("64 histories, one by one", |b| {
        b.iter_custom(|rounds| {
            timed(rounds, samples, &mut single, || {
                for drive in &drives {
                    black_box(model.simulate_drive(drive).is_ok());
                }
            })
        });
    });
    group.bench_function("64 histories, batch", |b| {
        b.iter_custom(|rounds| {
            timed(rounds, samples, &mut batch, || {
                black_box(model.simulate_batch(&drives).is_ok());
            })
        });
    });
    report("batch", batch, DYNAMIC_BAR_NS);
    let threads = rayon::current_num_threads();
    println!(
        "batch: {:.2} times as fast as one by one, on {threads} threads; bar on idle cores: their number, less a tenth",
        single / batch
    );
    group.finish();
}

const BATCH: usize = 64;

fn samples(c: &mut Criterion) {
    let Ok((fixed, dynamic)) = models(LEVELS) else {
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

    let (mut memory, _) = dynamic.start(65.0, StartState::Rest);
    let mut best = f64::INFINITY;
    group.bench_function("dynamic", |b| {
        b.iter_custom(|rounds| {
            timed(rounds, volts.len(), &mut best, || {
                for &u in &volts {
                    let u = black_box(u);
                    black_box(dynamic.step(&mut memory, u, TIME_STEP_S));
                }
            })
        });
    });
    report("dynamic", best, DYNAMIC_BAR_NS);
    group.finish();
}

/// How a sample of the dynamic model grows with the levels.
fn growth(c: &mut Criterion) {
    let volts = voltages();
    let mut group = c.benchmark_group("sample over levels");
    group.throughput(Throughput::Elements(volts.len() as u64));
    for levels in [20, 40, 80, 160] {
        let Ok((_, dynamic)) = models(levels) else { return };
        let (mut memory, _) = dynamic.start(65.0, StartState::Rest);
        group.bench_function(BenchmarkId::from_parameter(levels), |b| {
            b.iter(|| {
                for &u in &volts {
                    black_box(dynamic.step(&mut memory, black_box(u), TIME_STEP_S));
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, samples, actuators, batches, growth);
criterion_main!(benches);
