//! The open set: what is left, whether parameters hold still, how well they are known.

use super::FittedParameter;
use super::evidence::{Evidence, Seen, columns, difference, normal_equations, residual, ridged};
use super::fit::Fitted;
use super::thresholds::{DRIFT_DEVIATIONS, FALSE_ALARM, GENERIC_MARGIN};
use super::{Discovery, Signal, Simulator};
use crate::GapError;
use crate::quantile::{NORMAL_975, chi2_exceeded, student_975};
use nalgebra::{DMatrix, DVector};

/// The generic directions, ready to be tested against residuals.
pub(crate) struct Generic<'a> {
    directions: Vec<Seen<'a>>,
    /// Projected products of the directions, inverted on their range.
    inverse: DMatrix<f64>,
    /// Excess that surrogates with nothing missing reach, with a margin.
    pub(crate) threshold: f64,
}

impl<'a> Generic<'a> {
    /// `structures` is what the base model leaves of surrogates with nothing missing.
    pub(crate) fn new(
        evidence: &Evidence<'_>,
        directions: &'a [Signal],
        structures: &[Signal],
    ) -> Self {
        let directions = evidence.seen(&directions.iter().collect::<Vec<_>>());
        let (inverse, rank) = pseudo_inverse(&evidence.inners(&directions));
        let mut own = Self { directions, inverse, threshold: 0.0 };
        let structural = structures.iter().map(|s| own.along(evidence, s)).fold(0.0, f64::max);
        let noise = if rank > 0.0 { chi2_exceeded(rank, FALSE_ALARM) } else { 0.0 };
        own.threshold = GENERIC_MARGIN * structural + noise;
        own
    }

    /// Energy of a residual along the directions, in units of the noise variance.
    pub(crate) fn along(&self, evidence: &Evidence<'_>, residual: &Signal) -> f64 {
        let seen = evidence.see(residual);
        let along = DVector::from_iterator(
            self.directions.len(),
            self.directions.iter().map(|own| evidence.inner(own, &seen)),
        );
        (along.transpose() * &self.inverse * along)[0].max(0.0)
    }
}

/// Inverse on the range of a positive semidefinite matrix, and its rank.
fn pseudo_inverse(gram: &DMatrix<f64>) -> (DMatrix<f64>, f64) {
    let n = gram.nrows();
    if n == 0 {
        return (gram.clone(), 0.0);
    }
    // columns of unit size first, so that the rank does not depend on units
    let size: Vec<f64> = (0..n).map(|i| gram[(i, i)].max(0.0).sqrt()).collect();
    let scaled = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(n, n, |i, j| {
            let s = size[i] * size[j];
            if s > 0.0 { matrix[(i, j)] / s } else { 0.0 }
        })
    };
    let eigen = scaled(gram).symmetric_eigen();
    let mut inverse = DMatrix::zeros(n, n);
    let mut rank = 0.0;
    for (k, &value) in eigen.eigenvalues.iter().enumerate() {
        if value > 1e-6 {
            rank += 1.0;
            let v = eigen.eigenvectors.column(k);
            inverse += v * v.transpose() / value;
        }
    }
    (scaled(&inverse), rank)
}

/// How one fitted coordinate varies from experiment to experiment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drift {
    /// Sum of squared deviations over their variances, per degree of freedom.
    pub(crate) chi2_per_degree: f64,
    /// Standard deviation of the coordinate over the experiments, noise taken out.
    pub(crate) spread: f64,
    degrees: f64,
}

impl Drift {
    /// What the misfit would drop by if every experiment had a value of its own, in units of the noise
    /// variance.
    pub(crate) fn lost(&self) -> f64 {
        (self.chi2_per_degree - 1.0).max(0.0) * self.degrees
    }

    pub(crate) fn is_significant(&self) -> bool {
        self.degrees >= 1.0
            && self.chi2_per_degree > 1.0 + DRIFT_DEVIATIONS * (2.0 / self.degrees).sqrt()
    }
}

