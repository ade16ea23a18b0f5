//! Why a check could not be computed.

use std::convert::Infallible;
use std::path::PathBuf;

use exact_section::ExactError;
use flap_aero::AeroError;
use hhc_control::{ControlError, RunError};
use preisach_dyn::PreisachError;
use rotor_fem::{FemError, PeriodicError};
use rotor_response::ResponseError;
use rotor_wake::WakeError;
use sim_driver::SimError;
use trim::TrimError;
use truth::error::TruthError;

/// Why a check could not be computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// A reference table cannot be read.
    #[error("reference table {}: {source}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Why.
        source: csv::Error,
    },
    /// A reference table lacks a column, or a cell is no number.
    #[error("reference table {}, row {row}: column `{column}` {problem}", path.display())]
    Cell {
        /// The file.
        path: PathBuf,
        /// Row below the header, from 1.
        row: usize,
        /// The column.
        column: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// A reference table lacks a row.
    #[error("reference table {} has no row `{row}`", path.display())]
    NoRow {
        /// The file.
        path: PathBuf,
        /// What the row is called.
        row: String,
    },
    /// Fewer values were computed or compared than the check needs.
    #[error("only {found} values of {what} were compared, {needed} are needed")]
    TooFew {
        /// What was compared.
        what: &'static str,
        /// Values found.
        found: usize,
        /// Values needed.
        needed: usize,
    },
    /// The blade.
    #[error(transparent)]
    Fem(#[from] FemError),
    /// The time elements.
    #[error(transparent)]
    Periodic(#[from] PeriodicError<Infallible>),
    /// The section.
    #[error(transparent)]
    Aero(#[from] AeroError),
    /// The exact theory of the section.
    #[error(transparent)]
    Exact(#[from] ExactError),
    /// The inflow.
    #[error(transparent)]
    Wake(#[from] WakeError),
    /// The response.
    #[error(transparent)]
    Response(#[from] ResponseError),
    /// The trim.
    #[error(transparent)]
    Trim(#[from] TrimError),
    /// The controller.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The controller on its plant.
    #[error(transparent)]
    ControlRun(#[from] RunError<Infallible>),
    /// Generated data.
    #[error(transparent)]
    Truth(#[from] TruthError),
    /// What several checks rest on could not be made.
    #[error("{0}")]
    Shared(String),
    /// The actuator.
    #[error(transparent)]
    Actuator(#[from] PreisachError),
    /// The driver.
    #[error(transparent)]
    Driver(#[from] SimError),
}
