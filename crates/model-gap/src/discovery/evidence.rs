//! Sums of squares with the nuisance projected out.

use super::thresholds::NOISE_DOUBT;
use super::{Signal, Trace, TraceRole};
use crate::GapError;
use crate::quantile::{chi2_exceeded, normal_exceeded};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::sync::Arc;

/// Products of a set of columns, weighted by the noise, over one experiment.
#[derive(Debug, Clone)]
pub(crate) struct Products {
    /// Columns with columns.
    pub(crate) own: DMatrix<f64>,
    /// Nuisance with columns.
    pub(crate) with_nuisance: DMatrix<f64>,
}

impl Products {
    fn zero(columns: usize, nuisance: usize) -> Self {
        Self {
            own: DMatrix::zeros(columns, columns),
            with_nuisance: DMatrix::zeros(nuisance, columns),
        }
    }
}

/// Sum of squares of noise over what its samples weigh with: a sum of squares of normal deviates of unlike size.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct NoiseEnergy {
    /// Sum of their variances, and of the squares of these.
    sum: f64,
    squares: f64,
}

impl NoiseEnergy {
    pub(crate) fn mean(&self) -> f64 {
        self.sum
    }

    /// Its standard deviation, with the doubt of the noise itself.
    pub(crate) fn deviation(&self) -> f64 {
        (2.0 * self.squares).sqrt() + NOISE_DOUBT * self.sum
    }

    /// What it exceeds its mean by with a probability, with the doubt of the noise itself.
    ///
    /// By F. E. Satterthwaite, Biometrics Bulletin 2 (1946) 110: the chi-square of equal mean and variance, which has
    /// `(sum s)^2 / sum s^2` degrees of freedom; exact for deviates of equal size.
    pub(crate) fn exceeded(&self, probability: f64) -> f64 {
        if self.sum <= 0.0 {
            return 0.0;
        }
        let degrees = self.sum * self.sum / self.squares;
        let most = self.sum / degrees * chi2_exceeded(degrees, probability);
        most - self.sum + normal_exceeded(probability) * NOISE_DOUBT * self.sum
    }
}

/// A signal as all experiments together see it: with its products with the nuisance.
#[derive(Debug, Clone)]
pub(crate) struct Seen<'s> {
    signal: &'s Signal,
    /// Products with the nuisance, and those solved for what the nuisance takes.
    cross: DVector<f64>,
    solved: DVector<f64>,
}

/// Rows that are multiplied together: with the nuisance they stay in a second-level cache.
const ROWS: usize = 512;

/// The traces that count, with their nuisance factorised.
#[derive(Debug, Clone)]
pub(crate) struct Evidence<'a> {
    pub(crate) traces: &'a [Trace],
    pub(crate) experiments: usize,
    /// What a square of a sample of each trace counts, `1 / sigma^2`; 0 of a trace that is left out.
    weights: Vec<f64>,
    nuisance: Vec<DMatrix<f64>>,
    /// The columns of the nuisance that move each trace.
    moving: Arc<Vec<Vec<usize>>>,
    all: Cholesky<f64, Dyn>,
}

impl<'a> Evidence<'a> {
    pub(crate) fn new(traces: &'a [Trace]) -> Result<Self, GapError> {
        let experiments = traces.iter().map(|t| t.experiment + 1).max().unwrap_or(0);
        let width = traces.iter().map(|t| t.nuisance.ncols()).max().unwrap_or(0);
        let weights: Vec<f64> = traces.iter().map(|t| 1.0 / (t.sigma * t.sigma)).collect();
        let mut nuisance = vec![DMatrix::zeros(width, width); experiments];
        for (t, weight) in traces.iter().zip(&weights).filter(|(t, _)| t.nuisance.ncols() > 0) {
            nuisance[t.experiment] += t.nuisance.tr_mul(&t.nuisance) * *weight;
        }
        let moving = traces
            .iter()
            .map(|t| {
                let moves = |k: &usize| t.nuisance.column(*k).iter().any(|v| *v != 0.0);
                (0..t.nuisance.ncols()).filter(moves).collect()
            })
            .collect();
        let all = factor(&nuisance, width)?;
        Ok(Self { traces, experiments, weights, nuisance, moving: Arc::new(moving), all })
    }

