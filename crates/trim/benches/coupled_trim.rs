//! One coupled trim of the paper's rotor: level flight at an advance ratio of 0.30, Drees's inflow, default
//! discretisation, from nothing, on one core and on two.
//!
//! Budget: 0.08 s by the clock, on two cores.

use criterion::{Criterion, criterion_group, criterion_main};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{Discretisation, ResponseTolerances, Rotor, RotorModel, RotorSolver};
use rotor_wake::LinearInflow;
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};
use trim::{TrimError, TrimSettings, TrimSolution, TrimTarget, Vehicle, trim};

/// That of `hhc`.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const BUDGET_S: f64 = 0.08;
const MU: f64 = 0.3;

fn rotor() -> Result<Arc<Rotor>, TrimError> {
    let blade = BladeProperties::new(BladeSpec::table_1());
    let blade = blade.map_err(rotor_response::ResponseError::from)?;
    Ok(Arc::new(Rotor::new(RotorModel::paper_case(), &blade, Discretisation::default())?))
}

/// The section aerodynamics of the flight condition and the trim.
fn coupled_trim(rotor: &Arc<Rotor>) -> Result<TrimSolution, TrimError> {
    let mut solver = RotorSolver::new(Arc::clone(rotor), MU, ResponseTolerances::default())?;
    let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
    trim(&mut solver, &LinearInflow::Drees, MU, &target, &TrimSettings::default(), None)
}

#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn bench(criterion: &mut Criterion) {
    let Ok(rotor) = rotor() else { return };
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let Ok(pool) = pool else { return };
        let mut run = || black_box(pool.install(|| coupled_trim(&rotor)));
        if let Err(error) = run() {
            return println!("no trim: {error}");
        }
        let (started, count) = (Instant::now(), 5);
        for _ in 0..count {
            let _ = run();
        }
        let each = started.elapsed().as_secs_f64() / f64::from(count);
        let ratio = each / BUDGET_S;
        println!(
            "coupled trim: {:.0} ms, threads {threads}, ratio to budget {ratio:.2}",
            1e3 * each
        );
        criterion.bench_function(&format!("coupled_trim/{threads}"), |b| b.iter(&mut run));
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(5));
    targets = bench
}
criterion_main!(benches);
