//! The errors of this crate.

use measured_data::DataError;
use measured_data::problem::{Problem, Problems};

/// What planning, running and merging a sweep can end with.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The sweep file has problems, or a result cannot be written.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A file that a case names changed, or can no longer be read, since the sweep was planned: the case keeps no result.
    #[error(
        "case {case}: a file that it names changed since the sweep was planned{said}; what was computed of it is not kept. Leave the files alone, and run again: results that are there stay"
    )]
    Changed {
        /// Key of the case, its first digits.
        case: String,
        /// What is wrong with a file now, behind a colon; nothing if all can be read.
        said: String,
    },
    /// A thread ended by a fault of the program outside of a case.
    #[error(
        "a thread of the sweep ended by a fault of the program; results that are there stay: run again, and please report it"
    )]
    Ended,
    /// Results are missing, damaged, or of no case of the sweep.
    #[error("{}", .0.join("\n"))]
    Incomplete(Vec<String>),
    /// The part of the cases that is asked for is none.
    #[error("{0}")]
    Shard(String),
    /// What a page shall show is not there.
    #[error("{0}")]
    Choice(String),
}

impl From<Problems> for SweepError {
    fn from(problems: Problems) -> Self {
        Self::Data(problems.into())
    }
}

impl From<Problem> for SweepError {
    fn from(problem: Problem) -> Self {
        Self::Data(problem.into())
    }
}
