//! Fits of the parameters of one or several causes, the nuisance projected out.

use super::evidence::{Evidence, Products, Seen, columns, difference, normal_equations, residual};
use super::thresholds::PARAMETER_PENALTY;
use super::{Signal, Simulator, Trace, TraceRole};
use crate::{Candidate, Effect, GapError, Parameter};
use nalgebra::{DMatrix, DVector};

/// Effects fitted to the experiments of an evidence.
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
    /// Drop of the cost that the starts promised and the fit has not reached, less the penalty on its parameters; 0
    /// of a fit that is finished.
    pub(crate) promised: f64,
}

/// How many starts a fit is given.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Starts {
    /// Those that cost least and those that promise most, where one promises `least`.
    Widely {
        /// The drop that must be promised.
        least: f64,
    },
    /// Those that promise most, until the promise is kept.
    Shortly,
}

/// A start of a fit.
struct Tried {
    cost: f64,
    /// Drop of the cost that its effect, scaled freely, would bring.
    promise: f64,
    /// The factor of that.
    scale: f64,
    effects: Vec<Effect>,
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

const ITERATIONS: usize = 20;
/// Starts that a fit below its own promise is begun again from.
const MOST_RESTARTS: usize = 3;
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

    /// The best fit of the effects of `before` (refitted too) and a further candidate, from the starts given;
    /// none if no start promises a drop of `least` were its effect scaled freely.
    ///
    /// The largest promise is a check on the fit: one that stays below it by more than the penalty on its parameters
    /// is begun again elsewhere, and where that does not help [`Fitted::promised`] says what it may have missed.
    pub(crate) fn fit_with(
        &self,
        before: &Fitted,
        candidate: usize,
        starts: &[Vec<f64>],
        search: Starts,
    ) -> Result<Option<Fitted>, GapError> {
        let mut tried = Vec::new();
        let own = self.evidence.see(&before.residual);
        for values in starts {
            tried.push(self.tried(before, &own, Effect { candidate, values: values.clone() })?);
        }
        let promise = tried.iter().map(|start| start.promise).fold(0.0, f64::max);
        let widely = match search {
            Starts::Widely { least } if promise < least => return Ok(None),
            Starts::Widely { .. } => true,
            Starts::Shortly => false,
        };
        if tried.is_empty() {
            return Ok(None);
        }
        let cheapest = {
            let mut order: Vec<usize> = (0..tried.len()).collect();
            order.sort_by(|&a, &b| tried[a].cost.total_cmp(&tried[b].cost));
            order
        };
        let mut promising: Vec<usize> = (0..tried.len()).collect();
        promising.sort_by(|&a, &b| tried[b].promise.total_cmp(&tried[a].promise));
        let mut best: Option<Fitted> = None;
        let mut drop = 0.0_f64;
        let mut refined = |effects: Vec<Effect>| -> Result<f64, GapError> {
            let found = self.refine(effects)?;
            drop = drop.max(before.cost - found.cost);
            if best.as_ref().is_none_or(|b| found.cost < b.cost) {
                best = Some(found);
            }
            Ok(drop)
        };
        let asked = promise - PARAMETER_PENALTY * self.free_parameters(candidate) as f64;
        let mut reached = f64::NEG_INFINITY;
        for &place in cheapest.iter().take(if widely { 2 } else { 0 }) {
            reached = refined(tried[place].effects.clone())?;
        }
        // the effect of a start may be right in form and of another size: it costs more than none and promises much
        let first = &tried[promising[0]];
        if widely
            && !cheapest[..cheapest.len().min(2)].contains(&promising[0])
            && first.promise > reached
        {
            let on_trial = self.descend(first.effects.clone(), TRIAL_ITERATIONS)?;
            if before.cost - on_trial.cost > TRIAL_SHARE * reached.max(0.0) {
                reached = refined(on_trial.effects)?;
            }
        }
        for &place in promising.iter().take(MOST_RESTARTS) {
            if reached >= asked {
                break;
            }
            for effects in self.scaled(&tried[place], before.effects.len()) {
                if reached < asked || reached <= 0.0 {
                    reached = refined(effects)?;
                }
            }
        }
        if reached == f64::NEG_INFINITY {
            reached = refined(tried[cheapest[0]].effects.clone())?;
        }
        Ok(best
            .map(|found| Fitted { promised: if reached < asked { asked } else { 0.0 }, ..found }))
    }