/// The variation of a free coordinate (number from 0) over the experiments that show it.
///
/// ```text
/// Q = sum w (x - m)^2,   m = sum w x / W,   spread^2 = (Q - degrees) / (W - sum w^2 / W),   W = sum w
/// ```
/// The last denominator is that of `DerSimonian` and Laird, Controlled Clinical Trials 7 (1986) 177: one experiment
/// that knows the coordinate far better than the others does not hide how these vary.
pub(crate) fn drift(evidence: &Evidence<'_>, fitted: &Fitted, coordinate: usize) -> Drift {
    let mut shifts = Vec::new();
    for (experiment, products) in fitted.products.iter().enumerate() {
        let gram = evidence.project_alone(products, experiment);
        let information = gram[(coordinate + 1, coordinate + 1)];
        shifts.push((-gram[(0, coordinate + 1)] / information.max(1e-300), information));
    }
    let total: f64 = shifts.iter().map(|s| s.1).sum();
    shifts.retain(|s| s.1 > 0.02 * total);
    let kept: f64 = shifts.iter().map(|s| s.1).sum();
    let mean = shifts.iter().map(|s| s.0 * s.1).sum::<f64>() / kept.max(1e-300);
    let chi2: f64 = shifts.iter().map(|s| (s.0 - mean).powi(2) * s.1).sum();
    let degrees = (shifts.len() as f64 - 1.0).max(0.0);
    let excess = (chi2 - degrees).max(0.0);
    let squares: f64 = shifts.iter().map(|s| s.1.powi(2)).sum();
    let apart = kept - squares / kept.max(1e-300);
    Drift {
        chi2_per_degree: if degrees > 0.0 { chi2 / degrees } else { 0.0 },
        spread: (excess / apart.max(1e-300)).sqrt(),
        degrees,
    }
}

/// Squares of what moves the coordinates of a fit besides noise: an error of form of the effect, and
/// structure of the base model.
///
/// ```text
/// s_k' = s_k - the other slopes and the nuisance projected out
/// form_k = F <e, s_k'> / |s_k'|^2,   structure_k = q rms over surrogates z of <z, s_k'> / |s_k'|^2
/// held_k = <h, s_k'> / |s_k'|^2
/// ```
/// `e` is what the effect adds to the rest. No model of a cause is exact: what it lacks is taken to be
/// along its own effect by a part `F` of it ([`crate::Candidate::form_error`]), and each parameter moves as it would have to. `h` is what a standard
/// deviation of a parameter that is held adds. What the
/// base model leaves of a surrogate with nothing missing moves a parameter likewise; `q` is Student's quantile
/// for so many surrogates over the normal one, because a few draws tell a spread badly.
fn shifts<S: Simulator>(
    discovery: &Discovery<'_, S>,
    evidence: &Evidence<'_>,
    fitted: &Fitted,
    effect: usize,
    rest: &Fitted,
) -> Result<Option<DVector<f64>>, GapError> {
    let cause = &discovery.candidates[fitted.effects[effect].candidate];
    let added = difference(&rest.residual, &fitted.residual);
    let held = held_shifts(discovery, evidence, fitted, effect)?;
    let first = 1 + held.len();
    let others = first + discovery.structures.len();
    let mut columns = columns(&added, &held);
    columns.extend(discovery.structures.iter().chain(&fitted.slopes));
    let gram = evidence.gram(&columns);
    let n = fitted.slopes.len();
    let normal = ridged(gram.view((others, others), (n, n)).clone_owned(), 1e-12, 0.0);
    // regression on all slopes at once: each coefficient is <., s'> / |s'|^2
    let right = gram.view((others, 0), (n, others)).clone_owned();
    let Some(moved) = normal.cholesky().map(|c| c.solve(&right)) else { return Ok(None) };
    let surrogates = discovery.structures.len().max(1) as f64;
    let few = student_975(surrogates) / NORMAL_975;
    Ok(Some(DVector::from_fn(n, |k, _| {
        let sum =
            |columns: std::ops::Range<usize>| columns.map(|c| moved[(k, c)].powi(2)).sum::<f64>();
        (cause.form_error * moved[(k, 0)]).powi(2)
            + sum(1..first)
            + few * few * sum(first..others) / surrogates
    })))
}

