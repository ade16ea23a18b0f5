//! The records that train.

use crate::identify::Settings;
use crate::identify::records::prepared::Prepared;
use crate::{PreisachError, PreisachGrid};

/// The records that train, with the grid and the settings they are fitted with.
#[derive(Clone)]
pub(crate) struct Training<'p> {
    pub(crate) grid: PreisachGrid,
    pub(crate) settings: &'p Settings,
    /// Those that train the static map.
    pub(crate) slow: Vec<&'p Prepared<'p>>,
    /// Those that train the rate maps.
    pub(crate) fast: Vec<&'p Prepared<'p>>,
}

impl<'p> Training<'p> {
    pub(crate) fn of(
        prepared: &'p [Prepared<'p>],
        grid: PreisachGrid,
        settings: &'p Settings,
    ) -> Result<Self, PreisachError> {
        let trained = prepared.iter().filter(|r| !r.samples.is_empty());
        let (slow, fast): (Vec<_>, Vec<_>) = trained.partition(|r| r.is_slow);
        if slow.is_empty() {
            return Err(PreisachError::NoTrainingRecord {
                part: "the static density mu0",
                remedy: "record a slow major loop and reversal curves, or raise quasi_static_hz",
            });
        }
        Ok(Self { grid, settings, slow, fast })
    }

    /// All of them, the slow ones first.
    pub(crate) fn all(&self) -> Vec<&'p Prepared<'p>> {
        self.slow.iter().chain(&self.fast).copied().collect()
    }
}