    /// What a start costs, and what it promises.
    fn tried(&self, before: &Fitted, own: &Seen<'_>, added: Effect) -> Result<Tried, GapError> {
        let mut effects = before.effects.clone();
        effects.push(added);
        let residual = self.residual(&effects)?;
        let with = self.evidence.see(&residual);
        let (both, cost) = (self.evidence.inner(own, &with), self.evidence.inner(&with, &with));
        let (along, size) = (before.cost - both, before.cost - 2.0 * both + cost);
        let scale = if size > 0.0 { along / size } else { 0.0 };
        let promise = if scale > 0.0 { along * scale } else { 0.0 };
        Ok(Tried { cost, promise, scale, effects })
    }

    /// The effect of a start, which stands last, as large as the data ask for; and as it is.
    fn scaled(&self, start: &Tried, place: usize) -> Vec<Vec<Effect>> {
        let parameters = &self.candidates[start.effects[place].candidate].parameters;
        let mut scaled = start.effects.clone();
        for (value, parameter) in scaled[place].values.iter_mut().zip(parameters) {
            if parameter.is_amount || parameter.grows {
                let sized = parameter.none + (*value - parameter.none) * start.scale;
                *value = sized.clamp(parameter.low, parameter.high);
            }
        }
        if scaled == start.effects { vec![scaled] } else { vec![scaled, start.effects.clone()] }
    }

    /// Parameters of a candidate that are fitted.
    pub(crate) fn free_parameters(&self, candidate: usize) -> usize {
        self.candidates[candidate].parameters.iter().filter(|p| p.held.is_none()).count()
    }

