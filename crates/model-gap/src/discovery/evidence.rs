//! Sums of squares with the nuisance projected out.

use super::thresholds::NOISE_DOUBT;
use super::{Signal, Trace, TraceRole};
use crate::GapError;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

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

/// The traces with their nuisance factorised, for all experiments and with each fold left out.
#[derive(Debug, Clone)]
pub(crate) struct Evidence<'a> {
    pub(crate) traces: &'a [Trace],
    pub(crate) experiments: usize,
    /// Fold of every experiment.
    pub(crate) folds: Vec<usize>,
    pub(crate) fold_count: usize,
    nuisance: Vec<DMatrix<f64>>,
    /// The columns of the nuisance that move each trace.
    moving: Vec<Vec<usize>>,
    all: Cholesky<f64, Dyn>,
    without: Vec<Cholesky<f64, Dyn>>,
}

impl<'a> Evidence<'a> {
    pub(crate) fn new(traces: &'a [Trace], most_folds: usize) -> Result<Self, GapError> {
        let experiments = traces.iter().map(|t| t.experiment + 1).max().unwrap_or(0);
        let width = traces.iter().map(|t| t.nuisance.ncols()).max().unwrap_or(0);
        let mut nuisance = vec![DMatrix::zeros(width, width); experiments];
        for t in traces.iter().filter(|t| t.nuisance.ncols() > 0) {
            nuisance[t.experiment] += t.nuisance.tr_mul(&t.nuisance) / (t.sigma * t.sigma);
        }
        let fold_count = experiments.min(most_folds);
        let folds: Vec<usize> = (0..experiments).map(|e| e % fold_count.max(1)).collect();
        let factor = |left_out: Option<usize>| {
            let mut sum = DMatrix::identity(width, width);
            for (e, own) in nuisance.iter().enumerate() {
                if left_out != Some(folds[e]) {
                    sum += own;
                }
            }
            Cholesky::new(sum).ok_or(GapError::NotPositiveDefinite { columns: width })
        };
        let all = factor(None)?;
        let without = (0..fold_count).map(|f| factor(Some(f))).collect::<Result<_, _>>()?;
        let moving = traces
            .iter()
            .map(|t| {
                let moves = |k: &usize| t.nuisance.column(*k).iter().any(|v| *v != 0.0);
                (0..t.nuisance.ncols()).filter(moves).collect()
            })
            .collect();
        Ok(Self { traces, experiments, folds, fold_count, nuisance, moving, all, without })
    }

    fn width(&self) -> usize {
        self.nuisance.first().map_or(0, DMatrix::ncols)
    }

    /// Products over the noise of two signals, all experiments together.
    pub(crate) fn dot(&self, a: &Signal, b: &Signal) -> f64 {
        let pairs = self.traces.iter().zip(a.iter().zip(b));
        pairs.map(|(t, (a, b))| product(a, b) / (t.sigma * t.sigma)).sum()
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
        let trace = &self.traces[number];
        let weight = 1.0 / (trace.sigma * trace.sigma);
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
            .map(|(_, t)| {
                let mean = t.measured.iter().sum::<f64>() / t.measured.len().max(1) as f64;
                t.measured.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / (t.sigma * t.sigma)
            })
            .sum()
    }

    /// Sum of squares of a residual over what it weighs with, on the channels of some roles.
    fn energy_of(&self, residual: &Signal, counts: impl Fn(TraceRole) -> bool) -> f64 {
        self.traces
            .iter()
            .zip(residual)
            .filter(|(t, _)| counts(t.role))
            .map(|(t, r)| r.iter().map(|x| x * x).sum::<f64>() / (t.sigma * t.sigma))
            .sum()
    }

    /// The channels beside the output, which no nuisance touches: part of every cost.
    pub(crate) fn beside_output(&self, residual: &Signal) -> f64 {
        self.energy_of(residual, |role| role != TraceRole::Output)
    }

    /// The part of [`Self::beside_output`] of the covariates.
    pub(crate) fn of_covariates(&self, residual: &Signal) -> f64 {
        self.energy_of(residual, |role| role == TraceRole::Covariate)
    }

