//! What is said of the causes that a search has found: verdict, confidence, doubts.

use super::decide::Search;
use super::fit::Fitted;
use super::gain::gain;
use super::judge::{drift, parameters};
use super::{Confidence, Finding, Found, Screened, Simulator, Verdict};
use crate::{GapError, Scale};

/// Relative spread from which on the name is wrong.
const WRONG_NAME: f64 = 0.5;
/// Times its threshold that a cause must explain to be named with confidence.
const STRONG: f64 = 2.0;
/// Relative spread of a parameter over the experiments from which on it drifts.
const DRIFTING: f64 = 0.25;
/// Share of the drop that values of its own for every experiment must add before a drift speaks
/// against a name, and the share before it makes the name wrong.
const DRIFT_COSTS: [f64; 2] = [0.06, 0.15];
/// Share of the misfit above the floor below which something else than the names is missing too.
const LEAST_SHARE: f64 = 0.6;
/// Misfit over the floor, in floors, from which that share means anything.
const STANDS_OUT: f64 = 0.5;

impl<S: Simulator> Search<'_, S> {
    pub(super) fn conclude(
        &self,
        chosen: &[usize],
        current: &Fitted,
        singles: &[Option<Fitted>],
        single_drops: Vec<Option<f64>>,
        mut reasons: Vec<String>,
    ) -> Result<Finding, GapError> {
        let settings = self.discovery.settings;
        let before = self.generic.along(self.evidence, &self.base.residual);
        let after = self.generic.along(self.evidence, &current.residual);
        let mut causes = Vec::new();
        for at in 0..chosen.len() {
            let place = self.alternatives(chosen, at, current, singles)?;
            causes.push(Found {
                candidate: chosen[at],
                parameters: parameters(self.discovery, self.evidence, current, at, &place.rest),
                drop: place.drop,
                output_drop: self.output_drop(&place.rest, current),
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
    pub(super) fn doubts(&self, current: &Fitted) -> (Vec<String>, f64) {
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
