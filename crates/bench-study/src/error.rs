//! The errors of a bench study.

use actuator_gap::DiagnosisError;
use measured_data::DataError;
use measured_data::problem::{Place, Problem, Problems};
use preisach_dyn::PreisachError;

/// What an identification can end with; each with the place of the data that asked for it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    /// Files with problems, every one of them; a file that cannot be written.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The actuator model or its identification.
    #[error("{place}: {source}")]
    Actuator {
        /// Case or data that asked for it.
        place: Place,
        /// What went wrong.
        source: PreisachError,
    },
    /// The model of a generic loop or its identification.
    #[error("{place}: {message}")]
    Loop {
        /// Data that asked for it.
        place: Place,
        /// What went wrong, in the units of the data.
        message: String,
        /// The same as the model says it.
        source: PreisachError,
    },
    /// The misfit of a record, its diagnosis, or data in which nothing is to be explained.
    #[error("{place}: {source}")]
    Diagnosis {
        /// The data.
        place: Place,
        /// What went wrong.
        source: DiagnosisError,
    },
}

impl From<Problem> for BenchError {
    fn from(problem: Problem) -> Self {
        Self::Data(problem.into())
    }
}

impl From<Problems> for BenchError {
    fn from(problems: Problems) -> Self {
        Self::Data(problems.into())
    }
}
