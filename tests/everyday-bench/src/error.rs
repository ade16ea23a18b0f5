//! What can go wrong while a set is asked for or written.

use std::path::PathBuf;

/// Every way in which this package fails.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EverydayError {
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
    /// A number that is none, or outside what makes sense.
    #[error("{what} {found:?} has to be {expected}")]
    Size {
        /// What the number is for.
        what: String,
        /// The text found.
        found: String,
        /// The accepted range, in words.
        expected: &'static str,
    },
    /// A file could not be written.
    #[error("cannot write {}: {source}; check that the folder exists and is writable", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
    },
}
