//! From a misfit to its cause: screening, fits, selection, refusal.

mod conclude;
mod decide;
mod evidence;
mod fit;
mod floors;
mod gain;
mod intermediate;
mod judge;
mod quantile;
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
pub use trace::{Simulator, Trace, TraceRole};
pub use verdict::{
    Alternative, Compared, Confidence, Finding, FittedParameter, Found, StandsOut, Verdict,
};

use crate::{Candidate, GapError};
use evidence::Evidence;

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
    /// Bounds of the decisions.
    pub settings: Settings,
}

/// Bounds of the decisions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Standard deviations of the noise that a score must exceed; noise and structure add as squares.
    pub noise_deviations: f64,
    /// Factor on what surrogates reach.
    pub structure_margin: f64,
    /// Share of the excess that the named causes must explain.
    pub explained: f64,
    /// Most causes named together.
    pub most_causes: usize,
    /// Most folds of the split by experiment.
    pub most_folds: usize,
    /// Penalty on a free parameter, in units of the noise variance.
    pub parameter_penalty: f64,
    /// Drop of the misfit that separates two causes, in units of the noise variance.
    pub separation: f64,
    /// Share of a drop within which two causes are not discriminated: no model of a cause is better.
    pub form_error: f64,
    /// Whether the base model rests on reference runs; without, nothing is said with confidence.
    pub has_reference: bool,
    /// RMS of a weak effect over the standard deviation of the output.
    pub weak_effect: f64,
    /// Resamplings of the gain's interval.
    pub resamplings: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            noise_deviations: 4.2,
            structure_margin: 2.0,
            explained: 0.9,
            most_causes: 3,
            most_folds: 8,
            parameter_penalty: 3.0,
            separation: 12.0,
            form_error: 0.02,
            has_reference: true,
            weak_effect: 0.01,
            resamplings: 1000,
        }
    }
}

impl<S: Simulator> Discovery<'_, S> {
    /// Finds what is missing, or says that nothing is, or that it has no name.
    ///
    /// # Errors
    /// [`GapError::Simulation`]; [`GapError::NotPositiveDefinite`] for bad nuisance columns.
    pub fn find(&self) -> Result<Finding, GapError> {
        let evidence = Evidence::new(self.traces, self.settings.most_folds)?;
        decide::decide(self, &evidence)
    }

    /// Fits the candidates given together and refuses nothing: what a refit with the true causes gains.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn refit(&self, given: &[usize]) -> Result<Finding, GapError> {
        let evidence = Evidence::new(self.traces, self.settings.most_folds)?;
        decide::refit(self, &evidence, given)
    }
}