/// What a standard deviation of each parameter that is held does to the residual.
fn held_shifts<S: Simulator>(
    discovery: &Discovery<'_, S>,
    evidence: &Evidence<'_>,
    fitted: &Fitted,
    effect: usize,
) -> Result<Vec<Signal>, GapError> {
    let own = &fitted.effects[effect];
    let parameters = &discovery.candidates[own.candidate].parameters;
    let mut shifts = Vec::new();
    for (p, parameter) in parameters.iter().enumerate() {
        if let Some(std) = parameter.held {
            let mut effects = fitted.effects.clone();
            let x = parameter.coordinate(own.values[p]);
            effects[effect].values[p] = parameter.value(x + std);
            let moved = residual(evidence.traces, &discovery.simulator.predict(&effects)?);
            shifts.push(difference(&moved, &fitted.residual));
        }
    }
    Ok(shifts)
}

/// Values with 95 % intervals of the parameters of effect `effect`; `rest` is the fit without it.
///
/// # Errors
/// As [`Simulator::predict`].
pub(crate) fn parameters<S: Simulator>(
    discovery: &Discovery<'_, S>,
    evidence: &Evidence<'_>,
    fitted: &Fitted,
    effect: usize,
    rest: &Fitted,
) -> Result<Vec<FittedParameter>, GapError> {
    let own = &fitted.effects[effect];
    let cause = &discovery.candidates[own.candidate];
    let shifts = shifts(discovery, evidence, fitted, effect, rest)?;
    let (normal, _) = normal_equations(&evidence.project(&fitted.products));
    let covariance = ridged(normal, 1e-12, 0.0).cholesky().map(|c| c.inverse());
    let fitted = cause
        .parameters
        .iter()
        .enumerate()
        .map(|(p, parameter)| {
            let value = own.values[p];
            let place = fitted.free.iter().position(|&at| at == (effect, p));
            let std = place.and_then(|k| {
                let variance = covariance.as_ref()?[(k, k)];
                let inflation = drift(evidence, fitted, k).chi2_per_degree.max(1.0);
                let shift = shifts.as_ref().map_or(0.0, |s| s[k]);
                Some((variance * inflation + shift).sqrt())
            });
            let known = std.filter(|_| parameter.needs.is_none());
            let ci95 = known.map_or([parameter.low, parameter.high], |std| {
                let x = parameter.coordinate(value);
                [parameter.value(x - 1.96 * std), parameter.value(x + 1.96 * std)]
            });
            FittedParameter {
                name: parameter.name,
                unit: parameter.unit,
                value,
                ci95,
                is_shape: parameter.is_shape,
                needs: parameter.needs,
            }
        })
        .collect();
    Ok(fitted)
}

/// Standard error over the blocks of the drop of the misfit from one fit to another.
pub(crate) fn drop_error(evidence: &Evidence<'_>, worse: &Fitted, better: &Fitted) -> f64 {
    let (a, b) = (worse.cleaned(evidence), better.cleaned(evidence));
    let mut drops: Vec<f64> = Vec::new();
    for ((a, b), trace) in a.iter().zip(&b).zip(evidence.traces) {
        let weight = 1.0 / (trace.sigma * trace.sigma);
        for (a, b) in a.chunks(trace.block).zip(b.chunks(trace.block)) {
            let sum = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>();
            drops.push((sum(a) - sum(b)) * weight);
        }
    }
    let n = drops.len() as f64;
    if n < 2.0 { f64::INFINITY } else { (rotor_base::variance(&drops) * n * n / (n - 1.0)).sqrt() }
}
