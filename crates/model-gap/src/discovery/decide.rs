//! The decisions, in their order.

use super::evidence::{Evidence, Seen, difference};
use super::fit::{Fitted, Fitter, Starts};
use super::held_out::{Folds, Ground, HeldOut};
use super::judge::{Generic, drop_error, parameters};
use super::screen::screen;
use super::thresholds::{
    AS_LIKELY, CONFUSED_SHARE, HELD_OUT_SHARE, LEAST_GAIN, NEXT_SHARE, PARAMETER_PENALTY, PROMISE,
    RIVAL_LACK, RIVAL_PROMISE, SAME_GAIN, SEPARATION, STRONG, STRUCTURE_MARGIN, SWAY_SHARE,
    WRONG_NAME, needed_between, needed_to_separate,
};
use super::{
    Alternative, Compared, Discovery, Finding, Found, Reason, Rival, Screened, Simulator, Yardstick,
};
use crate::{Effect, GapError, Memo};
use rayon::prelude::*;
use std::sync::Arc;

/// What a search noted on its way.
#[derive(Debug, Default)]
pub(super) struct Notes {
    /// Why it took each decision.
    pub(super) reasons: Vec<Reason>,
    /// The cause that what is missing looks most like, and which cannot be there.
    pub(super) looks_like: Option<usize>,
    /// Whether a cause explains much where it is fitted and little where it is held out.
    pub(super) in_some_runs: bool,
}

/// Why a candidate is not the next cause.
struct Refusal {
    candidate: usize,
    reason: Reason,
}

/// The next cause with its fit, or why there is none.
type Entrance = Result<(usize, Fitted), Refusal>;

/// The fit without one of the causes, and every candidate fitted in its place.
struct TakenOut {
    rest: Fitted,
    fits: Vec<Option<Fitted>>,
}

pub(super) struct Search<'a, S> {
    pub(super) discovery: &'a Discovery<'a, S>,
    pub(super) evidence: &'a Evidence<'a>,
    pub(super) fitter: Fitter<'a, S>,
    pub(super) screened: Vec<Screened>,
    pub(super) generic: Generic<'a>,
    pub(super) trends: Generic<'a>,
    pub(super) base: Fitted,
    /// What the base model leaves of the surrogates.
    pub(super) structures: Vec<Seen<'a>>,
    /// Misfit that the worst of them leaves.
    pub(super) structure_energy: f64,
    kept: Memo<(Vec<Effect>, usize), TakenOut>,
    pub(super) folds: Folds<'a, S>,
    /// What held-out experiments say of fits, by the effects before and after.
    judged: Memo<(Vec<Effect>, Vec<Effect>), HeldOut>,
}

/// Judgements by held-out experiments that are kept.
const JUDGED: usize = 24;

impl<'a, S: Simulator> Search<'a, S> {
    pub(super) fn new(
        discovery: &'a Discovery<'a, S>,
        evidence: &'a Evidence<'a>,
    ) -> Result<Self, GapError> {
        let Discovery { simulator, candidates, generic, trends, structures, .. } = *discovery;
        let fitter = Fitter { simulator, evidence, candidates };
        let base = fitter.refine(Vec::new())?;
        let screened = screen(discovery, evidence, &simulator.predict(&[])?, &base.residual)?;
        let thresholds = screened.iter().map(|s| s.threshold).collect();
        let calibrations = discovery.calibrations;
        let yardstick = discovery.settings.yardstick;
        let ground = Ground { simulator, candidates, thresholds, calibrations, yardstick };
        let folds = Folds::new(evidence, discovery.groups, ground)?;
        let seen = evidence.seen(&structures.iter().collect::<Vec<_>>());
        let energy = |s: &Seen<'_>| evidence.inner(s, s);
        Ok(Self {
            discovery,
            evidence,
            fitter,
            screened,
            generic: Generic::new(evidence, generic, structures),
            trends: Generic::new(evidence, trends, structures),
            base,
            structure_energy: seen.iter().map(energy).fold(0.0, f64::max),
            structures: seen,
            kept: Memo::new(discovery.settings.most_causes),
            folds,
            judged: Memo::new(JUDGED),
        })
    }

