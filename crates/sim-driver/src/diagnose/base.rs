//! The base model of a diagnosis: static hysteresis with its ordinary creep and relaxation, linear in
//! its weights, with the covariance that the reference runs leave them.

use super::plays::{OutputMap, Plays, lagged, solve};
use super::record::Record;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Time constants of creep and relaxation, two per decade from 1 ms to 300 s, s.
fn time_constants_s() -> Vec<f64> {
    (0..12).map(|i| 1e-3 * 10.0_f64.powf(0.5 * f64::from(i))).collect()
}

/// Prior standard deviation of the share of one time constant.
const SHARE: f64 = 0.1;
/// Most rows that enter the normal equations.
const MOST_ROWS: usize = 15_000;
/// Amplitude of the density over the output's half range, and its length, to choose from.
const PRIORS: [(f64, f64); 6] =
    [(0.3, 0.2), (1.0, 0.2), (3.0, 0.2), (0.3, 0.5), (1.0, 0.5), (3.0, 0.5)];
/// Slope of the reversible part over the output's half range per half range of the input.
const REVERSIBLE: f64 = 1.0;
/// Factor on what the fit to the reference runs leaves: weights that were fitted leave less than others.
const STRUCTURE_MARGIN: f64 = 1.25;
/// Rounds of static part and relaxation after one another.
const ROUNDS: usize = 3;

/// What the base model leaves on one run, and how that error is made.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ErrorModel {
    /// White noise of the reading, output's unit.
    pub(crate) noise: f64,
    /// Structural error of the model, output's unit, rms.
    pub(crate) structure: f64,
    /// Samples over which the structural error keeps its sign.
    pub(crate) correlation: f64,
}

impl ErrorModel {
    /// Standard deviation that an independent sample would need to weigh as little.
    pub(crate) fn effective(&self) -> f64 {
        (self.noise.powi(2) + self.correlation * self.structure.powi(2)).sqrt()
    }
}

/// The base model with what is known about its weights.
#[derive(Debug, Clone)]
pub(crate) struct BaseModel {
    pub(crate) plays: Plays,
    pub(crate) map: OutputMap,
    /// Time constants and shares of creep and relaxation; all shares are `>= 0`.
    pub(crate) relaxation: Vec<(f64, f64)>,
    /// Error on the reference runs where they were left out of the fit; relative to the spread of the output.
    pub(crate) floor: f64,
    /// Noise of the reading on the reference runs, output's unit.
    pub(crate) noise: f64,
    /// Structural error relative to the spread of the output, and its correlation time, s.
    structure: f64,
    correlation_s: f64,
    /// Root of the covariance of offset, coefficients and shares.
    root: DMatrix<f64>,
    /// Spread of the output over all reference runs.
    pub(crate) spread: f64,
    /// Weights: offset, coefficients, shares.
    weights: DVector<f64>,
    /// Prior chosen by leaving out each reference run in turn.
    pub(crate) prior: (f64, f64),
}

/// Normal equations of one run.
struct Equations {
    gram: DMatrix<f64>,
    right: DVector<f64>,
    square: f64,
    count: f64,
}