    /// Levenberg-Marquardt from given effects, with what folds and intervals need.
    pub(crate) fn refine(&self, effects: Vec<Effect>) -> Result<Fitted, GapError> {
        let Descent { effects, free, residual, cost } = self.descend(effects, ITERATIONS)?;
        let slopes = self.slopes(&effects, &residual, &free)?;
        let products = self.evidence.products(&columns(&residual, &slopes));
        Ok(Fitted { effects, cost, residual, slopes, free, products, promised: 0.0 })
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
            let inward = self.inward(&effects, &free, &right);
            let mut improved = None;
            for _ in 0..6 {
                let Some(step) =
                    self.projected_step(&effects, &free, (&normal, &right), &inward, damping)
                else {
                    break;
                };
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

    /// The free coordinates that do not lie at an end of their range with the descent leading out of it.
    fn inward(
        &self,
        effects: &[Effect],
        free: &[(usize, usize)],
        downhill: &DVector<f64>,
    ) -> Vec<usize> {
        let leads_inward = |&k: &usize| {
            let parameter = self.parameter(effects, free[k]);
            let x = parameter.coordinate(effects[free[k].0].values[free[k].1]);
            let (low, high) =
                (parameter.coordinate(parameter.low), parameter.coordinate(parameter.high));
            let slack = 1e-9 * (high - low);
            !(x <= low + slack && downhill[k] < 0.0 || x >= high - slack && downhill[k] > 0.0)
        };
        (0..free.len()).filter(leads_inward).collect()
    }

    /// The damped step of the coordinates of `active`, none of which leaves its range: one that would is held at its
    /// end, and the others are solved for again.
    fn projected_step(
        &self,
        effects: &[Effect],
        free: &[(usize, usize)],
        (normal, right): (&DMatrix<f64>, &DVector<f64>),
        active: &[usize],
        damping: f64,
    ) -> Option<DVector<f64>> {
        let mut active = active.to_vec();
        let mut step = DVector::zeros(free.len());
        while !active.is_empty() {
            let mut own = normal.select_rows(&active).select_columns(&active);
            for (i, &k) in active.iter().enumerate() {
                own[(i, i)] += damping * normal[(k, k)] + 1e-12 + 1e-9 * normal.trace();
            }
            // what the coordinates held at their ends move already
            let asked = right.select_rows(&active) - normal.select_rows(&active) * &step;
            let solved = own.cholesky()?.solve(&asked);
            let ends = |(i, &k): (usize, &usize)| {
                let parameter = self.parameter(effects, free[k]);
                let x = parameter.coordinate(effects[free[k].0].values[free[k].1]);
                let (low, high) =
                    (parameter.coordinate(parameter.low), parameter.coordinate(parameter.high));
                let there = x + solved[i];
                let end = (there < low).then_some(low).or((there > high).then_some(high));
                end.map(|end| (i, end - x))
            };
            let out: Vec<(usize, f64)> = active.iter().enumerate().filter_map(ends).collect();
            if out.is_empty() {
                for (i, &k) in active.iter().enumerate() {
                    step[k] = solved[i];
                }
                break;
            }
            for &(i, to_end) in out.iter().rev() {
                step[active[i]] = to_end;
                active.remove(i);
            }
        }
        Some(step)
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
    /// The nuisance that its residual asks for.
    pub(crate) fn nuisance(&self, evidence: &Evidence<'_>) -> DVector<f64> {
        evidence.nuisance_of(&self.products, &zero_shift(self.free.len()))
    }

    /// The residual less the nuisance it asks for.
    pub(crate) fn cleaned(&self, evidence: &Evidence<'_>) -> Signal {
        let nuisance = self.nuisance(evidence);
        let pairs = evidence.traces.iter().zip(&self.residual);
        pairs.map(|(trace, own)| trace.cleaned(own.clone(), &nuisance)).collect()
    }
}

/// What a fit leaves of the evidence.
impl Evidence<'_> {
    /// Sums of squares over the noise that a fit leaves of every experiment, the nuisance being that of all.
    pub(crate) fn left_by_experiment(&self, fit: &Fitted) -> Vec<f64> {
        let shift = zero_shift(fit.free.len());
        let nuisance = fit.nuisance(self);
        let left = |(e, own): (usize, &Products)| self.left_of(own, &shift, &nuisance, e);
        fit.products.iter().enumerate().map(left).collect()
    }

    /// What a fit leaves of the channels beside the output: part of its cost.
    pub(crate) fn beside_output(&self, fit: &Fitted) -> f64 {
        self.left_beside(fit, |role| role != TraceRole::Output)
    }

    /// The part of [`Self::beside_output`] of the covariates.
    pub(crate) fn of_covariates(&self, fit: &Fitted) -> f64 {
        self.left_beside(fit, |role| role == TraceRole::Covariate)
    }

    /// What a fit leaves of channels of some roles, the nuisance that it asks for taken out.
    fn left_beside(&self, fit: &Fitted, counts: impl Fn(TraceRole) -> bool) -> f64 {
        if !self.traces.iter().any(|t| counts(t.role)) {
            return 0.0;
        }
        let nuisance = fit.nuisance(self);
        let left = |(trace, residual): (&Trace, &Vec<f64>)| {
            if counts(trace.role) { trace.cleaned(residual.clone(), &nuisance) } else { Vec::new() }
        };
        let left: Signal = self.traces.iter().zip(&fit.residual).map(left).collect();
        self.energy_of(&left, counts)
    }

    /// How far the last columns of the nuisance move under a fit, in their standard deviations: the farthest.
    pub(crate) fn strain(&self, fit: &Fitted, columns: usize) -> f64 {
        fit.nuisance(self).iter().rev().take(columns).fold(0.0, |most, shift| shift.abs().max(most))
    }

    /// Mean square of what a fit leaves of all outputs, the channels calibrated as in the reference runs; `calibrations`
    /// are so many of the last columns of the nuisance.
    pub(crate) fn left_of_outputs(&self, fit: &Fitted, calibrations: usize) -> f64 {
        self.output_square(&self.as_calibrated(&self.see(&fit.residual), calibrations))
    }
}

/// No step of `parameters` coordinates: the residual as it is, whose own entry is 1 and stands first.
pub(super) fn zero_shift(parameters: usize) -> DVector<f64> {
    let mut shift = DVector::zeros(parameters + 1);
    shift[0] = 1.0;
    shift
}
