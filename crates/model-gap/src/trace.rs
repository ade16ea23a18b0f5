//! Measured signals and what simulates them.

use crate::{Effect, GapError};
use nalgebra::DMatrix;

/// A signal on all traces.
pub type Signal = Vec<Vec<f64>>;

/// One measured signal of one experiment, with what is known about its errors when nothing is
/// missing from the simulation.
///
/// ```text
/// measured = predicted + nuisance delta + error,   delta ~ N(0, 1),   error ~ N(0, sigma^2)
/// ```
/// The nuisance columns carry the covariance that the reference fit left to the base model: it may
/// move on the measured runs as far as the reference runs allow, never freely.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Number of the experiment it belongs to, from 0.
    pub experiment: usize,
    /// Time from one sample to the next, s.
    pub step_s: f64,
    /// The samples, thinned or averaged as the simulator's predictions are.
    pub measured: Vec<f64>,
    /// Standard deviation that a sample weighs with, in the signal's unit: noise and what the
    /// structure of the base model leaves, as if white.
    pub sigma: f64,
    /// Spectrum of the errors, over the square of `sigma`.
    pub spectrum: crate::Spectrum,
    /// Standard deviation of the noise alone, in the signal's unit.
    pub noise: f64,
    /// What the base model may still move by, a row per sample; the same columns in every trace,
    /// or no column where it moves nothing.
    pub nuisance: DMatrix<f64>,
    /// Samples per block of the bootstrap: at least one period.
    pub block: usize,
    /// What it says of a cause.
    pub role: TraceRole,
}

/// What a measured signal says of a cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TraceRole {
    /// The output, whose error counts.
    Output,
    /// A signal within the chain, such as the voltage at the terminals or a second sensor: a cause that
    /// shows there acts on the output.
    IntermediateChannel,
    /// A quantity beside the chain, such as a temperature or a load. It tells how much of an agent there is,
    /// not what the agent does: a cause that shows nowhere else is not named.
    Covariate,
}

/// What predicts every trace under given effects.
pub trait Simulator: Sync {
    /// Predictions of all traces with these effects switched on.
    ///
    /// # Errors
    /// [`GapError::Simulation`] with the simulator's own words.
    fn predict(&self, effects: &[Effect]) -> Result<Signal, GapError>;

    /// Whether the samples of a trace carry what these effects do. What they do between samples no trace tells, and what
    /// is left of such a trace does not speak against them.
    fn carries(&self, _effects: &[Effect], _trace: usize) -> bool {
        true
    }

    /// What an effect adds when what it adapts to each experiment, such as a phase, is fitted to a
    /// given residual instead of the measured one. None for effects that adapt to nothing: theirs is
    /// what [`Self::predict`] says.
    ///
    /// # Errors
    /// As [`Self::predict`].
    fn adapted(&self, _effect: &Effect, _residual: &Signal) -> Result<Option<Signal>, GapError> {
        Ok(None)
    }
}