    /// Whether a covariate was measured.
    pub(crate) fn has_covariates(&self) -> bool {
        self.of_role(TraceRole::Covariate).next().is_some()
    }

    /// Sum of squares of the outputs that noise alone would leave, over what they weigh with.
    pub(crate) fn noise_energy(&self) -> f64 {
        self.of_role(TraceRole::Output)
            .map(|(_, t)| t.measured.len() as f64 * (t.noise / t.sigma).powi(2))
            .sum()
    }

    /// Sum of squares of a signal on the outputs over what they weigh with, experiment by experiment.
    pub(crate) fn by_experiment(&self, signal: &Signal) -> Vec<f64> {
        let mut all = vec![0.0; self.experiments];
        for (number, t) in self.of_role(TraceRole::Output) {
            let square: f64 = signal[number].iter().map(|x| x * x).sum();
            all[t.experiment] += square / (t.sigma * t.sigma);
        }
        all
    }

    /// Such sums of a residual less what noise alone would leave, with the standard error of that.
    pub(crate) fn excess_by_experiment(&self, energies: &[f64]) -> Vec<(f64, f64)> {
        let mut all: Vec<(f64, f64)> = energies.iter().map(|energy| (*energy, 0.0)).collect();
        for (_, t) in self.of_role(TraceRole::Output) {
            let (share, n) = ((t.noise / t.sigma).powi(2), t.measured.len() as f64);
            let own = &mut all[t.experiment];
            own.0 -= n * share;
            own.1 = own.1.hypot(share * (2.0 * n).sqrt() + NOISE_DOUBT * n * share);
        }
        all
    }

    /// Products of columns, experiment by experiment.
    pub(crate) fn products(&self, columns: &[&Signal]) -> Vec<Products> {
        let zero = Products::zero(columns.len(), self.width());
        self.added(vec![zero; self.experiments], columns, columns.len())
    }

    /// Products of columns whose first is another, the products of the others being known.
    pub(crate) fn products_after(&self, columns: &[&Signal], known: &[Products]) -> Vec<Products> {
        let mut all = known.to_vec();
        for own in &mut all {
            own.own.row_mut(0).fill(0.0);
            own.own.column_mut(0).fill(0.0);
            own.with_nuisance.column_mut(0).fill(0.0);
        }
        self.added(all, columns, 1)
    }

    /// Products with those of the first `count` columns added.
    fn added(&self, mut all: Vec<Products>, columns: &[&Signal], count: usize) -> Vec<Products> {
        for (number, trace) in self.traces.iter().enumerate() {
            let into = &mut all[trace.experiment];
            let weight = 1.0 / (trace.sigma * trace.sigma);
            for (a, column) in columns.iter().enumerate() {
                for (b, other) in columns[..count].iter().enumerate().take(a + 1) {
                    let own = weight * product(&column[number], &other[number]);
                    into.own[(a, b)] += own;
                    if a != b {
                        into.own[(b, a)] += own;
                    }
                }
            }
            self.add_crosses(&mut into.with_nuisance, &columns[..count], number);
        }
        all
    }

    fn sum(&self, products: &[Products], left_out: Option<usize>) -> Products {
        let columns = products.first().map_or(0, |p| p.own.ncols());
        let mut sum = Products::zero(columns, self.width());
        for (e, one) in products.iter().enumerate() {
            if left_out != Some(self.folds[e]) {
                sum.own += &one.own;
                sum.with_nuisance += &one.with_nuisance;
            }
        }
        sum
    }

    fn factor(&self, left_out: Option<usize>) -> &Cholesky<f64, Dyn> {
        left_out.map_or(&self.all, |fold| &self.without[fold])
    }

    /// The products with the nuisance projected out, over all experiments or with a fold left out.
    pub(crate) fn project(&self, products: &[Products], left_out: Option<usize>) -> DMatrix<f64> {
        let sum = self.sum(products, left_out);
        let solved = self.factor(left_out).solve(&sum.with_nuisance);
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
    pub(crate) fn nuisance_of(
        &self,
        products: &[Products],
        shift: &DVector<f64>,
        left_out: Option<usize>,
    ) -> DVector<f64> {
        let sum = self.sum(products, left_out);
        self.factor(left_out).solve(&(sum.with_nuisance * shift))
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

fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
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
