//! The errors of the driver and the exit code of each.

use crate::problem::{Fault, Place, Problem, Problems};
use actuator_gap::DiagnosisError;
use bench_study::BenchError;
use case_sweep::SweepError;
use flap_aero::AeroError;
use measured_data::DataError;
use preisach_dyn::PreisachError;
use rotor_fem::FemError;
use rotor_flight::FlightError;
use rotor_response::ResponseError;
use rotor_study::StudyError;
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
    /// Files with problems, every one of them; a file that cannot be written.
    #[error(transparent)]
    Data(#[from] DataError),

    /// Results of a sweep that are missing, damaged or foreign; a part of its cases that is none.
    #[error(transparent)]
    Sweep(SweepError),

    // ---- models; the family depends on the source ----
    /// The bench: an actuator model, its identification or its diagnosis.
    #[error(transparent)]
    Bench(BenchError),
    /// The section aerodynamics.
    #[error("section: {0}")]
    Section(#[from] AeroError),
    /// The rotor of a case: its blade, response, trim or control.
    #[error("{place}: {}", .source.cause())]
    Study {
        /// Field of the case that asked for it.
        place: Place,
        /// What went wrong.
        source: StudyError,
    },
    /// A flight in time.
    #[error("{place}: {source}")]
    Flight {
        /// Field of the case that asked for it.
        place: Place,
        /// What went wrong.
        source: Box<FlightError>,
    },
    /// A free wake that diverged or carries no thrust: what is given is no solution.
    #[error(
        "{place}: wake and trim found no solution: what is given is a state without control; the warning says why and what may help"
    )]
    WakeDiverged {
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
    /// Some of several advance ratios.
    #[error("{}{}", failed_at(.failed), stored_at(.found))]
    SpeedsFailed {
        /// Advance ratios that failed, and why.
        failed: Vec<(f64, String)>,
        /// Advance ratios whose results are stored.
        found: Vec<f64>,
    },
}

/// What is said of the advance ratios that failed.
fn failed_at(failed: &[(f64, String)]) -> String {
    let lines: Vec<String> =
        failed.iter().map(|(mu, reason)| format!("advance ratio {mu}: {reason}")).collect();
    lines.join("\n")
}

/// What is said of those that did not.
fn stored_at(found: &[f64]) -> String {
    let given: Vec<String> = found.iter().map(f64::to_string).collect();
    match given.len() {
        0 => String::new(),
        1 => format!("\nthe result at {} is stored", given[0]),
        _ => format!("\nthe results at {} are stored", given.join(", ")),
    }
}

/// The families of errors, by the exit code of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    /// The numerics failed on good input.
    NumericalFailure = 1,
    /// The user's input is at fault.
    RejectedInput = 2,
    /// A comparison failed.
    DataMismatch = 3,
}

fn listed(doubts: &[String]) -> String {
    format!("\n- {}", doubts.join("\n- "))
}

impl SimError {
    /// The error with doubts about the case that may be its cause; without any, or if the input is rejected, itself.
    pub(crate) fn in_doubt(self, doubts: Vec<String>) -> Self {
        match self {
            // what is rejected says itself what is wrong
            Self::Data(_) => self,
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
            source => Self::Study { place: place(source.field()), source },
        }
    }

    /// A text that cannot be written, such as a value that its format cannot express.
    pub(crate) fn not_written(path: impl Into<PathBuf>, reason: &dyn std::fmt::Display) -> Self {
        DataError::NotWritten { path: path.into(), reason: reason.to_string() }.into()
    }

    fn family(&self) -> Family {
        match self {
            Self::WakeDiverged { .. } | Self::SpeedsFailed { .. } => Family::NumericalFailure,
            Self::NotReproduced { .. } | Self::Sweep(SweepError::Incomplete(_)) => {
                Family::DataMismatch
            }
            Self::InDoubt { source, .. } => source.family(),
            Self::Bench(source) => bench_family(source),
            Self::Data(_) | Self::Sweep(_) | Self::Section(_) => Family::RejectedInput,
            Self::Study { source, .. } => study_family(source),
            Self::Flight { source, .. } => flight_family(source),
        }
    }

    /// Exit code of the program: 1 numerical failure, 2 rejected input, 3 data mismatch.
    pub fn exit_code(&self) -> u8 {
        self.family() as u8
    }
}

fn bench_family(error: &BenchError) -> Family {
    match error {
        BenchError::Actuator { source, .. }
        | BenchError::Loop { source, .. }
        | BenchError::Diagnosis { source: DiagnosisError::Actuator(source), .. } => {
            actuator_family(source)
        }
        _ => Family::RejectedInput,
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
        StudyError::Refused { .. } | StudyError::NoActuator { .. } => Family::RejectedInput,
        StudyError::Blade { source, .. } => blade_family(source),
        StudyError::Response { source, .. } => response_family(source),
        StudyError::Trim { source, .. } | StudyError::SoftPitch { source, .. } => {
            trim_family(source)
        }
        _ => Family::NumericalFailure,
    }
}

fn flight_family(error: &FlightError) -> Family {
    match error {
        FlightError::OutOfRange { .. } => Family::RejectedInput,
        FlightError::Trim { source, .. } => study_family(source),
        FlightError::Response { source, .. } => response_family(source),
        FlightError::Actuator { source, .. } => actuator_family(source),
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

impl From<BenchError> for SimError {
    fn from(error: BenchError) -> Self {
        match error {
            BenchError::Data(source) => Self::Data(source),
            other => Self::Bench(other),
        }
    }
}

impl From<SweepError> for SimError {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Data(error) => Self::Data(error),
            error => Self::Sweep(error),
        }
    }
}

impl From<Problems> for SimError {
    fn from(problems: Problems) -> Self {
        Self::Data(problems.into())
    }
}

impl From<Problem> for SimError {
    fn from(problem: Problem) -> Self {
        Self::Data(problem.into())
    }
}

/// Where no file is at hand, the place is the field of the case.
impl From<StudyError> for SimError {
    fn from(error: StudyError) -> Self {
        Self::of_study(error, |field| Place::file("case").field(field))
    }
}
