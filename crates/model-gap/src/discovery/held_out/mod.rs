//! Experiments predicted by fits that have not seen them.

mod gain;

pub use gain::Gain;
pub(super) use gain::gain;

use super::evidence::{Evidence, as_calibrated, normal_equations, ridged};
use super::fit::{Fitted, Fitter, Starts, zero_shift};
use super::thresholds::{FORETOLD_SHARE, KNOWN_SHARE, MOST_FOLDS, PARAMETER_PENALTY};
use super::{OnlyRun, Signal, Simulator, Trace, Yardstick};
use crate::{Candidate, Effect, GapError, Memo};
use nalgebra::DVector;
use rayon::prelude::*;
use std::sync::Arc;

/// The experiments in folds, each left out in turn.
///
/// A fold is fitted from the starts of the library on the other experiments alone: start, slopes, step and nuisance
/// know nothing of it. A cause that the others do not show is none there. What adapts to every record, such as the
/// phase of a hum, adapts to that of the fold too: no other experiment could say it.
pub(super) struct Folds<'a, S> {
    ground: Ground<'a, S>,
    /// Fold of every experiment.
    of: Vec<usize>,
    /// The evidence without each fold.
    without: Vec<Evidence<'a>>,
    kept: Memo<Vec<usize>, Vec<FoldFit>>,
}

/// What fits of folds are made of.
pub(super) struct Ground<'a, S> {
    pub(super) simulator: &'a S,
    pub(super) candidates: &'a [Candidate],
    /// What surrogates reach with each candidate.
    pub(super) thresholds: Vec<f64>,
    /// Columns of the nuisance, the last ones, that are calibrations. A prediction takes the channels as they were in
    /// the reference runs: a calibration that is off is for a cause to explain.
    pub(super) calibrations: usize,
    /// What effects are counted in. In their own starts the nuisance stands for other models and inputs, of which the points
    /// held out tell as much as the others: it is fitted to all, its cost counts, and the effects alone are held out.
    pub(super) yardstick: Yardstick,
}

impl<S> Clone for Ground<'_, S> {
    fn clone(&self) -> Self {
        let Self { simulator, candidates, thresholds, calibrations, yardstick } = self;
        let (thresholds, calibrations, yardstick) = (thresholds.clone(), *calibrations, *yardstick);
        Self { simulator, candidates, thresholds, calibrations, yardstick }
    }
}

/// A fit that has not seen a fold.
#[derive(Debug, Clone)]
pub(super) struct FoldFit {
    pub(super) fit: Fitted,
    /// Whether the other experiments show the cause added last.
    is_known: bool,
}

/// What held-out experiments say of a cause.
#[derive(Debug, Clone, Copy)]
pub(super) enum HeldOut {
    /// The misfit that fits take off experiments that they have not seen.
    Drop(f64),
    /// Nothing can be held out: there is one experiment, or one kind.
    Nothing,
    /// Nearly all that the cause explains is in one experiment, which no other foretells; the same of the halves of
    /// that experiment, each of them held out.
    OneRun(OnlyRun),
}

/// Lists of causes whose fits are kept.
const KEPT: usize = 12;

impl<'a, S: Simulator> Folds<'a, S> {
    /// Experiments of equal number in `groups` are left out together; each alone where `groups` is empty.
    pub(super) fn new(
        evidence: &Evidence<'a>,
        groups: &[usize],
        ground: Ground<'a, S>,
    ) -> Result<Self, GapError> {
        let group = |e: usize| groups.get(e).copied().unwrap_or(e);
        let mut seen: Vec<usize> = Vec::new();
        let mut place = |e: usize| {
            let known = seen.iter().position(|own| *own == group(e));
            known.unwrap_or_else(|| {
                seen.push(group(e));
                seen.len() - 1
            })
        };
        let of = (0..evidence.experiments).map(|e| Some(place(e) % MOST_FOLDS)).collect();
        Self::of_folds(evidence, of, ground)
    }

