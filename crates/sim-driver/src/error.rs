//! The errors of the driver and the exit code of each.

use crate::problem::{Fault, Place, Problem, Problems};
use flap_aero::AeroError;
use measured_data::DataError;
use model_gap::GapError;
use preisach_dyn::PreisachError;
use rotor_fem::FemError;
use rotor_response::ResponseError;
use rotor_study::{StudyError, soft_pitch_text};
use std::path::PathBuf;
use trim::TrimError;

/// What a run of the program can end with.
///
/// Three families, and an exit code for each ([`SimError::exit_code`]): rejected input (2),
/// numerical failure (1), data mismatch (3). The errors of the models carry the place of the user's
/// file that asked for what failed.
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
    /// What is written would replace what is read.
    #[error("{} is a file this command reads; name another to write", .path.display())]
    WouldOverwriteInput {
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

    // ---- models; the family depends on the source ----
    /// The actuator model or its identification.
    #[error("{place}: {source}")]
    Actuator {
        /// Case or data that asked for it.
        place: Place,
        /// What went wrong.
        source: PreisachError,
    },
    /// The model of a generic loop or its identification.
    #[error("{place}: {message}")]
    Loop {
        /// Data that asked for it.
        place: Place,
        /// What went wrong, in the units of the data.
        message: String,
        /// The same as the model says it.
        source: PreisachError,
    },
    /// A diagnosis of data in which nothing is to be explained.
    #[error(
        "{place}: no run has the role Measured: all {runs} are references; write `role: Measured` for those to be explained"
    )]
    NothingMeasured {
        /// The data.
        place: Place,
        /// Runs there.
        runs: usize,
    },
    /// The misfit of a record.
    #[error("{place}: {source}")]
    Misfit {
        /// The record.
        place: Place,
        /// What went wrong.
        source: GapError,
    },
    /// The blade and its modes.
    #[error("{place}: {source}")]
    Blade {
        /// Case that asked for it.
        place: Place,
        /// What went wrong.
        source: FemError,
    },
    /// The section aerodynamics.
    #[error("section: {0}")]
    Section(#[from] AeroError),
    /// The periodic response of the rotor.
    #[error("{place}: {source}")]
    Response {
        /// Case that asked for it.
        place: Place,
        /// What went wrong.
        source: ResponseError,
    },
    /// The trim.
    #[error("{place}: {source}")]
    Trim {
        /// The trim section of the case.
        place: Place,
        /// What went wrong.
        source: TrimError,
    },
    /// A free wake that parted from its rotor: what is given is a state on the way, no solution.
    #[error(
        "{place}: wake and trim have parted, there is no solution: what is given is the last good state, without control; the warning says where and what may help"
    )]
    WakeParted {
        /// The wake of the case.
        place: Place,
    },
    /// A failure of a case that asks for what hardly is meant, or of a blade that is unstable.
    #[error("{source}\nDoubts about the case, one of which may be the cause:{}", listed(.doubts))]
    InDoubt {
        /// What went wrong.
        source: Box<SimError>,
        /// The doubts, each with its place.
        doubts: Vec<String>,
    },
    /// The trim of a blade whose pitch link is so soft that it holds no pitch.
    #[error("{place}: {}", soft_pitch_text(*.stiffness, *.frequency_per_rev, .source))]
    SoftPitch {
        /// The spring in the case.
        place: Place,
        /// Its stiffness, `m0 Omega^2 R^3`.
        stiffness: f64,
        /// Frequency of the rigid blade on it, propeller moment included.
        frequency_per_rev: f64,
        /// What went wrong.
        source: TrimError,
    },
    /// A stored figure does not follow from the stored loads, controls and motions.
    #[error(
        "{file}: {field} is {stored}, but what the result holds gives {recomputed}; it was changed after it was written"
    )]
    NotReproduced {
        /// The file.
        file: String,
        /// The field in it.
        field: String,
        /// What the file says.
        stored: String,
        /// What follows from the rest.
        recomputed: String,
    },
    /// One advance ratio of several.
    #[error("advance ratio {advance_ratio}: {source}{}", found_before(.found))]
    SweepEnded {
        /// The advance ratio.
        advance_ratio: f64,
        /// Advance ratios before it, whose results are stored.
        found: Vec<f64>,
        /// What went wrong there.
        source: Box<SimError>,
    },
    /// The control study.
    #[error("{place}: {source}")]
    Study {
        /// The control section of the case.
        place: Place,
        /// What went wrong.
        source: StudyError,
    },
}

