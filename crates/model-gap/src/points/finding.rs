//! What the tables lack: the engine of discovery on points of test.

use super::floor::Floor;
use super::next::{NextPoints, next_points};
use super::predicted::Tables;
use super::shown::{ChannelFloor, Reading};
use super::table::{PointTable, Suspect, SuspectParameter};
use crate::discovery::{
    Confidence, Discovery, Finding, Fingerprint, FittedParameter, Found, Reason, Settings,
    Simulator, Yardstick, fingerprints,
};
use crate::{Candidate, GapError};

/// Part of what is left of the error of the readings that a cause after the first must take off it to be named with confidence.
const BESIDE_REST: f64 = 0.5;

/// What was found at points of test.
#[derive(Debug, Clone)]
pub struct PointFinding {
    /// Verdict, causes and reasons. Its experiments are the measured points in their order; its numbers are over standard
    /// deviations; its limits are over the first amount of each suspect.
    pub finding: Finding,
    /// The suspects as the engine saw them.
    pub candidates: Vec<Candidate>,
    /// The measured points, by number in the table.
    pub measured: Vec<usize>,
    /// The error of every channel before and after, on points that the fits have not seen; empty without a gain.
    pub gains: Vec<ChannelGain>,
    /// What to measure next; none where nothing is open or no point tells it apart.
    pub next: Option<NextPoints>,
    /// Every reading with what is simulated of it, point by point.
    pub readings: Vec<Reading>,
    /// What the causes found and their nearest rivals do to the readings, in their order, over [`Reading::sigma`].
    pub fingerprints: Vec<Fingerprint>,
    /// How large that is beside what is not known of each channel.
    pub floors: Vec<ChannelFloor>,
}

/// The error of a channel on points held out.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelGain {
    /// Position among the channels.
    pub channel: usize,
    /// Values it rests on.
    pub values: usize,
    /// Root of the mean square of measured less simulated, in the unit of the channel.
    pub rms_before: f64,
    /// The same with what was found.
    pub rms_after: f64,
    /// Both over the standard deviations of the values.
    pub in_deviations: [f64; 2],
}

impl PointFinding {
    /// Makes names tentative that inputs that are not known well may stand in the place of: `higher` is their chi-square over
    /// that of the causes, and the least that would tell them apart.
    pub(super) fn doubt_beside_inputs(&mut self, higher: [f64; 2]) {
        let Some(first) = self.finding.causes.first() else { return };
        let [delta_chi2, threshold] = higher;
        self.finding.confidence = Confidence::Tentative;
        self.finding.reasons.push(Reason::NotExcluded {
            cause: self.candidates[first.candidate].id,
            other: "what is stated as uncertain",
            is_open: delta_chi2 < threshold,
            delta_chi2,
            threshold,
        });
    }
}

impl PointTable {
    /// Finds what the simulation lacks, or says that nothing is, or that it has no name.
    ///
    /// Data of fewer values than there are parameters to choose from are not asked for a name.
    ///
    /// # Errors
    /// As [`Discovery::find`]; [`GapError::Length`], [`GapError::NotFinite`], [`GapError::OutOfRange`] and
    /// [`GapError::TooShort`] of a table that is none.
    pub fn find(&self) -> Result<PointFinding, GapError> {
        self.search(None)
    }