    /// Folds as given; an experiment without one is never left out.
    fn of_folds(
        evidence: &Evidence<'a>,
        of: Vec<Option<usize>>,
        ground: Ground<'a, S>,
    ) -> Result<Self, GapError> {
        let count = of.iter().flatten().max().map_or(0, |last| last + 1);
        let without = (0..count)
            .map(|fold| evidence.without(|e| of[e] == Some(fold)))
            .collect::<Result<_, _>>()?;
        // what is never left out is predicted by any of the fits
        let of = of.into_iter().map(Option::unwrap_or_default).collect();
        Ok(Self { ground, of, without, kept: Memo::new(KEPT) })
    }

    /// Whether anything can be held out: one fold alone leaves nothing to fit.
    pub(super) fn hold_out(&self) -> bool {
        self.without.len() > 1
    }

    /// Fits of a list of causes, one after the other, that have not seen a fold, fold by fold.
    pub(super) fn fits(&self, causes: &[usize]) -> Result<Arc<Vec<FoldFit>>, GapError> {
        self.kept.get(causes.to_vec(), || {
            let Ground { simulator, candidates, thresholds, .. } = &self.ground;
            let before = match causes.split_last() {
                Some((_, before)) => Some(self.fits(before)?),
                None => None,
            };
            self.without
                .par_iter()
                .enumerate()
                .map(|(fold, evidence)| {
                    let fitter = Fitter { simulator: *simulator, evidence, candidates };
                    let (Some(before), Some(&last)) = (&before, causes.last()) else {
                        return Ok(FoldFit { fit: fitter.refine(Vec::new())?, is_known: true });
                    };
                    let before = &before[fold].fit;
                    let starts = &candidates[last].starts;
                    let asked = KNOWN_SHARE * thresholds[last]
                        + PARAMETER_PENALTY * fitter.free_parameters(last) as f64;
                    let found = fitter.fit_with(before, last, starts, Starts::Shortly)?;
                    Ok(match found.filter(|f| before.cost - f.cost >= asked) {
                        Some(fit) => FoldFit { fit, is_known: true },
                        None => FoldFit { fit: before.clone(), is_known: false },
                    })
                })
                .collect()
        })
    }

