//! One relaxation sweep of the free wake.
//!
//! Budget: 0.1 s of processor time at 15 deg, 4 turns, tip vortex, 20 stations, four blades; the wake of
//! `OpenFAST` (OLAF) needs 2.1 s per revolution marched.
#![expect(clippy::print_stdout, reason = "the ratio to the budget is the bench's result")]
#![expect(clippy::unwrap_used, reason = "a bench whose inputs are refused cannot go on")]
#![expect(clippy::disallowed_methods, reason = "a bench reads the clock")]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rotor_wake::{
    BladeLines, CirculationMap, FarField, FlightState, FreeWake, FreeWakeSettings, WakeRotor,
};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// That of `hhc`.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const BUDGET_S: f64 = 0.1;
const PANELS: usize = 20;

/// As trims in forward flight have them.
fn usual() -> FreeWakeSettings {
    FreeWakeSettings { far_field: FarField::Single, ..FreeWakeSettings::default() }
}

/// An undistorted wake and a circulation on its grid.
fn wake_of(settings: FreeWakeSettings) -> (FreeWake, CirculationMap) {
    let rotor = WakeRotor::cosine(4, 0.2, PANELS).unwrap();
    let flight = FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.087 };
    let lines = BladeLines::flat(&rotor, settings.azimuths);
    let circulation =
        CirculationMap::constant(settings.azimuths, PANELS, TAU * 0.0049 / 4.0).unwrap();
    (FreeWake::undistorted(rotor, settings, flight, 0.008, lines).unwrap(), circulation)
}

/// How a sweep on one thread and on two grows with the steps of azimuth and with the free turns.
fn growth(criterion: &mut Criterion) {
    for (threads, on) in [(1, ""), (2, ", 2 threads")] {
        growth_on(criterion, threads, on);
    }
}

fn growth_on(criterion: &mut Criterion, threads: usize, on: &str) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let azimuths = [12, 24, 36, 48].map(|n| (n, usual().with_azimuths(n)));
    let turns = [2, 4, 6, 8].map(|turns| (turns, FreeWakeSettings { turns, ..usual() }));
    for (name, wakes) in [("sweep over azimuths", azimuths), ("sweep over turns", turns)] {
        let mut group = criterion.benchmark_group(format!("{name}{on}"));
        for (size, settings) in wakes {
            let (wake, circulation) = wake_of(settings);
            group.bench_function(BenchmarkId::from_parameter(size), |b| {
                pool.install(|| b.iter(|| black_box(wake.clone().sweep(&circulation).unwrap())));
            });
        }
        group.finish();
    }
}

fn sweep(criterion: &mut Criterion) {
    let (wake, circulation) = wake_of(usual());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut one = || {
        let mut moved = wake.clone();
        black_box(moved.sweep(&circulation).unwrap());
    };
    let best = pool.install(|| {
        (0..20)
            .map(|_| {
                let start = Instant::now();
                one();
                start.elapsed().as_secs_f64()
            })
            .fold(f64::INFINITY, f64::min)
    });
    println!("sweep: {:.1} ms on one thread, ratio to budget {:.2}", 1e3 * best, best / BUDGET_S);
    criterion.bench_function("sweep", |b| pool.install(|| b.iter(&mut one)));
    // on the grid of a trim
    let (wake, circulation) = wake_of(usual().with_azimuths(36));
    criterion.bench_function("line induction", |b| {
        pool.install(|| b.iter(|| black_box(wake.line_induction(&circulation).unwrap())));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(2));
    targets = sweep, growth
}
criterion_main!(benches);
