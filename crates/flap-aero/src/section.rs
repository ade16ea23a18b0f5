//! The structure all attached-flow models share: a linear section with lag states.

use crate::{
    AeroError, CalibratedSection, FlapChord, Mach, hariharan_leishman, incompressible, quasi_steady,
};

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

/// The attached-flow models of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum AttachedFlowModel {
    /// Theodorsen's function set to 1 and no apparent mass; the rate-damping moments kept.
    /// Prandtl-Glauert factor at a Mach number above 0.
    QuasiSteady,
    /// Theodorsen's exact coefficients with R. T. Jones's two lags for his function, apparent mass
    /// included. Mach number 0 only.
    Incompressible,
    /// Compressible indicial functions of the form of Hariharan and Leishman: piston values at the
    /// start, time constants from the exact initial slopes, Beddoes's circulatory lags.
    ///
    /// A *reconstruction*: the text of the 1996 paper was not available to this project.
    HariharanLeishman,
    /// Compressible, poles and gains fitted to exact linear theory: see [`CalibratedSection`].
    /// Flap chords 0.1 to 0.4, or no flap.
    Calibrated,
}

impl AttachedFlowModel {
    /// All models.
    pub const ALL: [Self; 4] =
        [Self::QuasiSteady, Self::Incompressible, Self::HariharanLeishman, Self::Calibrated];

    /// Short name, as case files and the command line spell it.
    pub fn name(self) -> &'static str {
        match self {
            Self::QuasiSteady => "quasi-steady",
            Self::Incompressible => "incompressible",
            Self::HariharanLeishman => "hariharan-leishman",
            Self::Calibrated => "calibrated",
        }
    }

    /// Name for reports, with what a reader has to know of the model's origin.
    pub fn title(self) -> &'static str {
        match self {
            Self::QuasiSteady => "quasi-steady",
            Self::Incompressible => {
                "incompressible: Theodorsen's coefficients, two lags of R. T. Jones for his function"
            }
            Self::HariharanLeishman => {
                "form of Hariharan and Leishman, slope-matched reconstruction"
            }
            Self::Calibrated => "calibrated on exact compressible theory",
        }
    }

    /// Mach numbers between 0 and 1 at which the coefficients have a kink: the ends of the range the model
    /// knows, beyond which it holds its values.
    pub fn mach_kinks(self) -> &'static [f64] {
        match self {
            Self::QuasiSteady | Self::Incompressible => &[],
            Self::HariharanLeishman => &[hariharan_leishman::MIN_NONCIRCULATORY_MACH],
            Self::Calibrated => &crate::calibrated::MACH_ENDS,
        }
    }

    /// The model of one flap, from which the coefficients at many Mach numbers are had at less cost.
    ///
    /// # Errors
    /// [`AeroError::FlapChordNotCalibrated`] for [`AttachedFlowModel::Calibrated`] with a flap
    /// outside its calibration.
    pub fn of_flap(self, flap: FlapChord) -> Result<FlappedModel, AeroError> {
        Ok(FlappedModel(match self {
            Self::QuasiSteady => Form::QuasiSteady(flap),
            Self::Incompressible => Form::Incompressible(flap),
            Self::HariharanLeishman => Form::HariharanLeishman(flap),
            Self::Calibrated => Form::Calibrated(Box::new(CalibratedSection::new(flap)?)),
        }))
    }

    /// The section under this model.
    ///
    /// # Errors
    /// [`AeroError::CompressibleFlow`] for [`AttachedFlowModel::Incompressible`] at a Mach number
    /// other than 0; [`AeroError::FlapChordNotCalibrated`] for [`AttachedFlowModel::Calibrated`] with
    /// a flap outside its calibration.
    pub fn coefficients(
        self,
        mach: Mach,
        flap: FlapChord,
    ) -> Result<SectionCoefficients, AeroError> {
        self.of_flap(flap)?.coefficients(mach)
    }
}

/// An attached-flow model of one flap.
#[derive(Debug, Clone, PartialEq)]
pub struct FlappedModel(Form);

/// What each model needs of its flap.
#[derive(Debug, Clone, PartialEq)]
enum Form {
    QuasiSteady(FlapChord),
    Incompressible(FlapChord),
    HariharanLeishman(FlapChord),
    Calibrated(Box<CalibratedSection>),
}

impl FlappedModel {
    /// The section at a Mach number.
    ///
    /// # Errors
    /// [`AeroError::CompressibleFlow`] for [`AttachedFlowModel::Incompressible`] at a Mach number
    /// other than 0.
    pub fn coefficients(&self, mach: Mach) -> Result<SectionCoefficients, AeroError> {
        match &self.0 {
            Form::QuasiSteady(flap) => Ok(quasi_steady::coefficients(mach, *flap)),
            Form::Incompressible(_) if mach > Mach::ZERO => {
                Err(AeroError::CompressibleFlow { mach: mach.value() })
            }
            Form::Incompressible(flap) => Ok(incompressible::coefficients(*flap)),
            Form::HariharanLeishman(flap) => Ok(hariharan_leishman::coefficients(mach, *flap)),
            Form::Calibrated(section) => Ok(section.coefficients(mach)),
        }
    }
}