    /// The residual of every experiment under the fit that has not seen it. Where effects are counted in their own starts
    /// the nuisance is that of `beside`, fits of the same folds that hold the effects judged.
    pub(super) fn residual(&self, fits: &[FoldFit], beside: &[FoldFit]) -> Signal {
        let nuisance_of = |fit: &Fitted, evidence: &Evidence<'_>| match self.ground.yardstick {
            Yardstick::OutputSpread => {
                as_calibrated(fit.nuisance(evidence), self.ground.calibrations)
            }
            Yardstick::FirstStart => fit.nuisance(evidence),
        };
        let whose = match self.ground.yardstick {
            Yardstick::OutputSpread => fits,
            Yardstick::FirstStart => beside,
        };
        let nuisance: Vec<DVector<f64>> = whose
            .iter()
            .zip(&self.without)
            .map(|(own, evidence)| nuisance_of(&own.fit, evidence))
            .collect();
        let traces = self.without.first().map_or(&[][..], |own| own.traces);
        let one = |(number, trace): (usize, &Trace)| {
            let fold = self.of[trace.experiment];
            trace.cleaned(fits[fold].fit.residual[number].clone(), &nuisance[fold])
        };
        traces.iter().enumerate().map(one).collect()
    }

    /// What such residuals change by when the measured signals change by `noise`; the fits straight in their
    /// parameters.
    pub(super) fn under(&self, whole: &Evidence<'_>, fits: &[FoldFit], noise: &Signal) -> Signal {
        let alone = whole.products(&[noise]);
        let shifted: Vec<(DVector<f64>, DVector<f64>)> = fits
            .iter()
            .zip(&self.without)
            .map(|(FoldFit { fit, .. }, own)| {
                let products = own.products_of_first(&alone, noise, &fit.products, &fit.slopes);
                let (normal, right) = normal_equations(&own.project(&products));
                let mut shift = zero_shift(fit.free.len());
                if let Some(factor) = ridged(normal, 1e-9, 1e-12).cholesky() {
                    shift.rows_mut(1, fit.free.len()).copy_from(&factor.solve(&right));
                }
                let nuisance = own.nuisance_of(&products, &shift);
                let nuisance = as_calibrated(nuisance, self.ground.calibrations);
                (shift, nuisance)
            })
            .collect();
        whole
            .traces
            .iter()
            .enumerate()
            .map(|(number, trace)| {
                let fold = self.of[trace.experiment];
                let (shift, nuisance) = &shifted[fold];
                let mut left = noise[number].clone();
                for (slope, s) in fits[fold].fit.slopes.iter().zip(shift.iter().skip(1)) {
                    left.iter_mut().zip(&slope[number]).for_each(|(y, slope)| *y += slope * s);
                }
                trace.cleaned(left, nuisance)
            })
            .collect()
    }

    /// What held-out experiments say of the causes that `after` has and `before` has not.
    pub(super) fn held_out(
        &self,
        whole: &Evidence<'_>,
        before: &Fitted,
        after: &Fitted,
    ) -> Result<HeldOut, GapError> {
        if !self.hold_out() {
            return Ok(HeldOut::Nothing);
        }
        let [causes_before, causes] = [before, after].map(Fitted::causes);
        let fits = self.fits(&causes)?;
        // what a cause takes off every experiment, where all of them are seen
        let left = |fit: &Fitted| whole.left_by_experiment(fit);
        let drops: Vec<f64> =
            left(before).iter().zip(left(after)).map(|(b, a)| (b - a).max(0.0)).collect();
        let foretold = |&(e, _): &(usize, &f64)| fits[self.of[e]].is_known;
        let known: f64 = drops.iter().enumerate().filter(foretold).map(|(_, drop)| drop).sum();
        if known < FORETOLD_SHARE * drops.iter().sum::<f64>() {
            let most = (0..drops.len()).max_by(|&a, &b| drops[a].total_cmp(&drops[b]));
            let run = most.unwrap_or_default();
            let halves_agree = self.halves_agree(whole, run, &causes_before, &causes)?;
            return Ok(HeldOut::OneRun(OnlyRun { experiment: run, halves_agree }));
        }
        let left = |causes: &[usize]| -> Result<f64, GapError> {
            let fits = self.fits(causes)?;
            Ok(match self.ground.yardstick {
                Yardstick::OutputSpread => whole.within_chain(&self.residual(&fits, &fits)),
                Yardstick::FirstStart => self.left_beside_nuisance(whole, &fits),
            })
        };
        Ok(HeldOut::Drop(left(&causes_before)? - left(&causes)?))
    }

    /// What fits leave of the experiments that they have not seen, the nuisance fitted to all; with the cost of the nuisance.
    fn left_beside_nuisance(&self, whole: &Evidence<'_>, fits: &[FoldFit]) -> f64 {
        let shift = DVector::from_element(1, 1.0);
        let of_fold = |own: &FoldFit| {
            let products = whole.products(&[&own.fit.residual]);
            let nuisance = whole.nuisance_of(&products, &shift);
            let left = products.iter().enumerate();
            let left: Vec<f64> =
                left.map(|(e, own)| whole.left_of(own, &shift, &nuisance, e)).collect();
            (left, nuisance.norm_squared())
        };
        let folds: Vec<(Vec<f64>, f64)> = fits.iter().map(of_fold).collect();
        let left: f64 = self.of.iter().enumerate().map(|(e, fold)| folds[*fold].0[e]).sum();
        left + folds.iter().map(|own| own.1).sum::<f64>() / folds.len().max(1) as f64
    }

    /// Whether each half of an experiment is foretold by the other, with all other experiments.
    fn halves_agree(
        &self,
        whole: &Evidence<'_>,
        run: usize,
        before: &[usize],
        causes: &[usize],
    ) -> Result<bool, GapError> {
        let Ground { simulator, candidates, thresholds, calibrations, yardstick } = &self.ground;
        let split = Split {
            whole: *simulator,
            run,
            of: whole.traces.iter().map(|t| t.experiment).collect(),
        };
        let traces = split.traces(whole.traces, whole.experiments);
        let evidence = Evidence::new(&traces)?;
        let fold = |e: usize| match e {
            e if e == run => Some(0),
            e if e == whole.experiments => Some(1),
            _ => None,
        };
        let of = (0..evidence.experiments).map(fold).collect();
        let (simulator, thresholds) = (&split, thresholds.iter().map(|t| 0.5 * t).collect());
        let (calibrations, yardstick) = (*calibrations, *yardstick);
        let ground = Ground { simulator, candidates, thresholds, calibrations, yardstick };
        let halves = Folds::of_folds(&evidence, of, ground)?;
        let fits = halves.fits(causes)?;
        if !fits.iter().all(|own| own.is_known) {
            return Ok(false);
        }
        let left = |causes: &[usize]| -> Result<[f64; 2], GapError> {
            let residual = halves.residual(&halves.fits(causes)?, &fits);
            let by_experiment = evidence.energy_by_experiment(&residual);
            Ok([by_experiment[run], by_experiment[whole.experiments]])
        };
        let (without, with) = (left(before)?, left(causes)?);
        Ok(without.iter().zip(&with).all(|(without, with)| with < without))
    }
}

