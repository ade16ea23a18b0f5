//! The T matrix of two flaps at 2 to 5/rev, the harmonics of control: linearised against central differences.
//!
//! Budget: a fifth of the time of the differences at the same settings (inflow settled anew, tolerances
//! of the default), the solutions of the differences in parallel. The columns of 3/rev alone are measured beside it: the
//! inflow's own column is then one of five, not of seventeen, and fewer columns help each other.

use criterion::{Criterion, criterion_group, criterion_main};
use flap_aero::AttachedFlowModel;
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Compressibility, Condition, Controls, Discretisation, FlapDirection, InflowState,
    ResponseError, ResponseTolerances, Rotor, RotorModel, RotorSolution, RotorSolver,
};
use rotor_wake::{FlightState, LinearInflow};
use std::hint::black_box;
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// That of `hhc`.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const BUDGET: f64 = 0.2;

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

fn condition() -> Condition {
    Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.1 },
        controls: Controls { theta0_rad: 0.145, theta1c_rad: 0.02, theta1s_rad: -0.08 },
        flap_angles_rad: vec![HarmonicSeries::zero(3); 2],
    }
}

/// Cosine and sine of each flap at some harmonics.
fn directions(harmonics: RangeInclusive<usize>) -> Vec<FlapDirection> {
    let of = |n: usize, flap: usize, (cosine, sine): (f64, f64)| {
        let mut direction = vec![HarmonicSeries::zero(n); 2];
        direction[flap].set_harmonic(n, Harmonic { cosine, sine });
        direction
    };
    harmonics
        .flat_map(|n| {
            [0, 1]
                .into_iter()
                .flat_map(move |flap| [of(n, flap, (1.0, 0.0)), of(n, flap, (0.0, 1.0))])
        })
        .collect()
}

fn by_differences(
    (solver, rest): (&RotorSolver, &RotorSolution),
    directions: &[FlapDirection],
) -> Result<f64, ResponseError> {
    let step = 0.5_f64.to_radians();
    let both = directions.iter().flat_map(|d| [(d, step), (d, -step)]);
    let all: Vec<(&FlapDirection, f64)> = both.collect();
    let loads = all
        .par_iter()
        .map(|(direction, by)| {
            let mut moved = condition();
            for (angle, along) in moved.flap_angles_rad.iter_mut().zip(direction.iter()) {
                for n in 1..=along.harmonics.len() {
                    let Harmonic { cosine, sine } = along.harmonic(n);
                    angle.set_harmonic(n, Harmonic { cosine: by * cosine, sine: by * sine });
                }
            }
            let found = solver.clone().solve(&moved, &LinearInflow::Drees, Some(rest))?;
            Ok(found.hub.harmonic(4)[4] / (2.0 * by))
        })
        .collect::<Result<Vec<f64>, ResponseError>>()?;
    Ok(loads.iter().sum())
}

fn linearised(
    (solver, rest): (&mut RotorSolver, &RotorSolution),
    directions: &[FlapDirection],
) -> Result<f64, ResponseError> {
    let at = (&condition(), rest);
    let found = solver.linearised(at, &LinearInflow::Drees, directions, InflowState::Settled)?;
    Ok(found.sensitivities.iter().map(|s| s.hub.harmonic(4)[4]).sum())
}

#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn t_matrix(criterion: &mut Criterion) {
    let built = solver(AttachedFlowModel::HariharanLeishman).and_then(|mut s| {
        let rest = s.solve(&condition(), &LinearInflow::Drees, None)?;
        Ok((s, rest))
    });
    let Ok((mut solver, rest)) = built else { return };
    for (name, all) in [("2 to 5/rev", directions(2..=5)), ("3/rev alone", directions(3..=3))] {
        let (mut slow, mut fast) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..10 {
            let started = Instant::now();
            let _ = black_box(by_differences((&solver, &rest), &all));
            slow = slow.min(started.elapsed().as_secs_f64());
            let started = Instant::now();
            let _ = black_box(linearised((&mut solver, &rest), &all));
            fast = fast.min(started.elapsed().as_secs_f64());
        }
        println!(
            "T at {name} by differences {:.1} ms, linearised {:.1} ms: ratio {:.3}, {:.2} of the budget",
            1e3 * slow,
            1e3 * fast,
            fast / slow,
            fast / slow / BUDGET
        );
    }
    let all = directions(2..=5);
    criterion.bench_function("T/differences", |b| {
        b.iter(|| black_box(by_differences((&solver, &rest), &all)));
    });
    criterion.bench_function("T/linearised", |b| {
        b.iter(|| black_box(linearised((&mut solver, &rest), &all)));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(3));
    targets = t_matrix
}
criterion_main!(benches);
