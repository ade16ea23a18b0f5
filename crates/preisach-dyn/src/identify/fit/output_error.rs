//! Output error: records are simulated from their first sample and compared.

use crate::ActuatorModel;
use crate::identify::fit::passage::{Command, Passage};
use crate::identify::records::prepared::Prepared;
use crate::laws::play_map::split;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Residuals kept of one record at most; all samples are simulated.
const MOST_RESIDUALS: usize = 800;
/// Residuals outside the domain over the best ones.
const PENALTY: f64 = 10.0;
/// A parameter whose influence is below this share of the largest has none.
const DEAD: f64 = 1e-10;
/// Largest deviation of a parameter of order one that is knowledge.
const MOST_DEVIATION: f64 = 10.0;
/// Step of the difference quotients.
const DIFFERENCE: f64 = 1e-5;

/// A family of models: the one of given parameters, none outside the family's domain. Parameters are
/// of order one: a step of 1e-5 in any of them must mean something.
pub(crate) type Build<'a> = &'a (dyn Fn(&DVector<f64>) -> Option<ActuatorModel> + Sync);

/// What is known of a parameter beforehand: the residual `weight (x - at)` is added.
///
/// Where records determine the parameter it means little; where they do not, the parameter stays
/// where the literature has it instead of wandering off.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pull {
    pub(crate) at: f64,
    pub(crate) weight: f64,
    /// Standard deviation of what is known.
    pub(crate) deviation: f64,
}

impl Pull {
    /// Information on the parameter, and that information times the variance of the residual behind it.
    fn information(self) -> [f64; 2] {
        let own = self.weight * self.weight;
        // nothing is known where the deviation is infinite
        let noise = if own > 0.0 { self.weight * self.deviation } else { 0.0 };
        [own, own * noise * noise]
    }
}

/// A parameter with its uncertainty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Name, with its unit.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Standard deviation; infinite if the records do not determine the parameter.
    pub std_deviation: f64,
    /// Share of what is known of it that comes from usual values instead of the records, 0 to 1.
    #[serde(default)]
    pub usual_share: f64,
}

impl Estimate {
    /// Whether usual values say more of it than the records do.
    pub fn is_tied(&self) -> bool {
        self.usual_share > 0.5
    }
}

/// The samples that the slopes of a search come from; residuals come from all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slopes {
    /// All.
    Exact,
    /// Those that give residuals, the signals straight between them: good enough to find the way, for
    /// models whose steps may be that long.
    Thinned,
}

/// Whether a fit finds the covariance of its parameters: the folds of a cross-validation need none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Uncertainty {
    Wanted,
    LeftOut,
}

impl Uncertainty {
    /// The covariance of the parameters where a problem stands, if it is wanted and there is one.
    pub(crate) fn of<'a>(self, problem: impl FnOnce() -> OutputError<'a>) -> Option<Covariance> {
        match self {
            Self::Wanted => problem().covariance(),
            Self::LeftOut => None,
        }
    }
}

/// Parameters with their standard deviations: infinite without a covariance.
pub(crate) fn estimates(
    names: &[&str],
    x: &DVector<f64>,
    covariance: Option<&Covariance>,
) -> Vec<Estimate> {
    let estimate = |(k, (name, &value)): (usize, (&&str, &f64))| Estimate {
        name: (*name).to_owned(),
        value,
        std_deviation: covariance.map_or(f64::INFINITY, |c| c.std_deviation(k)),
        usual_share: covariance.and_then(|c| c.usual_shares.get(k).copied()).unwrap_or(0.0),
    };
    names.iter().zip(x).enumerate().map(estimate).collect()
}

/// Covariance of refined parameters.
///
/// ```text
/// C = H^-1 [ sum_k s_k^2 T_k J_k' J_k ] H^-1,   H = J'J,   T_k = 1 + 2 sum_lag rho_k(lag)
/// ```
/// Gauss-Newton about the minimum, record by record `k` with its own residual variance `s_k^2`. What a
/// model misses is correlated from sample to sample, so `n` samples are worth `n / T_k` independent
/// ones; the autocorrelations are summed up to their first zero. Misfit of the model counts as noise
/// here: where it dominates, the true parameters of a better model may lie further off. Cycles and records are
/// drawn anew besides: to first order a bootstrap over them has, in the place of the sum,
/// ```text
/// sum_c n / (n - 1) g_c g_c',   g_c = J_c' r_c over one of n cycles (one of n records)
/// ```
/// and the largest of the three deviations stands. What is known beforehand counts as a measurement. A deviation
/// beyond 10, for parameters of order one, is no knowledge: infinite.
/// Source: G. A. F. Seber, C. J. Wild, *Nonlinear Regression* (1989), sections 2.1 and 6.2.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Covariance {
    /// The matrix, row by row, in the order of the parameters.
    pub rows: Vec<Vec<f64>>,
    /// Residuals used.
    pub samples: usize,
    /// Independent residuals they are worth.
    pub effective_samples: f64,
    /// Share of what is known of each parameter that comes from usual values, 0 to 1.
    #[serde(default)]
    pub usual_shares: Vec<f64>,
}