impl Fitted {
    /// The causes whose effects are fitted.
    pub(super) fn causes(&self) -> Vec<usize> {
        self.effects.iter().map(|effect| effect.candidate).collect()
    }
}

/// A simulator whose signals of one experiment are cut in two: the second halves stand at the end, as an experiment of
/// their own.
struct Split<'a, S> {
    whole: &'a S,
    run: usize,
    /// Experiment of every trace.
    of: Vec<usize>,
}

impl<S: Simulator> Split<'_, S> {
    fn cut(&self, mut signals: Signal) -> Signal {
        let mut second = Vec::new();
        for (signal, experiment) in signals.iter_mut().zip(&self.of) {
            if *experiment == self.run {
                second.push(signal.split_off(signal.len() / 2));
            }
        }
        signals.extend(second);
        signals
    }

    fn joined(&self, signals: &Signal) -> Signal {
        let (first, mut second) = (&signals[..self.of.len()], signals[self.of.len()..].iter());
        let join = |(own, experiment): (&Vec<f64>, &usize)| {
            let mut own = own.clone();
            if *experiment == self.run {
                own.extend(second.next().into_iter().flatten());
            }
            own
        };
        first.iter().zip(&self.of).map(join).collect()
    }

    fn traces(&self, traces: &[Trace], experiments: usize) -> Vec<Trace> {
        let mut all = Vec::new();
        let mut second = Vec::new();
        for trace in traces {
            if trace.experiment != self.run {
                all.push(trace.clone());
                continue;
            }
            let half = trace.measured.len() / 2;
            let rest = trace.measured.len() - half;
            let part = |from: usize, count: usize, experiment| Trace {
                experiment,
                measured: trace.measured[from..from + count].to_vec(),
                nuisance: trace.nuisance.rows(from, count).into_owned(),
                ..trace.clone()
            };
            all.push(part(0, half, self.run));
            second.push(part(half, rest, experiments));
        }
        all.extend(second);
        all
    }
}

impl<S: Simulator> Simulator for Split<'_, S> {
    fn predict(&self, effects: &[Effect]) -> Result<Signal, GapError> {
        Ok(self.cut(self.whole.predict(effects)?))
    }

    fn adapted(&self, effect: &Effect, residual: &Signal) -> Result<Option<Signal>, GapError> {
        let adapted = self.whole.adapted(effect, &self.joined(residual))?;
        Ok(adapted.map(|signals| self.cut(signals)))
    }
}
