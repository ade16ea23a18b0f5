//! What can go wrong.

use hhc_control::ControlError;
use preisach_dyn::PreisachError;
use rotor_case::HandedTError;
use rotor_response::ResponseError;
use rotor_study::StudyError;

/// Rejected input and numerical failures of a flight.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FlightError {
    /// A number outside its range.
    #[error("{what} is {value}, expected {expected}")]
    OutOfRange {
        /// Name of the quantity, with its unit.
        what: &'static str,
        /// The value found.
        value: f64,
        /// The range expected.
        expected: &'static str,
    },
    /// A trim of a knot.
    #[error("the trim at an advance ratio of {advance_ratio}: {source}")]
    Trim {
        /// Of the knot.
        advance_ratio: f64,
        /// Its own error.
        source: Box<StudyError>,
    },
    /// A free wake that found no solution at a knot.
    #[error(
        "the free wake at an advance ratio of {advance_ratio} diverged; fly in another inflow (Drees), or see `hhc wake` for why"
    )]
    WakeDiverged {
        /// Of the knot.
        advance_ratio: f64,
    },
    /// A response of the rotor, or of one blade, and what is linear about it.
    #[error("the rotor at an advance ratio of {advance_ratio}: {source}")]
    Response {
        /// Of the knot.
        advance_ratio: f64,
        /// Its own error.
        source: ResponseError,
    },
    /// An actuator.
    #[error("the actuator of flap {flap} (from 0): {source}")]
    Actuator {
        /// Which one.
        flap: usize,
        /// Its own error.
        source: PreisachError,
    },
    /// A blade unlike the rest.
    #[error("a blade unlike the rest at an advance ratio of {advance_ratio}: {source}")]
    Blade {
        /// Of the knot.
        advance_ratio: f64,
        /// Its own error.
        source: Box<StudyError>,
    },
    /// Blades whose own answers the rotor was not asked for.
    #[error(
        "{asked} blades move by themselves, and the rotor knows {known} of them: make its path by `RotorPath::with_blades`"
    )]
    OwnBlade {
        /// Blades that move by themselves.
        asked: usize,
        /// Blades known.
        known: usize,
    },
    /// A flap with an actuator of its own that nobody has read.
    #[error("`flight.flap_actuators[{index}]` has no model; read its file first and set `model`")]
    FlapActuator {
        /// Place in the list.
        index: usize,
    },
    /// T that a user hands in.
    #[error(transparent)]
    HandedT(#[from] HandedTError),
    /// The same, or the arrays it is read from: what was found, what was expected.
    #[error("{message}")]
    Arrays {
        /// In words.
        message: String,
    },
    /// The controller.
    #[error(transparent)]
    Control(#[from] ControlError),
}

impl FlightError {
    /// Field of the case that asked for what failed.
    pub fn field(&self) -> &str {
        match self {
            Self::Trim { source, .. } | Self::Blade { source, .. } => source.field(),
            Self::WakeDiverged { .. } => "inflow.model",
            Self::Actuator { .. } => "actuator",
            Self::HandedT(_) | Self::Arrays { .. } => "control.t_file",
            Self::OwnBlade { .. } => "flight.failed_flap",
            Self::FlapActuator { .. } => "flight.flap_actuators",
            Self::OutOfRange { .. } | Self::Response { .. } | Self::Control(_) => "flight",
        }
    }
}
