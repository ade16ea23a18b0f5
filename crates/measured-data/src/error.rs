//! The errors of this crate.

use crate::problem::{Problem, Problems};
use std::path::PathBuf;

/// What reading, writing or importing measured data can end with.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DataError {
    /// Files with problems, every one of them.
    #[error("{0}")]
    Rejected(#[from] Problems),
    /// A file is in the way.
    #[error("{} exists already and is not overwritten; give another name, or remove it first", .path.display())]
    WouldOverwrite {
        /// The file.
        path: PathBuf,
    },
    /// What is written would replace what is read.
    #[error("{} is a file this command reads; name another to write", .path.display())]
    WouldOverwriteInput {
        /// The file.
        path: PathBuf,
    },
    /// A file of the data is in the way.
    #[error("{} exists already, in the folder of the data, whose files are never replaced; name one elsewhere", .path.display())]
    WouldOverwriteData {
        /// The file.
        path: PathBuf,
    },
    /// A file is in the way that was not written by this program as what is to be written now.
    #[error("{} exists already and is no file of kind {kind}; name another to write, or replace it with --force", .path.display())]
    WouldOverwriteOther {
        /// The file.
        path: PathBuf,
        /// The kind of file that would be replaced without asking.
        kind: &'static str,
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

impl From<Problem> for DataError {
    fn from(problem: Problem) -> Self {
        Self::Rejected(problem.into())
    }
}
