//! What the sensor adds: an error of its characteristic, rounding, hum.

use crate::check::{check_finite, check_not_negative, check_positive, check_within};
use crate::{Calibration, StageError};
use crate::{Curve, Step};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Shape of a characteristic's error over its range, `|x| <= 1`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum NonlinearityShape {
    /// `2 x^2 - 1`: one side reads more than the other.
    Quadratic,
    /// `4 x^3 - 3 x`: both ends bend, as those of an LVDT do.
    #[default]
    Cubic,
    /// `(x^3 - straight x) / max |x^3 - straight x|`: a cubic about another line than the best one, which
    /// is `straight = 3/4` and gives [`Self::Cubic`]; 0 the tangent in the middle, 1 through the ends.
    CubicAbout {
        /// Slope of the line that the error is taken from, 0 to 1.5.
        straight: f64,
    },
}

impl NonlinearityShape {
    /// Coefficients of `x`, `x^2`, `x^3`, and the constant before them, of largest size 1 over the range.
    fn coefficients(self) -> [f64; 4] {
        match self {
            Self::Quadratic => [-1.0, 0.0, 2.0, 0.0],
            Self::Cubic => [0.0, -3.0, 0.0, 4.0],
            Self::CubicAbout { straight } => {
                // the extremum inside lies at root(straight / 3)
                let inside = 2.0 / 3.0 * straight * (straight / 3.0).sqrt();
                let largest = inside.max((1.0 - straight).abs());
                [0.0, -straight / largest, 0.0, 1.0 / largest]
            }
        }
    }
}

/// Error of a sensor's characteristic.
///
/// ```text
/// y = x + amplitude T_n( x / half_range )     T_n: Chebyshev polynomial, n = 2 or 3, or a cubic about another line
/// ```
/// with `x` the displacement from zero flap angle. The Chebyshev polynomial makes `amplitude` the
/// largest error inside the range. `amplitude_um = 0` is the identity.
/// Source: elementary; 0.1 to 0.5 % of full scale for an LVDT.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nonlinearity {
    /// Largest error inside the range, um, of either sign.
    pub amplitude_um: f64,
    /// Half the measuring range, um, `> 0`.
    pub half_range_um: f64,
    /// Its shape.
    #[serde(default)]
    pub shape: NonlinearityShape,
}

impl Nonlinearity {
    pub(crate) fn check(&self) -> Result<(), StageError> {
        check_positive("half_range_um", self.half_range_um)?;
        if let NonlinearityShape::CubicAbout { straight } = self.shape {
            check_within("straight", straight, 0.0..=1.5)?;
        }
        check_finite("amplitude_um", self.amplitude_um)
    }

    pub(crate) fn prepared(&self, calibration: &Calibration) -> NonlinearityStep {
        NonlinearityStep {
            amplitude_deg: self.amplitude_um * calibration.deg_per_um,
            per_deg: 1.0 / (self.half_range_um * calibration.deg_per_um),
            coefficients: self.shape.coefficients(),
        }
    }
}

/// A [`Nonlinearity`] made ready.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NonlinearityStep {
    amplitude_deg: f64,
    per_deg: f64,
    coefficients: [f64; 4],
}

impl Curve for NonlinearityStep {
    #[inline]
    fn value(&self, input: f64) -> f64 {
        let x = input * self.per_deg;
        let [a, b, c, d] = self.coefficients;
        input + self.amplitude_deg * (a + x * (b + x * (c + x * d)))
    }
}

/// Rounding to whole steps of the displacement from zero flap angle.
///
/// ```text
/// y = step round( x / step )
/// ```
/// `step_um = 0` is the identity. The error is at most half a step. Source: elementary.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantisation {
    /// Least step, um, `>= 0`.
    pub step_um: f64,
}

/// A [`Quantisation`] made ready.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuantisationStep {
    pub(crate) step_deg: f64,
}

impl Curve for QuantisationStep {
    #[inline]
    fn value(&self, input: f64) -> f64 {
        if self.step_deg == 0.0 { input } else { (input / self.step_deg).round() * self.step_deg }
    }
}

/// A line of the mains, or of any other machine, in the reading.
///
/// ```text
/// y = x + amplitude sin( 2 pi frequency t + phase ),   t = 0 at the first sample
/// ```
/// `amplitude_um = 0` is the identity. Source: elementary; 0.1 to 2 % of the reading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MainsHum {
    /// Amplitude, um, `>= 0`.
    pub amplitude_um: f64,
    /// Frequency, Hz, `> 0`.
    pub frequency_hz: f64,
    /// Phase at the first sample, rad.
    #[serde(default)]
    pub phase_rad: f64,
}

impl MainsHum {
    pub(crate) fn check(&self) -> Result<(), StageError> {
        check_not_negative("amplitude_um", self.amplitude_um)?;
        check_positive("frequency_hz", self.frequency_hz)?;
        check_finite("phase_rad", self.phase_rad)
    }

    pub(crate) fn prepared(&self, step_s: f64, calibration: &Calibration) -> HumStep {
        HumStep {
            amplitude_deg: self.amplitude_um * calibration.deg_per_um,
            turns_per_step: self.frequency_hz * step_s,
            first_turns: self.phase_rad / TAU,
        }
    }
}

/// A [`MainsHum`] made ready for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HumStep {
    amplitude_deg: f64,
    turns_per_step: f64,
    first_turns: f64,
}

impl HumStep {
    fn reading(&self, turns: f64, input: f64) -> f64 {
        input + self.amplitude_deg * (TAU * turns).sin()
    }
}

impl Step for HumStep {
    /// Phase in turns, 0 to 1.
    type Memory = f64;

    fn start(&self, input: f64) -> (f64, f64) {
        let turns = self.first_turns.rem_euclid(1.0);
        (turns, self.reading(turns, input))
    }

    #[inline]
    fn advance(&self, turns: &mut f64, input: f64) -> f64 {
        *turns = (*turns + self.turns_per_step).fract();
        self.reading(*turns, input)
    }
}
