//! The structure all attached-flow models share: a linear section with lag states.

use crate::AeroError;

/// The four inputs of a section, in the order of every array over inputs.
///
/// | index | symbol | input | positive |
/// |---|---|---|---|
/// | 0 | `alpha` | normal velocity at the quarter chord over `U`, rad | flow up against the section, nose-up |
/// | 1 | `q` | pitch rate `theta_dot c / U` | nose-up |
/// | 2 | `delta` | flap angle, rad | trailing edge down |
/// | 3 | `q_delta` | flap rate `delta_dot c / U` | trailing edge down |
///
/// Together they are the downwash along the chord, `x` semichords aft of mid-chord, hinge at `e`:
///
/// ```text
/// w(x) / U = alpha + q (x + 1/2) / 2 + [x > e] (delta + q_delta (x - e) / 2)
/// ```
/// A section that pitches about its quarter chord has `alpha = theta`, one that plunges with the
/// velocity `h_dot`, down +, has `alpha = h_dot / U`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mode {
    /// Normal velocity at the quarter chord over `U`.
    Alpha = 0,
    /// Pitch rate `theta_dot c / U`.
    PitchRate = 1,
    /// Flap angle.
    Flap = 2,
    /// Flap rate `delta_dot c / U`.
    FlapRate = 3,
}

impl Mode {
    /// All inputs, in order.
    pub const ALL: [Self; 4] = [Self::Alpha, Self::PitchRate, Self::Flap, Self::FlapRate];

    /// Place in every array over inputs.
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// The three outputs of a section, in the order of every array over outputs.
///
/// ```text
/// Cn = lift / (rho U^2 c / 2)          positive up
/// Cm = moment / (rho U^2 c^2 / 2)      about the quarter chord, nose-up +
/// Ch = hinge moment / (rho U^2 c^2 / 2)   about the hinge, positive in the sense of delta
/// ```
/// The hinge moment is on the chord of the section, not of the flap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Load {
    /// Normal force coefficient `Cn`.
    Lift = 0,
    /// Pitching-moment coefficient about the quarter chord, `Cm`.
    Moment = 1,
    /// Hinge-moment coefficient, `Ch`.
    Hinge = 2,
}

impl Load {
    /// All outputs, in order.
    pub const ALL: [Self; 3] = [Self::Lift, Self::Moment, Self::Hinge];

    /// Place in every array over outputs.
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// One first-order lag between inputs and outputs.
///
/// ```text
/// dx/dS = pole (input . m - x),      S = U t / b (semichords travelled)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LagChannel {
    /// Pole per semichord travelled, positive.
    pub pole: f64,
    /// Weight of each input, in the order of [`Mode`].
    pub input: [f64; 4],
    /// Weight in each output, in the order of [`Load`].
    pub output: [f64; 3],
    /// Whether it stands for vorticity that the section sheds, not for pressure waves of a start.
    pub is_circulatory: bool,
}

/// A section in attached flow: what every model of this crate comes down to.
///
/// ```text
/// y = direct m + rate dm/dS + sum over lags of (output x),    dx/dS = pole (input . m - x)
/// ```
/// with the inputs `m` in the order of [`Mode`] and the outputs `y = [Cn, Cm, Ch]` of [`Load`].
/// Everything the crate computes (harmonic and indicial response, time marching, loads in a varying
/// stream) is computed from this structure, whatever the model.
///
/// For one model and one flap the number of lags, their order and their `input` do not depend on
/// the Mach number: a lag state keeps its meaning while the Mach number varies.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SectionCoefficients {
    /// Outputs per input without delay, `[output][input]`.
    pub direct: [[f64; 4]; 3],
    /// Outputs per rate of an input in `S` (apparent mass), `[output][input]`.
    pub rate: [[f64; 4]; 3],
    /// The lags.
    pub lags: Vec<LagChannel>,
    /// Where the model had to leave its own form.
    pub remarks: ModelRemarks,
}

impl SectionCoefficients {
    /// Whether the lift holds pressure waves of a start: `direct` and the lags that are not circulatory. They
    /// make no circulation and trail no vorticity. Without them all lift but that of `rate` does.
    pub fn has_waves(&self) -> bool {
        let lift = Load::Lift.index();
        self.lags.iter().any(|lag| !lag.is_circulatory && lag.output[lift] != 0.0)
    }

    /// Whether `count` lag states are as many as the section has lags.
    pub(crate) fn check_lags(&self, count: usize) -> Result<(), AeroError> {
        if count == self.lags.len() {
            return Ok(());
        }
        Err(AeroError::StateMismatch { state: count, coefficients: self.lags.len() })
    }
}

/// Where a model had to leave its own form to give an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ModelRemarks {
    /// The Mach number lay below the smallest the noncirculatory loads are formed with, which was
    /// used for them instead.
    pub mach_floored: bool,
    /// The Mach number lay above the calibration; the coefficients are those of its upper end.
    pub mach_capped: bool,
    /// Pairs `[output][input]` whose time constant could not be had by matching the initial slope,
    /// and is the floor instead.
    pub slope_unmatched: [[bool; 4]; 3],
}

impl ModelRemarks {
    /// Whether the model kept its form throughout.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
