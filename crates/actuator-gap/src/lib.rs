//! The actuator bench as a kind of data that discovery works on: base model, causes, catalogue of experiments.
//!
//! It is handed records and gives findings back; it knows no file and no terminal.
//!
//! | idea | module |
//! |---|---|
//! | the records of a diagnosis | `record` |
//! | plays and lags, linear in their weights | `plays` |
//! | the base model with the covariance of its weights | `base` |
//! | the cause library, one file per cause | `causes` |
//! | the measured runs under effects, and beside what was measured | `simulator` |
//! | what other hysteresis families leave with nothing missing | `surrogate` |
//! | a diagnosis, its findings, and the data of its figures | `diagnosis`, `findings`, `figures` |
//! | what to measure next | `next` |
//! | the extended actuator, and what an actuator file holds | `extended`, `actuator_file` |
//! | how an identified model fits its records | `judge` |
//! | an actuator at work: prediction and inverse over a record | `actuator_file::at_work` |
//! | the models of the discovery ladder | `rungs` |

mod actuator_file;
mod base;
mod causes;
mod diagnosis;
mod displays;
mod error;
mod extended;
mod figures;
mod findings;
mod judge;
mod next;
mod numbers;
mod plan;
mod plays;
mod question;
mod record;
mod rungs;
mod sessions;
mod simulator;
mod surrogate;

pub use actuator_file::at_work::{ActuatorUse, Commanded, Deviation, UseError, UseSample};
pub use actuator_file::doubts::{Doubt, Weight};
pub use actuator_file::history_inverse::{HistoryInverse, HistoryInverseSettings, history_inverse};
pub use actuator_file::{
    GainRule, HarmonicResponse, StoredActuator, StoredChannels, StoredFit, StoredKind,
};
pub use diagnosis::{Diagnosis, RunEnergy, diagnose};
pub use error::DiagnosisError;
pub use judge::{NotJudged, judged};
pub use next::Proposal;
pub use plan::{Plan, Planned, PlannedCause, Rehearsal, SIZES, plan, usual_runs};
pub use question::{Question, Stage, StructureStore};
pub use record::{Record, Records};
pub use rungs::{Asked, RungModel, rung_models};
pub use sessions::GivenModel;
pub use simulator::RunShown;

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
