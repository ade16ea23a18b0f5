//! The base model of a diagnosis: static hysteresis with its ordinary creep and relaxation, linear in
//! its weights, with the covariance that the reference runs leave them.

use super::equations::{
    Equations, PRIORS, best_prior, covariance_root, equations, fit_of, fit_positive, precision,
    time_constants_s,
};
use super::errors::{ErrorModel, ErrorSpectrum, correlation_samples, pooled_spread, white_noise};
use crate::numbers::less;
use crate::plays::{OutputMap, Plays, behind_lags, lagged};
use crate::record::{Record, slower};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::{mean_square, variance};

/// Most rows that enter the normal equations.
const MOST_ROWS: usize = 15_000;
/// Factor on what the fit to the reference runs leaves: weights that were fitted leave less than others.
const STRUCTURE_MARGIN: f64 = 1.25;
/// Rounds of static part and relaxation after one another.
const ROUNDS: usize = 3;

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
    /// How its power is spread over frequency.
    spectrum: ErrorSpectrum,
    /// Root of the covariance of offset, coefficients and shares.
    root: DMatrix<f64>,
    /// Spread of the output over all reference runs.
    pub(crate) spread: f64,
    /// Weights: offset, coefficients, shares.
    weights: DVector<f64>,
    /// Prior chosen by leaving out each reference run in turn.
    pub(crate) prior: (f64, f64),
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
        let taus = time_constants_s(slower(runs));
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
            let first_share = 1 + rises.ncols();
            let solution = if round > 0 {
                // shares below zero are no relaxation
                fit_positive(&equations, &precision, noise, first_share)?
            } else {
                fit_of(&equations, |_| true, &precision, noise)?
            };
            let coefficients = &rises * solution.rows(1, rises.ncols());
            let map = plays.map(solution[0], coefficients.as_slice());
            history = runs.iter().map(|run| plays.outputs(&map, &run.input)).collect();
            let relaxation: Vec<(f64, f64)> = taus
                .iter()
                .enumerate()
                .map(|(i, &tau)| (tau, if round > 0 { solution[first_share + i] } else { 0.0 }))
                .collect();
            let mut model = Self::exact(plays.clone(), map, spread, solution);
            (model.relaxation, model.prior) = (relaxation, prior);
            noise = model.measure_errors(runs, &equations, &precision)?;
            if round + 1 == ROUNDS {
                model.root = covariance_root(&equations, &precision, noise)?;
            }
            own = Some(model);
        }
        own
    }

    /// The same with another zero of the output.
    pub(crate) fn raised(mut self, zero: f64) -> Self {
        self.map = self.map.raised(zero);
        self.weights[0] += zero;
        self
    }

    /// A straight line through runs, without memory, taken at its word: no structure is granted to it and
    /// nothing it may move by.
    pub(crate) fn straight(runs: &[&Record], range: (f64, f64)) -> Self {
        let plays = Plays::new(range.0, range.1);
        let pairs = || runs.iter().flat_map(|r| r.judged_input().iter().zip(r.judged_output()));
        let count = pairs().count().max(1) as f64;
        let (mu, my) = pairs().fold((0.0, 0.0), |s, (u, y)| (s.0 + u / count, s.1 + y / count));
        let (uy, uu) = pairs()
            .fold((0.0, 0.0), |s, (u, y)| (s.0 + (u - mu) * (y - my), s.1 + (u - mu).powi(2)));
        let slope = if uu > 0.0 { uy / uu } else { 0.0 };
        let (rises, offset) = plays.line(slope, my - slope * mu);
        let coefficients = plays.rises_to_coefficients() * &rises;
        let map = plays.map(offset, coefficients.as_slice());
        let weights = rises.insert_row(0, offset);
        let mut model = Self::exact(plays, map, pooled_spread(runs), weights);
        let noise2: f64 = runs
            .iter()
            .map(|r| white_noise(&model.residual(r)).powi(2) * r.judged_input().len() as f64)
            .sum();
        model.noise = (noise2 / count).sqrt();
        model
    }

    /// A model without relaxation or errors, none of whose weights may move.
    fn exact(plays: Plays, map: OutputMap, spread: f64, weights: DVector<f64>) -> Self {
        Self {
            plays,
            map,
            relaxation: Vec::new(),
            floor: 0.0,
            noise: 0.0,
            structure: 0.0,
            correlation_s: 0.0,
            spectrum: ErrorSpectrum::default(),
            root: DMatrix::zeros(weights.len(), weights.len()),
            spread,
            weights,
            prior: PRIORS[0],
        }
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
        let left: Vec<Vec<f64>> = runs.iter().map(|run| self.residual(run)).collect();
        for (run, residual) in runs.iter().zip(&left) {
            let white = white_noise(residual);
            let n = residual.len() as f64;
            noise2 += white * white * n;
            white_count += n;
            let part = (mean_square(residual) - white * white).max(0.0);
            correlation += part * n * correlation_samples(residual, white) * run.step_s;
            numerator += part * n;
            denominator += variance(run.judged_output()) * n;
        }
        self.spectrum = ErrorSpectrum::of(runs.iter().copied().zip(left));
        self.noise = (noise2 / white_count).sqrt();
        self.correlation_s = if numerator > 0.0 { correlation / numerator } else { 0.0 };
        let trained = (numerator / denominator).sqrt();
        // each run left out in turn: what the model leaves on runs it has not seen
        let sigma = self.noise.max(1e-3 * self.spread);
        let (mut left, mut all) = (0.0, 0.0);
        if equations.len() > 1 {
            for skip in 0..equations.len() {
                let noise = sigma.max(trained * self.spread);
                let solution = fit_of(equations, |run| run != skip, precision, noise)?;
                let own = &equations[skip];
                left += (own.left_by(&solution) / own.count - self.noise.powi(2)).max(0.0);
                all += variance(runs[skip].judged_output());
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
        let relaxing = self.relaxation.iter().filter(|r| r.1 != 0.0);
        behind_lags(law, relaxing.copied(), step_s)
    }

    /// The whole base model.
    pub(crate) fn predict(&self, inputs: &[f64], step_s: f64) -> Vec<f64> {
        self.relaxed(&self.hysteresis(inputs), step_s)
    }

    /// What it leaves of a run where that is judged.
    pub(crate) fn residual(&self, run: &Record) -> Vec<f64> {
        let predicted = self.predict(&run.input, run.step_s);
        less(run.judged_output(), run.judged(&predicted))
    }

    /// How the error of a run is made, its noise estimated from the run itself.
    pub(crate) fn errors(&self, run: &Record) -> ErrorModel {
        let noise = white_noise(&self.residual(run)).max(1e-5 * self.spread);
        let own = self.size_of(run);
        let correlation = (self.correlation_s / run.step_s).max(1.0);
        ErrorModel { noise, structure: self.structure * own, correlation }
    }

    /// Spread of the output that the structural error of a run goes with: it does not shrink to nothing in small runs.
    fn size_of(&self, run: &Record) -> f64 {
        0.5 * (variance(run.judged_output()).sqrt().min(self.spread) + self.spread)
    }

    /// Variance of the structural error of a run by the lines of `samples` samples of a step, in the square of the
    /// output's unit.
    pub(crate) fn structure_lines(&self, run: &Record, samples: usize, step_s: f64) -> Vec<f64> {
        let square = (STRUCTURE_MARGIN * self.size_of(run)).powi(2);
        self.spectrum.lines(samples, step_s).map(|line| square * line).collect()
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
        // a column per spline: those that a sample touches lie together in memory
        let splines = (&rises * basis.rows(1, rises.ncols())).transpose();
        let offset = basis.row(0).transpose();
        let first_share = 1 + rises.ncols();
        runs.iter()
            .map(|run| {
                let law = self.hysteresis(&run.input);
                // row by row of the transpose: its columns lie together in memory
                let mut transposed = DMatrix::zeros(kept.len(), run.input.len());
                self.plays.rows(&run.input, |i, row| {
                    let mut sum = transposed.column_mut(i);
                    sum.copy_from(&offset);
                    for &(k, value) in row {
                        sum.axpy(value, &splines.column(k), 1.0);
                    }
                });
                for (t, &tau) in taus.iter().enumerate() {
                    let weights = basis.row(first_share + t).transpose();
                    let relaxing = less(&lagged(&law, tau, run.step_s), &law);
                    for (i, deviation) in relaxing.into_iter().enumerate() {
                        transposed.column_mut(i).axpy(deviation, &weights, 1.0);
                    }
                }
                transposed.transpose()
            })
            .collect()
    }
}

fn stride_of(runs: &[&Record]) -> usize {
    let all: usize = runs.iter().map(|r| r.input.len()).sum();
    all.div_ceil(MOST_ROWS).max(1)
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
        Record { is_reference: true, ..Record::new(hz.to_string(), step_s, input, output) }
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

    /// A law that ends at its range misses nearly twice as much.
    #[test]
    fn a_law_goes_on_beyond_the_range_it_was_read_in() {
        let runs = [run(0.5, 1.0), run(1.7, 0.7), run(4.0, 0.9), run(9.0, 0.5), run(2.3, 0.25)];
        let references: Vec<&Record> = runs.iter().collect();
        let base = BaseModel::fit(&references, (-1.0, 1.0), None).unwrap();
        let wider = run(0.5, 1.06);
        let held: Vec<f64> = wider.input.iter().map(|u| u.clamp(-1.0, 1.0)).collect();
        let [beyond, ends] = [&wider.input, &held].map(|input| {
            let left = less(&wider.output, &base.predict(input, wider.step_s));
            mean_square(&left).sqrt() / variance(&wider.output).sqrt()
        });
        assert!(beyond < 0.008 && ends > 1.7 * beyond, "{beyond}, {ends}");
    }

    #[test]
    fn structure_of_other_runs_is_granted_a_quarter_more_than_the_fit_leaves() {
        // a bend that no play has: output that depends on the rate of the input
        let bent = |hz: f64| {
            let mut run = run(hz, 1.0);
            for i in 1..run.output.len() {
                let rate = (run.input[i] - run.input[i - 1]) / run.step_s;
                run.output[i] += 2e-4 * rate * rate;
            }
            run
        };
        let runs = [bent(1.3), bent(2.0), bent(3.1), bent(4.2)];
        let references: Vec<&Record> = runs.iter().collect();
        let base = BaseModel::fit(&references, (-1.0, 1.0), None).unwrap();
        let (mut left, mut all) = (0.0, 0.0);
        for run in &runs {
            let residual = base.residual(run);
            left += mean_square(&residual) - white_noise(&residual).powi(2);
            all += variance(&run.output);
        }
        let trained = (left / all).sqrt();
        for run in &runs {
            let spread = variance(&run.output).sqrt().min(base.spread);
            let share = base.errors(run).structure / (0.5 * (spread + base.spread));
            assert!((share / trained - 1.25).abs() < 0.02, "{share} of {trained}");
        }
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
