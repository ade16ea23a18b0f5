//! What can go wrong while a study runs, with the field of the case that is at fault.

use crate::flaps::PlantError;
use hhc_control::{ControlError, RunError};
use preisach_dyn::PreisachError;
use rotor_case::ModelError;
use rotor_fem::FemError;
use rotor_response::ResponseError;
use trim::TrimError;

/// Why a study of a rotor stopped; [`StudyError::field`] names the field of the case that asked for what failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// What the case asks for cannot be done.
    #[error("{field}: {message}")]
    Refused {
        /// Field of the case, such as `inflow.model.circulation`.
        field: String,
        /// Why, and the remedy.
        message: String,
    },
    /// The blade and its modes.
    #[error("{field}: {source}")]
    Blade {
        /// Field of the case.
        field: String,
        /// What went wrong.
        source: FemError,
    },
    /// The periodic response of the rotor.
    #[error("{field}: {source}")]
    Response {
        /// Field of the case.
        field: String,
        /// What went wrong.
        source: ResponseError,
    },
    /// The trim.
    #[error("{field}: {source}")]
    Trim {
        /// Field of the case.
        field: String,
        /// What went wrong.
        source: TrimError,
    },
    /// The trim of a blade whose pitch link is so soft that it holds no pitch.
    #[error("{field}: {}", soft_pitch_text(*.stiffness, *.frequency_per_rev, .source))]
    SoftPitch {
        /// Field of the spring in the case.
        field: String,
        /// Its stiffness, `m0 Omega^2 R^3`.
        stiffness: f64,
        /// Frequency of the rigid blade on it, propeller moment included, per rev.
        frequency_per_rev: f64,
        /// What went wrong.
        source: TrimError,
    },
    /// The control loop or the plant inside it.
    #[error("control at {}/rev with the {actuator} actuator: {source}", together(harmonics))]
    Control {
        /// Harmonics under control, per rev.
        harmonics: Vec<usize>,
        /// Name of the actuator.
        actuator: &'static str,
        /// What went wrong.
        source: Box<RunError<PlantError>>,
    },
    /// The stroke the actuator can make.
    #[error("stroke of the actuator at {harmonic}/rev ({frequency_hz} Hz on the bench): {source}")]
    Stroke {
        /// Harmonic, per rev.
        harmonic: usize,
        /// The same in the time of the bench.
        frequency_hz: f64,
        /// What went wrong.
        source: PlantError,
    },
    /// A robustness map.
    #[error("robustness of the control of {harmonic}/rev: {source}")]
    Robustness {
        /// Harmonic, per rev.
        harmonic: usize,
        /// What went wrong.
        source: Box<StudyError>,
    },
    /// The range of voltages of the case is none.
    #[error(transparent)]
    Range(PreisachError),
    /// The case asks for an actuator it does not have.
    #[error(
        "the case asks for the {actuator} actuator but its actuator model is Ideal: give a bench or an actuator file, or control with ideal alone"
    )]
    NoActuator {
        /// Name of the actuator asked for.
        actuator: &'static str,
    },
}

impl From<ModelError> for StudyError {
    fn from(error: ModelError) -> Self {
        match error {
            ModelError::Blade { field, source } => Self::Blade { field, source },
            ModelError::Response { field, source } => Self::Response { field, source },
        }
    }
}

/// Harmonics in one word: `2+3`.
fn together(harmonics: &[usize]) -> String {
    harmonics.iter().map(usize::to_string).collect::<Vec<_>>().join("+")
}

/// What is said of a pitch spring that does not hold its blade.
fn soft_pitch_text(stiffness: f64, frequency_per_rev: f64, source: &TrimError) -> String {
    format!(
        "a pitch spring of {stiffness} leaves the blade a pitch frequency of about {frequency_per_rev:.1} per rev, too soft for the loads it holds: {source}. Remedy: a stiffer spring (a pitch link gives 3 per rev and more), or Locked"
    )
}

impl StudyError {
    /// Field of the case that asked for what failed.
    pub fn field(&self) -> &str {
        match self {
            Self::Refused { field, .. }
            | Self::Blade { field, .. }
            | Self::Response { field, .. }
            | Self::Trim { field, .. }
            | Self::SoftPitch { field, .. } => field,
            Self::Control { .. }
            | Self::Stroke { .. }
            | Self::Robustness { .. }
            | Self::Range(_)
            | Self::NoActuator { .. } => "control",
        }
    }

    /// What went wrong, without the field.
    pub fn cause(&self) -> String {
        match self {
            Self::Refused { message, .. } => message.clone(),
            Self::Blade { source, .. } => source.to_string(),
            Self::Response { source, .. } => source.to_string(),
            Self::Trim { source, .. } => source.to_string(),
            Self::SoftPitch { stiffness, frequency_per_rev, source, .. } => {
                soft_pitch_text(*stiffness, *frequency_per_rev, source)
            }
            other => other.to_string(),
        }
    }

    /// Whether no control moves a weighted load: flaps without effect, or weights of the loads they move that are zero.
    pub fn is_powerless(&self) -> bool {
        let Self::Control { source, .. } = self else { return false };
        matches!(**source, RunError::Control(ControlError::NoAuthority))
    }

    /// Whether a start from a nearby flight may mend a trim: it lost its way, and nothing said that there is none.
    pub fn is_lost(&self) -> bool {
        let Self::Trim { source, .. } = self else { return false };
        matches!(
            source,
            TrimError::OutOfReach { .. }
                | TrimError::NoDescent { .. }
                | TrimError::NotConverged { .. }
                | TrimError::Singular { .. }
                | TrimError::Response(_)
        )
    }
}
