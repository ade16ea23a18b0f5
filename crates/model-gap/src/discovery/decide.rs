//! The decisions, in their order.

use super::evidence::Evidence;
use super::fit::{Fitted, Fitter};
use super::gain::gain;
use super::judge::{Generic, drift, paired, parameters};
use super::screen::screen;
use super::{Confidence, Discovery, Finding, Found, Rival, Screened, Signal, Simulator, Verdict};
use crate::{Effect, GapError, Scale};
use rayon::prelude::*;
use std::sync::{Arc, Mutex};

/// Relative spread from which on the name is wrong.
const WRONG_NAME: f64 = 0.5;
/// Times its threshold that a cause must explain to be named with confidence.
const STRONG: f64 = 2.0;
/// Part of its threshold that a candidate must promise before it is fitted.
const PROMISE: f64 = 0.3;
/// Part of the drop of a cause that another must promise before it is fitted in its place.
const RIVAL_PROMISE: f64 = 0.1;
/// Relative spread of a parameter over the experiments from which on it drifts.
const DRIFTING: f64 = 0.25;
/// Share of the drop that values of its own for every experiment must add before a drift speaks
/// against a name, and the share before it makes the name wrong.
const DRIFT_COSTS: [f64; 2] = [0.06, 0.15];
/// Share of the drop by the causes before that the next one must add: below it, it mends their form.
const NEXT_SHARE: f64 = 0.04;
/// Share of a drop that must show where experiments are held out.
const HELD_OUT_SHARE: f64 = 0.3;
/// Share of the misfit above the floor below which something else than the names is missing too.
const LEAST_SHARE: f64 = 0.6;
/// Misfit over the floor, in floors, from which that share means anything.
const STANDS_OUT: f64 = 0.5;
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
        let energy = |s: &Signal| fitter.cost_of(s);
        let structure_energy = discovery.structures.iter().map(energy).fold(0.0, f64::max);
        Ok(Self { discovery, evidence, fitter, screened, generic, base, structure_energy, kept })
    }
}

/// One of the causes found, taken out and looked at again.
struct Place {
    /// The fit without it.
    rest: Fitted,
    /// The candidates that do about as well in its place, best first.
    alternatives: Vec<usize>,
    /// It and those, as fitted.
    rivals: Vec<Rival>,
    drop: f64,
}

/// The fit without one of the causes, and every candidate fitted in its place.
struct TakenOut {
    rest: Fitted,
    fits: Vec<Option<Fitted>>,
}

type Kept = Vec<((Vec<Effect>, usize), Arc<TakenOut>)>;

