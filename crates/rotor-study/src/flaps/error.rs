//! Why a flap, or the rotor with it, did not answer to a voltage.

use hhc_control::ControlError;
use preisach_dyn::PreisachError;
use rotor_response::ResponseError;

/// Why the rotor with its actuators did not answer to a voltage.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlantError {
    /// The rotor.
    #[error(transparent)]
    Rotor(#[from] ResponseError),
    /// The actuator.
    #[error(transparent)]
    Actuator(#[from] PreisachError),
    /// A control vector that does not fit.
    #[error(transparent)]
    Control(ControlError),
    /// No bias voltage centres the flap.
    #[error("bias voltage: {0}")]
    Bias(ControlError),
    /// The search for the bias voltage ended for a reason unknown here.
    #[error("the search for the bias voltage failed")]
    BiasSearch,
    /// The inverse is asked of an actuator whose bias is held.
    #[error("the inverse sets the bias, which is held here: write control.bias: Centred")]
    HeldBias,
    /// Flap motion and hinge moment did not settle on each other.
    #[error(
        "flap motion and hinge moment did not settle: {residual_deg:.2e} deg are left after {iterations} responses of the rotor (wanted {tolerance_deg:.0e}); the actuator is soft against the hinge moment, or the flap near a resonance on it: lower compliance_um_per_newton"
    )]
    Coupling {
        /// Responses of the rotor.
        iterations: usize,
        /// Least change of a flap angle by the hinge moment left, deg.
        residual_deg: f64,
        /// Change wanted, deg.
        tolerance_deg: f64,
    },
    /// The hinge moment of a motion moves the flap as much as the motion itself, or more.
    #[error(
        "the actuator is too soft for the hinge moment: its compliance leaves a hinge stiffness of {hinge_stiffness_newton_metre_per_rad:.3} N m/rad, where the hinge moment of a motion moves the flap {loop_gain:.2} times as far as the motion (loop gain up to 5/rev; 1 is the limit): lower compliance_um_per_newton to less than {share_percent:.0} % of what it is ({source})"
    )]
    TooSoft {
        /// What the actuator holds the flap with, N m/rad.
        hinge_stiffness_newton_metre_per_rad: f64,
        /// Largest loop gain of a motion of the flaps up to 5/rev.
        loop_gain: f64,
        /// Share of the compliance at which the loop gain is 1, percent.
        share_percent: f64,
        /// What failed.
        source: Box<PlantError>,
    },
    /// The harmonics of the voltage are larger than the range.
    #[error(
        "the voltage swings over {swing_volt:.2} V, the actuator takes {span_volt:.2} V: lower the amplitudes"
    )]
    VoltageSwing {
        /// Peak to peak of the command; from a fixed bias to its furthest peak, V.
        swing_volt: f64,
        /// What the range leaves for that, V.
        span_volt: f64,
    },
}

impl PlantError {
    /// Part of a wanted motion that the actuator reaches, if that is why its inverse failed.
    pub(crate) fn within_reach(&self) -> Option<f64> {
        match self {
            Self::Actuator(PreisachError::MotionOutOfReach {
                wanted_deg, reachable_deg, ..
            }) => Some(reachable_deg / wanted_deg),
            Self::Actuator(PreisachError::InverseNotConverged { share, .. }) => Some(*share),
            _ => None,
        }
    }
}
