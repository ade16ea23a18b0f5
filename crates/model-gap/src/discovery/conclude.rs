//! What is said of the causes that a search has found: verdict, confidence, doubts.

use super::decide::{Notes, Search};
use super::fit::Fitted;
use super::gain::gain;
use super::judge::drift;
use super::thresholds::{
    DRIFT_COSTS, DRIFTING, EXPLAINED, LEAST_SHARE, LEAST_SHARE_OF_RUNS, STRONG, WRONG_NAME,
};
use super::{
    Compared, Confidence, Finding, Found, Reason, Screened, Simulator, StandsOut, Verdict,
};
use crate::{GapError, Scale};

impl<S: Simulator> Search<'_, S> {
    pub(super) fn conclude(
        &self,
        chosen: &[usize],
        current: &Fitted,
        singles: &[Option<Fitted>],
        notes: Notes,
    ) -> Result<Finding, GapError> {
        let settings = self.discovery.settings;
        let Notes { mut reasons, looks_like, in_some_runs } = notes;
        let before = self.generic.along(self.evidence, &self.base.residual);
        let after = self.generic.along(self.evidence, &current.residual);
        let mut causes: Vec<Found> = (0..chosen.len())
            .map(|at| self.found(chosen, at, current, singles))
            .collect::<Result<_, GapError>>()?;
        let ambiguous = causes.iter().any(|c| !c.alternatives.is_empty());
        let (found, is_wrong) =
            if chosen.is_empty() { (Vec::new(), false) } else { self.shortcomings(current, after) };
        let doubts = !chosen.is_empty() && (!found.is_empty() || looks_like.is_some());
        reasons.extend(found);
        let gain = gain(self.evidence, &self.base, current, settings.resamplings);
        let [least, most] = if chosen.is_empty() { [1.0; 2] } else { gain.drop_ci95 };
        let (gains, gains_surely) = (most > 0.0, least > 0.0);
        if !gains {
            reasons.push(Reason::WorseHeldOut);
        } else if !gains_surely {
            reasons.push(Reason::GainMayBeZero);
        }
        let wrong_name = !gains || is_wrong;
        if wrong_name && !chosen.is_empty() && before <= self.generic.threshold {
            reasons.push(Reason::NameDropped);
            let base = self.base.clone();
            let notes = Notes { reasons, looks_like, in_some_runs };
            let mut finding = self.conclude(&[], &base, singles, notes)?;
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
            gain,
            structure_remains: doubts,
            looks_like,
            is_slow,
            standing_out,
            residual_before: self.base.cleaned(self.evidence),
            residual_after: current.cleaned(self.evidence),
        })
    }

    /// What causes as fitted together leave open, and whether they cannot be what is missing; `after` is the
    /// chi-square they leave along the generic directions.
    fn shortcomings(&self, current: &Fitted, after: f64) -> (Vec<Reason>, bool) {
        let (mut reasons, worst_drift) = self.doubts(current);
        let drop = self.base.cost - current.cost;
        let lack = (after - self.generic.threshold).max(0.0);
        let explained = if drop > 0.0 { drop / (drop + lack) } else { 0.0 };
        if explained < EXPLAINED {
            let floor = self.generic.threshold;
            reasons.push(Reason::StructureLeft { share: explained, chi2: after, floor });
        }
        let whole = self.share_of_excess(current);
        if whole < LEAST_SHARE {
            reasons.push(Reason::MisfitLeft { share: whole });
        }
        let of_runs = self.share_of_runs(current);
        if of_runs < LEAST_SHARE_OF_RUNS {
            reasons.push(Reason::MisfitOfRunsLeft { share: of_runs });
        }
        let left = self.standing_out_after(current);
        reasons.extend(
            left.iter()
                .map(|run| run.times)
                .max_by(f64::total_cmp)
                .map(|times| Reason::RunsStandOut { runs: left.len(), times }),
        );
        let is_wrong = explained < 0.5
            || whole < LEAST_SHARE
            || of_runs < LEAST_SHARE_OF_RUNS
            || worst_drift > WRONG_NAME;
        (reasons, is_wrong)
    }

    /// Why the names of these causes are tentative, if they are.
    fn tentative(&self, causes: &[Found]) -> Vec<Reason> {
        // a cause whose own signal was not measured may be mistaken for any other slow or scaling error
        let guessed = causes.iter().flat_map(|c| &c.parameters).find_map(|p| p.needs);
        let guessed = guessed.map(|signal| Reason::NotMeasured { signal });
        let not_excluded = causes.iter().find_map(|found| self.not_excluded(found));
        let open_ended = causes.iter().find_map(|found| self.open_ended(found));
        let undetermined = causes.iter().find_map(|found| self.undetermined(found));
        [guessed, not_excluded, open_ended, undetermined].into_iter().flatten().collect()
    }

    /// What speaks against the parameters of fitted effects: ends of ranges, drift from experiment to
    /// experiment; and the largest drift.
    pub(super) fn doubts(&self, current: &Fitted) -> (Vec<Reason>, f64) {
        let mut doubts = Vec::new();
        let mut worst = 0.0_f64;
        for (k, &(effect, p)) in current.free.iter().enumerate() {
            let own = &current.effects[effect];
            let parameter = &self.discovery.candidates[own.candidate].parameters[p];
            if parameter.is_shape {
                continue;
            }
            let value = own.values[p];
            let (cause, name, unit) = (self.id(own.candidate), parameter.name, parameter.unit);
            if parameter.at_bound(value) {
                doubts.push(Reason::AtBound { cause, parameter: name, value, unit });
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
                doubts.push(Reason::Drifts { cause, parameter: name, spread });
            }
        }
        (doubts, worst)
    }

    /// Reason for a tentative name: the closest alternative is less likely, but not excluded.
    fn not_excluded(&self, found: &Found) -> Option<Reason> {
        let listed = |c: &Compared| found.alternatives.iter().any(|a| a.candidate == c.candidate);
        let mut near = found.compared.iter().filter(|c| c.is_near() && !listed(c));
        near.next().map(|other| Reason::NotExcluded {
            cause: self.id(found.candidate),
            other: self.id(other.candidate),
            is_open: other.is_open(),
            delta_chi2: other.delta_chi2,
            threshold: other.discrimination_threshold,
        })
    }

    /// Reason for a tentative name: no parameter is known. Each interval contains zero effect, or spans the
    /// whole range.
    fn undetermined(&self, found: &Found) -> Option<Reason> {
        let cause = &self.discovery.candidates[found.candidate];
        let own = found.parameters.iter().zip(&cause.parameters);
        let mut judged = own.filter(|(v, p)| !v.is_shape && p.needs.is_none()).peekable();
        judged.peek()?;
        judged
            .all(|(value, parameter)| parameter.says_nothing(value.ci95))
            .then_some(Reason::Undetermined { cause: cause.id })
    }

    /// Reason for a tentative name: the interval of a parameter reaches an end of its range, as of a mode far
    /// above the tested frequencies.
    fn open_ended(&self, found: &Found) -> Option<Reason> {
        let cause = self.id(found.candidate);
        let parameters = &self.discovery.candidates[found.candidate].parameters;
        let own = found.parameters.iter().zip(parameters).filter(|p| !p.0.is_shape);
        own.filter(|(value, parameter)| parameter.is_open_ended(value.ci95))
            .map(|(value, _)| Reason::OpenEnded { cause, parameter: value.name })
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
        reasons: &mut Vec<Reason>,
    ) -> Verdict {
        let threshold = self.generic.threshold;
        if excess > threshold {
            reasons.push(Reason::NoKnownCause { chi2: excess, floor: threshold });
            return Verdict::Unknown;
        }
        if let Some(trend) = self.trend() {
            reasons.push(Reason::ChangesSlowly { chi2: trend, floor: self.trends.threshold });
            return Verdict::Unknown;
        }
        if !alone.is_empty() {
            reasons.push(Reason::RunsMissed { runs: alone.len() });
            return Verdict::Unknown;
        }
        if in_some_runs {
            reasons.push(Reason::FewRuns);
            return Verdict::Unknown;
        }
        // neither a refuted cause nor a decoy would be named
        let visible =
            |(c, s): (usize, &Screened)| self.may_be_named(c) && s.weak_signal > s.threshold;
        if self.screened.iter().enumerate().any(visible) {
            Verdict::NothingMissing
        } else {
            reasons.push(Reason::NothingVisible);
            Verdict::NotObservable
        }
    }
}