struct Search<'a, S> {
    discovery: &'a Discovery<'a, S>,
    evidence: &'a Evidence<'a>,
    fitter: Fitter<'a, S>,
    screened: Vec<Screened>,
    generic: Generic,
    base: Fitted,
    /// Misfit that the worst surrogate leaves.
    structure_energy: f64,
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

    fn id(&self, candidate: usize) -> &'static str {
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
    fn output_drop(&self, before: &Fitted, after: &Fitted) -> f64 {
        let beside = |f: &Fitted| self.evidence.beside_output(&f.residual);
        let drop = before.cost - after.cost - (beside(before) - beside(after));
        drop.max(0.0)
    }

    fn held_out_drop(&self, before: &Fitted, after: &Fitted) -> f64 {
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

    /// The candidates that do about as well in the place of a chosen one, best first.
    fn alternatives(
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
            if behind < margin || (behind < 2.0 * error && behind < 0.2 * drop) {
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

    fn conclude(
        &self,
        chosen: &[usize],
        current: &Fitted,
        singles: &[Option<Fitted>],
        single_drops: Vec<Option<f64>>,
        mut reasons: Vec<String>,
    ) -> Result<Finding, GapError> {
        let settings = self.discovery.settings;
        let before = self.generic.along(self.discovery, self.evidence, &self.base.residual);
        let after = self.generic.along(self.discovery, self.evidence, &current.residual);
        let mut causes = Vec::new();
        for at in 0..chosen.len() {
            let place = self.alternatives(chosen, at, current, singles)?;
            causes.push(Found {
                candidate: chosen[at],
                parameters: parameters(self.discovery, self.evidence, current, at, &place.rest),
                drop: place.drop,
                held_out_drop: self.held_out_drop(&place.rest, current),
                alternatives: place.alternatives,
                rivals: place.rivals,
            });
        }
        let drop = self.base.cost - current.cost;
        let lack = (after - self.generic.threshold).max(0.0);
        let explained = if drop > 0.0 { drop / (drop + lack) } else { 0.0 };
        let ambiguous = causes.iter().any(|c| !c.alternatives.is_empty());
        let (found, worst_drift) = self.doubts(current);
        let mut doubts = !found.is_empty();
        reasons.extend(found);
        if chosen.is_empty() {
            doubts = false;
        } else if explained < settings.explained {
            doubts = true;
            reasons.push(format!(
                "{:.0} % of the excess is explained; structure is left along directions without a name: {after:.0} noise units, {:.0} at the floor",
                100.0 * explained, self.generic.threshold
            ));
        }
        let whole = self.share_of_excess(current);
        if !chosen.is_empty() && whole < LEAST_SHARE {
            doubts = true;
            reasons.push(format!(
                "{:.0} % of what the base model leaves above its floor is explained: most of it is something else",
                100.0 * whole
            ));
        }
        let wrong_name = explained < 0.5 || worst_drift > WRONG_NAME;
        if wrong_name && !chosen.is_empty() && before <= self.generic.threshold {
            reasons.push("what is left is within the floor: the name is dropped".into());
            let base = self.base.clone();
            let mut finding = self.conclude(&[], &base, singles, single_drops, reasons)?;
            finding.confidence = Confidence::Tentative;
            return Ok(finding);
        }
        let verdict = if chosen.is_empty() {
            self.nothing_named(before, &mut reasons)
        } else if wrong_name {
            Verdict::Unknown
        } else if ambiguous {
            Verdict::Ambiguous
        } else if doubts {
            Verdict::NamedStructureRemains
        } else {
            Verdict::Named
        };
        let strong = causes.iter().all(|c| c.drop > STRONG * self.screened[c.candidate].threshold);
        // a cause whose own signal was not measured may stand for any other slow or scaling error
        let guessed = causes.iter().flat_map(|c| &c.parameters).find_map(|p| p.needs);
        if let Some(needs) = guessed {
            reasons.push(format!("without {needs} a name that needs it is tentative"));
        }
        let sure = match verdict {
            Verdict::NothingMissing => settings.has_reference,
            Verdict::Named => settings.has_reference && strong && guessed.is_none(),
            _ => false,
        };
        let confidence = if sure { Confidence::Confident } else { Confidence::Tentative };
        causes.sort_by(|a, b| b.drop.total_cmp(&a.drop));
        Ok(Finding {
            verdict,
            confidence,
            causes,
            effects: current.effects.clone(),
            reasons,
            screen: self.screened.clone(),
            single_drops,
            excess: [before, after],
            gain: gain(self.evidence, &self.base, current, settings.resamplings),
            residual_before: self.base.cleaned(self.evidence),
            residual_after: current.cleaned(self.evidence),
        })
    }

    /// What speaks against the parameters of fitted effects: ends of ranges, drift from experiment to
    /// experiment; and the largest drift.
    fn doubts(&self, current: &Fitted) -> (Vec<String>, f64) {
        let mut doubts = Vec::new();
        let mut worst = 0.0_f64;
        for (k, &(effect, p)) in current.free.iter().enumerate() {
            let own = &current.effects[effect];
            let parameter = &self.discovery.candidates[own.candidate].cause.parameters[p];
            if parameter.is_shape {
                continue;
            }
            let value = own.values[p];
            let name = format!("{} of {}", parameter.name, self.id(own.candidate));
            if parameter.at_bound(value) {
                let unit = parameter.unit;
                doubts.push(format!("{name} lies at an end of its range, {value:.3e} {unit}"));
            }
            let found = drift(self.evidence, current, k);
            let spread = match parameter.scale {
                Scale::Log => found.spread,
                Scale::Linear => found.spread / value.abs().max(1e-300),
            };
            let cost = found.lost() / (self.base.cost - current.cost).max(1.0);
            if found.is_significant() && spread > DRIFTING && cost > DRIFT_COSTS[0] {
                if cost > DRIFT_COSTS[1] {
                    worst = worst.max(spread);
                }
                doubts.push(format!(
                    "{name} drifts by {:.0} % from experiment to experiment: the name may be wrong",
                    100.0 * spread
                ));
            }
        }
        (doubts, worst)
    }

    /// Share of the misfit above the floor that a fit takes away; 1 where nothing stands out. The floor
    /// is what noise and the worst surrogate leave.
    fn share_of_excess(&self, current: &Fitted) -> f64 {
        let energy = |f: &Fitted| f.cost - self.evidence.beside_output(&f.residual);
        let floor = self.evidence.noise_energy() + self.structure_energy;
        let before = energy(&self.base) - floor;
        let drop = self.output_drop(&self.base, current);
        if before > STANDS_OUT * floor { (drop / before).min(1.0) } else { 1.0 }
    }

    fn nothing_named(&self, excess: f64, reasons: &mut Vec<String>) -> Verdict {
        let threshold = self.generic.threshold;
        if excess > threshold {
            reasons.push(format!(
                "{excess:.0} noise units of structure are missing, {threshold:.0} would be the floor, and no known cause explains them"
            ));
            return Verdict::Unknown;
        }
        let visible = |s: &Screened| s.weak_signal > s.threshold;
        if self.screened.iter().any(visible) {
            Verdict::NothingMissing
        } else {
            reasons.push("no cause of usual strength would show in these data".into());
            Verdict::NotObservable
        }
    }
}
