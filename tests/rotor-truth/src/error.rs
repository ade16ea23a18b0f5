//! What can go wrong while a set is made.

use std::path::PathBuf;

/// Every way in which this package fails.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RotorTruthError {
    /// The modes of a blade were not found.
    #[error("the {family} modes of the blade were not found; correct mass and stiffness")]
    Modes {
        /// Flap, lag or torsion.
        family: &'static str,
    },
    /// The periodic response did not converge.
    #[error(
        "no periodic response at advance ratio {advance_ratio}, CT/sigma {loading}: the residual stays at {residual:e} after \
         {iterations} steps; choose a milder condition or effect"
    )]
    Response {
        /// Advance ratio of the condition.
        advance_ratio: f64,
        /// Its thrust over solidity.
        loading: f64,
        /// Largest residual left.
        residual: f64,
        /// Steps taken.
        iterations: usize,
    },
    /// The Jacobian cannot be inverted.
    #[error("the Jacobian of the periodic response is singular; add structural damping")]
    Singular,
    /// A value lies outside its range.
    #[error("{what} is {value}, expected {expected}")]
    Value {
        /// What it is.
        what: &'static str,
        /// The value found.
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
    /// A name that is none of the known ones.
    #[error("{what} {found:?} is not known; known are {known}")]
    UnknownName {
        /// What the name should be one of.
        what: &'static str,
        /// The name found.
        found: String,
        /// The names known.
        known: String,
    },
    /// A file could not be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The answer could not be put into text.
    #[error("cannot write the answer: {0}")]
    Answer(#[from] serde_json::Error),
}