impl Covariance {
    /// Standard deviation of parameter `index`.
    pub fn std_deviation(&self, index: usize) -> f64 {
        self.rows.get(index).and_then(|row| row.get(index)).map_or(f64::NAN, |v| v.sqrt())
    }
}

/// Where a minimisation ended.
pub(crate) struct Minimum {
    pub(crate) x: DVector<f64>,
    pub(crate) model: ActuatorModel,
    /// Root mean square of the NRMSE of the records, with the pulls if there are any.
    pub(crate) nrmse: f64,
    /// Evaluations spent.
    pub(crate) steps: usize,
}

/// The problem of one family on some records.
#[derive(Clone)]
pub(crate) struct OutputError<'a> {
    build: Build<'a>,
    records: &'a [&'a Prepared<'a>],
    commands: Vec<Command<'a>>,
    /// The commands that slopes are found with, if these are others.
    thinned: Option<Vec<Command<'a>>>,
    /// Of the first parameters.
    pulls: &'a [Pull],
    x: DVector<f64>,
    /// Residuals at `x`; outside the domain those of the best parameters ten times as
    /// large, so that the step is taken back; none if the start lies outside.
    here: Option<DVector<f64>>,
    /// The best parameters so far and their residuals.
    best: Option<(DVector<f64>, DVector<f64>)>,
    /// The parameters last tried that gave residuals, and their model run over the records.
    passage: Option<(DVector<f64>, Passage)>,
}

impl<'a> OutputError<'a> {
    /// The problem at some parameters, with what is known beforehand of the first of them.
    pub(crate) fn new(
        build: Build<'a>,
        records: &'a [&'a Prepared<'a>],
        pulls: &'a [Pull],
        x: DVector<f64>,
    ) -> Self {
        let commands = records.iter().map(|r| Command::whole(r)).collect();
        let mut problem = Self {
            build,
            records,
            commands,
            thinned: None,
            pulls,
            x,
            here: None,
            best: None,
            passage: None,
        };
        problem.here = problem.tried();
        problem.best = problem.here.clone().map(|here| (problem.x.clone(), here));
        problem
    }

    /// With slopes of a kind.
    pub(crate) fn with(self, slopes: Slopes) -> Self {
        let thinned = |r: &&'a Prepared<'a>| {
            let (first, stride) = (r.record.trained_samples().start, Self::stride(r));
            Command::thinned(r, if first.is_multiple_of(stride) { stride } else { 1 })
        };
        let is_thinned = slopes == Slopes::Thinned;
        Self { thinned: is_thinned.then(|| self.records.iter().map(thinned).collect()), ..self }
    }

    /// Root mean square of the NRMSE of the records at the start, with the pulls.
    pub(crate) fn nrmse(&self) -> Option<f64> {
        Some(self.here.as_ref()?.norm())
    }

    /// Samples of a record from one residual to the next.
    fn stride(record: &Prepared) -> usize {
        record.record.trained_samples().len().div_ceil(MOST_RESIDUALS).max(1)
    }

    /// Samples of a record that give residuals.
    pub(crate) fn kept(record: &Prepared) -> impl Iterator<Item = usize> + Clone + use<> {
        let left_out = record.left_out.clone();
        let trained = record.record.trained_samples().step_by(Self::stride(record));
        trained.filter(move |index| !left_out.contains(index))
    }

    /// Residuals at some parameters, with the passage they come from; none if the model diverges.
    fn evaluated(&self, x: &DVector<f64>, commands: &[Command]) -> Option<(DVector<f64>, Passage)> {
        let passage = Passage::of((self.build)(x)?, commands)?;
        Some((self.residuals(x, commands, |r| passage.output_deg(r))?, passage))
    }

    /// Residuals at the present parameters, their passage kept.
    fn tried(&mut self) -> Option<DVector<f64>> {
        let (here, passage) = self.evaluated(&self.x, &self.commands)?;
        self.passage = Some((self.x.clone(), passage));
        Some(here)
    }

