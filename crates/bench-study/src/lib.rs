//! What a bench says of an actuator: measured records in, an identified model, its tables, figures and page out.
//!
//! | idea | module |
//! |---|---|
//! | identification from a bench or from loops of any two channels, the model chosen | [`identification`] |
//! | from a data folder of any kind | [`any_data`] |
//! | what a person checks at a glance of one record | [`Glance`] |
//! | what records show beside one another | [`compared`] |
//! | what an import says of the records that it wrote | [`ImportReport`] |
//! | identification from reversal curves | [`curves`] |
//! | drift of their instrument, taken off | [`drift`] |
//! | their FORC diagram | [`diagram`](mod@diagram) |
//! | actuator files: read with places, written, what is unlikely about them | [`stored`] |
//! | what `hhc predict` and `hhc invert` show | [`use_text`], [`samples_csv`] |
//! | tables of the figures, for any plotting program | [`figures`] |
//! | reversal curves within records, and their FORC diagram | [`reversals`] |
//! | spectra of what a model leaves of its records | [`spectra`] |
//! | the same as pictures on one page | [`page`] |

mod actuator_use;
pub mod any_data;
mod beside;
pub mod curves;
pub mod diagram;
pub mod drift;
mod error;
pub mod figures;
mod glance;
pub mod identification;
mod import_report;
pub mod page;
pub mod reversals;
pub mod spectra;
pub mod stored;
#[cfg(test)]
mod test_bench;

pub use actuator_use::{samples_csv, use_text};
pub use beside::{compared, glances};
pub use error::BenchError;
pub use glance::Glance;
pub use import_report::ImportReport;

/// Version of the program, part of every actuator file.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