    /// The same without some experiments: what a fit may see that has not seen them.
    pub(crate) fn without(&self, left_out: impl Fn(usize) -> bool) -> Result<Self, GapError> {
        let mut own = self.clone();
        for (weight, trace) in own.weights.iter_mut().zip(self.traces) {
            if left_out(trace.experiment) {
                *weight = 0.0;
            }
        }
        for (e, nuisance) in own.nuisance.iter_mut().enumerate() {
            if left_out(e) {
                nuisance.fill(0.0);
            }
        }
        own.all = factor(&own.nuisance, self.width())?;
        Ok(own)
    }

    fn width(&self) -> usize {
        self.nuisance.first().map_or(0, DMatrix::ncols)
    }

    /// Products over the noise of two signals, all experiments together.
    pub(crate) fn dot(&self, a: &Signal, b: &Signal) -> f64 {
        let seen = self.weights.iter().zip(a.iter().zip(b)).filter(|(weight, _)| **weight > 0.0);
        seen.map(|(weight, (a, b))| product(a, b) * weight).sum()
    }

    /// Signals with their products with the nuisance.
    pub(crate) fn seen<'s>(&self, signals: &[&'s Signal]) -> Vec<Seen<'s>> {
        let mut crosses = DMatrix::zeros(self.width(), signals.len());
        for number in 0..self.traces.len() {
            self.add_crosses(&mut crosses, signals, number);
        }
        let solved = self.all.solve(&crosses);
        signals
            .iter()
            .enumerate()
            .map(|(c, signal)| Seen {
                signal,
                cross: crosses.column(c).clone_owned(),
                solved: solved.column(c).clone_owned(),
            })
            .collect()
    }

    /// One signal with its products with the nuisance.
    pub(crate) fn see<'s>(&self, signal: &'s Signal) -> Seen<'s> {
        self.seen(&[signal]).swap_remove(0)
    }

    /// Variance of the product of a signal, the nuisance taken out, with the errors, over that with errors as white as the
    /// weights take them for: at most about 1, and far less of a signal where the structure of the base model is not.
    pub(crate) fn error_share(&self, signal: &Seen<'_>) -> f64 {
        let cleaned = self.cleaned(signal);
        let (mut own, mut white) = (0.0, 0.0);
        for ((trace, signal), weight) in self.traces.iter().zip(&cleaned).zip(&self.weights) {
            let [coloured, plain] = trace.spectrum.energies(signal);
            own += weight * coloured;
            white += weight * plain;
        }
        if white > 0.0 { own / white } else { 1.0 }
    }

    /// Product of two signals with the nuisance projected out.
    pub(crate) fn inner(&self, a: &Seen<'_>, b: &Seen<'_>) -> f64 {
        self.dot(a.signal, b.signal) - a.cross.dot(&b.solved)
    }

    /// Products of signals with each other, the nuisance projected out.
    pub(crate) fn gram(&self, signals: &[&Signal]) -> DMatrix<f64> {
        self.inners(&self.seen(signals))
    }

    /// As [`Self::gram`], of signals whose products with the nuisance are known.
    pub(crate) fn inners(&self, signals: &[Seen<'_>]) -> DMatrix<f64> {
        let n = signals.len();
        let mut gram = DMatrix::zeros(n, n);
        for a in 0..n {
            for b in 0..=a {
                gram[(a, b)] = self.inner(&signals[a], &signals[b]);
                gram[(b, a)] = gram[(a, b)];
            }
        }
        gram
    }

    /// Adds the products of signals with the nuisance on one trace.
    fn add_crosses(&self, into: &mut DMatrix<f64>, signals: &[&Signal], number: usize) {
        let (trace, weight) = (&self.traces[number], self.weights[number]);
        if weight == 0.0 {
            return;
        }
        let (rows, all) = (trace.nuisance.nrows(), trace.nuisance.as_slice());
        let mut first = 0;
        while first < rows {
            let last = (first + ROWS).min(rows);
            for &k in &self.moving[number] {
                let column = &all[k * rows + first..k * rows + last];
                for (c, signal) in signals.iter().enumerate() {
                    into[(k, c)] += weight * product(column, &signal[number][first..last]);
                }
            }
            first = last;
        }
    }

    /// The traces of a role, with their numbers.
    pub(crate) fn of_role(&self, role: TraceRole) -> impl Iterator<Item = (usize, &'a Trace)> {
        self.traces.iter().enumerate().filter(move |(_, trace)| trace.role == role)
    }

    /// Energy of the outputs about their means, in units of the noise variance.
    pub(crate) fn output_energy(&self) -> f64 {
        self.of_role(TraceRole::Output)
            .map(|(number, t)| {
                let mean = t.measured.iter().sum::<f64>() / t.measured.len().max(1) as f64;
                t.measured.iter().map(|y| (y - mean).powi(2)).sum::<f64>() * self.weights[number]
            })
            .sum()
    }

    /// Mean square of a signal over the samples of all outputs.
    pub(crate) fn output_square(&self, signal: &Signal) -> f64 {
        self.output_mean(|number, _| signal[number].iter().map(|x| x * x).sum())
    }

    /// Mean square of the outputs about their means.
    pub(crate) fn output_variance(&self) -> f64 {
        self.output_mean(|_, t| {
            let mean = t.measured.iter().sum::<f64>() / t.measured.len().max(1) as f64;
            t.measured.iter().map(|y| (y - mean).powi(2)).sum()
        })
    }

    /// Samples of all outputs.
    pub(crate) fn output_samples(&self) -> f64 {
        self.of_role(TraceRole::Output).map(|(_, t)| t.measured.len() as f64).sum()
    }

    /// A sum over every output, over the samples of all.
    fn output_mean(&self, of_trace: impl Fn(usize, &Trace) -> f64) -> f64 {
        let sum: f64 = self.of_role(TraceRole::Output).map(|(number, t)| of_trace(number, t)).sum();
        sum / self.output_samples().max(1.0)
    }

    /// A signal less the nuisance that it asks for, but for the calibrations: so many of the last columns.
    pub(crate) fn as_calibrated(&self, signal: &Seen<'_>, calibrations: usize) -> Signal {
        let nuisance = as_calibrated(signal.solved.clone(), calibrations);
        let pairs = self.traces.iter().zip(signal.signal);
        pairs.map(|(trace, own)| trace.cleaned(own.clone(), &nuisance)).collect()
    }

    /// A signal less all the nuisance that it asks for.
    pub(crate) fn cleaned(&self, signal: &Seen<'_>) -> Signal {
        self.as_calibrated(signal, 0)
    }

    /// Sum of squares of a residual over what it weighs with, on the channels of some roles.
    pub(super) fn energy_of(&self, residual: &Signal, counts: impl Fn(TraceRole) -> bool) -> f64 {
        self.traces
            .iter()
            .zip(residual)
            .zip(&self.weights)
            .filter(|((t, _), _)| counts(t.role))
            .map(|((_, r), weight)| r.iter().map(|x| x * x).sum::<f64>() * weight)
            .sum()
    }

    /// The energy of a signal on the channels beside the output.
    pub(crate) fn energy_beside(&self, signal: &Signal) -> f64 {
        self.energy_of(signal, |role| role != TraceRole::Output)
    }

    /// Sum of squares of a residual on all channels but the covariates.
    pub(crate) fn within_chain(&self, residual: &Signal) -> f64 {
        self.energy_of(residual, |role| role != TraceRole::Covariate)
    }

    /// Sum of squares of the outputs that noise alone would leave, over what they weigh with.
    pub(crate) fn noise_energy(&self) -> f64 {
        self.noise_by_experiment().iter().map(NoiseEnergy::mean).sum()
    }

    /// Sum of squares of a signal on the outputs over what they weigh with, experiment by experiment.
    pub(crate) fn by_experiment(&self, signal: &Signal) -> Vec<f64> {
        let mut all = vec![0.0; self.experiments];
        for (number, t) in self.of_role(TraceRole::Output) {
            let square: f64 = signal[number].iter().map(|x| x * x).sum();
            all[t.experiment] += square * self.weights[number];
        }
        all
    }

    /// The same on all channels but the covariates.
    pub(crate) fn energy_by_experiment(&self, signal: &Signal) -> Vec<f64> {
        let mut all = vec![0.0; self.experiments];
        for ((trace, own), weight) in self.traces.iter().zip(signal).zip(&self.weights) {
            if trace.role != TraceRole::Covariate {
                all[trace.experiment] += own.iter().map(|x| x * x).sum::<f64>() * weight;
            }
        }
        all
    }

    /// What noise alone leaves of the outputs of every experiment.
    pub(crate) fn noise_by_experiment(&self) -> Vec<NoiseEnergy> {
        let mut all = vec![NoiseEnergy::default(); self.experiments];
        for (number, t) in self.of_role(TraceRole::Output) {
            let share = t.noise.powi(2) * self.weights[number];
            let own = &mut all[t.experiment];
            own.sum += share * t.measured.len() as f64;
            own.squares += share.powi(2) * t.measured.len() as f64;
        }
        all
    }

    /// Products of columns, experiment by experiment.
    pub(crate) fn products(&self, columns: &[&Signal]) -> Vec<Products> {
        let mut all = vec![Products::zero(columns.len(), self.width()); self.experiments];
        for (number, trace) in self.traces.iter().enumerate() {
            let into = &mut all[trace.experiment];
            let weight = self.weights[number];
            if weight == 0.0 {
                continue;
            }
            for (a, column) in columns.iter().enumerate() {
                for (b, other) in columns.iter().enumerate().take(a + 1) {
                    let own = weight * product(&column[number], &other[number]);
                    into.own[(a, b)] += own;
                    if a != b {
                        into.own[(b, a)] += own;
                    }
                }
            }
            self.add_crosses(&mut into.with_nuisance, columns, number);
        }
        all
    }

    /// Products of a fit with another signal in the place of its residual, whose products with itself and the
    /// nuisance are known; none of an experiment that is left out.
    pub(crate) fn products_of_first(
        &self,
        alone: &[Products],
        first: &Signal,
        products: &[Products],
        slopes: &[Signal],
    ) -> Vec<Products> {
        let mut all = products.to_vec();
        for (own, alone) in all.iter_mut().zip(alone) {
            own.own.row_mut(0).fill(0.0);
            own.own.column_mut(0).fill(0.0);
            own.own[(0, 0)] = alone.own[(0, 0)];
            own.with_nuisance.set_column(0, &alone.with_nuisance.column(0));
        }
        for (number, trace) in self.traces.iter().enumerate() {
            let own = &mut all[trace.experiment];
            if self.weights[number] == 0.0 {
                own.own[(0, 0)] = 0.0;
                own.with_nuisance.column_mut(0).fill(0.0);
                continue;
            }
            for (k, slope) in slopes.iter().enumerate() {
                let both = self.weights[number] * product(&first[number], &slope[number]);
                own.own[(0, k + 1)] += both;
                own.own[(k + 1, 0)] += both;
            }
        }
        all
    }

    fn sum(&self, products: &[Products]) -> Products {
        let columns = products.first().map_or(0, |p| p.own.ncols());
        let mut sum = Products::zero(columns, self.width());
        for one in products {
            sum.own += &one.own;
            sum.with_nuisance += &one.with_nuisance;
        }
        sum
    }

    /// The products with the nuisance projected out.
    pub(crate) fn project(&self, products: &[Products]) -> DMatrix<f64> {
        let sum = self.sum(products);
        let solved = self.all.solve(&sum.with_nuisance);
        sum.own - sum.with_nuisance.tr_mul(&solved)
    }

    /// The products of one experiment with its own nuisance projected out.
    pub(crate) fn project_alone(&self, products: &Products, experiment: usize) -> DMatrix<f64> {
        let (own, cross) = (&self.nuisance[experiment], &products.with_nuisance);
        match Cholesky::new(own + DMatrix::identity(own.nrows(), own.ncols())) {
            Some(information) => &products.own - cross.tr_mul(&information.solve(cross)),
            None => products.own.clone(),
        }
    }

    /// What the nuisance leaves of a signal on the outputs of every experiment where it meets all of them but some:
    /// sums of squares over what they weigh with. The signal is given by its products with itself.
    pub(crate) fn left_without(&self, products: &[Products], aside: &[usize]) -> Vec<f64> {
        let mut normal = DMatrix::identity(self.width(), self.width());
        let mut cross = DVector::zeros(self.width());
        for (e, own) in products.iter().enumerate().filter(|(e, _)| !aside.contains(e)) {
            normal += &self.nuisance[e];
            cross += own.with_nuisance.column(0);
        }
        // without a factor there is no nuisance that could move
        let nuisance = Cholesky::new(normal).map_or_else(|| &cross * 0.0, |c| c.solve(&cross));
        let shift = DVector::from_element(1, 1.0);
        let left = |(e, own): (usize, &Products)| self.left_of(own, &shift, &nuisance, e);
        products.iter().enumerate().map(left).collect()
    }

    /// Products of a signal with itself on the outputs.
    pub(crate) fn output_products(&self, signal: &Signal) -> Vec<Products> {
        let mut all = self.products(&[signal]);
        for (own, energy) in all.iter_mut().zip(self.by_experiment(signal)) {
            own.own.fill(energy);
        }
        all
    }

    /// The nuisance that a residual asks for, the residual being `column + rest shift`.
    pub(crate) fn nuisance_of(&self, products: &[Products], shift: &DVector<f64>) -> DVector<f64> {
        self.all.solve(&(self.sum(products).with_nuisance * shift))
    }

    /// Sum of squares, over the noise, of a residual less its nuisance on one experiment.
    pub(crate) fn left_of(
        &self,
        products: &Products,
        shift: &DVector<f64>,
        nuisance: &DVector<f64>,
        experiment: usize,
    ) -> f64 {
        let own = (shift.transpose() * &products.own * shift)[0];
        let cross = nuisance.dot(&(&products.with_nuisance * shift));
        let square = (nuisance.transpose() * &self.nuisance[experiment] * nuisance)[0];
        (own - 2.0 * cross + square).max(0.0)
    }
}