impl BaseModel {
    /// Fits the base model to runs.
    ///
    /// The prior's size and length are chosen by leaving out each run in turn. `fixed` takes over an
    /// earlier choice.
    pub(crate) fn fit(
        runs: &[&Record],
        range: (f64, f64),
        fixed: Option<(f64, f64)>,
    ) -> Option<Self> {
        let plays = Plays::new(range.0, range.1);
        let spread = pooled_spread(runs);
        let taus = time_constants_s();
        let stride = stride_of(runs);
        let rises = plays.rises_to_coefficients();
        let mut history: Vec<Vec<f64>> = Vec::new();
        let mut noise = 0.01 * spread;
        let mut chosen = fixed;
        let mut own: Option<Self> = None;
        for round in 0..ROUNDS {
            let equations: Vec<Equations> = runs
                .par_iter()
                .enumerate()
                .map(|(r, run)| {
                    let memory = history.get(r).map_or(&[][..], Vec::as_slice);
                    equations(&plays, &rises, run, memory, &taus, stride)
                })
                .collect();
            if fixed.is_none() && round < 2 {
                chosen = Some(best_prior(&plays, &equations, noise, spread)?);
            }
            let prior = chosen?;
            let precision = precision(&plays, prior, spread, taus.len())?;
            let mut solution = fit_of(&equations, None, &precision, noise)?;
            let mut held: Vec<usize> = Vec::new();
            let first_share = 1 + rises.ncols();
            // shares below zero are no relaxation: they are held at zero one after another
            if round > 0 {
                while let Some(worst) = most_negative(&solution, first_share) {
                    held.push(worst);
                    solution = fit_held(&equations, &precision, noise, &held)?;
                }
            }
            let coefficients = &rises * solution.rows(1, rises.ncols());
            let map = plays.map(solution[0], coefficients.as_slice());
            history = runs.iter().map(|run| plays.outputs(&map, &run.input)).collect();
            let relaxation: Vec<(f64, f64)> = taus
                .iter()
                .enumerate()
                .map(|(i, &tau)| (tau, if round > 0 { solution[first_share + i] } else { 0.0 }))
                .collect();
            let mut model = Self {
                plays: plays.clone(),
                map,
                relaxation,
                floor: 0.0,
                noise,
                structure: 0.0,
                correlation_s: 0.0,
                root: DMatrix::zeros(0, 0),
                spread,
                weights: solution,
                prior,
            };
            let errors = model.measure_errors(runs, &equations, &precision)?;
            noise = errors;
            if round + 1 == ROUNDS {
                model.root = covariance_root(&equations, &precision, noise)?;
            }
            own = Some(model);
        }
        own
    }

    /// Estimates noise, structure and floor; returns the effective noise of the next round.
    fn measure_errors(
        &mut self,
        runs: &[&Record],
        equations: &[Equations],
        precision: &DMatrix<f64>,
    ) -> Option<f64> {
        let (mut noise2, mut white_count) = (0.0, 0.0);
        let (mut numerator, mut denominator) = (0.0, 0.0);
        let mut correlation = 0.0;
        for run in runs {
            let residual = self.residual(run);
            let white = white_noise(&residual);
            let n = residual.len() as f64;
            noise2 += white * white * n;
            white_count += n;
            let total = mean_square(&residual);
            let part = (total - white * white).max(0.0);
            let length = correlation_samples(&residual, white) * run.step_s;
            correlation += part * n * length;
            numerator += part * n;
            denominator += variance(&run.output) * n;
        }
        self.noise = (noise2 / white_count).sqrt();
        self.correlation_s = if numerator > 0.0 { correlation / numerator } else { 0.0 };
        let trained = (numerator / denominator).sqrt();
        // each run left out in turn: what the model leaves on runs it has not seen
        let sigma = self.noise.max(1e-3 * self.spread);
        let (mut left, mut all) = (0.0, 0.0);
        if equations.len() > 1 {
            for skip in 0..equations.len() {
                let solution =
                    fit_of(equations, Some(skip), precision, sigma.max(trained * self.spread))?;
                let own = &equations[skip];
                let square = own.square - 2.0 * own.right.dot(&solution)
                    + (solution.transpose() * &own.gram * &solution)[0];
                left += (square / own.count - self.noise.powi(2)).max(0.0);
                all += variance(&runs[skip].output);
            }
        }
        let held_out = if all > 0.0 { (left / all).sqrt() } else { 2.0 * trained };
        // a run left out also misses what its weights could not be known from: the measured runs are
        // granted that by the covariance, so the structure is what the fit itself leaves
        self.structure = STRUCTURE_MARGIN * trained;
        self.floor = held_out.max(trained);
        let step = runs.iter().map(|r| r.step_s).fold(f64::INFINITY, f64::min);
        let samples = (self.correlation_s / step).max(1.0);
        Some((self.noise.powi(2) + samples * (trained * self.spread).powi(2)).sqrt())
    }

    /// The static part for a history of inputs.
    pub(crate) fn hysteresis(&self, inputs: &[f64]) -> Vec<f64> {
        self.plays.outputs(&self.map, inputs)
    }

    /// Ordinary creep and relaxation behind the static part.
    pub(crate) fn relaxed(&self, law: &[f64], step_s: f64) -> Vec<f64> {
        let mut output = law.to_vec();
        for &(tau, share) in self.relaxation.iter().filter(|r| r.1 != 0.0) {
            for ((y, x), u) in output.iter_mut().zip(lagged(law, tau, step_s)).zip(law) {
                *y += share * (x - u);
            }
        }
        output
    }

