//! What is said of the causes that a search has found: verdict, confidence, doubts.

use super::decide::{Notes, Search};
use super::fit::Fitted;
use super::held_out::gain;
use super::judge::drift;
use super::thresholds::{
    DRIFT_COSTS, DRIFTING, EXPLAINED, GENERIC_SURELY, LEAST_SHARE, LEAST_SHARE_OF_RUNS, STRAINED,
    STRAINED_BESIDE, STRONG, WRONG_NAME, least_effect, limit,
};
use super::{
    Alternative, Compared, Confidence, Finding, Found, FoundClass, Reason, Screened, Simulator,
    StandsOut, Verdict, Yardstick,
};
use crate::{Class, Effect, GapError, Scale};

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
        // candidates of one name are one cause in another place
        let is_other = |c: &Found, a: &Alternative| self.id(a.candidate) != self.id(c.candidate);
        let ambiguous = causes.iter().any(|c| c.alternatives.iter().any(|a| is_other(c, a)));
        let (found, is_wrong) =
            if chosen.is_empty() { (Vec::new(), false) } else { self.shortcomings(current, after) };
        let doubts = !chosen.is_empty() && (!found.is_empty() || looks_like.is_some());
        reasons.extend(found);
        let bands_left = if chosen.is_empty() { Vec::new() } else { self.bands_left(current) };
        let worst = bands_left.iter().max_by(|a, b| a.times.total_cmp(&b.times));
        reasons.extend(
            worst.map(|worst| Reason::BandsLeft { bands: bands_left.len(), worst: *worst }),
        );
        let held_out = gain(&self.folds, self.evidence, current, settings.resamplings)?;
        let (unseen, are_borne_out) = self.borne_out(&causes);
        let is_unseen = unseen.is_some();
        let is_beside = |c: &usize| self.discovery.candidates[*c].is_beside_output;
        let is_beside = chosen.iter().all(is_beside);
        // a gain that no held-out run can show is not stated
        let held_out = held_out.filter(|_| !is_unseen && !is_beside);
        let (gain, held_out_residuals) = held_out.unzip();
        let [least, most] = gain.map_or([1.0; 2], |gain| gain.drop_ci95);
        let (gains, gains_surely) = (most > 0.0, least > 0.0);
        if !gains {
            reasons.push(Reason::WorseHeldOut);
        } else if !gains_surely {
            reasons.push(Reason::GainMayBeZero);
        }
        reasons.extend(unseen);
        let wrong_name = !gains || is_wrong;
        if wrong_name && !chosen.is_empty() && before <= self.generic.threshold {
            reasons.push(Reason::NameDropped);
            let base = self.base.clone();
            let in_some_runs = in_some_runs || causes.iter().any(|c| c.only_run.is_some());
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
        } else if doubts || !bands_left.is_empty() {
            Verdict::NamedStructureRemains
        } else {
            Verdict::Named
        };
        let is_slow = matches!(verdict, Verdict::Unknown) && self.trend().is_some();
        let strong = causes.iter().all(|c| c.drop > STRONG * self.screened[c.candidate].threshold);
        let tentative = self.tentative(&causes, current);
        let named_surely = strong && tentative.is_empty() && gains_surely && are_borne_out;
        reasons.extend(tentative);
        let limits = self.limits();
        let sure = match verdict {
            Verdict::NothingMissing => self.denies_surely(&limits, before, current, &mut reasons),
            Verdict::Named => settings.has_reference && named_surely,
            _ => false,
        };
        let confidence = if sure { Confidence::Confident } else { Confidence::Tentative };
        causes.sort_by(|a, b| b.drop.total_cmp(&a.drop));
        let is_named = !matches!(verdict, Verdict::Unknown | Verdict::NothingMissing);
        let class_is_sure =
            settings.has_reference && strong && gains_surely && are_borne_out && !doubts;
        let class = causes.first().filter(|_| is_named);
        let class = class.map(|leading| self.class_of(leading, class_is_sure));
        Ok(Finding {
            verdict,
            confidence,
            causes,
            class,
            limits,
            singles: singles.iter().map(|own| self.single(own.as_ref()?)).collect(),
            effects: current.effects.clone(),
            reasons,
            screen: self.screened.clone(),
            gain,
            structure_remains: doubts || !bands_left.is_empty(),
            looks_like,
            is_slow,
            standing_out,
            bands_left,
            residual_before: self.base.cleaned(self.evidence),
            residual_after: current.cleaned(self.evidence),
            held_out_residuals,
        })
    }

    /// The effect of a candidate fitted alone, with its drop.
    fn single(&self, fit: &Fitted) -> Option<(Effect, f64)> {
        Some((fit.effects.last()?.clone(), self.base.cost - fit.cost))
    }

    /// Why no run bears a cause out, if there is one such cause; and whether every cause is borne out by runs or parts
    /// of a run that its fit has not seen.
    fn borne_out(&self, causes: &[Found]) -> (Option<Reason>, bool) {
        let unseen = causes.iter().find(|c| c.held_out_drop.is_none()).map(|found| {
            let cause = self.id(found.candidate);
            found.only_run.map_or(Reason::NothingHeldOut, |run| Reason::OneRunOnly { cause, run })
        });
        let is_borne_out =
            |c: &Found| c.held_out_drop.is_some() || c.only_run.is_some_and(|run| run.halves_agree);
        (unseen, causes.iter().all(is_borne_out))
    }

    /// Whether "nothing is missing" is sure, with what speaks against it; `excess` is what the base model leaves along
    /// the generic directions.
    fn denies_surely(
        &self,
        limits: &[Option<f64>],
        excess: f64,
        base: &Fitted,
        reasons: &mut Vec<Reason>,
    ) -> bool {
        let missed = self.would_be_missed(limits);
        let strain = self.evidence.strain(base, self.discovery.calibrations);
        let (sees_all, is_calibrated) = (missed.is_empty(), strain <= STRAINED);
        if !sees_all {
            let yardstick = self.discovery.settings.yardstick;
            let share = (yardstick == Yardstick::OutputSpread).then(|| yardstick.matters());
            reasons.push(Reason::WouldBeMissed { share, causes: missed });
        }
        if !is_calibrated {
            reasons.push(Reason::CalibrationOff { times: strain });
        }
        let is_at_floor = excess <= self.generic.threshold;
        // a further channel shows what the output does not
        let is_beside = |r: &Reason| matches!(r, Reason::Negligible { drop, .. } if *drop < 0.0);
        let is_at_floor = is_at_floor && !reasons.iter().any(is_beside);
        self.discovery.settings.has_reference && sees_all && is_calibrated && is_at_floor
    }

    /// What would have been seen of every candidate, over the output.
    fn limits(&self) -> Vec<Option<f64>> {
        let left = self.evidence.left_of_outputs(&self.base, self.discovery.calibrations);
        let least = least_effect(left, self.evidence.output_samples());
        let yardstick = self.discovery.settings.yardstick;
        let limit = |(c, s): (usize, &Screened)| {
            let is_seen = self.discovery.candidates[c].blocked.is_none() && s.weak_signal > 0.0;
            let by_chi2 = limit(s.weak_signal, s.threshold + self.penalty(c));
            let of_weak = match yardstick {
                Yardstick::OutputSpread => by_chi2.max(least / s.weak_drop.sqrt()),
                Yardstick::FirstStart => by_chi2,
            };
            is_seen.then(|| yardstick.weak() * of_weak)
        };
        self.screened.iter().enumerate().map(limit).collect()
    }

    /// The common causes that would have been missed at a size that matters.
    fn would_be_missed(&self, limits: &[Option<f64>]) -> Vec<&'static str> {
        let candidates = self.discovery.candidates.iter().zip(limits);
        let matters = self.discovery.settings.yardstick.matters();
        let missed = candidates.filter(|(own, limit)| {
            own.is_common && own.refuted.is_none() && limit.is_none_or(|size| size > matters)
        });
        let mut ids: Vec<&'static str> = missed.map(|(own, _)| own.id).collect();
        ids.dedup();
        ids
    }

    /// The class of a cause, with the members that the data leave open; sure if no cause of another class is near it.
    fn class_of(&self, leading: &Found, is_sure: bool) -> FoundClass {
        let class_of = |c: usize| self.discovery.candidates[c].class;
        let class = class_of(leading.candidate);
        let near = || leading.compared.iter().filter(|other| other.is_near());
        let is_alone =
            class != Class::Other && near().all(|other| class_of(other.candidate) == class);
        let is_known = self.undetermined(leading).is_none() && self.open_ended(leading).is_none();
        let open = leading.compared.iter().filter(|other| other.is_open());
        let members = open
            .map(|other| other.candidate)
            .filter(|&c| self.may_be_named(c) && class_of(c) == class);
        FoundClass {
            class,
            members: std::iter::once(leading.candidate).chain(members).collect(),
            confidence: if is_sure && is_alone && is_known {
                Confidence::Confident
            } else {
                Confidence::Tentative
            },
        }
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
    fn tentative(&self, causes: &[Found], current: &Fitted) -> Vec<Reason> {
        // a cause whose own signal was not measured may be mistaken for any other slow or scaling error
        let guessed = causes.iter().flat_map(|c| &c.parameters).find_map(|p| p.needs);
        let guessed = guessed.map(|signal| Reason::NotMeasured { signal });
        let not_excluded = causes.iter().find_map(|found| self.not_excluded(found));
        let open_ended = causes.iter().find_map(|found| self.open_ended(found));
        let undetermined = causes.iter().find_map(|found| self.undetermined(found));
        // a name that asks for another calibration besides is not the whole of it
        let strain = self.evidence.strain(current, self.discovery.calibrations);
        let off = (!causes.is_empty() && strain > STRAINED_BESIDE)
            .then_some(Reason::CalibrationOff { times: strain });
        [guessed, not_excluded, open_ended, undetermined, off].into_iter().flatten().collect()
    }

    /// What speaks against the parameters of fitted effects: ends of ranges, drift from experiment to
    /// experiment; and the largest drift.
    pub(super) fn doubts(&self, current: &Fitted) -> (Vec<Reason>, f64) {
        self.doubts_of(current, None)
    }

    /// The same of one effect alone, or of all.
    pub(super) fn doubts_of(&self, current: &Fitted, of: Option<usize>) -> (Vec<Reason>, f64) {
        let mut doubts = Vec::new();
        let mut worst = 0.0_f64;
        for (k, &(effect, p)) in current.free.iter().enumerate() {
            if of.is_some_and(|own| own != effect) {
                continue;
            }
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
                Scale::Linear => found.spread / (value - parameter.none).abs().max(1e-300),
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
        }
        if excess > GENERIC_SURELY * threshold {
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
