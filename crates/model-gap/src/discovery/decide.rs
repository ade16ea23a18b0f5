//! The decisions, in their order.

use super::evidence::{Evidence, Seen, difference};
use super::fit::{Fitted, Fitter};
use super::judge::{Generic, paired};
use super::screen::screen;
use super::{Discovery, Finding, Rival, Screened, Simulator};
use crate::{Effect, GapError};
use rayon::prelude::*;
use std::sync::{Arc, Mutex};

/// Part of its threshold that a candidate must promise before it is fitted.
const PROMISE: f64 = 0.3;
/// Part of the drop of a cause that another must promise before it is fitted in its place.
const RIVAL_PROMISE: f64 = 0.1;
/// Share of the drop by the causes before that the next one must add: below it, it mends their form.
const NEXT_SHARE: f64 = 0.04;
/// Share of a drop that must show where experiments are held out.
const HELD_OUT_SHARE: f64 = 0.3;
/// Share of the drop beyond which structure of the base model does not make two causes change places.
const SWAY_SHARE: f64 = 0.1;
/// Share of a drop within which two causes are not told apart: no model of a cause is better.
const FORM_ERROR: f64 = 0.02;

pub(super) fn decide<S: Simulator>(
    discovery: &Discovery<'_, S>,
    evidence: &Evidence<'_>,
) -> Result<Finding, GapError> {
    Search::new(discovery, evidence)?.run()
}

/// The candidates given, all of them, as the data fit them.
pub(super) fn refit<S: Simulator>(
    discovery: &Discovery<'_, S>,
    evidence: &Evidence<'_>,
    given: &[usize],
) -> Result<Finding, GapError> {
    let search = Search::new(discovery, evidence)?;
    let mut current = search.base.clone();
    let mut chosen = Vec::new();
    for &candidate in given {
        let starts = &discovery.candidates[candidate].starts;
        if let Some(found) = search.fitter.fit_with(&current, candidate, starts, 0.0)? {
            current = found;
            chosen.push(candidate);
        }
    }
    let none = vec![None; discovery.candidates.len()];
    search.conclude(&chosen, &current, &none, none.iter().map(|_| None).collect(), Vec::new())
}

impl<'a, S: Simulator> Search<'a, S> {
    fn new(discovery: &'a Discovery<'a, S>, evidence: &'a Evidence<'a>) -> Result<Self, GapError> {
        let base_prediction = discovery.simulator.predict(&[])?;
        let fitter =
            Fitter { simulator: discovery.simulator, evidence, candidates: discovery.candidates };
        let base = fitter.refine(Vec::new())?;
        let screened = screen(discovery, evidence, &base_prediction, &base.residual)?;
        let generic = Generic::new(discovery, evidence);
        let kept = Mutex::new(Vec::new());
        let columns: Vec<&[Vec<f64>]> = discovery.structures.iter().map(Vec::as_slice).collect();
        let structures = evidence.seen(&columns);
        let energy = |s: &Seen<'_>| evidence.inner(s, s);
        let structure_energy = structures.iter().map(energy).fold(0.0, f64::max);
        Ok(Self {
            discovery,
            evidence,
            fitter,
            screened,
            generic,
            base,
            structures,
            structure_energy,
            kept,
        })
    }
}

/// One of the causes found, taken out and looked at again.
pub(super) struct Place {
    /// The fit without it.
    pub(super) rest: Fitted,
    /// The candidates that do about as well in its place, best first.
    pub(super) alternatives: Vec<usize>,
    /// It and those, as fitted.
    pub(super) rivals: Vec<Rival>,
    pub(super) drop: f64,
}

/// The fit without one of the causes, and every candidate fitted in its place.
struct TakenOut {
    rest: Fitted,
    fits: Vec<Option<Fitted>>,
}

type Kept = Vec<((Vec<Effect>, usize), Arc<TakenOut>)>;

pub(super) struct Search<'a, S> {
    pub(super) discovery: &'a Discovery<'a, S>,
    pub(super) evidence: &'a Evidence<'a>,
    fitter: Fitter<'a, S>,
    pub(super) screened: Vec<Screened>,
    pub(super) generic: Generic<'a>,
    pub(super) base: Fitted,
    /// What the base model leaves of the surrogates.
    structures: Vec<Seen<'a>>,
    /// Misfit that the worst of them leaves.
    pub(super) structure_energy: f64,
    kept: Mutex<Kept>,
}

