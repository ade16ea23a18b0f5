//! The whole chain against an independent model of the same physics (Fourier collocation, exact mode
//! shapes): `fixtures/reference/rotor/crosscheck_S1_S2.json`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::disallowed_methods, reason = "tests read reference tables")]

mod common;

use common::{paper_blade, paper_model};
use rotor_base::HarmonicSeries;
use rotor_fem::{TorsionTerms, TwistAngle, Untwist};
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

/// The couplings are what separates the two cases: neither passes for the other.
#[test]
fn the_couplings_are_seen_by_the_bound() {
    let reference = reference("S2_full_fixed");
    let linear = solve(Couplings::Linear, Discretisation::paper());
    let z4 = distance(&linear.hub.harmonic(4), &reference.z4) / norm(&reference.z4);
    assert!(z4 > 0.5, "linear couplings differ by {z4:e} only");
}

/// Distance of the 4/rev vector and of its vertical force, and the largest error of a mode.
#[expect(clippy::print_stdout, reason = "the comparison, mode by mode, is what a reader wants")]
fn moderate_distance(torsion: TorsionTerms) -> [f64; 3] {
    let reference = reference("S2_full_fixed");
    let solution = solve(Couplings::Moderate(torsion), Discretisation::paper());
    let z4 = solution.hub.harmonic(4);
    println!("{torsion:?}");
    for (name, k) in ["FX", "FY", "FZ", "MX", "MY", "MZ"].iter().zip((0..).step_by(2)) {
        let (got, want) = (&z4[k..k + 2], &reference.z4[k..k + 2]);
        println!("{name} {:12.4e} {:12.4e}   {:12.4e} {:12.4e}", got[0], got[1], want[0], want[1]);
    }
    let modes: Vec<f64> = solution
        .modal
        .iter()
        .zip(&reference.modal)
        .map(|(got, want)| modal_error(got, want))
        .collect();
    let result = [
        distance(&z4, &reference.z4) / norm(&reference.z4),
        distance(&z4[4..6], &reference.z4[4..6]) / norm(&reference.z4[4..6]),
        modes.iter().copied().fold(0.0, f64::max),
    ];
    println!("4/rev vector, vertical force, worst mode {result:.4?}; modes {modes:.4?}");
    result
}

/// Moderate deflections keep third-order terms that the reference leaves out (3.3 % of the vector, 13 %
/// of the vertical force by its own account): 5 % and 15 %. Two terms of second order are not in it and
/// have to go for the comparison; each is seen when it comes back.
#[test]
fn moderate_deflections_with_fixed_controls() {
    let none = TorsionTerms { untwist: Untwist::Neglected, angle: TwistAngle::Elastic };
    let [vector, vertical, mode] = moderate_distance(none);
    assert!(vector <= 0.05 && vertical <= 0.15, "{vector} {vertical}");
    assert!(mode <= 0.02, "worst mode off by {mode}");
    let turning = TorsionTerms { angle: TwistAngle::Rotation, ..none };
    let [with_turning, _, _] = moderate_distance(turning);
    let untwisted = TorsionTerms { untwist: Untwist::Included, ..none };
    let [with_untwist, _, _] = moderate_distance(untwisted);
    let [whole, _, _] = moderate_distance(TorsionTerms::default());
    assert!(with_turning > 1.2 * vector && with_untwist > 2.0 * vector);
    assert!((0.10..0.15).contains(&whole), "{whole}");
}