    /// The candidates given, all of them, as the data fit them.
    pub(super) fn refit(&self, given: &[usize]) -> Result<Finding, GapError> {
        let mut current = self.base.clone();
        let mut chosen = Vec::new();
        for &candidate in given {
            let starts = &self.discovery.candidates[candidate].starts;
            if let Some(found) =
                self.fitter.fit_with(&current, candidate, starts, Starts::Widely { least: 0.0 })?
            {
                current = found;
                chosen.push(candidate);
            }
        }
        let none = vec![None; self.discovery.candidates.len()];
        self.conclude(&chosen, &current, &none, Notes::default())
    }

    /// Searches for what is missing.
    pub(super) fn run(&self) -> Result<Finding, GapError> {
        let mut notes = Notes::default();
        let singles = self.fits_after(&self.base, &[], 0.0)?;
        let mut current = self.base.clone();
        let mut chosen: Vec<usize> = Vec::new();
        let mut fits = singles.clone();
        while chosen.len() < self.discovery.settings.most_causes {
            let (mut candidate, mut next) = match self.next(&current, &fits)? {
                None => break,
                Some(Err(Refusal { candidate, reason })) => {
                    let is_lost = matches!(
                        reason,
                        Reason::LostHeldOut { .. }
                            | Reason::OneRunOnly { .. }
                            | Reason::Negligible { .. }
                    );
                    notes.in_some_runs |= matches!(reason, Reason::LostHeldOut { drop, threshold, held_out, .. }
                        if drop > STRONG * threshold && held_out > 0.0);
                    notes.reasons.push(reason);
                    if is_lost {
                        // what held-out runs speak against is not there: the next one may be
                        fits[candidate] = None;
                        continue;
                    }
                    break;
                }
                Some(Ok(next)) => next,
            };
            let mut why = self.cannot_be(candidate, &next)?;
            if let Some(what) = self.discovery.candidates[candidate].decoy {
                if why.is_some() {
                    // a decoy that is refuted is left out: no name depends on it
                    fits[candidate] = None;
                    continue;
                }
                match self.named_as_well(&current, (candidate, &next), &fits)? {
                    Some(named) => (candidate, next) = named,
                    None => why = Some(Reason::Decoy { what }),
                }
            }
            if let Some(why) = why {
                let (cause, why) = (self.id(candidate), Box::new(why));
                notes.reasons.push(Reason::Resembles { cause, why });
                notes.looks_like = Some(candidate);
                break;
            }
            chosen.push(candidate);
            current = next;
            if chosen.len() > 1 {
                self.swap(&mut chosen, &mut current)?;
            }
            if chosen.len() < self.discovery.settings.most_causes {
                let asked = NEXT_SHARE * self.output_drop(&self.base, &current);
                fits = self.fits_after(&current, &chosen, PROMISE * asked)?;
            }
        }
        self.check_backward(&mut chosen, &mut current)?;
        self.conclude(&chosen, &current, &singles, notes)
    }

    /// Whether a candidate is a cause that may be there.
    pub(super) fn may_be_named(&self, candidate: usize) -> bool {
        let own = &self.discovery.candidates[candidate];
        own.refuted.is_none() && own.decoy.is_none()
    }

    /// The cause of the library that explains as much as a decoy, to within the penalty on one parameter.
    fn named_as_well(
        &self,
        rest: &Fitted,
        (decoy, fit): (usize, &Fitted),
        fits: &[Option<Fitted>],
    ) -> Result<Option<(usize, Fitted)>, GapError> {
        let drop = |f: &Fitted| rest.cost - f.cost;
        let Some((candidate, found)) = self.best_by(fits, drop, |c, _| self.may_be_named(c)) else {
            return Ok(None);
        };
        let delta_chi2 = found.cost - fit.cost + self.penalty(candidate) - self.penalty(decoy);
        let is_as_good = delta_chi2 < PARAMETER_PENALTY
            && self.enters(rest, candidate, &found)?.is_ok()
            && self.contradicted(&found)?.is_none();
        Ok(is_as_good.then_some((candidate, found)))
    }

    /// Why the data show that a candidate, fitted last, is not there.
    fn cannot_be(&self, candidate: usize, fit: &Fitted) -> Result<Option<Reason>, GapError> {
        match &self.discovery.candidates[candidate].refuted {
            Some(why) => Ok(Some(Reason::Refuted(why.clone()))),
            None => self.contradicted(fit),
        }
    }