fn factor(nuisance: &[DMatrix<f64>], width: usize) -> Result<Cholesky<f64, Dyn>, GapError> {
    let sum = nuisance.iter().fold(DMatrix::identity(width, width), |sum, own| sum + own);
    Cholesky::new(sum).ok_or(GapError::NotPositiveDefinite { columns: width })
}

/// Nuisance with the calibrations, so many of its last columns, of the reference runs.
pub(super) fn as_calibrated(mut nuisance: DVector<f64>, calibrations: usize) -> DVector<f64> {
    let first = nuisance.len().saturating_sub(calibrations);
    nuisance.rows_range_mut(first..).fill(0.0);
    nuisance
}

impl Trace {
    /// Takes the nuisance out of a residual.
    pub(super) fn cleaned(&self, mut residual: Vec<f64>, nuisance: &DVector<f64>) -> Vec<f64> {
        if self.nuisance.ncols() > 0 {
            let moved = &self.nuisance * nuisance;
            residual.iter_mut().zip(moved.iter()).for_each(|(left, moved)| *left -= moved);
        }
        residual
    }
}

/// Sum of products, in eight parts that a processor adds side by side.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let (mut eights_a, mut eights_b) = (a.chunks_exact(8), b.chunks_exact(8));
    let mut sums = [0.0; 8];
    for (x, y) in eights_a.by_ref().zip(eights_b.by_ref()) {
        for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
            *sum += x * y;
        }
    }
    let rest: f64 = eights_a.remainder().iter().zip(eights_b.remainder()).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

