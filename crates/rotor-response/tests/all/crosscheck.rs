//! The whole chain against an independent model of the same physics (Fourier collocation, exact mode
//! shapes): `fixtures/reference/rotor/crosscheck_S1_S2.json`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::disallowed_methods, reason = "tests read reference tables")]

use crate::common;

use common::{paper_blade, paper_model};
use rotor_base::HarmonicSeries;
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, ResponseTolerances, ReverseFlow, Rotor,
    RotorModel, RotorSolution, RotorSolver, SixLoads, hub_loads,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

struct Reference {
    modal: Vec<Vec<f64>>,
    mean: Vec<f64>,
    z4: Vec<f64>,
}

fn reference(case: &str) -> Reference {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/reference/rotor/crosscheck_S1_S2.json"
    );
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let numbers = |v: &serde_json::Value| -> Vec<f64> {
        v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
    };
    let case = &json[case];
    Reference {
        modal: case["modal_fourier_F1_4_L1_4_T1_2"]
            .as_array()
            .unwrap()
            .iter()
            .map(numbers)
            .collect(),
        mean: numbers(&case["hub_mean"]),
        z4: numbers(&case["hub_Z4"]),
    }
}

fn model(couplings: Couplings) -> RotorModel {
    RotorModel { root_cutout: 0.35, reverse_flow: ReverseFlow::Abrupt, ..paper_model(couplings) }
}

fn solve(couplings: Couplings, discretisation: Discretisation) -> RotorSolution {
    solve_with_statics(couplings, discretisation).0
}

/// The solution, and hub loads from the statics of the deflected blade, which is clamped at the centre.
fn solve_with_statics(
    couplings: Couplings,
    discretisation: Discretisation,
) -> (RotorSolution, SixLoads) {
    let rotor = Rotor::new(model(couplings), &paper_blade(), discretisation).unwrap();
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default()).unwrap();
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 5.0_f64.to_radians() },
        controls: Controls {
            theta0_rad: 8.0_f64.to_radians(),
            theta1c_rad: 1.0_f64.to_radians(),
            theta1s_rad: -4.0_f64.to_radians(),
        },
        flap_angles_rad: vec![],
    };
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.008 };
    let found = solver.solve(&condition, &inflow, None).unwrap();
    let root = solver.station_loads(&condition, &found, &[0.0]).unwrap().remove(0);
    let [fx, fy, fz] = root.forces.harmonics;
    let [mut flap, lag, torsion] = root.statics.harmonics;
    flap.mean *= -1.0;
    for h in &mut flap.harmonics {
        (h.cosine, h.sine) = (-h.cosine, -h.sine);
    }
    let blade = SixLoads { components: [fx, fy, fz, torsion, flap, lag] };
    (found, hub_loads(&vec![blade; 4], 12))
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(x, y)| x - y).collect::<Vec<_>>())
}

/// Largest error of the first `modes` modal harmonics 0..=5 relative to the mode's own size.
fn modal_error(solution: &HarmonicSeries, reference: &[f64]) -> f64 {
    let mut got = vec![solution.mean];
    for n in 1..=5 {
        got.extend([solution.harmonic(n).cosine, solution.harmonic(n).sine]);
    }
    distance(&got, reference) / norm(reference)
}

/// Bounds of one case: the 4/rev vector, the mean forces, the mean moments and every mode.
fn compare(case: &str, couplings: Couplings, discretisation: Discretisation, bound: f64) {
    let reference = reference(case);
    let (solution, statics) = solve_with_statics(couplings, discretisation);
    // the reference sums the loads of the deflected blade; the hub gets the reactions of the equations
    let hub = if couplings == Couplings::Full { &statics } else { &solution.hub };
    let z4 = distance(&hub.harmonic(4), &reference.z4) / norm(&reference.z4);
    assert!(z4 <= bound, "4/rev vector off by {z4:e}");
    let mean = hub.mean();
    let force = distance(&mean[..3], &reference.mean[..3]) / norm(&reference.mean[..3]);
    let moment = distance(&mean[3..], &reference.mean[3..]) / norm(&reference.mean[3..]);
    assert!(force <= bound && moment <= bound, "mean loads off by {force:e} and {moment:e}");
    for (k, (got, want)) in solution.modal.iter().zip(&reference.modal).enumerate() {
        let error = modal_error(got, want);
        assert!(error <= bound, "mode {k} off by {error:e}");
    }
    assert!(solution.residuals.periodicity <= 1e-11);
}

#[test]
fn linear_quasi_steady_rotor_with_fixed_controls() {
    compare("S1_linear_fixed", Couplings::Linear, Discretisation::paper(), 1e-3);
}

/// Mode shapes of more beam elements bring the chain closer: what is left is discretisation.
#[test]
fn linear_case_converges_with_the_beam_elements() {
    let fine = Discretisation {
        blade_elements: 20,
        span_points_per_piece: 5,
        time_elements: 10,
        ..Discretisation::paper()
    };
    compare("S1_linear_fixed", Couplings::Linear, fine, 6e-5);
}

#[test]
fn full_couplings_with_fixed_controls() {
    compare("S2_full_fixed", Couplings::Full, Discretisation::paper(), 1e-2);
    let fine = Discretisation {
        blade_elements: 40,
        span_points_per_piece: 4,
        time_elements: 10,
        ..Discretisation::paper()
    };
    compare("S2_full_fixed", Couplings::Full, fine, 1e-3);
}

/// What the hub gets is the reaction of the equations: off the statics, which the reference sums, by terms of
/// third order.
#[test]
fn reactions_of_the_equations_are_near_the_statics() {
    let reference = reference("S2_full_fixed");
    let found = solve(Couplings::Full, Discretisation::paper());
    let z4 = distance(&found.hub.harmonic(4), &reference.z4) / norm(&reference.z4);
    assert!(z4 > 2e-3 && z4 <= 1.5e-2, "{z4:e}");
}
