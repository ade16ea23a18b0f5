//! Normal equations of the base model and their solution under its prior.

use crate::plays::{Plays, lagged, solve};
use crate::record::Record;
use nalgebra::{DMatrix, DVector};

/// Time constants of creep and relaxation, two per decade from 1 ms to 300 s, s.
pub(super) fn time_constants_s() -> Vec<f64> {
    (0..12).map(|i| 1e-3 * 10.0_f64.powf(0.5 * f64::from(i))).collect()
}

/// Prior standard deviation of the share of one time constant.
const SHARE: f64 = 0.1;
/// Amplitude of the density over the output's half range, and its length, to choose from.
pub(super) const PRIORS: [(f64, f64); 6] =
    [(0.3, 0.2), (1.0, 0.2), (3.0, 0.2), (0.3, 0.5), (1.0, 0.5), (3.0, 0.5)];
/// Slope of the reversible part over the output's half range per half range of the input.
const REVERSIBLE: f64 = 1.0;
/// Normal equations of one run.
pub(super) struct Equations {
    pub(super) gram: DMatrix<f64>,
    pub(super) right: DVector<f64>,
    pub(super) square: f64,
    pub(super) count: f64,
}

/// Products of offset, rises and shares with themselves and the output; every `stride`-th sample.
pub(super) fn equations(
    plays: &Plays,
    rises: &DMatrix<f64>,
    run: &Record,
    law: &[f64],
    taus: &[f64],
    stride: usize,
) -> Equations {
    let relaxing: Vec<Vec<f64>> = if law.is_empty() {
        Vec::new()
    } else {
        taus.iter()
            .map(|&tau| lagged(law, tau, run.step_s).iter().zip(law).map(|(x, u)| x - u).collect())
            .collect()
    };
    let count = plays.count();
    let width = 1 + count + taus.len();
    let mut gram = DMatrix::zeros(width, width);
    let mut right = DVector::zeros(width);
    let (mut square, mut used) = (0.0, 0.0);
    let mut entries: Vec<(usize, f64)> = Vec::new();
    plays.rows(&run.input, |i, row| {
        if i % stride != 0 || !run.window.contains(&i) {
            return;
        }
        entries.clear();
        entries.push((0, 1.0));
        entries.extend(row.iter().map(|&(k, v)| (k + 1, v)));
        entries.extend(relaxing.iter().enumerate().map(|(t, x)| (1 + count + t, x[i])));
        let y = run.output[i];
        for (a, &(ka, va)) in entries.iter().enumerate() {
            right[ka] += va * y;
            for &(kb, vb) in &entries[..=a] {
                gram[(ka, kb)] += va * vb;
            }
        }
        square += y * y;
        used += 1.0;
    });
    gram.fill_upper_triangle_with_lower_triangle();
    // from spline coefficients to rises
    let mut change = DMatrix::zeros(width, 1 + rises.ncols() + taus.len());
    change[(0, 0)] = 1.0;
    change.view_mut((1, 1), rises.shape()).copy_from(rises);
    for t in 0..taus.len() {
        change[(1 + count + t, 1 + rises.ncols() + t)] = 1.0;
    }
    Equations {
        gram: change.tr_mul(&gram) * &change,
        right: change.tr_mul(&right),
        square,
        count: used,
    }
}

/// Precision of the prior of offset, rises and shares.
pub(super) fn precision(
    plays: &Plays,
    prior: (f64, f64),
    spread: f64,
    shares: usize,
) -> Option<DMatrix<f64>> {
    let covariance = plays.prior(prior.0 * spread, REVERSIBLE * 2.0 * spread, prior.1);
    let n = covariance.nrows();
    let inverse = covariance.cholesky()?.inverse();
    let mut precision = DMatrix::zeros(1 + n + shares, 1 + n + shares);
    precision[(0, 0)] = 1.0 / (4.0 * spread).powi(2);
    precision.view_mut((1, 1), (n, n)).copy_from(&inverse);
    for t in 0..shares {
        precision[(1 + n + t, 1 + n + t)] = 1.0 / (SHARE * SHARE);
    }
    Some(precision)
}

pub(super) fn fit_of(
    equations: &[Equations],
    skip: Option<usize>,
    precision: &DMatrix<f64>,
    noise: f64,
) -> Option<DVector<f64>> {
    let weight = 1.0 / (noise * noise);
    let mut gram = precision.clone();
    let mut right = DVector::zeros(precision.nrows());
    for (r, own) in equations.iter().enumerate() {
        if Some(r) != skip {
            gram += &own.gram * weight;
            right += &own.right * weight;
        }
    }
    solve(&gram, &right)
}

/// As [`fit_of`], with some weights held at zero.
pub(super) fn fit_held(
    equations: &[Equations],
    precision: &DMatrix<f64>,
    noise: f64,
    held: &[usize],
) -> Option<DVector<f64>> {
    let mut stiff = precision.clone();
    for &k in held {
        stiff[(k, k)] += 1e14;
    }
    let mut solution = fit_of(equations, None, &stiff, noise)?;
    for &k in held {
        solution[k] = 0.0;
    }
    Some(solution)
}

pub(super) fn most_negative(solution: &DVector<f64>, first: usize) -> Option<usize> {
    (first..solution.len())
        .filter(|&k| solution[k] < 0.0)
        .min_by(|&a, &b| solution[a].total_cmp(&solution[b]))
}

/// The prior whose fits predict left-out runs best; mean logarithm of the relative error.
pub(super) fn best_prior(
    plays: &Plays,
    equations: &[Equations],
    noise: f64,
    spread: f64,
) -> Option<(f64, f64)> {
    let mut best: Option<(f64, (f64, f64))> = None;
    let taus = time_constants_s().len();
    let folds = equations.len().min(6);
    for prior in PRIORS {
        let precision = precision(plays, prior, spread, taus)?;
        let mut score = 0.0;
        if equations.len() > 1 {
            for fold in 0..folds {
                let weight = 1.0 / (noise * noise);
                let mut gram = precision.clone();
                let mut right = DVector::zeros(precision.nrows());
                for (r, own) in equations.iter().enumerate() {
                    if r % folds != fold {
                        gram += &own.gram * weight;
                        right += &own.right * weight;
                    }
                }
                let solution = solve(&gram, &right)?;
                for own in equations.iter().enumerate().filter(|(r, _)| r % folds == fold) {
                    let own = own.1;
                    let square = own.square - 2.0 * own.right.dot(&solution)
                        + (solution.transpose() * &own.gram * &solution)[0];
                    score += (square.max(0.0) / own.count + 1e-8 * spread * spread).ln();
                }
            }
        }
        if best.is_none_or(|b| score < b.0) {
            best = Some((score, prior));
        }
    }
    best.map(|b| b.1)
}

pub(super) fn covariance_root(
    equations: &[Equations],
    precision: &DMatrix<f64>,
    noise: f64,
) -> Option<DMatrix<f64>> {
    let mut gram = precision.clone();
    for own in equations {
        gram += &own.gram / (noise * noise);
    }
    // inverse of the transposed factor: root root' = inverse of the information
    let factor = gram.cholesky()?.l();
    factor.transpose().solve_upper_triangular(&DMatrix::identity(factor.nrows(), factor.nrows()))
}
