//! Fits of the parameters of one or several causes, the nuisance projected out.

use super::evidence::{
    Evidence, Products, columns, difference, normal_equations, residual, ridged,
};
use super::{Signal, Simulator};
use crate::{Candidate, Effect, GapError, Parameter};
use nalgebra::{DMatrix, DVector};

/// Effects fitted to all experiments, with what is needed to fit them to fewer.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    pub(crate) effects: Vec<Effect>,
    /// Projected sum of squares over the noise.
    pub(crate) cost: f64,
    /// Measured less predicted, nuisance not taken out.
    pub(crate) residual: Signal,
    /// Change of the residual per coordinate, free coordinates only.
    pub(crate) slopes: Vec<Signal>,
    /// Which coordinates are free: effect and parameter.
    pub(crate) free: Vec<(usize, usize)>,
    /// Products of residual and slopes, experiment by experiment.
    pub(crate) products: Vec<Products>,
    /// Rise of the cost of the whole set up to which a fold may move the parameters, the residual taken
    /// as straight in them.
    pub(crate) trust: f64,
}

/// Where a descent has come to.
struct Descent {
    effects: Vec<Effect>,
    free: Vec<(usize, usize)>,
    residual: Signal,
    cost: f64,
}

/// Fits effects.
pub(crate) struct Fitter<'a, S> {
    pub(crate) simulator: &'a S,
    pub(crate) evidence: &'a Evidence<'a>,
    pub(crate) candidates: &'a [Candidate],
}

/// Part of the drop of a fit up to which its residual counts as straight in the parameters.
const TRUSTED: f64 = 0.1;
/// Weight of the whole set in the fit of a fold.
const KEPT: f64 = 0.02;
const ITERATIONS: usize = 12;
/// Iterations that a start which costs much and promises much is given to show it.
const TRIAL_ITERATIONS: usize = 4;
/// Part of the drop found from other starts that it must have reached by then.
const TRIAL_SHARE: f64 = 0.5;
/// Change of the cost below which a fit has converged.
const CONVERGED: f64 = 0.02;
/// Largest step of a logarithmic coordinate.
const LARGEST_LOG_STEP: f64 = 0.7;

