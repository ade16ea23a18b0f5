//! Case files, data files, studies and the `hhc` command of rotor-hhc.
//!
//! Floor 7: case files with their lines, stored results and the terminal. What it hands down are validated
//! values; what it gets back are plain results.
//!
//! | idea | module |
//! |---|---|
//! | problems of user files, each with file, line, field and remedy | [`problem`] |
//! | reading and atomic writing, RON, measured tables, shipped files | [`files`] |
//! | what an import prints | [`import`] |
//! | case files: the values of [`rotor_case`] with the lines they stand at | [`case`] |
//! | the actuators of a case, their use; identified and stored by [`bench_study`] | [`actuator`], [`actuator_use`] |
//! | one physics alone | [`section`]; modes, root pitch and wake of [`rotor_study`] in [`print`](mod@print), told by [`study_text`] |
//! | a whole case | [`run`], stored and told in figures by [`results`]; over advance ratios in [`sweep`] |
//! | a case flown in time | [`flight`] |
//! | two results side by side | [`compare`] |
//! | the HTML report | [`report`] |
//! | choices by their names on the command line | [`choices`] |
//! | `hhc` | [`cli`] |

pub mod actuator;
pub mod actuator_use;
pub mod case;
pub mod check;
pub mod choices;
pub mod cli;
pub mod compare;
pub mod diagnose;
mod error;
pub mod files;
pub mod flight;
pub mod import;
pub mod output;
pub mod print;
pub mod progress;
pub mod report;
pub mod results;
pub mod run;
pub mod section;
pub mod sweep;
mod terminal;

pub use error::SimError;
pub use measured_data::problem;

/// Version of the program, part of every result; its key has that of the model, [`rotor_study::MODEL_VERSION`].
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
