//! An output curve without memory: what makes a symmetric loop asymmetric.

use crate::PreisachError;
use crate::check::{check_finite, check_that};
use serde::{Deserialize, Serialize};

/// A rising cubic from a symmetric law's output to the flap angle.
///
/// ```text
/// z = reference * zeta      delta = offset + reference (zeta + quadratic zeta^2 + cubic zeta^3)
/// ```
/// Loops of a sum of plays are symmetric about their centre; behind a curve that bends, the upper
/// and the lower end of a loop differ in slope and in width, as those of a poled ceramic do.
///
/// `Default` is the straight line through zero.
/// Source: K. Kuhnen, *Modeling, identification and compensation of complex hysteretic
/// nonlinearities: a modified Prandtl-Ishlinskii approach*, European Journal of Control 9 (2003):
/// a memoryless operator behind the plays; there dead zones, here a cubic.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Envelope {
    /// Output at the middle of the voltage range of a law at rest, deg.
    pub offset_deg: f64,
    /// Factor of `zeta^2`, -1/2 to 1/2 without a cubic.
    pub quadratic: f64,
    /// Factor of `zeta^3`.
    pub cubic: f64,
}

impl Envelope {
    /// Refuses numbers that are not finite, and a curve that falls anywhere in `|zeta| <= 1`.
    pub(crate) fn check(&self) -> Result<(), PreisachError> {
        check_finite("envelope", [self.offset_deg, self.quadratic, self.cubic])?;
        let slope = |zeta: f64| 1.0 + 2.0 * self.quadratic * zeta + 3.0 * self.cubic * zeta * zeta;
        let bottom = -self.quadratic / (3.0 * self.cubic);
        let mut least_slope = slope(1.0).min(slope(-1.0));
        if self.cubic > 0.0 && bottom.abs() < 1.0 {
            least_slope = least_slope.min(slope(bottom));
        }
        let expected = "0 or more; lower quadratic or cubic";
        check_that(least_slope >= 0.0, "least slope of the output curve", least_slope, expected)
    }

    /// The flap angle, deg, of a symmetric output `z` whose largest value is `reference`, both deg.
    #[inline]
    pub(crate) fn output_deg(&self, z: f64, reference: f64) -> f64 {
        if reference == 0.0 {
            return self.offset_deg;
        }
        let zeta = z / reference;
        self.offset_deg + z * (1.0 + zeta * (self.quadratic + zeta * self.cubic))
    }
}