    /// Weighted residuals of all records, one after another, from the flap angles at each sample of
    /// each command; none if they are not finite.
    fn residuals<'o>(
        &self,
        x: &DVector<f64>,
        commands: &[Command],
        output_deg: impl Fn(usize) -> &'o [f64],
    ) -> Option<DVector<f64>> {
        let mut residuals = Vec::new();
        for (r, (prepared, command)) in self.records.iter().zip(commands).enumerate() {
            let measured = &prepared.record.output_deg;
            let kept = Self::kept(prepared).count() as f64 * self.records.len() as f64;
            let weight = 1.0 / (prepared.spread_deg * kept.sqrt());
            let output = output_deg(r);
            let error = |i: usize| weight * (output[i / command.stride] - measured[i]);
            residuals.extend(Self::kept(prepared).map(error));
        }
        residuals.extend(self.pulls.iter().zip(x.iter()).map(|(p, x)| p.weight * (x - p.at)));
        let residuals = DVector::from_vec(residuals);
        residuals.iter().all(|r| r.is_finite()).then_some(residuals)
    }

    /// Residuals at parameters beside those of a passage; none where the model diverges.
    fn residuals_beside(
        &self,
        passage: &Passage,
        moved: &[DVector<f64>],
        commands: &[Command],
    ) -> Vec<Option<DVector<f64>>> {
        let models: Vec<Option<ActuatorModel>> = moved.iter().map(|x| (self.build)(x)).collect();
        let laws = passage.laws_beside(&models, commands);
        let columns: Vec<_> = moved.iter().zip(models).zip(laws).collect();
        columns
            .into_par_iter()
            .map(|((x, model), law)| {
                let outputs = passage.beside(&model?, law, commands)?;
                self.residuals(x, commands, |r| &outputs[r])
            })
            .collect()
    }

    /// Levenberg-Marquardt from the start; none if the start lies outside the domain.
    pub(crate) fn minimise(self, patience: usize) -> Option<Minimum> {
        self.nrmse()?;
        let (problem, report) = LevenbergMarquardt::new()
            .with_patience(patience)
            .with_ftol(1e-4)
            .with_xtol(1e-4)
            .minimize(self);
        let (x, residuals) = problem.best?;
        let model = (problem.build)(&x)?;
        let steps = report.number_of_evaluations;
        Some(Minimum { model, nrmse: residuals.norm(), steps, x })
    }

    /// The covariance of the parameters where the problem stands; none outside the domain or if
    /// parameters act alike.
    fn covariance(&self) -> Option<Covariance> {
        let here = self.here.as_ref()?;
        let whole = self.jacobian()?;
        let sizes: Vec<f64> = whole.column_iter().map(|c| c.norm()).collect();
        // what has no influence is left out: its variance is infinite
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let active: Vec<usize> = (0..self.x.len()).filter(|&k| sizes[k] > DEAD * largest).collect();
        // columns of one size: parameters of little influence must not cost the others their digits
        let mut jacobian = whole.select_columns(&active);
        for (mut column, &k) in jacobian.column_iter_mut().zip(&active) {
            column /= sizes[k];
        }
        let inverse = (jacobian.transpose() * &jacobian).cholesky()?.inverse();
        let Scores { noise, cycles, records, samples, effective_samples } =
            self.scores(here, &jacobian);
        let pulls = active.iter().map(|&k| self.pulls.get(k).copied().map(Pull::information));
        let pulls: Vec<[f64; 2]> = pulls.map(Option::unwrap_or_default).collect();
        let sandwich = |mut middle: DMatrix<f64>| {
            for (i, (&k, [_, noise])) in active.iter().zip(&pulls).enumerate() {
                middle[(i, i)] += noise / (sizes[k] * sizes[k]);
            }
            &inverse * middle * &inverse
        };
        let mut matrix = sandwich(noise);
        let drawn = [cycles, records].map(sandwich);
        let widened = |i: usize| {
            let largest = drawn.iter().map(|m| m[(i, i)]).fold(matrix[(i, i)], f64::max);
            (largest / matrix[(i, i)].max(f64::MIN_POSITIVE)).sqrt()
        };
        let factors: Vec<f64> = (0..active.len()).map(widened).collect();
        for i in 0..active.len() {
            for j in 0..active.len() {
                matrix[(i, j)] *= factors[i] * factors[j] / (sizes[active[i]] * sizes[active[j]]);
            }
        }
        let mut rows = vec![vec![0.0; self.x.len()]; self.x.len()];
        let mut usual_shares = vec![0.0; self.x.len()];
        (0..self.x.len()).for_each(|k| rows[k][k] = f64::INFINITY);
        for (i, &row) in active.iter().enumerate() {
            let [own, _] = pulls[i];
            usual_shares[row] = own * inverse[(i, i)] / (sizes[row] * sizes[row]);
            if matrix[(i, i)].sqrt() > MOST_DEVIATION {
                continue;
            }
            for (j, &column) in active.iter().enumerate() {
                rows[row][column] = matrix[(i, j)];
            }
        }
        Some(Covariance { rows, samples, effective_samples, usual_shares })
    }

    /// The sums of the scores `J' r` that a covariance is made of, from scaled columns.
    fn scores(&self, here: &DVector<f64>, jacobian: &DMatrix<f64>) -> Scores {
        let count = jacobian.ncols();
        let mut sums = Scores {
            noise: DMatrix::zeros(count, count),
            cycles: DMatrix::zeros(count, count),
            records: DMatrix::zeros(count, count),
            samples: 0,
            effective_samples: 0.0,
        };
        let share = |drawn: usize| drawn as f64 / (drawn.max(2) - 1) as f64;
        for prepared in self.records {
            let kept = Self::kept(prepared).count();
            let residuals: Vec<f64> = here.rows(sums.samples, kept).iter().copied().collect();
            let rows = jacobian.rows(sums.samples, kept);
            let variance = residuals.iter().map(|r| r * r).sum::<f64>() / kept as f64;
            let time = correlation_time(&residuals);
            sums.noise += rows.transpose() * rows * (variance * time);
            sums.effective_samples += kept as f64 / time;
            let parts = Self::cycles(prepared).clamp(1, kept);
            let whole = rows.transpose() * here.rows(sums.samples, kept);
            let length = kept.div_ceil(parts);
            let mut drawn = DMatrix::zeros(count, count);
            let starts = (0..kept).step_by(length);
            let used = starts.len();
            for start in starts {
                let part = start..(start + length).min(kept);
                let score = rows.rows(part.start, part.len()).transpose()
                    * here.rows(sums.samples + part.start, part.len())
                    - &whole / used as f64;
                drawn += &score * score.transpose();
            }
            if used > 1 {
                sums.cycles += drawn * share(used);
            }
            if self.records.len() > 1 {
                sums.records += &whole * whole.transpose() * share(self.records.len());
            }
            sums.samples += kept;
        }
        sums
    }

    /// Whole cycles of the samples of a record that train; 1 of what does not repeat.
    fn cycles(record: &Prepared) -> usize {
        let seconds = record.record.trained_samples().len() as f64 * record.record.time_step_s;
        let periods = if record.drive.is_periodic() { seconds * record.drive.base_hz } else { 1.0 };
        split(periods + 0.5).0
    }
}

