//! The T matrix of two flaps at 3/rev: linearised against central differences.
//!
//! Budget: a fifth of the time of the differences at the same settings (inflow settled anew, tolerances
//! of the default), the eight solutions of the differences in parallel as the program makes them.

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
use std::sync::Arc;
use std::time::{Duration, Instant};

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

fn directions() -> Vec<FlapDirection> {
    (0..4)
        .map(|control| {
            let mut direction = vec![HarmonicSeries::zero(3); 2];
            let (cosine, sine) = if control % 2 == 0 { (1.0, 0.0) } else { (0.0, 1.0) };
            direction[control / 2].set_harmonic(3, Harmonic { cosine, sine });
            direction
        })
        .collect()
}

fn by_differences(solver: &RotorSolver, rest: &RotorSolution) -> Result<f64, ResponseError> {
    let step = 0.5_f64.to_radians();
    let both = directions().into_iter().flat_map(|d| [(d.clone(), step), (d, -step)]);
    let all: Vec<(FlapDirection, f64)> = both.collect();
    let loads = all
        .par_iter()
        .map(|(direction, by)| {
            let mut moved = condition();
            for (angle, along) in moved.flap_angles_rad.iter_mut().zip(direction) {
                let h = along.harmonic(3);
                angle.set_harmonic(3, Harmonic { cosine: by * h.cosine, sine: by * h.sine });
            }
            let found = solver.clone().solve(&moved, &LinearInflow::Drees, Some(rest))?;
            Ok(found.hub.harmonic(4)[4] / (2.0 * by))
        })
        .collect::<Result<Vec<f64>, ResponseError>>()?;
    Ok(loads.iter().sum())
}

fn linearised(solver: &mut RotorSolver, rest: &RotorSolution) -> Result<f64, ResponseError> {
    let at = (&condition(), rest);
    let found = solver.linearised(at, &LinearInflow::Drees, &directions(), InflowState::Settled)?;
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
    let (mut slow, mut fast) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..10 {
        let started = Instant::now();
        let _ = black_box(by_differences(&solver, &rest));
        slow = slow.min(started.elapsed().as_secs_f64());
        let started = Instant::now();
        let _ = black_box(linearised(&mut solver, &rest));
        fast = fast.min(started.elapsed().as_secs_f64());
    }
    println!(
        "T by differences {:.1} ms, linearised {:.1} ms: ratio {:.3}, {:.2} of the budget",
        1e3 * slow,
        1e3 * fast,
        fast / slow,
        fast / slow / BUDGET
    );
    criterion.bench_function("T/differences", |b| {
        b.iter(|| black_box(by_differences(&solver, &rest)));
    });
    criterion
        .bench_function("T/linearised", |b| b.iter(|| black_box(linearised(&mut solver, &rest))));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(3));
    targets = t_matrix
}
criterion_main!(benches);
