//! Which experiments train and which are held out.

use crate::{Experiment, GapError, Stimulus, Use};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::fmt;

/// A rule that splits a set *by experiment*: a record is trained on whole or held out whole.
///
/// Its `Display` is the rule in words, to stand over every table made with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SplitRule {
    /// Every experiment states its own use.
    Stated,
    /// Slow records show the static model, two frequencies its dependence on rate. Trained on are:
    ///
    /// - the sines of the lowest frequency, and every other signal that never moves faster than
    ///   they do (ramps, reversal curves);
    /// - of the frequencies above, the lowest and the middle one, at their largest and their
    ///   smallest amplitude. With an even number of frequencies the middle is the lower of two.
    ///
    /// Held out are the other frequencies (the highest above all, an extrapolation), the amplitudes
    /// between (interpolation), and all faster signals that are no sine. A stated use takes
    /// precedence. The role of a record plays no part: it says what a record shows, not whether a model
    /// may see it.
    SlowAndTwoFrequencies,
}

/// Relative distance below which two frequencies, or two amplitudes, are the same.
const SAME: f64 = 0.02;

impl fmt::Display for SplitRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stated => "split by experiment, as the data set states",
            Self::SlowAndTwoFrequencies => {
                "split by experiment: trained are the sines of the lowest frequency with all signals as slow, and \
                 of the frequencies above the lowest and the middle one at largest and smallest amplitude; held \
                 out are the other frequencies, the amplitudes between, and all faster signals"
            }
        })
    }
}

impl SplitRule {
    /// The use of each experiment, in their order.
    ///
    /// # Errors
    /// [`GapError::DuplicateId`], [`GapError::NoStatedUse`], and [`GapError::NothingToTrain`] if all
    /// would be held out.
    pub fn split(self, experiments: &[Experiment]) -> Result<Vec<Use>, GapError> {
        let mut ids = BTreeSet::new();
        for experiment in experiments {
            if !ids.insert(experiment.id()) {
                return Err(GapError::DuplicateId { id: experiment.id().into() });
            }
        }
        let uses = match self {
            Self::Stated => experiments
                .iter()
                .map(|e| e.stated_use().ok_or_else(|| GapError::NoStatedUse { id: e.id().into() }))
                .collect::<Result<Vec<Use>, GapError>>()?,
            Self::SlowAndTwoFrequencies => by_speed(experiments),
        };
        if uses.contains(&Use::Train) {
            Ok(uses)
        } else {
            let (rule, experiments) = (self.to_string(), experiments.len());
            Err(GapError::NothingToTrain { rule, experiments })
        }
    }
}

fn by_speed(experiments: &[Experiment]) -> Vec<Use> {
    let sines: Vec<Option<(f64, f64)>> = experiments
        .iter()
        .map(|experiment| match experiment.stimulus() {
            Stimulus::Sine { frequency_hz, amplitude, .. } => Some((frequency_hz, amplitude)),
            Stimulus::Other => None,
        })
        .collect();
    let frequencies = distinct(sines.iter().flatten().map(|sine| sine.0).collect());
    let Some((&slowest, above)) = frequencies.split_first() else {
        return experiments.iter().map(|e| e.stated_use().unwrap_or(Use::HeldOut)).collect();
    };
    let amplitudes_at = |frequency: f64| {
        distinct(sines.iter().flatten().filter(|s| same(s.0, frequency)).map(|s| s.1).collect())
    };
    let largest = amplitudes_at(slowest).last().copied().unwrap_or_default();
    let slow_rate = TAU * slowest * largest * (1.0 + SAME);
    let middle = above.len().saturating_sub(1) / 2;
    let chosen = [above.first().copied(), above.get(middle).copied()];
    let extreme = |(frequency, amplitude): (f64, f64)| {
        let amplitudes = amplitudes_at(frequency);
        [amplitudes.first(), amplitudes.last()].iter().flatten().any(|&&a| same(a, amplitude))
    };
    let trains = |experiment: &Experiment, sine: Option<(f64, f64)>| match sine {
        None => largest_rate_per_s(experiment) <= slow_rate,
        Some((frequency, _)) if same(frequency, slowest) => true,
        Some(sine) => chosen.iter().flatten().any(|&f| same(f, sine.0)) && extreme(sine),
    };
    experiments
        .iter()
        .zip(&sines)
        .map(|(experiment, &sine)| match experiment.stated_use() {
            Some(stated) => stated,
            None if trains(experiment, sine) => Use::Train,
            None => Use::HeldOut,
        })
        .collect()
}

/// Largest rate of the input, in its unit per second.
fn largest_rate_per_s(experiment: &Experiment) -> f64 {
    let samples = experiment.input().samples();
    let largest = samples.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    largest / experiment.time_step_s()
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

/// Sorted values, those that are the same kept once.
fn distinct(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values.dedup_by(|later, kept| same(*later, *kept));
    values
}
