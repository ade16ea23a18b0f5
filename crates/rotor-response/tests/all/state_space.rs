//! The matrices of state space against Floquet's exponents, the shift of multiblade coordinates and the loads of the
//! linearised rotor.

#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use crate::common::{paper_blade, paper_flaps, paper_model};
use nalgebra::{Complex, DMatrix, DVector};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::{
    BladeStateSpace, BladesTogether, Condition, Controls, Couplings, Discretisation, InflowState,
    MultibladeStateSpace, ResponseTolerances, Rotor, RotorModel, RotorSolution, RotorSolver,
    SectionLags,
};
use rotor_wake::{FlightState, LinearInflow};
use std::f64::consts::TAU;
use std::sync::Arc;

const BLADES: usize = 4;
/// Highest harmonic of the balance.
const HIGHEST: i32 = 12;
type Matrix = DMatrix<Complex<f64>>;

fn solved(model: RotorModel, advance_ratio: f64) -> (RotorSolver, Condition, RotorSolution) {
    let discretisation = Discretisation { modes: [2, 1, 1], ..Discretisation::default() };
    let rotor = Rotor::new(model, &paper_blade(), discretisation).unwrap();
    let tolerances = ResponseTolerances { linear: 1e-10, ..ResponseTolerances::default() };
    let mut solver = RotorSolver::new(Arc::new(rotor), advance_ratio, tolerances).unwrap();
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio, shaft_tilt_rad: 0.1 * advance_ratio },
        controls: Controls {
            theta0_rad: 0.14,
            theta1c_rad: 0.1 * advance_ratio,
            theta1s_rad: -0.3 * advance_ratio,
        },
        flap_angles_rad: vec![HarmonicSeries::zero(0); 2],
    };
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.03 };
    let solution = solver.solve(&condition, &inflow, None).unwrap();
    (solver, condition, solution)
}

fn quasi_steady() -> RotorModel {
    RotorModel { flaps: paper_flaps(), ..paper_model(Couplings::Full) }
}

fn mean(matrices: &[DMatrix<f64>], weights: &[f64]) -> DMatrix<f64> {
    let zero = matrices[0].map(|_| 0.0);
    matrices.iter().zip(weights).fold(zero, |sum, (matrix, weight)| sum + matrix * *weight)
}

/// The largest distance of exponents from the expected ones, each matched once.
fn unmatched(found: &DVector<Complex<f64>>, expected: &[Complex<f64>]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let mut left: Vec<Complex<f64>> = found.iter().copied().collect();
    let mut worst = 0.0_f64;
    for one in expected {
        let nearest = (0..left.len())
            .min_by(|&a, &b| (left[a] - one).norm().total_cmp(&(left[b] - one).norm()))
            .unwrap();
        worst = worst.max((left.swap_remove(nearest) - one).norm());
    }
    worst
}

/// Cosine and sine of the hub loads at the blade number per rev for a cosine of a flap, by the product.
fn by_the_product(
    (solver, condition, solution): &mut (RotorSolver, Condition, RotorSolution),
    (flap, n): (usize, usize),
) -> [f64; 12] {
    let mut direction = vec![HarmonicSeries::zero(0); 2];
    direction[flap].set_harmonic(n, Harmonic { cosine: 1.0, sine: 0.0 });
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.03 };
    let at = (&*condition, &*solution);
    let found = solver.linearised(at, &inflow, &[direction], InflowState::Frozen).unwrap();
    found.sensitivities[0].hub.harmonic(BLADES)
}

/// Angle, rate and acceleration of `e^(i n psi)`.
fn motion(n: i32) -> [Complex<f64>; 3] {
    let rate = Complex::new(0.0, f64::from(n));
    [Complex::new(1.0, 0.0), rate, rate * rate]
}

/// Coefficient `k` of the Fourier series of a matrix over the azimuth.
fn harmonic(space: &BladeStateSpace, matrices: &[DMatrix<f64>], k: i32) -> Matrix {
    let zero = matrices[0].map(|_| Complex::new(0.0, 0.0));
    let places = space.azimuths_rad.iter().zip(&space.weights).zip(matrices);
    places.fold(zero, |sum, ((psi, weight), matrix)| {
        let wave = Complex::from_polar(*weight, -f64::from(k) * psi);
        sum + matrix.map(|value| wave * value)
    })
}