    /// Every further candidate fitted after the effects of `current`, if it promises a part of its
    /// threshold and a drop of `least`.
    fn fits_after(
        &self,
        current: &Fitted,
        chosen: &[usize],
        least: f64,
    ) -> Result<Vec<Option<Fitted>>, GapError> {
        (0..self.discovery.candidates.len())
            .into_par_iter()
            .map(|candidate| {
                let own = &self.discovery.candidates[candidate];
                if own.blocked.is_some() || chosen.contains(&candidate) {
                    return Ok(None);
                }
                let least = least.max(PROMISE * self.screened[candidate].threshold);
                self.fitter.fit_with(current, candidate, &own.starts, Starts::Widely { least })
            })
            .collect()
    }

    pub(super) fn penalty(&self, candidate: usize) -> f64 {
        PARAMETER_PENALTY * self.fitter.free_parameters(candidate) as f64
    }

    /// The candidate with the largest drop of a kind, its parameters paid for, of some of them.
    fn best_by(
        &self,
        fits: &[Option<Fitted>],
        drop: impl Fn(&Fitted) -> f64,
        of: impl Fn(usize, &Fitted) -> bool,
    ) -> Option<(usize, Fitted)> {
        fits.iter()
            .enumerate()
            .filter_map(|(c, f)| f.as_ref().map(|f| (c, f)))
            .filter(|&(c, f)| of(c, f))
            .max_by(|a, b| {
                let worth = |x: &(usize, &Fitted)| drop(x.1) - self.penalty(x.0);
                worth(a).total_cmp(&worth(b))
            })
            .map(|(c, f)| (c, f.clone()))
    }

    /// Share of the drop by given effects that a candidate beside them must add.
    fn share_beside(&self, candidate: usize, effects: &[Effect]) -> f64 {
        let cause = |c: usize| &self.discovery.candidates[c];
        let own = cause(candidate);
        let is_confused = effects.iter().map(|e| cause(e.candidate)).any(|other| {
            own.confused_with.contains(&other.id) || other.confused_with.contains(&own.id)
        });
        if is_confused { CONFUSED_SHARE } else { NEXT_SHARE }
    }

    /// The candidate that enters next. Whether one does is decided within the chain alone; which one it is,
    /// by everything that was measured.
    fn next(
        &self,
        current: &Fitted,
        fits: &[Option<Fitted>],
    ) -> Result<Option<Entrance>, GapError> {
        let over = |c: usize, f: &Fitted| {
            self.proven_drop(current, f) - self.penalty(c) - self.threshold_after(current, c)
        };
        let shows = |c: usize, f: &Fitted| over(c, f) >= 0.0;
        let last = current.effects.len();
        // a cause whose value differs from run to run stands back behind any other that shows
        let holds =
            |f: &Fitted| f.effects.len() <= last || self.doubts_of(f, Some(last)).1 <= WRONG_NAME;
        let drop = |f: &Fitted| current.cost - f.cost;
        let proven = |f: &Fitted| self.proven_drop(current, f);
        let Some(most) = self.best_by(fits, proven, |_, _| true) else { return Ok(None) };
        // beside causes that were found, a lesser candidate would only mend the form of what the best one is
        let is_barred = !current.effects.is_empty() && !shows(most.0, &most.1);
        let best = if is_barred {
            most
        } else {
            self.best_by(fits, drop, |c, f| shows(c, f) && holds(f))
                .or_else(|| self.best_by(fits, drop, shows))
                .unwrap_or(most)
        };
        let candidate = best.0;
        let entered = self.enters(current, candidate, &best.1)?;
        Ok(Some(entered.map(|()| best).map_err(|reason| Refusal { candidate, reason })))
    }

