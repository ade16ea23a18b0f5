//! Sweeps: variations of a RON text over axes, run anywhere, stored by content, merged into one table.
//!
//! What a case means is the matter of a [`Runner`]: it reads a text, and makes numbers of it.
//!
//! | idea | module |
//! |---|---|
//! | the sweep file: axes and sampling | `file` |
//! | values of the axes of every case | `sample` |
//! | the cases of a sweep with their keys | `plan` |
//! | results on disk, each with its own hash | `store` |
//! | what is there, missing, damaged, foreign | `status` |
//! | running what is missing, on all threads | `run` |
//! | one table of all results | `merge` |
//! | its page: maps and carpets over two axes, parallel coordinates, reduction against power | `page` |
//! | the script of an array of Slurm, the part of a task | `shard` |
//!
//! No result depends on thread, order or shard: a case is read from its own text; what a [`Runner`] shares among cases must
//! leave every result as it is alone.

mod error;
mod file;
mod merge;
mod page;
mod plan;
mod run;
mod sample;
mod shard;
mod status;
mod store;
#[cfg(test)]
mod tests;

pub use error::SweepError;
pub use file::{Axis, AxisValues, Sampling, SweepFile, read_sweep_file};
pub use merge::{Merged, MergedCase, merge};
pub use page::PageChoice;
pub use plan::{Plan, PlannedCase, plan};
pub use run::{Done, Failed, Pace, Ran, run};
pub use shard::{Shard, array_script};
pub use status::{Status, status};
pub use store::{Cell, Outcome, State, Store, StoredCase, case_key};

use measured_data::DataError;
use measured_data::problem::Problems;

/// A case as a runner has read it.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadCase<C> {
    /// The case printed anew with all its defaults: comments, order and layout of the text are gone.
    pub canonical: String,
    /// blake3 of every file that the case names, and names of what else the result depends on, in a fixed order.
    pub inputs: Vec<String>,
    /// What the runner needs to run it.
    pub case: C,
}

/// What is found of a case.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// Name with unit, and value; the same names in the same order for cases of the same kind.
    pub columns: Vec<(String, Cell)>,
    /// What a reader should know before using the numbers.
    pub warnings: Vec<String>,
}

/// Why a case has no numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum NoNumbers {
    /// It has none, in words why: the same case with the same files fails the same way, which is its result.
    Failed(String),
    /// The place where it runs is at fault, such as a full disk: the sweep ends, and the case stays without a result.
    Stopped(DataError),
}

/// What makes numbers of a case text.
///
/// Both functions are functions of their arguments alone: equal texts and files give equal bits.
pub trait Runner: Sync {
    /// A case that was read.
    type Case;

    /// Version of the model, part of every key: other versions give other numbers.
    fn version(&self) -> &str;

    /// The folder that paths of a case start from, as messages show it before a name of a file; empty for none.
    fn folder(&self) -> String {
        String::new()
    }

    /// Reads a case.
    ///
    /// # Errors
    /// Every problem of the text, each with its field.
    fn read(&self, text: &str) -> Result<ReadCase<Self::Case>, Problems>;

    /// The unit of a field of a case, empty for a pure number or a word; none for a field that the case does not have.
    fn unit(&self, case: &Self::Case, field: &str) -> Option<String>;

    /// Runs a case.
    ///
    /// # Errors
    /// Why there are no numbers.
    fn run(&self, case: Self::Case) -> Result<Found, NoNumbers>;
}

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
