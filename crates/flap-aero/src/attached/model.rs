//! The attached-flow models of a section.

use crate::attached::hariharan_leishman;
use crate::attached::incompressible;
use crate::attached::quasi_steady;
use crate::attached::values::MIN_NONCIRCULATORY_MACH;
use crate::{AeroError, CalibratedSection, FlapChord, Mach, SectionCoefficients};
use serde::{Deserialize, Serialize};

/// The attached-flow models of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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
            Self::HariharanLeishman => &[MIN_NONCIRCULATORY_MACH],
            Self::Calibrated => &crate::attached::calibrated::MACH_ENDS,
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
