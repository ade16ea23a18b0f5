//! One relaxation sweep of the free wake.
//!
//! Budget: 0.1 s of processor time at 15 deg, 4 turns, tip vortex, 20 stations, four blades; the wake of
//! `OpenFAST` (OLAF) needs 2.1 s per revolution marched.
#![expect(clippy::print_stdout, reason = "the ratio to the budget is the bench's result")]
#![expect(clippy::unwrap_used, reason = "a bench whose inputs are refused cannot go on")]
#![expect(clippy::disallowed_methods, reason = "a bench reads the clock")]

use criterion::{Criterion, criterion_group, criterion_main};
use rotor_wake::{BladeLines, CirculationMap, FlightState, FreeWake, FreeWakeSettings, WakeRotor};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::{Duration, Instant};

const BUDGET_S: f64 = 0.1;
const PANELS: usize = 20;

fn sweep(criterion: &mut Criterion) {
    let rotor = WakeRotor::cosine(4, 0.2, PANELS).unwrap();
    let settings = FreeWakeSettings::default();
    let flight = FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.087 };
    let lines = BladeLines::flat(&rotor, settings.azimuths);
    let circulation =
        CirculationMap::constant(settings.azimuths, PANELS, TAU * 0.0049 / 4.0).unwrap();
    let wake = FreeWake::undistorted(rotor, settings, flight, 0.008, lines).unwrap();
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
    criterion.bench_function("sweep", |b| b.iter(&mut one));
    criterion.bench_function("line induction", |b| {
        b.iter(|| black_box(wake.line_induction(&circulation).unwrap()));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(2));
    targets = sweep
}
criterion_main!(benches);
