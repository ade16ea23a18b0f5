//! The records that train.

use crate::identify::Settings;
use crate::identify::fit::program::LeastSquaresProgram;
use crate::identify::records::prepared::Prepared;
use crate::{PlayMap, PreisachError, PreisachGrid};
use std::sync::{Arc, OnceLock};

/// The records that train, with the grid and the settings they are fitted with.
#[derive(Clone)]
pub(crate) struct Training<'p> {
    pub(crate) grid: PreisachGrid,
    pub(crate) settings: &'p Settings,
    /// Those that train the static map.
    pub(crate) slow: Vec<&'p Prepared<'p>>,
    /// Those that train the rate maps: periodic, faster than the slow ones.
    pub(crate) fast: Vec<&'p Prepared<'p>>,
    /// Those that are not periodic and not slow, steps and fades: what is fitted to outputs as simulated is fitted to them
    /// too.
    pub(crate) others: Vec<&'p Prepared<'p>>,
    pub(crate) slow_once: Arc<SlowOnce>,
}

/// What is found once of the slow records: it serves every family, and every fold that leaves only fast
/// records out.
#[derive(Debug, Default)]
pub(crate) struct SlowOnce {
    /// Their samples without targets, the weights of all together 1.
    pub(crate) normal: OnceLock<LeastSquaresProgram>,
    /// The static map of the outputs as measured.
    pub(crate) map: OnceLock<Result<PlayMap, PreisachError>>,
}

impl<'p> Training<'p> {
    pub(crate) fn of(
        prepared: &'p [Prepared<'p>],
        grid: PreisachGrid,
        settings: &'p Settings,
    ) -> Result<Self, PreisachError> {
        let trained = prepared.iter().filter(|r| !r.samples.is_empty());
        let (slow, faster): (Vec<_>, Vec<_>) = trained.partition(|r| r.is_slow);
        let (fast, others) = faster.into_iter().partition(|r| r.cycles.is_some());
        if slow.is_empty() {
            return Err(PreisachError::NoTrainingRecord {
                part: "the static density mu0",
                remedy: "record a slow major loop and reversal curves, or raise quasi_static_hz",
            });
        }
        Ok(Self { grid, settings, slow, fast, others, slow_once: Arc::default() })
    }

    /// With settings that differ in what the rate maps are fitted with.
    pub(crate) fn with_rate<'s>(&self, settings: &'s Settings) -> Training<'s>
    where
        'p: 's,
    {
        Training { settings, ..self.clone() }
    }

    /// All but the records at some places of [`Self::all`].
    pub(crate) fn without(&self, left_out: &[usize]) -> Self {
        let part = |records: &[&'p Prepared<'p>], first: usize| -> Vec<&'p Prepared<'p>> {
            let kept = (first..).zip(records).filter(|(place, _)| !left_out.contains(place));
            kept.map(|(_, record)| *record).collect()
        };
        let of_others = self.slow.len() + self.fast.len();
        let (slow, fast) = (part(&self.slow, 0), part(&self.fast, self.slow.len()));
        let others = part(&self.others, of_others);
        let is_same = slow.len() == self.slow.len();
        let slow_once = if is_same { Arc::clone(&self.slow_once) } else { Arc::default() };
        Self { slow, fast, others, slow_once, ..*self }
    }

    /// All of them: the slow ones, the fast ones, the others.
    pub(crate) fn all(&self) -> Vec<&'p Prepared<'p>> {
        self.slow.iter().chain(&self.fast).chain(&self.others).copied().collect()
    }
}
