//! What the linkage does to the motion: lost motion, dry friction, load.

use super::Step;
use crate::PreisachError;
use crate::actuator::check_not_negative;
use serde::{Deserialize, Serialize};

/// Lost motion in a joint.
///
/// ```text
/// y <- max( x - width/2, min( x + width/2, y ) )
/// ```
/// The output stands still after every reversal until the gap is taken up. A play operator, so a
/// free Preisach density absorbs it. `width_um = 0` is the identity. Exact at the samples.
/// Starts in the middle of the gap. Source: elementary; 0.2 to 3 % of stroke.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Backlash {
    /// Whole width of the gap, at the actuator, um, `>= 0`.
    pub width_um: f64,
}

impl Backlash {
    pub(super) fn check(self) -> Result<(), PreisachError> {
        check_not_negative("width_um", self.width_um)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlayStep {
    half_width: f64,
}

impl PlayStep {
    pub(super) fn new(half_width: f64) -> Self {
        Self { half_width }
    }
}

impl Step for PlayStep {
    /// The output.
    type Memory = f64;

    fn start(&self, input: f64) -> (f64, f64) {
        (input, input)
    }

    #[inline]
    fn advance(&self, output: &mut f64, input: f64) -> f64 {
        *output = output.min(input + self.half_width).max(input - self.half_width);
        *output
    }
}

/// Dry friction of the driven part against the elasticity of the linkage.
///
/// ```text
/// y = x - e,   de = ( 1 - sgn(dx) e / r ) dx,   r = width / 2 = F_c / k
/// ```
/// After a reversal the output first stands still and then bends smoothly into following at the
/// distance `r`: a backlash with rounded corners. Rate-independent; exact for a motion that is
/// monotone between samples. `width_um = 0` is the identity.
///
/// Not modelled: minor loops do not close exactly (Dahl's law has no return-point memory).
/// Source: P. R. Dahl, *Solid friction damping of mechanical vibrations*, AIAA Journal 14 (1976),
/// with exponent 1, in terms of the motion that drives the spring.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoulombFriction {
    /// Whole width `2 F_c / k` of the loop, at the actuator, um, `>= 0`; 0.1 to 2 % of stroke.
    pub width_um: f64,
}

impl CoulombFriction {
    pub(super) fn check(self) -> Result<(), PreisachError> {
        check_not_negative("width_um", self.width_um)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FrictionStep {
    half_width: f64,
    /// What of the stretch is missing from the output.
    share: f64,
}

impl FrictionStep {
    pub(super) fn new(half_width: f64, share: f64) -> Self {
        Self { half_width, share }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct FrictionMemory {
    input: f64,
    /// Stretch of the spring, -r to r.
    stretch: f64,
}

impl Step for FrictionStep {
    type Memory = FrictionMemory;

    fn start(&self, input: f64) -> (FrictionMemory, f64) {
        (FrictionMemory { input, stretch: 0.0 }, input)
    }

    #[inline]
    fn advance(&self, memory: &mut FrictionMemory, input: f64) -> f64 {
        let change = input - memory.input;
        memory.input = input;
        if change != 0.0 && self.half_width > 0.0 {
            let limit = self.half_width.copysign(change);
            let left = (-change.abs() / self.half_width).exp();
            memory.stretch = limit + (memory.stretch - limit) * left;
        }
        input - self.share * memory.stretch
    }
}

/// Accommodation: a share of the motion that settles with the way travelled, not with time.
///
/// ```text
/// y = x - share e,   de = ( 1 - sgn(dx) e / travel ) dx
/// ```
/// `x - e` is a lag of `x` whose time is the way travelled. Loops drift over several cycles before
/// they close, and a return to the same voltage does not bring back the same output: what no
/// operator with return-point memory can show. Rate-independent; exact for a motion that is monotone
/// between samples. `share = 0` is the identity.
/// Source: K. C. Valanis, *A theory of viscoplasticity without a yield surface*, Archives of Mechanics
/// 23 (1971): time measured by the way; the effect: E. Della Torre, *Magnetic Hysteresis* (1999).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accommodation {
    /// Share of the motion that settles late, 0 to 1.
    pub share: f64,
    /// Way after which it has settled to `1 - 1/e`, at the actuator, um, `> 0`.
    pub travel_um: f64,
}

impl Accommodation {
    pub(super) fn check(self) -> Result<(), PreisachError> {
        crate::actuator::check_positive("travel_um", self.travel_um)?;
        if (0.0..=1.0).contains(&self.share) {
            return Ok(());
        }
        let (quantity, value) = ("share of the accommodation", self.share);
        Err(PreisachError::OutOfRange { quantity, value, least: 0.0, most: 1.0 })
    }
}

/// A load spring, and the give of actuator and linkage under an external load.
///
/// ```text
/// delta = ( delta_free - deg_per_um F / k_a ) / ( 1 + stiffness_ratio ),   stiffness_ratio = k_load / k_a
/// ```
/// `F` is the external load along the actuator, positive against a growing displacement; see
/// [`crate::ActuatorModel::simulate_drive`] and
/// [`crate::Calibration::load_newton`] for a hinge moment. The load spring is unstrained at zero
/// flap angle. `stiffness_ratio = 0` without a load is the identity.
///
/// Assumes: quasi-static, the ceramic's hysteresis unchanged by stress.
/// Source: elementary; e.g. I. Chopra, J. Sirohi, *Smart Structures Theory* (2013), section 4.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadStiffness {
    /// Stiffness of the load over that of actuator and linkage, `>= 0`.
    pub stiffness_ratio: f64,
    /// Give of actuator and linkage, `1 / k_a`, um/N, `>= 0`.
    #[serde(default)]
    pub compliance_um_per_newton: f64,
}

impl LoadStiffness {
    pub(super) fn check(&self) -> Result<(), PreisachError> {
        check_not_negative("stiffness_ratio", self.stiffness_ratio)?;
        check_not_negative("compliance_um_per_newton", self.compliance_um_per_newton)
    }

    pub(super) fn prepared(&self, deg_per_um: f64) -> LoadStep {
        LoadStep {
            share: 1.0 / (1.0 + self.stiffness_ratio),
            deg_per_newton: deg_per_um * self.compliance_um_per_newton,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LoadStep {
    share: f64,
    deg_per_newton: f64,
}

impl LoadStep {
    /// The flap angle, deg, under an external load, N.
    #[inline]
    pub(crate) fn under(&self, free_deg: f64, load_newton: f64) -> f64 {
        (free_deg - self.deg_per_newton * load_newton) * self.share
    }
}

impl Step for LoadStep {
    type Memory = ();

    fn start(&self, input: f64) -> ((), f64) {
        ((), self.under(input, 0.0))
    }

    #[inline]
    fn advance(&self, (): &mut (), input: f64) -> f64 {
        self.under(input, 0.0)
    }
}
