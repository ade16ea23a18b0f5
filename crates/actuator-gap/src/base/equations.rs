//! Normal equations of the base model and their solution under its prior.

use crate::numbers::less;
use crate::plays::{Plays, lagged};
use crate::record::Record;
use nalgebra::{DMatrix, DVector};

/// Number of time constants of creep and relaxation.
const TIME_CONSTANTS: i32 = 12;

/// Time constants of creep and relaxation, two per decade from 1 ms to 300 s, and so many times longer, s.
pub(super) fn time_constants_s(slower: f64) -> Vec<f64> {
    (0..TIME_CONSTANTS).map(|i| slower * 1e-3 * 10.0_f64.powf(0.5 * f64::from(i))).collect()
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
    // without the law's output there is nothing that relaxes
    let relaxing: Vec<Vec<f64>> = if law.is_empty() {
        Vec::new()
    } else {
        taus.iter().map(|&tau| less(&lagged(law, tau, run.step_s), law)).collect()
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

impl Equations {
    /// Sum of squares that a solution leaves.
    pub(super) fn left_by(&self, solution: &DVector<f64>) -> f64 {
        self.square - 2.0 * self.right.dot(solution)
            + (solution.transpose() * &self.gram * solution)[0]
    }
}

/// Solves for the coefficients of a Gaussian prior and Gaussian data of the runs that count.
pub(super) fn fit_of(
    equations: &[Equations],
    counts: impl Fn(usize) -> bool,
    precision: &DMatrix<f64>,
    noise: f64,
) -> Option<DVector<f64>> {
    let weight = 1.0 / (noise * noise);
    let mut gram = precision.clone();
    let mut right = DVector::zeros(precision.nrows());
    for (_, own) in equations.iter().enumerate().filter(|(run, _)| counts(*run)) {
        gram += &own.gram * weight;
        right += &own.right * weight;
    }
    gram.cholesky().map(|c| c.solve(&right))
}

/// As [`fit_of`] of all runs, with the weights from `first` on held at zero, one after another, that would be
/// negative.
pub(super) fn fit_positive(
    equations: &[Equations],
    precision: &DMatrix<f64>,
    noise: f64,
    first: usize,
) -> Option<DVector<f64>> {
    let mut stiff = precision.clone();
    let mut held: Vec<usize> = Vec::new();
    loop {
        let mut solution = fit_of(equations, |_| true, &stiff, noise)?;
        for &k in &held {
            solution[k] = 0.0;
        }
        let negative = (first..solution.len()).filter(|&k| solution[k] < 0.0);
        let worst = negative.min_by(|&a, &b| solution[a].total_cmp(&solution[b]));
        let Some(worst) = worst else { return Some(solution) };
        stiff[(worst, worst)] += 1e14;
        held.push(worst);
    }
}

/// The prior whose fits predict left-out runs best; mean logarithm of the relative error.
pub(super) fn best_prior(
    plays: &Plays,
    equations: &[Equations],
    noise: f64,
    spread: f64,
) -> Option<(f64, f64)> {
    let mut best: Option<(f64, (f64, f64))> = None;
    let taus = TIME_CONSTANTS as usize;
    let folds = equations.len().min(6);
    for prior in PRIORS {
        let precision = precision(plays, prior, spread, taus)?;
        let mut score = 0.0;
        if equations.len() > 1 {
            for fold in 0..folds {
                let solution = fit_of(equations, |run| run % folds != fold, &precision, noise)?;
                for own in equations.iter().skip(fold).step_by(folds) {
                    let square = own.left_by(&solution);
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
