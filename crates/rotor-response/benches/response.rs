//! One periodic response of the paper rotor with moving flaps.
//!
//! Budget: 50 ms from a nearby orbit at the paper's discretisation on one core, so that a T matrix of
//! twelve columns costs less than a second. A new Newton matrix, which holds the memory of the lags of the sections
//! (quasi-steady ones have none), has the same budget: a trim from nothing makes a few. One residual of a revolution
//! has 0.8 ms, at the default discretisation.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use flap_aero::AttachedFlowModel;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Compressibility, Condition, Controls, Discretisation, ResponseError, ResponseTolerances, Rotor,
    RotorModel, RotorSolution, RotorSolver,
};
use rotor_wake::{FlightState, LinearInflow};
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// That of `hhc`.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const BUDGET_S: f64 = 0.05;
const RESIDUAL_BUDGET_S: f64 = 0.8e-3;

fn solver(section_model: AttachedFlowModel) -> Result<RotorSolver, ResponseError> {
    let blade = BladeProperties::new(BladeSpec::table_1())?;
    let paper = RotorModel::paper_case();
    let compressibility = match section_model {
        AttachedFlowModel::Incompressible => Compressibility::None,
        _ => paper.compressibility,
    };
    let model = RotorModel { section_model, compressibility, ..paper };
    let rotor = Rotor::new(model, &blade, Discretisation::paper())?;
    RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default())
}

fn condition(amplitude_rad: f64) -> Condition {
    let mut angle = HarmonicSeries::zero(3);
    angle.set_harmonic(3, Harmonic { cosine: amplitude_rad, sine: 0.0 });
    Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.1 },
        controls: Controls { theta0_rad: 0.145, theta1c_rad: 0.02, theta1s_rad: -0.08 },
        flap_angles_rad: vec![angle.clone(), angle],
    }
}

#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn response(criterion: &mut Criterion) {
    for model in [
        AttachedFlowModel::QuasiSteady,
        AttachedFlowModel::Incompressible,
        AttachedFlowModel::HariharanLeishman,
        AttachedFlowModel::Calibrated,
    ] {
        let built = solver(model).and_then(|mut s| {
            let rest = s.solve(&condition(0.0), &LinearInflow::Drees, None)?;
            Ok((s, rest))
        });
        let Ok((mut solver, rest)) = built else { continue };
        let moved = condition(0.05);
        let mut run = || black_box(solver.solve(&moved, &LinearInflow::Drees, Some(&rest)));
        let (started, count) = (Instant::now(), 10);
        for _ in 0..count {
            let _ = run();
        }
        let each = started.elapsed().as_secs_f64() / f64::from(count);
        println!("{model:?}: {:.1} ms, {:.2} of the budget", 1e3 * each, each / BUDGET_S);
        criterion.bench_function(&format!("response/{model:?}"), |b| b.iter(&mut run));
    }
}

/// What a new Newton matrix costs: a response with a solver that has none, less one with a solver that keeps its own.
#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn newton_matrix(criterion: &mut Criterion) {
    for model in [AttachedFlowModel::QuasiSteady, AttachedFlowModel::HariharanLeishman] {
        let built = solver(model).and_then(|fresh| {
            let mut kept = fresh.clone();
            let rest = kept.solve(&condition(0.0), &LinearInflow::Drees, None)?;
            Ok((fresh, kept, rest))
        });
        let Ok((fresh, kept, rest)) = built else { continue };
        let moved = condition(0.05);
        let run = |solver: &RotorSolver| {
            let mut solver = solver.clone();
            black_box(solver.solve(&moved, &LinearInflow::Drees, Some(&rest)))
        };
        let time = |solver: &RotorSolver| {
            let (started, count) = (Instant::now(), 10);
            let made: usize = (0..count)
                .map(|_| run(solver).map_or(0, |found| found.residuals.factorisations))
                .sum();
            (started.elapsed().as_secs_f64() / f64::from(count), made as f64 / f64::from(count))
        };
        let ((anew, matrices), (again, kept_matrices)) = (time(&fresh), time(&kept));
        let each = (anew - again) / (matrices - kept_matrices).max(1.0);
        println!(
            "{model:?}: a Newton matrix {:.1} ms, {:.2} of the budget ({matrices} against {kept_matrices} made)",
            1e3 * each,
            each / BUDGET_S
        );
        criterion.bench_function(&format!("newton_matrix/{model:?}"), |b| b.iter(|| run(&fresh)));
    }
}

/// One residual of a revolution, with the inputs of its points.
#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn residual(criterion: &mut Criterion) {
    let Ok(one_core) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return };
    let Ok((solver, rest)) = at_rest(Discretisation::default()) else { return };
    let moved = condition(0.05);
    let run = || black_box(solver.periodicity(&moved, &rest));
    let mut best = f64::INFINITY;
    for _ in 0..20 {
        let (started, count) = (Instant::now(), 20);
        one_core.install(|| (0..count).for_each(|_| drop(run())));
        best = best.min(started.elapsed().as_secs_f64() / f64::from(count));
    }
    println!("residual: {:.2} ms, {:.2} of the budget", 1e3 * best, best / RESIDUAL_BUDGET_S);
    criterion.bench_function("residual", |b| one_core.install(|| b.iter(run)));
    growth(criterion, &one_core, "residual over stations");
    if let Ok(two_cores) = rayon::ThreadPoolBuilder::new().num_threads(2).build() {
        growth(criterion, &two_cores, "residual over stations, 2 threads");
    }
}

/// How a residual grows with the stations.
fn growth(criterion: &mut Criterion, cores: &rayon::ThreadPool, name: &str) {
    let moved = condition(0.05);
    let mut group = criterion.benchmark_group(name);
    for span_points_per_piece in [2, 4, 6, 8] {
        let finer = Discretisation { span_points_per_piece, ..Discretisation::default() };
        let Ok((solver, rest)) = at_rest(finer) else { return };
        let stations = solver.rotor().blade().grid().len();
        let run = || black_box(solver.periodicity(&moved, &rest));
        group.bench_function(BenchmarkId::from_parameter(stations), |b| {
            cores.install(|| b.iter(run));
        });
    }
    group.finish();
}

/// The paper's rotor with flaps at rest.
fn at_rest(discretisation: Discretisation) -> Result<(RotorSolver, RotorSolution), ResponseError> {
    let blade = BladeProperties::new(BladeSpec::table_1())?;
    let rotor = Rotor::new(RotorModel::paper_case(), &blade, discretisation)?;
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default())?;
    let rest = solver.solve(&condition(0.0), &LinearInflow::Drees, None)?;
    Ok((solver, rest))
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(3));
    targets = residual, response, newton_matrix
}
criterion_main!(benches);
