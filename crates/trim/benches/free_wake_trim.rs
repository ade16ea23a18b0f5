//! One coupled trim of the paper's rotor in its free wake: level flight at an advance ratio of 0.30, default wake,
//! default discretisation, from nothing, on one core and on two.
//!
//! Budget: 0.4 s by the clock, on two cores.

use criterion::{Criterion, criterion_group, criterion_main};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{Discretisation, ResponseTolerances, Rotor, RotorModel, RotorSolver};
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};
use trim::{
    TrimError, TrimSettings, TrimTarget, Vehicle, WakeOutcome, WakeTrim, WakeTrimSettings,
    trim_in_free_wake,
};

/// That of `hhc`.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const BUDGET_S: f64 = 0.4;
const MU: f64 = 0.3;

fn coupled(settings: &WakeTrimSettings) -> Result<WakeTrim, TrimError> {
    let blade = BladeProperties::new(BladeSpec::table_1());
    let blade = blade.map_err(rotor_response::ResponseError::from)?;
    let rotor = Rotor::new(RotorModel::paper_case(), &blade, Discretisation::default())?;
    let mut solver = RotorSolver::new(Arc::new(rotor), MU, ResponseTolerances::default())?;
    let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
    trim_in_free_wake(&mut solver, settings, MU, &target, &TrimSettings::default())
}

#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn bench(criterion: &mut Criterion) {
    let settings = WakeTrimSettings::default();
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let Ok(pool) = pool else { return };
        let mut run = || black_box(pool.install(|| coupled(&settings)));
        let started = Instant::now();
        match run() {
            Ok(wake) if wake.outcome == WakeOutcome::Settled => {}
            Ok(wake) => return println!("not settled: {:?}", wake.outcome),
            Err(error) => return println!("no trim: {error}"),
        }
        let first = started.elapsed().as_secs_f64();
        let ratio = first / BUDGET_S;
        println!(
            "trim in the free wake: {first:.2} s, threads {threads}, ratio to budget {ratio:.2}"
        );
        criterion.bench_function(&format!("trim in the free wake/{threads}"), |b| b.iter(&mut run));
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).warm_up_time(Duration::from_millis(1)).measurement_time(Duration::from_secs(5));
    targets = bench
}
criterion_main!(benches);
