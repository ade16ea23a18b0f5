//! Memory taken by a residual of a revolution. Alone in its file: an allocator counts for the whole process. The thread that
//! waits for the test takes some once, at any moment: each solution is counted three times and the least is judged.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Condition, Controls, Discretisation, ResponseTolerances, Rotor, RotorModel, RotorSolver,
};
use rotor_wake::{FlightState, LinearInflow};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::sync::Arc;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Allocations of a chord step: orbit, samples, forces, residual, section loads, step and its mixing with those before.
const MOST: usize = 29;

/// Allocations of a long way to an orbit less those of a short one, and its chord steps more, on a blade of so many stations a
/// piece.
fn of_more_steps(span_points_per_piece: usize) -> (usize, usize) {
    let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
    let discretisation = Discretisation { span_points_per_piece, ..Discretisation::paper() };
    let rotor = Arc::new(Rotor::new(RotorModel::paper_case(), &blade, discretisation).unwrap());
    let solver = |periodicity: f64| {
        let tolerances = ResponseTolerances { periodicity, inflow: 1.0, ..Default::default() };
        RotorSolver::new(Arc::clone(&rotor), 0.3, tolerances).unwrap()
    };
    let condition = |amplitude_rad: f64| {
        let mut angle = HarmonicSeries::zero(3);
        angle.set_harmonic(3, Harmonic { cosine: amplitude_rad, sine: 0.0 });
        Condition {
            bank_rad: 0.0,
            flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.1 },
            controls: Controls { theta0_rad: 0.145, theta1c_rad: 0.02, theta1s_rad: -0.08 },
            flap_angles_rad: vec![angle.clone(), angle],
        }
    };
    let inflow = LinearInflow::Uniform;
    let mut warm = solver(1e-11);
    let rest = warm.solve(&condition(0.0), &inflow, None).unwrap();
    let counted = [1e-3, 1e-6].map(|periodicity| {
        let solved = [(); 3].map(|()| {
            let mut solver = solver(periodicity).with_matrix_of(&warm);
            let region = Region::new(ALLOCATOR);
            let found = solver.solve(&condition(0.05), &inflow, Some(&rest)).unwrap();
            let taken = region.change();
            assert_eq!(found.residuals.inflow_iterations, 1);
            (found.residuals.response_iterations, taken.allocations + taken.reallocations)
        });
        solved.into_iter().min().unwrap()
    });
    let [(few, of_few), (many, of_many)] = counted;
    (of_many - of_few, many - few)
}

#[test]
fn a_residual_takes_no_memory_for_each_station() {
    // on one thread: what hands work to others takes memory too
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let [few, many] = pool.install(|| [4, 16].map(of_more_steps));
    for (allocations, steps) in [few, many] {
        println!("{allocations} allocations in {steps} steps");
        assert!(steps >= 2 && allocations <= MOST * steps, "{allocations} in {steps}");
    }
    let [few, many] = [few, many].map(|(allocations, steps)| allocations / steps);
    assert_eq!(few, many, "whole ones in a step");
}
