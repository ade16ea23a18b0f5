//! From a misfit to its cause: screening, fits, selection, refusal.

mod conclude;
mod decide;
mod evidence;
mod fingerprint;
mod fit;
mod floors;
mod held_out;
mod intermediate;
mod judge;
mod reason;
mod rival;
mod screen;
mod thresholds;
mod verdict;

pub use crate::trace::{Signal, Simulator, Trace, TraceRole};
pub use fingerprint::{Fingerprint, Fingerprints, Standing, fingerprints};
pub use held_out::Gain;
pub use reason::{BandLeft, OnlyRun, Reason};
pub use rival::{Rival, Separation, separations};
pub use screen::{Screened, by_score};
pub use thresholds::needed_to_separate;
pub(crate) use thresholds::{AS_LIKELY, SURELY, needed_between};
pub use verdict::{
    Alternative, Compared, Confidence, Finding, FittedParameter, Found, FoundClass, StandsOut,
    Verdict,
};

use crate::{Candidate, GapError};
use decide::Search;
use evidence::Evidence;

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
    /// Which experiments are held out together, because they repeat one input: those of equal number. Each is held
    /// out by itself where this is empty.
    pub groups: &'a [usize],
    /// How many of the last nuisance columns are calibrations of the channels: where one of them must move by more than
    /// its accuracy, nothing is denied with confidence.
    pub calibrations: usize,
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
    /// What the size of an effect is counted in.
    pub yardstick: Yardstick,
}

/// What the size of an effect is counted in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Yardstick {
    /// The spread of the outputs, which have one unit: a cause must lower their error by a part that matters.
    #[default]
    OutputSpread,
    /// The effect at its own first start, the amount that who asks holds for one that matters. For outputs of several
    /// units, whose spread means nothing.
    FirstStart,
}

impl Default for Settings {
    fn default() -> Self {
        let yardstick = Yardstick::default();
        Self { most_causes: 3, has_reference: true, resamplings: 1000, yardstick }
    }
}

impl<'a, S> Discovery<'a, S> {
    /// A search with no directions, no surrogates, nothing repeated and no calibration.
    pub fn new(traces: &'a [Trace], simulator: &'a S, candidates: &'a [Candidate]) -> Self {
        Self {
            traces,
            simulator,
            candidates,
            generic: &[],
            trends: &[],
            structures: &[],
            groups: &[],
            calibrations: 0,
            settings: Settings::default(),
        }
    }
}

impl<S: Simulator> Discovery<'_, S> {
    /// Finds what is missing, or says that nothing is, or that it has no name.
    ///
    /// # Errors
    /// [`GapError::Simulation`]; [`GapError::NotPositiveDefinite`] for bad nuisance columns.
    pub fn find(&self) -> Result<Finding, GapError> {
        let evidence = Evidence::new(self.traces)?;
        Search::new(self, &evidence)?.run()
    }

    /// Fits the candidates given together and refuses nothing: what a refit with the true causes gains.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn refit(&self, given: &[usize]) -> Result<Finding, GapError> {
        let evidence = Evidence::new(self.traces)?;
        Search::new(self, &evidence)?.refit(given)
    }
}
