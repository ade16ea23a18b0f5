//! The errors of the chores.

use std::path::PathBuf;

/// Why a chore could not be done at all; a chore that was done and found faults is no error.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum XtaskError {
    /// A file or folder could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// What was to be read.
        path: PathBuf,
        /// Why it could not be.
        source: std::io::Error,
    },
    /// A file could not be written; what stood there before still does.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// What was to be written.
        path: PathBuf,
        /// Why it could not be.
        source: std::io::Error,
    },
    /// A program could not be started.
    #[error("cannot start {program}: {source}")]
    Start {
        /// The program.
        program: String,
        /// Why it could not be started.
        source: std::io::Error,
    },
    /// A program did not do what it was asked to.
    #[error("{program} failed; it said: {said}")]
    Refused {
        /// The program.
        program: String,
        /// The first line it wrote to standard error.
        said: String,
    },
    /// Findings of a diagnosis are in another shape than published.
    #[error("{}: not the findings of a diagnosis: {source}", path.display())]
    Findings {
        /// The file.
        path: PathBuf,
        /// What was not understood.
        source: serde_json::Error,
    },
    /// A synthetic set could not be generated.
    #[error(transparent)]
    Truth(#[from] truth::error::TruthError),
    /// `cargo metadata` said no.
    #[error("cargo metadata failed, so the members are unknown; it said: {said}")]
    Metadata {
        /// What it wrote to standard error.
        said: String,
    },
    /// `cargo metadata` answered in another shape than expected.
    #[error("the answer of cargo metadata is not understood: {source}")]
    MetadataShape {
        /// What was not understood.
        source: serde_json::Error,
    },
    /// A golden could not be turned into text.
    #[error("the result of case {case} cannot be written as RON: {source}")]
    GoldenText {
        /// The case.
        case: String,
        /// Why.
        source: ron::Error,
    },
    /// A filter of the regression sweep is not understood.
    #[error(
        "filter `{text}`: {problem}; write for example mu=0.30,n=3 (the sweep has {available})"
    )]
    Filter {
        /// The filter as given.
        text: String,
        /// What is wrong with it.
        problem: &'static str,
        /// The values there are.
        available: String,
    },
    /// No validation check has the text asked for in its id or area.
    #[error("no validation check matches `{text}`; the areas are {areas}")]
    NoSuchCheck {
        /// The text asked for.
        text: String,
        /// The areas there are.
        areas: String,
    },
    /// The exact theory failed at a sample of the calibration.
    #[error("the calibration stopped: {source}")]
    Exact {
        /// Why.
        source: exact_section::ExactError,
    },
    /// A study could not be computed.
    #[error("{0}")]
    Study(String),
    /// A figure of the speed page could not be found.
    #[error("speed of {what}: {said}")]
    Speed {
        /// What was measured.
        what: String,
        /// Why there is no figure.
        said: String,
    },
    /// A row of the validation page could not be read.
    #[error("row {id} in {}: {said}", folder.display())]
    Row {
        /// Id of the row.
        id: &'static str,
        /// Where it was looked for.
        folder: PathBuf,
        /// Why it could not be read.
        said: String,
    },
    /// The program to sweep could not be set up.
    #[error(transparent)]
    Program(#[from] sim_driver::SimError),
}

impl XtaskError {
    /// Exit code: 1 for failed numerics, 2 for everything that was wrong before them.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Program(error) => error.exit_code(),
            Self::Exact { .. } | Self::Study(_) => 1,
            _ => 2,
        }
    }
}
