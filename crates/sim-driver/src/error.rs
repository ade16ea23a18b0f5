//! The errors of the driver and the exit code of each.

use crate::problem::{Problem, Problems};
use std::path::PathBuf;

/// What a run of the program can end with.
///
/// Three families, and an exit code for each ([`SimError::exit_code`]): rejected input (2),
/// numerical failure (1), data mismatch (3).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    // ---- rejected input ----
    /// Files with problems, every one of them.
    #[error("{0}")]
    Rejected(Problems),
    /// A file is in the way.
    #[error("{} exists already and is not overwritten; give another name, or remove it first", .path.display())]
    WouldOverwrite {
        /// The file.
        path: PathBuf,
    },
    /// A file cannot be written.
    #[error("{} cannot be written ({reason}); check the folder, its permissions and the space left", .path.display())]
    NotWritten {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        reason: String,
    },
}

/// The families of errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// The user's input is at fault.
    RejectedInput,
    /// The numerics failed on good input.
    NumericalFailure,
    /// A comparison failed.
    DataMismatch,
}

impl Family {
    /// Exit code of the program.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::NumericalFailure => 1,
            Self::RejectedInput => 2,
            Self::DataMismatch => 3,
        }
    }
}

impl SimError {
    /// Family of the error.
    pub fn family(&self) -> Family {
        match self {
            Self::Rejected(_) | Self::WouldOverwrite { .. } | Self::NotWritten { .. } => {
                Family::RejectedInput
            }
        }
    }

    /// Exit code of the program: 1 numerical failure, 2 rejected input, 3 data mismatch.
    pub fn exit_code(&self) -> u8 {
        self.family().exit_code()
    }
}

impl From<Problems> for SimError {
    fn from(problems: Problems) -> Self {
        Self::Rejected(problems)
    }
}

impl From<Problem> for SimError {
    fn from(problem: Problem) -> Self {
        Self::Rejected(problem.into())
    }
}