impl<S: Simulator> Fitter<'_, S> {
    fn parameter(&self, effects: &[Effect], at: (usize, usize)) -> &Parameter {
        &self.candidates[effects[at.0].candidate].parameters[at.1]
    }

    pub(crate) fn residual(&self, effects: &[Effect]) -> Result<Signal, GapError> {
        Ok(residual(self.evidence.traces, &self.simulator.predict(effects)?))
    }

    pub(crate) fn cost_of(&self, residual: &Signal) -> f64 {
        let seen = self.evidence.see(residual);
        self.evidence.inner(&seen, &seen)
    }

    /// The best fit of the effects of `before` (refitted too) and a further candidate, from every
    /// start given; none if no start promises a drop of `least` were its effect scaled freely.
    pub(crate) fn fit_with(
        &self,
        before: &Fitted,
        candidate: usize,
        starts: &[Vec<f64>],
        least: f64,
    ) -> Result<Option<Fitted>, GapError> {
        let mut tried = Vec::new();
        let mut promise = 0.0_f64;
        let own = self.evidence.see(&before.residual);
        for values in starts {
            let mut effects = before.effects.clone();
            effects.push(Effect { candidate, values: values.clone() });
            let residual = self.residual(&effects)?;
            let with = self.evidence.see(&residual);
            let (both, cost) =
                (self.evidence.inner(&own, &with), self.evidence.inner(&with, &with));
            let along = before.cost - both;
            let size = before.cost - 2.0 * both + cost;
            let own_promise = if along > 0.0 && size > 0.0 { along * along / size } else { 0.0 };
            promise = promise.max(own_promise);
            tried.push((cost, own_promise, effects));
        }
        if promise < least {
            return Ok(None);
        }
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        let promising = tried.iter().enumerate().max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let third = promising.map(|(place, (_, promise, _))| (place, *promise));
        let mut best: Option<Fitted> = None;
        let mut refined = |effects: &[Effect]| -> Result<f64, GapError> {
            let mut found = self.refine(effects.to_vec())?;
            let drop = before.cost - found.cost;
            found.trust = TRUSTED * drop.max(0.0);
            if best.as_ref().is_none_or(|b| found.cost < b.cost) {
                best = Some(found);
            }
            Ok(drop)
        };
        let mut drop = 0.0_f64;
        for (_, _, effects) in tried.iter().take(2) {
            drop = drop.max(refined(effects)?);
        }
        // the effect of a start may be right in form and too large: it costs more than none and promises much
        if let Some((place, promise)) = third
            && place > 1
            && promise > drop
        {
            let on_trial = self.descend(tried[place].2.clone(), TRIAL_ITERATIONS)?;
            if before.cost - on_trial.cost > TRIAL_SHARE * drop {
                refined(&on_trial.effects)?;
            }
        }
        Ok(best)
    }

    /// Levenberg-Marquardt from given effects, with what folds and intervals need.
    pub(crate) fn refine(&self, effects: Vec<Effect>) -> Result<Fitted, GapError> {
        let Descent { effects, free, residual, cost } = self.descend(effects, ITERATIONS)?;
        let slopes = self.slopes(&effects, &residual, &free)?;
        let products = self.evidence.products(&columns(&residual, &slopes));
        Ok(Fitted { effects, cost, residual, slopes, free, products, trust: f64::INFINITY })
    }

    /// Levenberg-Marquardt from given effects.
    fn descend(&self, mut effects: Vec<Effect>, iterations: usize) -> Result<Descent, GapError> {
        let free: Vec<(usize, usize)> = effects
            .iter()
            .enumerate()
            .flat_map(|(e, effect)| (0..effect.values.len()).map(move |p| (e, p)))
            .filter(|&at| self.parameter(&effects, at).held.is_none())
            .collect();
        let mut residual = self.residual(&effects)?;
        let mut cost = self.cost_of(&residual);
        let mut damping = 1e-3;
        for _ in 0..iterations {
            let slopes = self.slopes(&effects, &residual, &free)?;
            let gram = self.evidence.gram(&columns(&residual, &slopes));
            let (normal, right) = normal_equations(&gram);
            let mut improved = None;
            for _ in 0..4 {
                let mut damped = normal.clone();
                for i in 0..free.len() {
                    damped[(i, i)] += damping * normal[(i, i)] + 1e-12 + 1e-9 * normal.trace();
                }
                let Some(step) = damped.cholesky().map(|c| c.solve(&right)) else { break };
                let moved = self.moved(&effects, &free, &step);
                let new_residual = self.residual(&moved)?;
                let new_cost = self.cost_of(&new_residual);
                if new_cost < cost {
                    improved = Some((moved, new_residual, new_cost));
                    damping = (damping * 0.1).max(1e-9);
                    break;
                }
                damping *= 10.0;
                if cost - new_cost > -CONVERGED && damping > 1.0 {
                    break;
                }
            }
            let Some((moved, new_residual, new_cost)) = improved else { break };
            let gained = cost - new_cost;
            (effects, residual, cost) = (moved, new_residual, new_cost);
            if gained < CONVERGED {
                break;
            }
        }
        Ok(Descent { effects, free, residual, cost })
    }

    /// Slopes of the residual by one-sided differences, turned inward at the upper bound.
    pub(crate) fn slopes(
        &self,
        effects: &[Effect],
        residual: &Signal,
        free: &[(usize, usize)],
    ) -> Result<Vec<Signal>, GapError> {
        free.iter()
            .map(|&at| {
                let parameter = self.parameter(effects, at);
                let value = effects[at.0].values[at.1];
                let x = parameter.coordinate(value);
                let mut step = parameter.step(value);
                let other = parameter.value(x + step);
                if (parameter.coordinate(other) - x).abs() < 0.5 * step {
                    step = -step;
                }
                let mut shifted = effects.to_vec();
                shifted[at.0].values[at.1] = parameter.value(x + step);
                let change = parameter.coordinate(shifted[at.0].values[at.1]) - x;
                let there = self.residual(&shifted)?;
                let mut slope = difference(&there, residual);
                slope.iter_mut().flatten().for_each(|value| *value /= change);
                Ok(slope)
            })
            .collect()
    }

    fn moved(
        &self,
        effects: &[Effect],
        free: &[(usize, usize)],
        step: &DVector<f64>,
    ) -> Vec<Effect> {
        let mut moved = effects.to_vec();
        for (&at, &change) in free.iter().zip(step.iter()) {
            let parameter = self.parameter(effects, at);
            let change = match parameter.scale {
                crate::Scale::Log => change.clamp(-LARGEST_LOG_STEP, LARGEST_LOG_STEP),
                crate::Scale::Linear => change,
            };
            let x = parameter.coordinate(effects[at.0].values[at.1]) + change;
            moved[at.0].values[at.1] = parameter.value(x);
        }
        moved
    }
}