    /// The whole base model.
    pub(crate) fn predict(&self, inputs: &[f64], step_s: f64) -> Vec<f64> {
        self.relaxed(&self.hysteresis(inputs), step_s)
    }

    pub(crate) fn residual(&self, run: &Record) -> Vec<f64> {
        let predicted = self.predict(&run.input, run.step_s);
        run.output.iter().zip(predicted).map(|(a, b)| a - b).collect()
    }

    /// How the error of a run is made, its noise estimated from the run itself.
    pub(crate) fn errors(&self, run: &Record) -> ErrorModel {
        let noise = white_noise(&self.residual(run)).max(1e-5 * self.spread);
        let own = 0.5 * (variance(&run.output).sqrt().min(self.spread) + self.spread);
        let correlation = (self.correlation_s / run.step_s).max(1.0);
        ErrorModel { noise, structure: self.structure * own, correlation }
    }

    /// What the base model may still move by on given runs: columns of standard deviation 1, the
    /// directions the runs can see, strongest first.
    pub(crate) fn nuisance(
        &self,
        runs: &[&Record],
        sigmas: &[f64],
        most: usize,
    ) -> Vec<DMatrix<f64>> {
        let rises = self.plays.rises_to_coefficients();
        let width = self.weights.len();
        let taus: Vec<f64> = self.relaxation.iter().map(|r| r.0).collect();
        let stride = stride_of(runs);
        let mut information = DMatrix::zeros(width, width);
        for (run, sigma) in runs.iter().zip(sigmas) {
            let law = self.hysteresis(&run.input);
            let own = equations(&self.plays, &rises, run, &law, &taus, stride);
            information += own.gram * (stride as f64 / (sigma * sigma));
        }
        let seen = self.root.transpose() * information * &self.root;
        let eigen = seen.symmetric_eigen();
        let mut order: Vec<usize> = (0..width).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let kept: Vec<usize> =
            order.into_iter().filter(|&k| eigen.eigenvalues[k] > 0.02).take(most).collect();
        let directions =
            DMatrix::from_fn(width, kept.len(), |i, k| eigen.eigenvectors[(i, kept[k])]);
        let basis = &self.root * directions;
        let splines = &rises * basis.rows(1, rises.ncols());
        let first_share = 1 + rises.ncols();
        runs.iter()
            .map(|run| {
                let mut columns = DMatrix::zeros(run.input.len(), kept.len());
                let law = self.hysteresis(&run.input);
                // row by row of the transpose: its columns lie together in memory
                let mut transposed = DMatrix::zeros(kept.len(), run.input.len());
                self.plays.rows(&run.input, |i, row| {
                    let mut sum = basis.row(0).transpose();
                    for &(k, value) in row {
                        sum.axpy(value, &splines.row(k).transpose(), 1.0);
                    }
                    transposed.set_column(i, &sum);
                });
                for (t, &tau) in taus.iter().enumerate() {
                    let weights = basis.row(first_share + t).transpose();
                    for (i, x) in lagged(&law, tau, run.step_s).iter().enumerate() {
                        let deviation = x - law[i];
                        transposed.column_mut(i).axpy(deviation, &weights, 1.0);
                    }
                }
                transposed.transpose_to(&mut columns);
                columns
            })
            .collect()
    }
}

fn stride_of(runs: &[&Record]) -> usize {
    let all: usize = runs.iter().map(|r| r.input.len()).sum();
    all.div_ceil(MOST_ROWS).max(1)
}