/// The same loads by harmonic balance of the periodic blade, highest harmonic held.
fn by_balance(space: &BladeStateSpace, (flap, n): (usize, i32), highest: i32) -> [f64; 12] {
    let states = space.a[0].nrows();
    let count = (2 * highest + 1).unsigned_abs() as usize;
    let place = |k: i32| (k + highest).unsigned_abs() as usize * states;
    let mut left = Matrix::zeros(count * states, count * states);
    let mut right = DVector::zeros(count * states);
    let half = Complex::new(0.5, 0.0);
    let input = |m: i32| DVector::from_iterator(3, motion(m).map(|u| u * half));
    for k in -highest..=highest {
        for m in -highest..=highest {
            let mut block = -harmonic(space, &space.a, k - m);
            if k == m {
                block += Matrix::identity(states, states) * Complex::new(0.0, f64::from(k));
            }
            left.view_mut((place(k), place(m)), (states, states)).copy_from(&block);
        }
        for m in [-n, n] {
            let own = harmonic(space, &space.b, k - m).columns(3 * flap, 3) * input(m);
            let mut rows = right.rows_mut(place(k), states);
            rows += own;
        }
    }
    let x = left.lu().solve(&right).unwrap();
    let blades = i32::try_from(BLADES).unwrap();
    let mut y = DVector::zeros(6);
    for m in -highest..=highest {
        y += harmonic(space, &space.c, blades - m) * x.rows(place(m), states);
    }
    for m in [-n, n] {
        y += harmonic(space, &space.d, blades - m).columns(3 * flap, 3) * input(m);
    }
    parts(&(y * Complex::new(BLADES as f64, 0.0)))
}

/// Cosine and sine of each load of `y e^(i n psi)` and its conjugate.
fn parts(y: &DVector<Complex<f64>>) -> [f64; 12] {
    std::array::from_fn(|k| if k % 2 == 0 { 2.0 * y[k / 2].re } else { -2.0 * y[k / 2].im })
}

fn relative_difference(found: [f64; 12], expected: [f64; 12]) -> f64 {
    let norm = |z: &[f64]| z.iter().map(|v| v * v).sum::<f64>().sqrt();
    let off: Vec<f64> = found.iter().zip(expected).map(|(a, b)| a - b).collect();
    norm(&off) / norm(&expected)
}

/// In hover nothing changes with the azimuth. The exponents of the blade are Floquet's; in multiblade coordinates they are
/// those, shifted by 1/rev to either side in the cyclic ones.
#[test]
fn in_hover_multiblade_exponents_are_those_of_the_blade_shifted_by_one_per_rev() {
    let (solver, condition, solution) = solved(quasi_steady(), 0.0);
    let space = solver.state_space(&condition, &solution).unwrap();
    let one = mean(&space.a, &space.weights);
    let varies = space.a.iter().map(|a| (a - &one).amax()).fold(0.0, f64::max) / one.amax();
    println!("A varies by {varies:.1e} over the azimuth");
    assert!(varies < 1e-7, "{varies}");
    let blade = one.complex_eigenvalues();
    let stability = solver.stability_with(&condition, &solution, SectionLags::Settled).unwrap();
    for motion in &stability.motions {
        let multiplier = motion.multiplier;
        let near = blade.iter().map(|s| ((s * TAU).exp() - multiplier).norm());
        assert!(near.fold(f64::INFINITY, f64::min) < 1e-4 * multiplier.norm(), "{motion:?}");
    }
    let shifted = |shifts: &[f64]| -> Vec<Complex<f64>> {
        shifts.iter().flat_map(|&n| blade.iter().map(move |s| s + Complex::new(0.0, n))).collect()
    };
    // the same blade on hubs of other numbers of blades
    let hubs: [&[f64]; 4] = [
        &[0.0, 1.0, -1.0],
        &[0.0, 0.0, 1.0, -1.0],
        &[0.0, 1.0, -1.0, 2.0, -2.0],
        &[0.0, 0.0, 1.0, -1.0, 2.0, -2.0],
    ];
    for shifts in hubs {
        let together = BladeStateSpace { blades: shifts.len(), ..space.clone() }.multiblade();
        let found = together.a.complex_eigenvalues();
        let off = unmatched(&found, &shifted(shifts));
        println!("{} blades: multiblade exponents differ by {off:.1e} per rad", shifts.len());
        assert!(off < 1e-6, "{off}");
        // without the shift they do not fit
        assert!(unmatched(&found, &shifted(&vec![0.0; shifts.len()])) > 0.3);
    }
}