impl Fitted {
    /// The step of the coordinates that fits the projected products of a fold best, the residual
    /// straight in them. The first entry belongs to the residual and is 1.
    ///
    /// The products of the whole set weigh in with a fiftieth: a parameter that only the fold left out
    /// shows keeps the value of the whole fit, where the others alone would leave it anywhere. A step is
    /// cut back to where the residual may be taken as straight in the parameters.
    fn shift(&self, matrix: &DMatrix<f64>, whole: &DMatrix<f64>) -> DVector<f64> {
        let n = matrix.nrows() - 1;
        let mut shift = zero_shift(n);
        if n == 0 {
            return shift;
        }
        let (normal, right) = normal_equations(matrix);
        let whole = whole.view((1, 1), (n, n));
        let normal = ridged(normal + whole * KEPT, 1e-9, 1e-12);
        if let Some(mut step) = normal.cholesky().map(|c| c.solve(&right)) {
            let rise = (step.transpose() * whole * &step)[0];
            if rise > self.trust {
                step *= (self.trust / rise).sqrt();
            }
            shift.rows_mut(1, n).copy_from(&step);
        }
        shift
    }

    /// Sums of squares over the noise on every experiment, each predicted by a fit that has not seen
    /// its fold.
    pub(crate) fn held_out(&self, evidence: &Evidence<'_>) -> Vec<f64> {
        let folds = self.folds(evidence, &self.products);
        let left = |(e, products): (usize, &Products)| {
            let (shift, nuisance) = &folds[evidence.folds[e]];
            evidence.left_of(products, shift, nuisance, e)
        };
        self.products.iter().enumerate().map(left).collect()
    }

    /// Steps of the coordinates and nuisance of the fits that have not seen a fold, fold by fold, from products of
    /// a residual with the slopes; one fold alone is its own judge.
    pub(crate) fn folds(
        &self,
        evidence: &Evidence<'_>,
        products: &[Products],
    ) -> Vec<(DVector<f64>, DVector<f64>)> {
        let whole = evidence.project(products, None);
        let one = |fold| {
            let left_out = (evidence.fold_count > 1).then_some(fold);
            let shift = self.shift(&evidence.project(products, left_out), &whole);
            let nuisance = evidence.nuisance_of(products, &shift, left_out);
            (shift, nuisance)
        };
        (0..evidence.fold_count).map(one).collect()
    }

    /// The residual less the nuisance it asks for.
    pub(crate) fn cleaned(&self, evidence: &Evidence<'_>) -> Signal {
        let shift = zero_shift(self.free.len());
        let nuisance = evidence.nuisance_of(&self.products, &shift, None);
        let pairs = evidence.traces.iter().zip(&self.residual);
        pairs.map(|(trace, own)| trace.cleaned(own.clone(), &nuisance)).collect()
    }
}

/// No step of `parameters` coordinates: the residual as it is, whose own entry is 1 and stands first.
fn zero_shift(parameters: usize) -> DVector<f64> {
    let mut shift = DVector::zeros(parameters + 1);
    shift[0] = 1.0;
    shift
}
