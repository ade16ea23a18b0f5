//! One coupled trim of the paper's rotor in its free wake: level flight at an advance ratio of 0.30, default wake,
//! default discretisation, from nothing, on two cores.
//!
//! Budget: 10 s.

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

const BUDGET_S: f64 = 10.0;
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
    let Ok(two_cores) = rayon::ThreadPoolBuilder::new().num_threads(2).build() else { return };
    let settings = WakeTrimSettings::default();
    let mut run = || black_box(two_cores.install(|| coupled(&settings)));
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let started = Instant::now();
        match run() {
            Ok(wake) if wake.outcome == WakeOutcome::Settled => {}
            Ok(wake) => return println!("not settled: {:?}", wake.outcome),
            Err(error) => return println!("no trim: {error}"),
        }
        best = best.min(started.elapsed().as_secs_f64());
    }
    println!(
        "coupled trim in the free wake: {best:.2} s on two cores, ratio to budget {:.2}",
        best / BUDGET_S
    );
    criterion.bench_function("free_wake_trim", |b| b.iter(&mut run));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).warm_up_time(Duration::from_millis(1)).measurement_time(Duration::from_secs(30));
    targets = bench
}
criterion_main!(benches);