/// Measured less predicted, trace by trace.
pub(crate) fn residual(traces: &[Trace], predicted: &Signal) -> Signal {
    traces.iter().zip(predicted).map(|(t, p)| less(&t.measured, p)).collect()
}

/// One signal less another, trace by trace.
pub(crate) fn difference(a: &Signal, b: &Signal) -> Signal {
    a.iter().zip(b).map(|(a, b)| less(a, b)).collect()
}

pub(super) fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// A signal and further ones as columns.
pub(crate) fn columns<'s>(first: &'s Signal, others: &'s [Signal]) -> Vec<&'s Signal> {
    std::iter::once(first).chain(others).collect()
}

/// The normal matrix and right side of a fit, from the products of its residual, which stands first, and the
/// slopes of that.
pub(crate) fn normal_equations(gram: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let n = gram.nrows() - 1;
    let right = -gram.view((1, 0), (n, 1)).column(0).clone_owned();
    (gram.view((1, 1), (n, n)).clone_owned(), right)
}

/// A normal matrix with a part of its trace and a number added to its diagonal.
pub(crate) fn ridged(mut normal: DMatrix<f64>, part: f64, number: f64) -> DMatrix<f64> {
    let ridge = part * normal.trace() + number;
    for i in 0..normal.nrows() {
        normal[(i, i)] += ridge;
    }
    normal
}