/// What is said of the advance ratios before the one that failed.
fn found_before(found: &[f64]) -> String {
    let given: Vec<String> = found.iter().map(f64::to_string).collect();
    match given.len() {
        0 => String::new(),
        1 => format!("\nthe result at {} before it is stored", given[0]),
        _ => format!("\nthe results at {} before it are stored", given.join(", ")),
    }
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

fn listed(doubts: &[String]) -> String {
    format!("\n- {}", doubts.join("\n- "))
}

impl SimError {
    /// The error with doubts about the case that may be its cause; without any, or if the input is rejected, itself.
    pub(crate) fn in_doubt(self, doubts: Vec<String>) -> Self {
        match self {
            // what is rejected says itself what is wrong
            Self::Rejected(_) => self,
            _ if doubts.is_empty() => self,
            _ => Self::InDoubt { source: Box::new(self), doubts },
        }
    }

    /// An error of a study at the place of its field.
    pub fn of_study(error: StudyError, place: impl Fn(&str) -> Place) -> Self {
        match error {
            StudyError::Refused { field, message } => {
                Problem::new(place(&field), Fault::Refused { message }).into()
            }
            StudyError::Blade { field, source } => Self::Blade { place: place(&field), source },
            StudyError::Response { field, source } => {
                Self::Response { place: place(&field), source }
            }
            StudyError::Trim { field, source } => Self::Trim { place: place(&field), source },
            StudyError::SoftPitch { field, stiffness, frequency_per_rev, source } => {
                Self::SoftPitch { place: place(&field), stiffness, frequency_per_rev, source }
            }
            source => Self::Study { place: place(source.field()), source },
        }
    }

    /// Family of the error.
    pub fn family(&self) -> Family {
        match self {
            Self::Rejected(_)
            | Self::WouldOverwrite { .. }
            | Self::WouldOverwriteInput { .. }
            | Self::NotWritten { .. }
            | Self::Section(_)
            | Self::NothingMeasured { .. }
            | Self::Misfit { .. } => Family::RejectedInput,
            Self::WakeParted { .. } => Family::NumericalFailure,
            Self::NotReproduced { .. } => Family::DataMismatch,
            Self::SweepEnded { source, .. } | Self::InDoubt { source, .. } => source.family(),
            Self::Actuator { source, .. } | Self::Loop { source, .. } => actuator_family(source),
            Self::Blade { source, .. } => blade_family(source),
            Self::Response { source, .. } => response_family(source),
            Self::Trim { source, .. } | Self::SoftPitch { source, .. } => trim_family(source),
            Self::Study { source, .. } => study_family(source),
        }
    }

    /// Exit code of the program: 1 numerical failure, 2 rejected input, 3 data mismatch.
    pub fn exit_code(&self) -> u8 {
        self.family().exit_code()
    }
}

fn actuator_family(error: &PreisachError) -> Family {
    match error {
        PreisachError::Diverged { .. }
        | PreisachError::OrbitNotClosed { .. }
        | PreisachError::QuadraticProgram { .. } => Family::NumericalFailure,
        _ => Family::RejectedInput,
    }
}

fn blade_family(error: &FemError) -> Family {
    match error {
        FemError::NotStable { .. } | FemError::Eigen { .. } => Family::NumericalFailure,
        _ => Family::RejectedInput,
    }
}

fn response_family(error: &ResponseError) -> Family {
    match error {
        ResponseError::MassMatrix { .. }
        | ResponseError::LagSingular { .. }
        | ResponseError::StallNotPeriodic { .. }
        | ResponseError::Periodic(_)
        | ResponseError::PeriodicStall(_)
        | ResponseError::InflowNotConverged { .. } => Family::NumericalFailure,
        ResponseError::Fem(source) => blade_family(source),
        _ => Family::RejectedInput,
    }
}

fn study_family(error: &StudyError) -> Family {
    match error {
        StudyError::NoActuator { .. } => Family::RejectedInput,
        _ => Family::NumericalFailure,
    }
}

/// A trim out of reach asks for more than the rotor can give: the case is at fault, not the solver.
fn trim_family(error: &TrimError) -> Family {
    match error {
        TrimError::Parameter { .. }
        | TrimError::Stalled { .. }
        | TrimError::StalledControls { .. }
        | TrimError::BeyondStall { .. }
        | TrimError::OutOfReach { .. }
        | TrimError::NoDescent { .. } => Family::RejectedInput,
        TrimError::Response(source) => response_family(source),
        _ => Family::NumericalFailure,
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

impl From<DataError> for SimError {
    fn from(error: DataError) -> Self {
        match error {
            DataError::Rejected(problems) => Self::Rejected(problems),
            DataError::WouldOverwrite { path } => Self::WouldOverwrite { path },
            DataError::WouldOverwriteInput { path } => Self::WouldOverwriteInput { path },
            DataError::NotWritten { path, reason } => Self::NotWritten { path, reason },
        }
    }
}

/// Where no file is at hand, the place is the field of the case.
impl From<StudyError> for SimError {
    fn from(error: StudyError) -> Self {
        Self::of_study(error, |field| Place::file("case").field(field))
    }
}
