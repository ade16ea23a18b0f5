//! What the linearised T costs, counted: the same on every machine.

use std::sync::Arc;

use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Condition, Discretisation, InflowState, ResponseTolerances, Rotor, RotorModel, RotorSolver,
};
use rotor_wake::LinearInflow;
use validation::{Check, Failure, row};

pub(crate) const ROWS: &[Check] = &[row(
    "V-STUDY-21",
    "T of two flaps at 2 to 5/rev, inflow settled: evaluations of the equations \
         over a revolution for the linearised one, over those of central \
         differences of .5 deg (each iteration and each inflow once)",
    "-",
)
.against("counts of the solver; its time is on the page on speed")
.at_most(0.25, work_of_t)];

/// Evaluations for the linearised T over those of the differences.
fn work_of_t() -> Result<f64, Failure> {
    let blade = BladeProperties::new(BladeSpec::table_1())?;
    let rotor = Rotor::new(RotorModel::paper_case(), &blade, Discretisation::paper())?;
    let condition = Condition {
        flap_angles_rad: vec![HarmonicSeries::zero(3); 2],
        ..crate::rotor::fixed_controls()
    };
    let mu = condition.flight.advance_ratio;
    let mut solver = RotorSolver::new(Arc::new(rotor), mu, ResponseTolerances::default())?;
    let rest = solver.solve(&condition, &LinearInflow::Drees, None)?;
    let directions: Vec<Vec<HarmonicSeries>> = (0..16)
        .map(|column| {
            let (harmonic, control) = (2 + column / 4, column % 4);
            let mut direction = vec![HarmonicSeries::zero(harmonic); 2];
            let (cosine, sine) = if control % 2 == 0 { (1.0, 0.0) } else { (0.0, 1.0) };
            direction[control / 2].set_harmonic(harmonic, Harmonic { cosine, sine });
            direction
        })
        .collect();
    let at = (&condition, &rest);
    let linear =
        solver.clone().linearised(at, &LinearInflow::Drees, &directions, InflowState::Settled)?;
    let mut evaluations = 0;
    for direction in &directions {
        for by in [0.5_f64.to_radians(), -0.5_f64.to_radians()] {
            let mut moved = condition.clone();
            for (angle, along) in moved.flap_angles_rad.iter_mut().zip(direction) {
                for n in 2..=along.harmonics.len() {
                    let Harmonic { cosine, sine } = along.harmonic(n);
                    angle.set_harmonic(n, Harmonic { cosine: by * cosine, sine: by * sine });
                }
            }
            let found = solver.clone().solve(&moved, &LinearInflow::Drees, Some(&rest))?;
            evaluations += found.residuals.response_iterations + found.residuals.inflow_iterations;
        }
    }
    Ok((linear.evaluations + linear.factorisations) as f64 / evaluations as f64)
}