    /// Fits the suspects given, by number, together and refuses nothing.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn refit(&self, given: &[usize]) -> Result<PointFinding, GapError> {
        self.search(Some(given))
    }

    fn search(&self, given: Option<&[usize]>) -> Result<PointFinding, GapError> {
        self.check()?;
        let floor = Floor::of(self)?;
        let tables = Tables::of_measured(self, floor.sigma.clone());
        let (traces, calibrations) = floor.traces(&tables);
        let generic = Floor::generic(&tables);
        let mut candidates = tables.candidates();
        let (values, parameters) = (self.values(), self.parameters());
        if values < parameters {
            for own in &mut candidates {
                own.blocked.get_or_insert_with(|| {
                    format!("{values} values do not choose between {parameters} parameters: measure more points or channels")
                });
            }
        }
        let groups: Vec<usize> = tables.rows.iter().map(|(p, _)| self.points[*p].group).collect();
        let settings = Settings {
            has_reference: self.knows_deviations,
            yardstick: Yardstick::FirstStart,
            ..Settings::default()
        };
        let discovery = Discovery {
            generic: &generic,
            groups: &groups,
            calibrations,
            settings,
            ..Discovery::new(&traces, &tables, &candidates)
        };
        let mut finding = match given {
            Some(given) => discovery.refit(given)?,
            None => discovery.find()?,
        };
        if finding.confidence == Confidence::Confident {
            let doubt = match self.not_tried(&finding) {
                None => self.small_beside_rest((&floor, &tables), &candidates, &finding)?,
                doubt => doubt,
            };
            if let Some(reason) = doubt {
                finding.confidence = Confidence::Tentative;
                finding.reasons.push(reason);
            }
        }
        if given.is_some() && !finding.causes.is_empty() {
            finding.confidence = Confidence::Tentative;
            finding.reasons.push(Reason::TakenForTrue);
        }
        finding.reasons = finding.reasons.into_iter().map(Reason::of_points).collect();
        // a frequency along the channels of a point is none
        finding.bands_left.clear();
        let next = next_points(self, &floor, &candidates, &finding)?;
        let gains = self.gains(&tables, &finding);
        let measured = tables.rows.iter().map(|(p, _)| *p).collect();
        let shown = fingerprints(&tables, &traces, &candidates, &finding)?;
        let readings = Reading::of(&tables, &shown.predicted, &finding);
        let floors = ChannelFloor::of((&floor, &tables), &readings, &shown.causes);
        for found in &mut finding.causes {
            self.show(found.candidate, &mut found.parameters);
            self.widen(found);
            for other in &mut found.alternatives {
                self.show(other.candidate, &mut other.parameters);
            }
        }
        let fingerprints = shown.causes;
        Ok(PointFinding {
            finding,
            candidates,
            measured,
            gains,
            next,
            readings,
            fingerprints,
            floors,
        })
    }

    /// A cause that looks like one that was found and was not tried, for no model with it could be read.
    fn not_tried(&self, finding: &Finding) -> Option<Reason> {
        let found = finding.causes.iter().map(|own| &self.suspects[own.candidate]);
        let pairs = found.flat_map(|own| {
            let is_alike = |other: &&Suspect| {
                other.is_unread
                    && (own.confused_with.contains(&other.name)
                        || other.confused_with.contains(&own.name))
            };
            self.suspects.iter().filter(is_alike).map(move |other| (own.name, other.name))
        });
        pairs.map(|(cause, other)| Reason::NotTried { cause, other }).next()
    }

    /// A cause after the first that takes less off the error of the readings than [`BESIDE_REST`] of what is left of it, on
    /// points that the fits have not seen. The floor says how large an error of the simulation is, not what it looks like.
    fn small_beside_rest(
        &self,
        (floor, tables): (&Floor, &Tables<'_>),
        candidates: &[Candidate],
        finding: &Finding,
    ) -> Result<Option<Reason>, GapError> {
        let Some([_, left]) = &finding.held_out_residuals else { return Ok(None) };
        let left = left.concat();
        let over = tables.signal(|p, c| tables.sigma[p][c].powi(2) / self.points[p].deviation[c]);
        let over = over.concat();
        // mean square over the deviations of the readings, times their number
        let square = |signal: &[f64]| -> f64 {
            signal.iter().zip(&over).map(|(value, over)| (value * over).powi(2)).sum()
        };
        let kept = square(&left);
        let rest = kept - left.len() as f64;
        let all = tables.predict(&finding.effects)?.concat();
        for (k, effect) in finding.effects.iter().enumerate().skip(1) {
            let mut others = finding.effects.clone();
            others.remove(k);
            let without = tables.predict(&others)?.concat();
            let own: Vec<f64> = all.iter().zip(&without).map(|(a, b)| a - b).collect();
            let beyond = floor.beyond(tables, &own)?;
            let with: Vec<f64> = left.iter().zip(&beyond).map(|(a, b)| a + b).collect();
            let taken = square(&with) - kept;
            if taken < BESIDE_REST * rest {
                let cause = candidates[effect.candidate].id;
                return Ok(Some(Reason::SmallBesideRest { cause, share: taken / rest }));
            }
        }
        Ok(None)
    }

    /// Lets what only says which suspect it is span those of the same name that do about as well.
    fn widen(&self, found: &mut Found) {
        let own = &self.suspects[found.candidate];
        for other in &found.alternatives {
            let suspect = &self.suspects[other.candidate];
            if suspect.name != own.name {
                continue;
            }
            for label in own.parameters.iter().filter(|p| p.tables.is_empty()) {
                let same = |p: &&SuspectParameter| p.name == label.name && p.tables.is_empty();
                let place = found.parameters.iter_mut().find(|p| p.name == label.name);
                if let (Some(there), Some(place)) = (suspect.parameters.iter().find(same), place) {
                    place.ci95 = [place.ci95[0].min(there.none), place.ci95[1].max(there.none)];
                }
            }
        }
    }

    /// Values of parameters as they are reported.
    fn show(&self, suspect: usize, values: &mut [FittedParameter]) {
        for (value, own) in values.iter_mut().zip(&self.suspects[suspect].parameters) {
            value.value = own.shown.of(value.value);
            value.ci95 = value.ci95.map(|end| own.shown.of(end));
            value.ci95.sort_by(f64::total_cmp);
        }
    }

    /// The held-out errors channel by channel.
    fn gains(&self, tables: &Tables<'_>, finding: &Finding) -> Vec<ChannelGain> {
        let Some(residuals) = &finding.held_out_residuals else { return Vec::new() };
        let of_channel = |channel: usize| {
            // squares in the unit and over the deviation, before and after
            let mut sums = [[0.0; 2]; 2];
            let mut values = 0;
            for (row, (p, channels)) in tables.rows.iter().enumerate() {
                let Some(place) = channels.iter().position(|&c| c == channel) else { continue };
                let sigma = tables.sigma[*p][channel];
                values += 1;
                for (sum, residual) in sums.iter_mut().zip(residuals) {
                    let off = residual[row][place];
                    sum[0] += (off * sigma).powi(2);
                    sum[1] += (off * sigma / self.points[*p].deviation[channel]).powi(2);
                }
            }
            let rms = |which: usize, form: usize| {
                (sums[which][form] / f64::max(values as f64, 1.0)).sqrt()
            };
            ChannelGain {
                channel,
                values,
                rms_before: rms(0, 0),
                rms_after: rms(1, 0),
                in_deviations: [rms(0, 1), rms(1, 1)],
            }
        };
        (0..self.channels.len()).map(of_channel).filter(|own| own.values > 0).collect()
    }
}
