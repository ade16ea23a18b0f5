//! What is said of the causes that a search has found: verdict, confidence, doubts.

use super::decide::{Notes, STRONG, Search};
use super::fit::Fitted;
use super::gain::gain;
use super::judge::{drift, parameters};
use super::{Compared, Confidence, Finding, Found, Screened, Simulator, StandsOut, Verdict};
use crate::{GapError, Scale};

/// Relative spread from which on the name is wrong.
const WRONG_NAME: f64 = 0.5;
/// Relative spread of a parameter over the experiments from which on it drifts.
const DRIFTING: f64 = 0.25;
/// Share of the drop that values of its own for every experiment must add before a drift speaks
/// against a name, and the share before it makes the name wrong.
const DRIFT_COSTS: [f64; 2] = [0.06, 0.15];
/// Share of the misfit above the floor below which something else than the names is missing too.
const LEAST_SHARE: f64 = 0.6;
/// The same for the runs that stand out alone, where an error of form of a cause weighs most.
const LEAST_SHARE_OF_RUNS: f64 = 0.3;

/// What the causes found leave open.
#[derive(Default)]
struct Shortcomings {
    reasons: Vec<String>,
    /// Whether they cannot be what is missing.
    is_wrong: bool,
}

impl<S: Simulator> Search<'_, S> {
    pub(super) fn conclude(
        &self,
        chosen: &[usize],
        current: &Fitted,
        singles: &[Option<Fitted>],
        single_drops: Vec<Option<f64>>,
        notes: Notes,
    ) -> Result<Finding, GapError> {
        let settings = self.discovery.settings;
        let Notes { mut reasons, looks_like, in_some_runs } = notes;
        let before = self.generic.along(self.evidence, &self.base.residual);
        let after = self.generic.along(self.evidence, &current.residual);
        let mut causes = self.found(chosen, current, singles)?;
        let ambiguous = causes.iter().any(|c| !c.alternatives.is_empty());
        let Shortcomings { reasons: found, is_wrong } = if chosen.is_empty() {
            Shortcomings::default()
        } else {
            self.shortcomings(current, after)
        };
        let doubts = !chosen.is_empty() && (!found.is_empty() || looks_like.is_some());
        reasons.extend(found);
        let gain = gain(self.evidence, &self.base, current, settings.resamplings);
        let [least, most] = if chosen.is_empty() { [1.0; 2] } else { gain.drop_ci95 };
        let (gains, gains_surely) = (most > 0.0, least > 0.0);
        if !gains {
            reasons.push("the extended model is worse where it is held out".into());
        } else if !gains_surely {
            reasons.push("held out it may gain nothing: the name is tentative".into());
        }
        let wrong_name = !gains || is_wrong;
        if wrong_name && !chosen.is_empty() && before <= self.generic.threshold {
            reasons.push("what is left is within the floor: the name is dropped".into());
            let base = self.base.clone();
            let notes = Notes { reasons, looks_like, in_some_runs };
            let mut finding = self.conclude(&[], &base, singles, single_drops, notes)?;
            finding.confidence = Confidence::Tentative;
            return Ok(finding);
        }
        let standing_out = self.standing_out();
        let verdict = if chosen.is_empty() && looks_like.is_some() {
            Verdict::Unknown
        } else if chosen.is_empty() {
            self.nothing_named(before, &standing_out, in_some_runs, &mut reasons)
        } else if wrong_name {
            Verdict::Unknown
        } else if ambiguous {
            Verdict::Ambiguous
        } else if doubts {
            Verdict::NamedStructureRemains
        } else {
            Verdict::Named
        };
        let is_slow = chosen.is_empty() && self.trend().is_some();
        let strong = causes.iter().all(|c| c.drop > STRONG * self.screened[c.candidate].threshold);
        let tentative = self.tentative(&causes);
        let named_surely = strong && tentative.is_empty() && gains_surely;
        reasons.extend(tentative);
        let sure = match verdict {
            Verdict::NothingMissing => settings.has_reference,
            Verdict::Named => settings.has_reference && named_surely,
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
            gain,
            structure_remains: doubts,
            looks_like,
            is_slow,
            standing_out,
            residual_before: self.base.cleaned(self.evidence),
            residual_after: current.cleaned(self.evidence),
        })
    }

    /// What causes as fitted together leave open; `after` is what they leave along the directions without a name.
    fn shortcomings(&self, current: &Fitted, after: f64) -> Shortcomings {
        let (mut reasons, worst_drift) = self.doubts(current);
        let drop = self.base.cost - current.cost;
        let lack = (after - self.generic.threshold).max(0.0);
        let explained = if drop > 0.0 { drop / (drop + lack) } else { 0.0 };
        if explained < self.discovery.settings.explained {
            reasons.push(format!(
                "{:.0} % of the excess is explained; structure is left along directions without a name: {after:.0} noise units, {:.0} at the floor",
                100.0 * explained, self.generic.threshold
            ));
        }
        let whole = self.share_of_excess(current);
        if whole < LEAST_SHARE {
            reasons.push(format!(
                "{:.0} % of what the base model leaves above its floor is explained: most of it is something else",
                100.0 * whole
            ));
        }
        let of_runs = self.share_of_runs(current);
        if of_runs < LEAST_SHARE_OF_RUNS {
            reasons.push(format!(
                "{:.0} % of what stands out run by run is explained: most of it is something else",
                100.0 * of_runs
            ));
        }
        let left = self.standing_out_after(current);
        reasons.extend(left.iter().max_by(|a, b| a.times.total_cmp(&b.times)).map(|worst| {
            format!(
                "{} of the runs are missed beside the names too, the worst by {:.1} times what the worst surrogate leaves there",
                left.len(), worst.times
            )
        }));
        let is_wrong = explained < 0.5
            || whole < LEAST_SHARE
            || of_runs < LEAST_SHARE_OF_RUNS
            || worst_drift > WRONG_NAME;
        Shortcomings { reasons, is_wrong }
    }

    /// Every chosen cause with what was found about it.
    fn found(
        &self,
        chosen: &[usize],
        current: &Fitted,
        singles: &[Option<Fitted>],
    ) -> Result<Vec<Found>, GapError> {
        let one = |at: usize| {
            let place = self.alternatives(chosen, at, current, singles)?;
            Ok(Found {
                candidate: chosen[at],
                parameters: parameters(self.discovery, self.evidence, current, at, &place.rest)?,
                drop: place.drop,
                output_drop: self.output_drop(&place.rest, current),
                held_out_drop: self.held_out_drop(&place.rest, current),
                alternatives: place.alternatives,
                rivals: place.rivals,
                compared: place.compared,
            })
        };
        (0..chosen.len()).map(one).collect()
    }

    /// Why the names of these causes are tentative, if they are.
    fn tentative(&self, causes: &[Found]) -> Vec<String> {
        // a cause whose own signal was not measured may stand for any other slow or scaling error
        let guessed = causes.iter().flat_map(|c| &c.parameters).find_map(|p| p.needs);
        let guessed =
            guessed.map(|needs| format!("without {needs} a name that needs it is tentative"));
        let not_excluded = causes.iter().find_map(|found| self.not_excluded(found));
        let open_ended = causes.iter().find_map(|found| self.open_ended(found));
        let undetermined = causes.iter().find_map(|found| self.undetermined(found));
        [guessed, not_excluded, open_ended, undetermined].into_iter().flatten().collect()
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

    /// What is said of a cause whose closest rival is less likely, but not excluded.
    fn not_excluded(&self, found: &Found) -> Option<String> {
        let listed = |c: &Compared| found.alternatives.iter().any(|a| a.candidate == c.candidate);
        let mut near = found.compared.iter().filter(|c| c.is_near() && !listed(c));
        near.next().map(|other| {
            let how = if other.is_open() { "is not excluded" } else { "is excluded by little" };
            let less = if other.behind < 0.0 { "more" } else { "less" };
            format!(
                "{} explains {:.0} noise units {less} than {} and {how}: to stay {:.0} behind would exclude it",
                self.id(other.candidate),
                other.behind.abs(),
                self.id(found.candidate),
                other.told_apart_beyond
            )
        })
    }

    /// What is said of a cause none of whose parameters is known: each interval holds no effect at all, or the
    /// whole range. Such a cause mends the misfit, but what it says of the system may be nothing.
    fn undetermined(&self, found: &Found) -> Option<String> {
        let cause = &self.discovery.candidates[found.candidate].cause;
        let own = found.parameters.iter().zip(&cause.parameters);
        let mut judged = own.filter(|(v, p)| !v.is_shape && p.needs.is_none()).peekable();
        judged.peek()?;
        judged
            .all(|(value, parameter)| parameter.says_nothing(value.ci95))
            .then(|| format!("no parameter of {} is determined: the name is tentative", cause.id))
    }

    /// What is said of a parameter whose interval reaches an end of its range: an effect of such a kind was
    /// seen by one of its sides, as a mode far above the runs by its tail.
    fn open_ended(&self, found: &Found) -> Option<String> {
        let id = self.id(found.candidate);
        let parameters = &self.discovery.candidates[found.candidate].cause.parameters;
        let own = found.parameters.iter().zip(parameters).filter(|p| !p.0.is_shape);
        own.filter(|(value, parameter)| parameter.is_open_ended(value.ci95))
            .map(|(value, _)| {
                format!(
                    "{} of {id} is not determined: its interval reaches an end of its range, the name is tentative",
                    value.name
                )
            })
            .next()
    }

    /// What the base model leaves along the slow changes, where it is more than the floor.
    fn trend(&self) -> Option<f64> {
        let trend = self.trends.along(self.evidence, &self.base.residual);
        (trend > self.trends.threshold).then_some(trend)
    }

    fn nothing_named(
        &self,
        excess: f64,
        alone: &[StandsOut],
        in_some_runs: bool,
        reasons: &mut Vec<String>,
    ) -> Verdict {
        let threshold = self.generic.threshold;
        if excess > threshold {
            reasons.push(format!(
                "{excess:.0} noise units of structure are missing, {threshold:.0} would be the floor, and no known cause explains them"
            ));
            return Verdict::Unknown;
        }
        if let Some(trend) = self.trend() {
            reasons.push(format!(
                "the output changes slowly in all runs alike: {trend:.0} noise units along a zero, a gain and a return to zero that are steady, {:.0} would be the floor, and no known cause explains them",
                self.trends.threshold
            ));
            return Verdict::Unknown;
        }
        if !alone.is_empty() {
            reasons.push(format!(
                "{} of the runs are missed by more than any surrogate is there: what is missing is not in all of them alike",
                alone.len()
            ));
            return Verdict::Unknown;
        }
        if in_some_runs {
            reasons.push("what it explains is in some of the runs alone: no cause acts so".into());
            return Verdict::Unknown;
        }
        // a cause that cannot be there, or has no name, would not be said either
        let visible =
            |(c, s): (usize, &Screened)| self.may_be_named(c) && s.weak_signal > s.threshold;
        if self.screened.iter().enumerate().any(visible) {
            Verdict::NothingMissing
        } else {
            reasons.push("no cause of usual strength would show in these data".into());
            Verdict::NotObservable
        }
    }
}