/// Products of offset, rises and shares with themselves and the output; every `stride`-th sample.
fn equations(
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
        if i % stride != 0 {
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
fn precision(plays: &Plays, prior: (f64, f64), spread: f64, shares: usize) -> Option<DMatrix<f64>> {
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

fn fit_of(
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
fn fit_held(
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

fn most_negative(solution: &DVector<f64>, first: usize) -> Option<usize> {
    (first..solution.len())
        .filter(|&k| solution[k] < 0.0)
        .min_by(|&a, &b| solution[a].total_cmp(&solution[b]))
}

/// The prior whose fits predict left-out runs best; mean logarithm of the relative error.
fn best_prior(
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

fn covariance_root(
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

fn pooled_spread(runs: &[&Record]) -> f64 {
    let count: usize = runs.iter().map(|r| r.output.len()).sum();
    let sum: f64 = runs.iter().map(|r| variance(&r.output) * r.output.len() as f64).sum();
    (sum / count.max(1) as f64).sqrt()
}

pub(crate) fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64
}

pub(crate) fn variance(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len().max(1) as f64
}

/// White noise under a smooth residual: rms of its second differences over the root of 6, robustly
/// from the median, so that a few jumps do not count.
pub(crate) fn white_noise(residual: &[f64]) -> f64 {
    let mut sizes: Vec<f64> =
        residual.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    // median of |N(0,1)| is 0.6745
    *median / 0.6745 / 6.0_f64.sqrt()
}

/// Integrated correlation of a residual without its noise, samples: one and twice the sum of the
/// correlations up to the first that is not positive.
fn correlation_samples(residual: &[f64], noise: f64) -> f64 {
    let n = residual.len();
    let total = mean_square(residual);
    let smooth = total - noise * noise;
    if smooth <= 0.05 * total {
        return 1.0;
    }
    let mut sum = 1.0;
    let mut lag = 1;
    let mut step = 1;
    while lag < n / 4 {
        let products: f64 = residual.iter().zip(&residual[lag..]).map(|(a, b)| a * b).sum::<f64>()
            / (n - lag) as f64;
        let rho = products / smooth;
        if rho <= 0.05 {
            break;
        }
        sum += 2.0 * rho.min(1.0) * step as f64;
        if lag >= 16 {
            step = lag / 8;
        }
        lag += step;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three plays and a relaxation: in the class of the base model, but with half-widths of its own.
    fn truth(input: &[f64], step_s: f64) -> Vec<f64> {
        let mut plays = [input[0]; 3];
        let law: Vec<f64> = input
            .iter()
            .map(|&u| {
                for (p, r) in plays.iter_mut().zip([0.07, 0.22, 0.45]) {
                    *p = p.min(u + r).max(u - r);
                }
                0.6 * u + 0.3 * plays[0] + 0.25 * plays[1] + 0.2 * plays[2]
            })
            .collect();
        let late = lagged(&law, 0.05, step_s);
        law.iter().zip(late).map(|(h, x)| h + 0.1 * (x - h)).collect()
    }

    fn run(hz: f64, amplitude: f64) -> Record {
        let step_s = 2e-3;
        let input: Vec<f64> = (0..2000)
            .map(|i| {
                let t = step_s * f64::from(i);
                amplitude * (std::f64::consts::TAU * hz * t).sin() * (1.0 - (-t).exp())
            })
            .collect();
        let output = truth(&input, step_s);
        Record {
            id: format!("{hz}"),
            is_reference: true,
            step_s,
            input,
            output,
            amplifier: None,
            temperature: None,
            load: None,
        }
    }

    #[test]
    fn a_system_with_plays_between_its_own_is_described_on_runs_it_has_not_seen() {
        let runs = [run(0.5, 1.0), run(1.7, 0.7), run(4.0, 0.9), run(9.0, 0.5), run(2.3, 0.25)];
        let references: Vec<&Record> = runs.iter().collect();
        let base = BaseModel::fit(&references, (-1.0, 1.0), None).unwrap();
        let unseen = run(3.1, 0.8);
        let left = mean_square(&base.residual(&unseen)).sqrt();
        let spread = variance(&unseen.output).sqrt();
        assert!(left < 0.01 * spread, "{left} of {spread}");
        let nuisance = base.nuisance(&[&unseen], &[0.01], 30);
        assert_eq!(nuisance[0].nrows(), unseen.input.len());
        assert!(nuisance[0].ncols() > 0 && nuisance[0].iter().all(|v| v.is_finite()));
    }

    #[test]
    fn noise_is_found_under_a_smooth_residual() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(99);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let noisy: Vec<f64> = (0..20_000)
            .map(|i| {
                let sum: f64 = (0..12).map(|_| random()).sum();
                5.0 * (1e-3 * f64::from(i)).sin() + 0.1 * sum
            })
            .collect();
        assert!((white_noise(&noisy) / 0.1 - 1.0).abs() < 0.03);
        assert!(correlation_samples(&noisy, 0.1) > 200.0);
    }
}
