//! From a misfit to its cause: screening, fits, selection, refusal.

mod conclude;
mod decide;
mod evidence;
mod fit;
mod floors;
mod gain;
mod intermediate;
mod judge;
mod reason;
mod rival;
mod screen;
mod thresholds;
mod trace;
mod verdict;

pub use gain::Gain;
pub use reason::Reason;
pub use rival::{Rival, Separation, separations};
pub use screen::Screened;
pub use thresholds::needed_to_separate;
pub use trace::{Simulator, Trace, TraceRole};
pub use verdict::{
    Alternative, Compared, Confidence, Finding, FittedParameter, Found, StandsOut, Verdict,
};

use crate::{Candidate, GapError};
use decide::Search;
use evidence::Evidence;
use thresholds::MOST_FOLDS;

/// A signal on all traces.
pub type Signal = Vec<Vec<f64>>;

/// Everything a search for what is missing needs.
#[derive(Debug)]
pub struct Discovery<'a, S> {
    /// What was measured.
    pub traces: &'a [Trace],
    /// What predicts it.
    pub simulator: &'a S,
    /// What could be missing.
    pub candidates: &'a [Candidate],
    /// Generic directions: structure left along them after the best fit is explained by no candidate.
    pub generic: &'a [Signal],
    /// Directions that stand for a slow change of the measurement itself, such as a zero that wanders: judged
    /// apart, because one certain direction is lost among all generic ones.
    pub trends: &'a [Signal],
    /// What the base model leaves of surrogate systems of other kinds with nothing missing.
    pub structures: &'a [Signal],
    /// What depends on the data and on who asks.
    pub settings: Settings,
}

/// What of the decisions depends on the data and on who asks. Their bounds are the same for all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Most causes named together.
    pub most_causes: usize,
    /// Whether the base model rests on reference runs; without, nothing is said with confidence.
    pub has_reference: bool,
    /// Resamplings of the gain's interval.
    pub resamplings: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { most_causes: 3, has_reference: true, resamplings: 1000 }
    }
}

impl<S: Simulator> Discovery<'_, S> {
    /// Finds what is missing, or says that nothing is, or that it has no name.
    ///
    /// # Errors
    /// [`GapError::Simulation`]; [`GapError::NotPositiveDefinite`] for bad nuisance columns.
    pub fn find(&self) -> Result<Finding, GapError> {
        let evidence = Evidence::new(self.traces, MOST_FOLDS)?;
        Search::new(self, &evidence)?.run()
    }

    /// Fits the candidates given together and refuses nothing: what a refit with the true causes gains.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn refit(&self, given: &[usize]) -> Result<Finding, GapError> {
        let evidence = Evidence::new(self.traces, MOST_FOLDS)?;
        Search::new(self, &evidence)?.refit(given)
    }
}
