//! Case files, data files, studies and the `hhc` command of rotor-hhc.
//!
//! Floor 4: the only crate that knows files and the terminal. What it hands down are validated
//! values; what it gets back are plain results.
//!
//! | idea | module |
//! |---|---|
//! | problems of user files, each with file, line, field and remedy | [`problem`] |
//! | reading and atomic writing, RON, measured tables, shipped files | [`files`] |
//! | data of the figures of an identification | [`figures`] |
//! | measured data of other formats into data folders | [`import`] |
//! | case files and the validated case | [`case`], its hand-over to the models in `models` |
//! | actuators: identification from a bench, stored models | [`identification`], [`stored_actuator`], [`actuator`] |
//! | one physics alone | [`modes`], [`section`] |
//! | a whole case | [`run`], stored by [`results`]; [`stability`] of its trimmed blade, its [`blade_loads`], blades unlike each other in [`dissimilar`]; over advance ratios in [`sweep`] |
//! | the HTML report | [`report`] |
//! | `hhc` | [`cli`] |

pub mod actuator;
pub mod blade_loads;
pub mod case;
pub mod check;
pub mod cli;
pub mod curve_identification;
pub mod diagnose;
pub mod dissimilar;
mod doubts;
mod error;
pub mod figures;
pub mod files;
pub mod identification;
pub mod import;
pub mod inflow;
pub mod mean_loads;
mod models;
pub mod modes;
pub mod output;
pub mod problem;
pub mod progress;
pub mod raw;
pub mod recompute;
mod record_fault;
mod refigure;
pub mod report;
mod resonance;
pub mod results;
pub mod run;
pub mod section;
pub mod stability;
pub mod stored_actuator;
pub mod study;
pub mod sweep;
pub mod wake;

pub use error::{Family, SimError};

/// Version of the program, part of every result and its key.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