    pub(super) fn id(&self, candidate: usize) -> &'static str {
        self.discovery.candidates[candidate].id
    }

    /// Both acceptance tests: the drop of chi-square exceeds what surrogates reach, and most of it shows on
    /// held-out runs, where one could show it.
    fn enters(
        &self,
        current: &Fitted,
        candidate: usize,
        next: &Fitted,
    ) -> Result<Result<(), Reason>, GapError> {
        let drop = self.proven_drop(current, next) - self.penalty(candidate);
        let threshold = self.threshold_after(current, candidate);
        let cause = self.id(candidate);
        if let Some(shown) = self.hardly_shown(candidate, current, next) {
            return Ok(Err(Reason::NotAdded { cause, why: Box::new(shown) }));
        }
        if drop < threshold {
            return Ok(Err(Reason::WithinSurrogates { cause, drop: drop.max(0.0), threshold }));
        }
        let left = |fit| self.evidence.left_of_outputs(fit, self.discovery.calibrations);
        let (drop_of_outputs, needed) = (left(current) - left(next), self.least_gain(current));
        let must_matter = self.discovery.settings.yardstick == Yardstick::OutputSpread
            && !self.discovery.candidates[candidate].is_beside_output;
        if must_matter && drop_of_outputs < needed {
            return Ok(Err(Reason::Negligible { cause, drop: drop_of_outputs, needed }));
        }
        match self.held_out(current, next)? {
            HeldOut::Drop(held_out) if held_out < HELD_OUT_SHARE * drop => {
                let needed = HELD_OUT_SHARE * drop;
                return Ok(Err(Reason::LostHeldOut { cause, drop, threshold, held_out, needed }));
            }
            // one run that does not even foretell itself
            HeldOut::OneRun(run) if !run.halves_agree => {
                return Ok(Err(Reason::OneRunOnly { cause, run }));
            }
            _ => {}
        }
        // parameters of an added cause that drift show that it compensates an error of form of those before it
        if !current.effects.is_empty()
            && let Some(doubt) = self.doubts(next).0.into_iter().next()
        {
            return Ok(Err(Reason::NotAdded { cause, why: Box::new(doubt) }));
        }
        Ok(Ok(()))
    }

    /// Mean square that a cause must take off what a fit leaves of the outputs.
    fn least_gain(&self, fit: &Fitted) -> f64 {
        LEAST_GAIN * self.evidence.left_of_outputs(fit, self.discovery.calibrations)
    }

    /// Why one more cause shows too little on the outputs, if it does: the further channels alone would show an
    /// error of form of the causes before.
    fn hardly_shown(&self, candidate: usize, before: &Fitted, after: &Fitted) -> Option<Reason> {
        let (by_others, own) =
            (self.output_drop(&self.base, before), self.output_drop(before, after));
        let asked = self.share_beside(candidate, &before.effects) * by_others;
        (own < asked).then_some(Reason::HardlyShown { drop: own, needed: asked })
    }

    /// What a candidate after those of `current` must take off the misfit.
    fn threshold_after(&self, current: &Fitted, candidate: usize) -> f64 {
        let before = self.output_drop(&self.base, current);
        self.screened[candidate].threshold + self.share_beside(candidate, &current.effects) * before
    }

    /// Drop of chi-square within the chain, covariates left out. A temperature that rises shows that heat is
    /// there, not that it changes the output.
    fn proven_drop(&self, before: &Fitted, after: &Fitted) -> f64 {
        let around = |f: &Fitted| self.evidence.of_covariates(f);
        before.cost - after.cost - (around(before) - around(after))
    }

    /// What a fit takes off the misfit of the outputs. A further channel shows a cause directly: it says
    /// nothing about the form of its effect on the output, which is what a next cause may mend.
    pub(super) fn output_drop(&self, before: &Fitted, after: &Fitted) -> f64 {
        let beside = |f: &Fitted| self.evidence.beside_output(f);
        let drop = before.cost - after.cost - (beside(before) - beside(after));
        drop.max(0.0)
    }

    /// What experiments that its fit has not seen say of the cause added last.
    fn held_out(&self, before: &Fitted, after: &Fitted) -> Result<HeldOut, GapError> {
        let key = (before.effects.clone(), after.effects.clone());
        let found = self.judged.get(key, || self.folds.held_out(self.evidence, before, after))?;
        Ok(*found)
    }

    /// Effects without one of them.
    fn without(effects: &[Effect], at: usize) -> Vec<Effect> {
        let mut rest = effects.to_vec();
        rest.remove(at);
        rest
    }

    /// The fit without one of the causes, and what does for it; kept, because it is asked for again.
    fn taken_out(
        &self,
        chosen: &[usize],
        at: usize,
        current: &Fitted,
    ) -> Result<Arc<TakenOut>, GapError> {
        self.kept.get((current.effects.clone(), at), || {
            let rest = self.fitter.refine(Self::without(&current.effects, at))?;
            let least = RIVAL_PROMISE * (rest.cost - current.cost);
            let fits = self.fits_after(&rest, chosen, least)?;
            Ok(TakenOut { rest, fits })
        })
    }

    /// Replaces a chosen cause where another one does better beside the rest.
    fn swap(&self, chosen: &mut [usize], current: &mut Fitted) -> Result<(), GapError> {
        for at in 0..chosen.len() {
            let place = self.taken_out(chosen, at, current)?;
            let drop = |f: &Fitted| place.rest.cost - f.cost;
            let may_be = |c: usize, _: &Fitted| self.may_be_named(c);
            if let Some((candidate, found)) = self.best_by(&place.fits, drop, may_be)
                && self.contradicted(&found)?.is_none()
            {
                let better = current.cost - found.cost
                    > SEPARATION + self.penalty(candidate) - self.penalty(chosen[at]);
                if better {
                    // effects keep the order of the chosen: the new one stands last
                    chosen[at..].rotate_left(1);
                    if let Some(last) = chosen.last_mut() {
                        *last = candidate;
                    }
                    *current = found;
                }
            }
        }
        Ok(())
    }

    /// Drops every cause that the others make superfluous.
    fn check_backward(
        &self,
        chosen: &mut Vec<usize>,
        current: &mut Fitted,
    ) -> Result<(), GapError> {
        let mut at = 0;
        while chosen.len() > 1 && at < chosen.len() {
            let rest = self.fitter.refine(Self::without(&current.effects, at))?;
            let drop = rest.cost - current.cost - self.penalty(chosen[at]);
            // the same two acceptance tests, now that the other causes are refitted beside it
            let needed = self.threshold_after(&rest, chosen[at]);
            let is_shown = self.hardly_shown(chosen[at], &rest, current).is_none();
            let is_lost = match self.held_out(&rest, current)? {
                HeldOut::Drop(held_out) => held_out < HELD_OUT_SHARE * drop,
                HeldOut::OneRun(run) => !run.halves_agree,
                HeldOut::Nothing => false,
            };
            if !is_shown || drop < needed || is_lost {
                chosen.remove(at);
                *current = rest;
                at = 0;
            } else {
                at += 1;
            }
        }
        Ok(())
    }

    /// Difference of the misfits of two fits, `b` the better, that structure of the base model can make: the
    /// larger of what surrogates could, `2 |<z, d>|` of the worst of them `z`, `d = r_a - r_b`, with the margin of
    /// the floors and at most [`SWAY_SHARE`] of the drop; and of what the data show,
    /// `separation (x^2 - 1)`, `x = <r_b, d> / |d|`.
    ///
    /// Whichever of the fits is right, structure of at least the size `x` lies along `d`, where noise alone would
    /// leave 1. With its variance beside that of the noise the difference of the misfits weighs `1 / (1 + x^2)` as
    /// much. A base model without surrogates is assumed exact: the result is 0.
    fn structure_between(&self, a: &Fitted, b: &Fitted) -> f64 {
        if self.structures.is_empty() {
            return 0.0;
        }
        let apart = difference(&a.residual, &b.residual);
        let apart = self.evidence.see(&apart);
        let along = |z: &Seen<'_>| 2.0 * self.evidence.inner(z, &apart).abs();
        let worst = self.structures.iter().map(along).fold(0.0, f64::max);
        let most = SWAY_SHARE * self.output_drop(&self.base, b);
        let energy = self.evidence.inner(&apart, &apart);
        // |r_a|^2 - |r_b|^2 = |d|^2 + 2 <r_b, d>
        let along = 0.5 * (a.cost - b.cost - energy);
        let squared = if energy > 0.0 { along * along / energy } else { 0.0 };
        (STRUCTURE_MARGIN * worst).min(most).max(SEPARATION * (squared - 1.0).max(0.0))
    }

    /// A chosen cause with what was found about it, and the candidates that do about as well in its place.
    pub(super) fn found(
        &self,
        chosen: &[usize],
        at: usize,
        current: &Fitted,
        singles: &[Option<Fitted>],
    ) -> Result<Found, GapError> {
        let out = if chosen.len() == 1 {
            Arc::new(TakenOut { rest: self.base.clone(), fits: singles.to_vec() })
        } else {
            self.taken_out(chosen, at, current)?
        };
        let TakenOut { rest, fits } = &*out;
        let drop = rest.cost - current.cost;
        let output_drop = self.output_drop(rest, current);
        let mut compared: Vec<(Compared, &Fitted)> = Vec::new();
        for (candidate, fit) in fits.iter().enumerate() {
            let Some(fit) = fit.as_ref().filter(|_| !chosen.contains(&candidate)) else { continue };
            let penalty = self.penalty(candidate) - self.penalty(chosen[at]);
            // a fit that has not come as far as its starts promised may be as good as they do
            let reached = (rest.cost - fit.cost).max(fit.promised);
            let delta_chi2 = rest.cost - reached - current.cost + penalty;
            let error = drop_error(self.evidence, fit, current);
            let [own, other] = [chosen[at], candidate].map(|c| &self.discovery.candidates[c]);
            let margin = match self.discovery.settings.yardstick {
                Yardstick::OutputSpread => needed_to_separate(output_drop),
                Yardstick::FirstStart => {
                    needed_between(output_drop, [own.form_error, other.form_error])
                }
            };
            let open = margin + self.structure_between(fit, current);
            let mut discrimination_threshold = open.max((2.0 * error).min(0.2 * drop));
            // what explains much less explains something else
            discrimination_threshold = discrimination_threshold.min(margin.max(RIVAL_LACK * drop));
            // errors of form of the base model outweigh what parts two changes of scale, in every run as in all
            let are_scales = own.is_one_set_with(other) && own.is_scale() && other.is_scale();
            if are_scales || own.is_one_set_with(other) && reached > SAME_GAIN * drop {
                // as likely, whatever the fit says
                let least = 1.01 / AS_LIKELY * delta_chi2.max(0.0);
                discrimination_threshold = discrimination_threshold.max(least);
            }
            let compared_with = Compared { candidate, delta_chi2, discrimination_threshold };
            // one that fits far worse is excluded already; one that differs from run to run is no better than a name
            let last = fit.effects.len() - 1;
            let differs = || !are_scales && self.doubts_of(fit, Some(last)).1 > WRONG_NAME;
            if compared_with.is_near() && (self.contradicted(fit)?.is_some() || differs()) {
                continue;
            }
            compared.push((compared_with, fit));
        }
        compared.sort_by(|a, b| a.0.delta_chi2.total_cmp(&b.0.delta_chi2));
        let may_be = |c: &&(Compared, &Fitted)| self.may_be_named(c.0.candidate);
        let open = compared.iter().filter(|c| c.0.is_open()).filter(may_be);
        let own = std::iter::once((current, chosen[at]));
        let rivals = own
            .chain(open.map(|c| (c.1, c.0.candidate)))
            .map(|(fit, candidate)| Rival::of(self.evidence, fit, candidate))
            .collect();
        let (held_out_drop, only_run) = match self.held_out(rest, current)? {
            HeldOut::Drop(drop) => (Some(drop), None),
            HeldOut::Nothing => (None, None),
            HeldOut::OneRun(run) => (None, Some(run)),
        };
        let likely = compared.iter().filter(|c| c.0.is_as_likely()).filter(may_be);
        let alternatives = likely
            .map(|(c, fit)| {
                // a candidate fitted in the place of another stands last
                let last = fit.effects.len() - 1;
                let parameters = parameters(self.discovery, self.evidence, fit, last, rest)?;
                Ok(Alternative { candidate: c.candidate, parameters })
            })
            .collect::<Result<_, GapError>>()?;
        Ok(Found {
            candidate: chosen[at],
            parameters: parameters(self.discovery, self.evidence, current, at, rest)?,
            drop: self.proven_drop(rest, current),
            output_drop,
            held_out_drop,
            only_run,
            alternatives,
            rivals,
            compared: compared.iter().map(|c| c.0).collect(),
        })
    }
}