impl<S: Simulator> Search<'_, S> {
    fn run(self) -> Result<Finding, GapError> {
        let mut reasons = Vec::new();
        let singles = self.fits_after(&self.base, &[], 0.0)?;
        let single_drops: Vec<Option<f64>> =
            singles.iter().map(|f| f.as_ref().map(|f| self.base.cost - f.cost)).collect();
        let mut current = self.base.clone();
        let mut chosen: Vec<usize> = Vec::new();
        let mut fits = singles.clone();
        while chosen.len() < self.discovery.settings.most_causes {
            let Some((candidate, next)) = self.best_of(&current, &fits) else { break };
            if let Err(reason) = self.enters(&current, candidate, &next) {
                reasons.push(reason);
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
        self.conclude(&chosen, &current, &singles, single_drops, reasons)
    }

    fn allowed(&self, candidate: usize) -> bool {
        self.discovery.candidates[candidate].blocked.is_none()
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
                if !self.allowed(candidate) || chosen.contains(&candidate) {
                    return Ok(None);
                }
                let starts = &self.discovery.candidates[candidate].starts;
                let least = least.max(PROMISE * self.screened[candidate].threshold);
                self.fitter.fit_with(current, candidate, starts, least)
            })
            .collect()
    }

    fn penalty(&self, candidate: usize) -> f64 {
        let free = self.discovery.candidates[candidate].cause.parameters.len() as f64;
        self.discovery.settings.parameter_penalty * free
    }

    /// The candidate with the largest drop, its parameters paid for.
    fn best_of(&self, current: &Fitted, fits: &[Option<Fitted>]) -> Option<(usize, Fitted)> {
        fits.iter()
            .enumerate()
            .filter_map(|(c, f)| f.as_ref().map(|f| (c, f)))
            .max_by(|a, b| {
                let worth = |x: &(usize, &Fitted)| current.cost - x.1.cost - self.penalty(x.0);
                worth(a).total_cmp(&worth(b))
            })
            .map(|(c, f)| (c, f.clone()))
    }

    pub(super) fn id(&self, candidate: usize) -> &'static str {
        self.discovery.candidates[candidate].cause.id
    }

    /// Both keys: the drop exceeds what surrogates reach, and most of it shows where it is held out.
    fn enters(&self, current: &Fitted, candidate: usize, next: &Fitted) -> Result<f64, String> {
        let drop = current.cost - next.cost - self.penalty(candidate);
        let before = self.output_drop(&self.base, current);
        let threshold = self.screened[candidate].threshold + NEXT_SHARE * before;
        let id = self.id(candidate);
        if drop < threshold {
            return Err(format!(
                "{id} would explain most, {drop:.0} noise units, within the {threshold:.0} that surrogates with nothing missing can reach"
            ));
        }
        let held_out = self.held_out_drop(current, next);
        let needed = HELD_OUT_SHARE * drop;
        if held_out < needed {
            return Err(format!(
                "{id} explains {drop:.0} noise units where it is fitted and {held_out:.0} where it is held out, less than the {needed:.0} asked for"
            ));
        }
        // one more cause must stand on its own feet: what drifts mends the form of those before it
        if !current.effects.is_empty()
            && let Some(doubt) = self.doubts(next).0.into_iter().next()
        {
            return Err(format!("{id} beside the causes before is refused: {doubt}"));
        }
        Ok(held_out)
    }

    /// What a fit takes off the misfit of the outputs. A further channel shows a cause directly: it says
    /// nothing about the form of its effect on the output, which is what a next cause may mend.
    pub(super) fn output_drop(&self, before: &Fitted, after: &Fitted) -> f64 {
        let beside = |f: &Fitted| self.evidence.beside_output(&f.residual);
        let drop = before.cost - after.cost - (beside(before) - beside(after));
        drop.max(0.0)
    }

    pub(super) fn held_out_drop(&self, before: &Fitted, after: &Fitted) -> f64 {
        let sum = |f: &Fitted| f.held_out(self.evidence).iter().sum::<f64>();
        sum(before) - sum(after)
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
        let key = (current.effects.clone(), at);
        let known = |kept: &Kept| kept.iter().find(|k| k.0 == key).map(|k| Arc::clone(&k.1));
        // a lock is poisoned only by a panic while it was held, and nothing panics there
        if let Some(found) = self.kept.lock().ok().and_then(|kept| known(&kept)) {
            return Ok(found);
        }
        let rest = self.fitter.refine(Self::without(&current.effects, at))?;
        let least = RIVAL_PROMISE * (rest.cost - current.cost);
        let fits = self.fits_after(&rest, chosen, least)?;
        let made = Arc::new(TakenOut { rest, fits });
        if let Ok(mut kept) = self.kept.lock() {
            kept.insert(0, (key, Arc::clone(&made)));
            kept.truncate(self.discovery.settings.most_causes);
        }
        Ok(made)
    }

    /// Replaces a chosen cause where another one does better beside the rest.
    fn swap(&self, chosen: &mut [usize], current: &mut Fitted) -> Result<(), GapError> {
        for at in 0..chosen.len() {
            let place = self.taken_out(chosen, at, current)?;
            if let Some((candidate, found)) = self.best_of(&place.rest, &place.fits) {
                let better = current.cost - found.cost
                    > self.discovery.settings.separation + self.penalty(candidate)
                        - self.penalty(chosen[at]);
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
            // the same two keys that it entered by, now that the others know of it
            let others = self.output_drop(&self.base, &rest);
            let needed = self.screened[chosen[at]].threshold + NEXT_SHARE * others;
            if drop < needed || self.held_out_drop(&rest, current) < HELD_OUT_SHARE * drop {
                chosen.remove(at);
                *current = rest;
                at = 0;
            } else {
                at += 1;
            }
        }
        Ok(())
    }

    /// What the structure that a base model may leave with nothing missing can do to the difference of
    /// two misfits: `2 |<z, r_a - r_b>|` of the worst surrogate `z`, with the margin of the floors; at most
    /// [`SWAY_SHARE`] of the drop.
    fn swayed(&self, a: &Fitted, b: &Fitted) -> f64 {
        let apart = difference(&a.residual, &b.residual);
        let apart = self.evidence.see(&apart);
        let along = |z: &Seen<'_>| 2.0 * self.evidence.inner(z, &apart).abs();
        let worst = self.structures.iter().map(along).fold(0.0, f64::max);
        let most = SWAY_SHARE * self.output_drop(&self.base, b);
        (self.discovery.settings.structure_margin * worst).min(most)
    }

    /// The candidates that do about as well in the place of a chosen one, best first.
    pub(super) fn alternatives(
        &self,
        chosen: &[usize],
        at: usize,
        current: &Fitted,
        singles: &[Option<Fitted>],
    ) -> Result<Place, GapError> {
        let out = if chosen.len() == 1 {
            Arc::new(TakenOut { rest: self.base.clone(), fits: singles.to_vec() })
        } else {
            self.taken_out(chosen, at, current)?
        };
        let TakenOut { rest, fits } = &*out;
        let drop = rest.cost - current.cost;
        let margin =
            self.discovery.settings.separation + FORM_ERROR * self.output_drop(rest, current);
        let mut close: Vec<(f64, &Fitted, usize)> = Vec::new();
        for (candidate, fit) in fits.iter().enumerate() {
            let Some(fit) = fit.as_ref().filter(|_| !chosen.contains(&candidate)) else { continue };
            let penalty = self.penalty(candidate) - self.penalty(chosen[at]);
            let behind = fit.cost - current.cost + penalty;
            let (_, error) = paired(self.evidence, fit, current);
            let open = margin + self.swayed(fit, current);
            if behind < open || (behind < 2.0 * error && behind < 0.2 * drop) {
                close.push((behind, fit, candidate));
            }
        }
        close.sort_by(|a, b| a.0.total_cmp(&b.0));
        let own = std::iter::once((current, chosen[at]));
        let rivals = own
            .chain(close.iter().map(|c| (c.1, c.2)))
            .map(|(fit, candidate)| Rival::of(self.evidence, fit, candidate))
            .collect();
        let alternatives = close.into_iter().map(|c| c.2).collect();
        Ok(Place { rest: rest.clone(), alternatives, rivals, drop })
    }
}