/// Response of the constant system to a cosine of a flap at 3, 4 or 5 per rev of every blade, at 4 per rev.
///
/// ```text
/// exp(i (4 +- 1) psi_b) = exp(4 i psi) ( cos psi_b +- i sin psi_b ),      4 psi_b = 4 psi up to whole turns
/// ```
fn of_constant_system(system: &MultibladeStateSpace, (flap, n): (usize, i32)) -> [f64; 12] {
    let complex = |matrix: &DMatrix<f64>| matrix.map(|value| Complex::new(value, 0.0));
    let (states, inputs) = system.b.shape();
    let mut input = DVector::zeros(inputs);
    for (k, coordinate) in system.coordinates.iter().enumerate() {
        let amplitude = match (coordinate, n - 4) {
            (BladesTogether::Collective, 0) | (BladesTogether::Cosine(1), -1 | 1) => {
                Complex::new(0.5, 0.0)
            }
            (BladesTogether::Sine(1), side @ (-1 | 1)) => Complex::new(0.0, 0.5 * f64::from(side)),
            _ => Complex::new(0.0, 0.0),
        };
        let first = k * inputs / system.coordinates.len() + 3 * flap;
        for (part, value) in motion(4).into_iter().enumerate() {
            input[first + part] = amplitude * value;
        }
    }
    let turning = Matrix::identity(states, states) * Complex::new(0.0, 4.0);
    let b = complex(&system.b) * &input;
    let x = (turning - complex(&system.a)).lu().solve(&b).unwrap();
    parts(&(complex(&system.c) * x + complex(&system.d) * input))
}

#[test]
fn in_hover_the_constant_system_answers_as_the_linearised_rotor_does() {
    let mut case = solved(quasi_steady(), 0.0);
    let together = case.0.state_space(&case.1, &case.2).unwrap().multiblade();
    assert_eq!(together.coordinates[3], BladesTogether::Differential);
    for (flap, n) in [(0, 3), (0, 4), (1, 4), (1, 5)] {
        let expected = by_the_product(&mut case, (flap, n));
        let order = i32::try_from(n).unwrap();
        let off = relative_difference(of_constant_system(&together, (flap, order)), expected);
        println!("flap {flap}, {n}/rev: constant system in hover {off:.1e}");
        assert!(off < 1e-3, "{off}");
    }
}

#[test]
fn in_flight_the_periodic_blade_answers_as_the_linearised_rotor_does() {
    let mut case = solved(quasi_steady(), 0.3);
    let space = case.0.state_space(&case.1, &case.2).unwrap();
    for (flap, n) in [(0, 2), (0, 3), (1, 4), (1, 5)] {
        let expected = by_the_product(&mut case, (flap, n));
        let order = i32::try_from(n).unwrap();
        let off = relative_difference(by_balance(&space, (flap, order), HIGHEST), expected);
        // what the harmonics of the coefficients carry: none in a blade whose coefficients are their means
        let held = BladeStateSpace {
            a: vec![mean(&space.a, &space.weights); space.a.len()],
            ..space.clone()
        };
        let without = relative_difference(by_balance(&held, (flap, order), HIGHEST), expected);
        println!("flap {flap}, {n}/rev: periodic blade {off:.1e}, with mean A {without:.1e}");
        assert!(off < 1e-3, "{off}");
        assert!(without > 3e-3, "{without}");
    }
}

/// In flight the constant system drops what the harmonics of the coefficients carry.
#[test]
fn in_flight_the_constant_system_is_told_from_the_periodic_one() {
    let mut case = solved(quasi_steady(), 0.3);
    let together = case.0.state_space(&case.1, &case.2).unwrap().multiblade();
    for n in [3, 4, 5] {
        let expected = by_the_product(&mut case, (1, n));
        let order = i32::try_from(n).unwrap();
        let off = relative_difference(of_constant_system(&together, (1, order)), expected);
        println!("constant system at an advance ratio of 0.3: {off:.2} at {n}/rev");
        assert!(off > 0.01, "{off}");
    }
}

/// What settled lags leave out of the response of unsteady sections.
#[test]
fn settled_lags_are_told_from_moving_ones() {
    let mut case = solved(RotorModel::paper_case(), 0.3);
    let space = case.0.state_space(&case.1, &case.2).unwrap();
    let expected = by_the_product(&mut case, (0, 3));
    let off = relative_difference(by_balance(&space, (0, 3), HIGHEST), expected);
    println!("unsteady sections: settled lags change the response at 3/rev by {off:.2}");
    assert!(off > 0.02 && off < 1.0, "{off}");
}
