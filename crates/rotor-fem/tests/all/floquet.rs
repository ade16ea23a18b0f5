//! Floquet exponents against closed forms and against direct integration of the same equation.
#![expect(clippy::unwrap_used, reason = "a test may fail by unwrapping")]

use crate::common;
use crate::linear;

use std::f64::consts::TAU;

use approx::assert_abs_diff_eq;
use common::{flap_equation, flap_stability_coefficients};
use linear::{LinearCoefficients, LinearPeriodic};
use nalgebra::{DMatrix, DVector};
use rotor_fem::{FemError, Floquet, LocalTangent, Orbit, PeriodicSystem, TimeElements};

fn floquet<S: PeriodicSystem>(system: &S, time: &TimeElements) -> Floquet {
    let orbit = Orbit::zero(time, system.dof()).sample(time);
    Floquet::of(time, system.mass(), &system.tangents(&orbit).unwrap(), &[]).unwrap()
}

/// Multipliers of the flap equation by the classical Runge-Kutta method with many steps: trace and
/// determinant of the monodromy matrix.
fn integrated(steps: usize) -> [f64; 2] {
    let rate = |psi: f64, [x, v]: [f64; 2]| {
        let [damping, stiffness] = flap_stability_coefficients(psi);
        [v, -damping * v - stiffness * x]
    };
    let h = TAU / steps as f64;
    let shift = |[x, v]: [f64; 2], [a, b]: [f64; 2], s: f64| [x + s * a, v + s * b];
    let carry = |mut y: [f64; 2]| {
        for i in 0..steps {
            let psi = h * i as f64;
            let k1 = rate(psi, y);
            let k2 = rate(psi + 0.5 * h, shift(y, k1, 0.5 * h));
            let k3 = rate(psi + 0.5 * h, shift(y, k2, 0.5 * h));
            let k4 = rate(psi + h, shift(y, k3, h));
            for (k, s) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
                y = shift(y, k, s * h / 6.0);
            }
        }
        y
    };
    let (a, b) = (carry([1.0, 0.0]), carry([0.0, 1.0]));
    [a[0] + b[1], a[0] * b[1] - a[1] * b[0]]
}

/// Growth (per rad) and frequency (per rev) of a complex pair of that trace and determinant.
fn exponent([trace, determinant]: [f64; 2]) -> [f64; 2] {
    let imaginary = (determinant - 0.25 * trace * trace).sqrt();
    [determinant.ln() / (2.0 * TAU), imaginary.atan2(0.5 * trace) / TAU]
}

#[test]
fn the_flap_equation_meets_direct_integration() {
    let truth = exponent(integrated(20_000));
    let coarse = exponent(integrated(10_000));
    assert!((truth[0] - coarse[0]).abs() < 1e-12, "the truth itself has converged");
    // by Liouville's theorem the growths add up to the mean damping, -g/8
    assert_abs_diff_eq!(truth[0], -5.2 / 16.0, epsilon = 1e-12);
    let mode = floquet(&flap_equation(), &TimeElements::default()).modes[0];
    let errors = [mode.growth_per_rad - truth[0], mode.frequency_per_rev - truth[1]];
    println!("growth {}, frequency {}: errors {errors:?}", truth[0], truth[1]);
    assert!(errors.iter().all(|e| e.abs() < 1e-8), "{errors:?}");
    // the periodic terms matter: without them the frequency is that of the mean equation
    let mean = (1.125_789_21_f64.powi(2) - (5.2_f64 / 16.0).powi(2)).sqrt();
    assert!((truth[1] - (mean - 1.0)).abs() > 5e-3);
}

/// More time elements bring the interpolated coefficients to the true ones.
#[test]
fn the_error_falls_with_the_time_elements() {
    let truth = exponent(integrated(20_000))[1];
    let error = |elements| {
        let time = TimeElements::new(elements, 3, 3).unwrap();
        (floquet(&flap_equation(), &time).modes[0].frequency_per_rev - truth).abs()
    };
    let errors = [4, 8, 16].map(error);
    println!("{errors:?}");
    assert!(errors[0] > 6.0 * errors[1] && errors[1] > 6.0 * errors[2], "{errors:?}");
}

/// Damped oscillators with constant coefficients: exponents in closed form, the fast one too.
#[test]
fn oscillators_keep_their_damping_and_frequency() {
    let (omega, zeta) = ([0.7, 4.588, 20.656], [0.02, 0.005, 0.0]);
    let system = LinearPeriodic::new(DMatrix::identity(3, 3) * 2.0, |_| LinearCoefficients {
        damping: DMatrix::from_fn(3, 3, |i, j| if i == j { 4.0 * zeta[i] * omega[i] } else { 0.0 }),
        stiffness: DMatrix::from_fn(
            3,
            3,
            |i, j| {
                if i == j { 2.0 * omega[i] * omega[i] } else { 0.0 }
            },
        ),
        load: DVector::zeros(3),
    });
    let result = floquet(&system, &TimeElements::default());
    assert_eq!(result.modes.len(), 3);
    for mode in &result.modes {
        let (w, z) = (omega[mode.leading_dof], zeta[mode.leading_dof]);
        let frequency = w * (1.0 - z * z).sqrt();
        let folded = (frequency - frequency.round()).abs();
        assert_abs_diff_eq!(mode.growth_per_rad, -z * w, epsilon = 1e-8);
        assert_abs_diff_eq!(mode.frequency_per_rev, folded, epsilon = 1e-6);
    }
    assert_abs_diff_eq!(result.modes[0].growth_per_rad, 0.0, epsilon = 1e-12);
}

/// Mathieu's equation inside its first tongue grows: at `x'' + (1/4 + 2 e cos psi) x = 0` by e per rad
/// in first order.
#[test]
fn a_parametric_resonance_is_seen() {
    let strength = 0.01;
    let system = LinearPeriodic::new(DMatrix::identity(1, 1), |psi: f64| LinearCoefficients {
        damping: DMatrix::zeros(1, 1),
        stiffness: DMatrix::from_element(1, 1, 0.25 + 2.0 * strength * psi.cos()),
        load: DVector::zeros(1),
    });
    let result = floquet(&system, &TimeElements::default());
    let growth = result.modes[0].growth_per_rad;
    assert_abs_diff_eq!(growth, strength, epsilon = 0.02 * strength);
    assert_abs_diff_eq!(result.monodromy.determinant(), 1.0, epsilon = 1e-10);
}

#[test]
fn tangents_that_do_not_fit_are_named() {
    let time = TimeElements::default();
    let mass = DMatrix::identity(1, 1);
    let few = vec![LocalTangent::zero(1); 3];
    let error = Floquet::of(&time, &mass, &few, &[]).unwrap_err();
    assert!(matches!(error, FemError::Tangents { found: 3, expected: 64, .. }), "{error}");
    let mut bad = vec![LocalTangent::zero(1); 64];
    bad[5].dq[(0, 0)] = f64::NAN;
    let error = Floquet::of(&time, &mass, &bad, &[]).unwrap_err();
    assert!(error.to_string().contains("point 5"), "{error}");
    let mut light = vec![LocalTangent::zero(1); 64];
    for tangent in &mut light {
        tangent.dqdd[(0, 0)] = -1.0;
    }
    let error = Floquet::of(&time, &mass, &light, &[]).unwrap_err();
    assert!(matches!(error, FemError::MassSingular { .. }), "{error}");
}