/// Sums of scores, with columns scaled to one size.
struct Scores {
    /// Of noise of the correlation that the residuals show.
    noise: DMatrix<f64>,
    /// Of cycles drawn anew in every record.
    cycles: DMatrix<f64>,
    /// Of records drawn anew.
    records: DMatrix<f64>,
    samples: usize,
    effective_samples: f64,
}

/// `1 + 2 sum rho` up to the first lag at which the autocorrelation is not positive.
fn correlation_time(residuals: &[f64]) -> f64 {
    let variance: f64 = residuals.iter().map(|r| r * r).sum();
    if variance <= 0.0 {
        return 1.0;
    }
    let at = |lag: usize| {
        residuals.iter().zip(&residuals[lag..]).map(|(a, b)| a * b).sum::<f64>() / variance
    };
    let sum: f64 = (1..residuals.len() / 2).map(at).take_while(|rho| *rho > 0.0).sum();
    1.0 + 2.0 * sum
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for OutputError<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        self.x.copy_from(x);
        let found = match &self.best {
            // a step taken back
            Some((at, best)) if at == x => Some(best.clone()),
            _ => self.tried(),
        };
        if let (Some(found), Some((_, best))) = (&found, &self.best)
            && found.norm() < best.norm()
        {
            self.best = Some((x.clone(), found.clone()));
        }
        self.here = found.or_else(|| self.best.as_ref().map(|(_, best)| best * PENALTY));
    }

    fn params(&self) -> DVector<f64> {
        self.x.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        self.here.clone()
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let commands = self.thinned.as_ref().unwrap_or(&self.commands);
        // the last passage, unless a step was taken back since
        let last = self.passage.as_ref().filter(|(x, _)| self.thinned.is_none() && *x == self.x);
        let kept = last.and_then(|(_, passage)| Some((self.here.clone()?, Cow::Borrowed(passage))));
        let anew = || self.evaluated(&self.x, commands).map(|(here, p)| (here, Cow::Owned(p)));
        let (here, passage) = kept.or_else(anew)?;
        let moved = |k: usize, difference: f64| {
            let mut x = self.x.clone();
            x[k] += difference;
            x
        };
        let ahead: Vec<_> = (0..self.x.len()).map(|k| moved(k, DIFFERENCE)).collect();
        let columns = self
            .residuals_beside(&passage, &ahead, commands)
            .into_iter()
            .enumerate()
            .map(|(k, found)| {
                // the domain may end at the parameter
                let back = || Some((self.evaluated(&moved(k, -DIFFERENCE), commands)?.0, -1.0));
                let (found, sign) = found.map(|found| (found, 1.0)).or_else(back)?;
                Some((found - &here) / (sign * DIFFERENCE))
            })
            .collect::<Option<Vec<_>>>()?;
        Some(DMatrix::from_columns(&columns))
    }
}
