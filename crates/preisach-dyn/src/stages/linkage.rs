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
/// y = x - e,   de = ( 1 - sgn(dx) e / r ) dx / 2,   r = width / 2 = F_c / k
/// ```
/// `k e` is the force in the linkage, which friction holds. After a reversal the output stands still,
/// then bends smoothly into following at the distance `r`: a backlash with rounded corners. The output
/// never moves against the input: `dy/dx = (1 + sgn(dx) e / r) / 2` lies between 0 and 1.
/// Rate-independent; exact for a motion that is monotone between samples. `width_um = 0` is the
/// identity.
///
/// The friction force against the way of the driven part, `dF/dy = k (1 - q) / (1 + q)`,
/// `q = sgn(dy) F / F_c`, is rigid at the reversal and slips at `q = 1`, with the hysteresis of Dahl's
/// law in the motion that drives the spring.
///
/// Not modelled: minor loops do not close exactly (Dahl's law has no return-point memory).
/// Source: P. R. Dahl, *Solid friction damping of mechanical vibrations*, AIAA Journal 14 (1976),
/// with exponent 1; the factor 1/2, own, is the largest with which the output stands still after a
/// reversal instead of running on.
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

/// `de = (1 - sgn(dx) e / limit) limit / way dx`, `y = x - share e`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FrictionStep {
    /// Largest stretch.
    limit: f64,
    /// Way after which the stretch is within `1/e` of it.
    way: f64,
    /// What of the stretch is missing from the output.
    share: f64,
}

impl FrictionStep {
    /// Of dry friction with this half-width.
    pub(crate) fn dry(half_width: f64) -> Self {
        Self { limit: half_width, way: 2.0 * half_width, share: 1.0 }
    }

    /// Of an accommodation after this way.
    pub(super) fn accommodation(travel: f64, share: f64) -> Self {
        Self { limit: travel, way: travel, share }
    }

    /// The stretch after a monotone change of the input.
    #[inline]
    pub(crate) fn stretched(&self, stretch: f64, change: f64) -> f64 {
        if change == 0.0 || self.limit == 0.0 {
            return stretch;
        }
        let goal = self.limit.copysign(change);
        goal + (stretch - goal) * (-change.abs() / self.way).exp()
    }

    /// The change of the input that changes the output by as much; the smallest where several do.
    ///
    /// ```text
    /// g(d) = d - (change of the stretch) = |dy|,   d >= 0
    /// ```
    /// `g` bends upward and rises to a slope of 1: Newton's method from the right stays there.
    pub(crate) fn change_for(&self, stretch: f64, output_change: f64) -> f64 {
        let wanted = output_change.abs();
        let toward = |d: f64| d.copysign(output_change);
        if wanted == 0.0 {
            return 0.0;
        }
        // no more of the stretch is missing from the output than this
        let mut d = wanted + 2.0 * self.share * self.limit;
        for _ in 0..NEWTON_STEPS {
            let after = self.stretched(stretch, toward(d));
            let taken = self.share * (after - stretch) * output_change.signum();
            let left = self.limit - after * output_change.signum();
            let slope = 1.0 - self.share * left / self.way;
            let step = (d - taken - wanted) / slope;
            d -= step;
            if step <= f64::EPSILON * d {
                break;
            }
        }
        toward(d)
    }

    /// The stretch that a periodic input leads to, from those before and after one period.
    ///
    /// The stretch is multiplied by `exp(-way travelled / way)` over the period, whatever the turns.
    pub(super) fn settle(&self, before: &FrictionMemory, now: &mut FrictionMemory) {
        let ways = (now.travelled - before.travelled) / self.way;
        if ways > 0.0 && ways < SHORT_WAY {
            now.stretch = before.stretch - (now.stretch - before.stretch) / (-ways).exp_m1();
        }
    }
}

/// Steps of the inverse of one sample: at a reversal, where the output starts with slope zero, they
/// halve the error at worst.
const NEWTON_STEPS: usize = 80;

/// Periods with a longer way than this many [`FrictionStep::way`] settle by themselves.
const SHORT_WAY: f64 = 3.0;

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct FrictionMemory {
    input: f64,
    /// Stretch of the spring.
    stretch: f64,
    /// Way of the input since the start.
    #[serde(default)]
    travelled: f64,
}

impl Step for FrictionStep {
    type Memory = FrictionMemory;

    fn start(&self, input: f64) -> (FrictionMemory, f64) {
        (FrictionMemory { input, stretch: 0.0, travelled: 0.0 }, input)
    }

    #[inline]
    fn advance(&self, memory: &mut FrictionMemory, input: f64) -> f64 {
        let change = input - memory.input;
        memory.input = input;
        memory.travelled += change.abs();
        memory.stretch = self.stretched(memory.stretch, change);
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
/// between samples. `share = 0` is the identity. Above a share of one half the output would turn back
/// after every reversal.
/// Source: K. C. Valanis, *A theory of viscoplasticity without a yield surface*, Archives of Mechanics
/// 23 (1971): time measured by the way; the effect: E. Della Torre, *Magnetic Hysteresis* (1999).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accommodation {
    /// Share of the motion that settles late, 0 to 0.5.
    pub share: f64,
    /// Way after which it has settled to `1 - 1/e`, at the actuator, um, `> 0`.
    pub travel_um: f64,
}

impl Accommodation {
    pub(super) fn check(self) -> Result<(), PreisachError> {
        crate::actuator::check_positive("travel_um", self.travel_um)?;
        if (0.0..=LARGEST_SHARE).contains(&self.share) {
            return Ok(());
        }
        let (quantity, value) = ("share of the accommodation", self.share);
        Err(PreisachError::OutOfRange { quantity, value, least: 0.0, most: LARGEST_SHARE })
    }
}

/// Largest share of an [`Accommodation`]: `dy/dx >= 1 - 2 share`.
const LARGEST_SHARE: f64 = 0.5;

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
