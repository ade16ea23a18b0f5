//! Time elements on the flap equation against harmonic balance (24 harmonics).
#![expect(clippy::disallowed_methods, reason = "tests read reference tables")]
#![expect(clippy::unwrap_used, reason = "a test may fail by unwrapping")]

use crate::common;

use std::path::Path;

use approx::assert_abs_diff_eq;
use common::flap_equation;
use rotor_fem::{Orbit, PeriodicSettings, PeriodicSolver, TimeElements};

/// Mean and harmonics 1 to 6, degrees, of a row of the reference table: `[harmonic][cos, sin]`.
fn reference(row: &str) -> Vec<[f64; 2]> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures/reference/rotor/timefe_flap_reference.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let line = text.lines().find(|line| line.starts_with(row)).unwrap();
    let values: Vec<f64> = line.split(',').skip(1).map(|v| v.parse().unwrap()).collect();
    let mut out = vec![[values[0], 0.0]];
    out.extend(values[1..].chunks(2).map(|pair| [pair[0], pair[1]]));
    out
}

/// The same from time elements, with the residual norm and the number of iterations.
fn computed(elements: usize, order: usize, gauss: usize) -> (Vec<[f64; 2]>, f64, usize) {
    let time = TimeElements::new(elements, order, gauss).unwrap();
    let mut solver = PeriodicSolver::new(time.clone(), PeriodicSettings::default()).unwrap();
    let solution = solver.solve(&flap_equation(), &Orbit::zero(&time, 1)).unwrap();
    let series = solution.orbit.harmonics(&time, 0, 6);
    let mut out = vec![[series.mean, 0.0]];
    out.extend(series.harmonics.iter().map(|h| [h.cosine, h.sine]));
    (out, solution.residual_norm, solution.iterations)
}

/// Largest error of the harmonics in `range`, degrees.
fn error(got: &[[f64; 2]], range: std::ops::RangeInclusive<usize>) -> f64 {
    let truth = reference("harmonic_balance");
    range.flat_map(|n| [0, 1].map(|k| (got[n][k] - truth[n][k]).abs())).fold(0.0, f64::max)
}

#[test]
fn the_default_mesh_meets_harmonic_balance() {
    let (got, residual, iterations) = computed(8, 5, 8);
    let (low, sixth) = (error(&got, 0..=5), error(&got, 6..=6));
    println!("to 5/rev {low:.2e} deg, 6/rev {sixth:.2e} deg, residual {residual:.1e}");
    assert!(low <= 4e-8, "{low:e}");
    assert!(sixth <= 2e-7, "{sixth:e}");
    assert!(residual <= 1e-11);
    // the tangent of a linear system is exact
    assert_eq!(iterations, 1);
}

/// An independent program with the same elements made the same errors: the elements are those meant,
/// not merely others that are also accurate. The table prints ten decimals.
#[test]
fn the_discretisation_error_itself_is_the_one_of_the_table() {
    for (elements, row) in [(4, "timeFE_p5_ne4"), (6, "timeFE_p5_ne6"), (8, "timeFE_p5_ne8")] {
        let got = computed(elements, 5, 8).0;
        for (ours, theirs) in got.iter().zip(reference(row)) {
            for k in 0..2 {
                assert_abs_diff_eq!(ours[k], theirs[k], epsilon = 7e-11);
            }
        }
    }
}

/// Elements of fifth order: the least-squares slope over 4 to 10 elements is steeper than the 2 p = 10
/// a functional of the solution is owed, and each refinement pays.
#[test]
fn more_elements_help_and_less_order_or_quadrature_hurts() {
    let all = |e, p, g| error(&computed(e, p, g).0, 0..=6);
    let counts = [4, 6, 8, 10];
    let errors = counts.map(|e| all(e, 5, 8));
    println!("4, 6, 8, 10 elements: {errors:?} deg");
    assert!(errors.windows(2).all(|pair| pair[1] < 0.5 * pair[0]), "{errors:?}");
    let logs: Vec<(f64, f64)> =
        counts.iter().zip(errors).map(|(e, err)| ((*e as f64).ln(), err.ln())).collect();
    let mean = |f: fn(&(f64, f64)) -> f64| logs.iter().map(f).sum::<f64>() / 4.0;
    let (mx, my) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    let order = -covariance / logs.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>();
    println!("order of the harmonics: {order:.2}");
    assert!((9.5..13.0).contains(&order), "{order}");

    let (cubic, quartic, fewer) = (all(8, 3, 8), all(8, 4, 8), all(8, 5, 5));
    println!("order 3: {cubic:.1e}, order 4: {quartic:.1e}, 5 Gauss points: {fewer:.1e} deg");
    assert!(cubic > 10.0 * quartic && quartic > 10.0 * errors[2]);
    assert!(fewer > 10.0 * errors[2]);
}
