//! The errors of one experiment, and whether the model was fitted to it.

use crate::{FirstHarmonicError, Misfit};

/// Whether a model may be fitted to a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Use {
    /// Fitted to.
    Train,
    /// Kept away from every fit, to judge it.
    HeldOut,
}

/// The errors of one experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct RunError {
    /// Name of the experiment.
    pub id: String,
    /// Whether it was trained on.
    pub used: Use,
    /// The misfit of the whole record.
    pub misfit: Misfit,
    /// Amplitude and phase of the first harmonic, where the input has one frequency.
    pub first_harmonic: Option<FirstHarmonicError>,
}
