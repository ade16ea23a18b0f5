//! What the linkage does to the motion: lost motion, dry friction, load.

use crate::StageError;
use crate::check::{check_not_negative, check_positive, check_within};
use crate::{Curve, Step};
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

/// A [`Backlash`] made ready for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlayStep {
    pub(crate) half_width: f64,
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
/// x = y + e,   de = 10 ( 1 - sgn(dy) e / r ) dy,   r = width / 2 = F_c / k
/// ```
/// `k e` is the force in the linkage, `k` its stiffness, which friction holds: Dahl's law on the driven part, whose
/// contact gives 10 times less than the linkage before it slips. After a reversal the output all but
/// stands still (`dy/dx = 1/21`), then bends smoothly into following at the distance `r`: a backlash with
/// rounded corners. `0 < dy/dx <= 1`; of motions much smaller than the width `1/11` passes, through a
/// backlash nothing. Rate-independent; exact for a motion that is monotone between samples.
/// `width_um = 0` is the identity.
///
/// Not modelled: minor loops do not close exactly (Dahl's law has no return-point memory).
/// Source: P. R. Dahl, *Solid friction damping of mechanical vibrations*, AIAA Journal 14 (1976),
/// with exponent 1; the stiffness of the contact is assumed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoulombFriction {
    /// Whole width `2 F_c / k` of the loop, at the actuator, um, `>= 0`; 0.1 to 2 % of stroke.
    pub width_um: f64,
}

/// Stiffness of a contact before it slips over that of the linkage.
const CONTACT_STIFFNESS: f64 = 10.0;

/// A [`CoulombFriction`] made ready: `de = c (1 - sgn(dy) e / r) dy`, `x = y + e`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionStep {
    /// Largest stretch, `r`, deg.
    limit: f64,
}

impl FrictionStep {
    /// Friction whose stretch is at most `limit_deg`, in degrees of flap angle.
    pub fn new(limit_deg: f64) -> Self {
        Self { limit: limit_deg }
    }

    /// The stretch after a monotone change of the output, deg.
    #[inline]
    pub fn stretched(self, stretch: f64, output_change: f64) -> f64 {
        settled_by_way(stretch, self.limit, output_change, self.limit / CONTACT_STIFFNESS)
    }

    /// The change of the output that goes with a monotone change of the input.
    ///
    /// ```text
    /// g(d) = d + sgn (e(d) - e) = |dx|,   d >= 0
    /// ```
    /// `g` rises with a slope that falls to 1: Newton's method from zero stays on the left.
    #[inline]
    fn followed(self, stretch: f64, input_change: f64) -> f64 {
        let wanted = input_change.abs();
        let toward = |d: f64| d.copysign(input_change);
        let mut d = 0.0;
        for _ in 0..NEWTON_STEPS {
            let after = self.stretched(stretch, toward(d));
            let taken = (after - stretch) * input_change.signum();
            let left = 1.0 - after * input_change.signum() / self.limit;
            let step = (wanted - d - taken) / (1.0 + CONTACT_STIFFNESS * left);
            d += step;
            if step <= 4.0 * f64::EPSILON * wanted {
                break;
            }
        }
        toward(d.clamp(0.0, wanted))
    }
}

/// Steps of Newton's method for one sample, at most; some six are needed.
const NEWTON_STEPS: usize = 60;

/// The state of `de = (1 - sgn(dx) e / limit) limit / way dx` after a monotone `dx`.
#[inline]
fn settled_by_way(state: f64, limit: f64, change: f64, way: f64) -> f64 {
    if change == 0.0 || limit == 0.0 {
        return state;
    }
    let goal = limit.copysign(change);
    goal + (state - goal) * (-change.abs() / way).exp()
}

/// The state that a periodic motion leads to, from those before and after one period: over the period it is
/// multiplied by `exp(-way travelled / way)`, whatever the turns.
fn settled_over_period(before: WayMemory, now: WayMemory, way: f64) -> f64 {
    let ways = (now.travelled - before.travelled) / way;
    if ways > 0.0 && ways < SHORT_WAY {
        before.state - (now.state - before.state) / (-ways).exp_m1()
    } else {
        now.state
    }
}

/// Periods with a longer way than this many of the stage's settle by themselves.
const SHORT_WAY: f64 = 3.0;

/// The memory of a stage that settles with the way.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WayMemory {
    input: f64,
    /// Stretch.
    #[serde(rename = "stretch")]
    state: f64,
    /// Way since the start of the motion that counts.
    #[serde(default)]
    travelled: f64,
}

impl WayMemory {
    fn at_rest(input: f64) -> Self {
        Self { input, state: 0.0, travelled: 0.0 }
    }
}

impl Step for FrictionStep {
    type Memory = WayMemory;

    fn start(&self, input: f64) -> (WayMemory, f64) {
        (WayMemory::at_rest(input), input)
    }

    #[inline]
    fn advance(&self, memory: &mut WayMemory, input: f64) -> f64 {
        let change = input - memory.input;
        memory.input = input;
        if change != 0.0 && self.limit > 0.0 {
            let followed = self.followed(memory.state, change);
            memory.travelled += followed.abs();
            // what the output does not follow stretches the linkage: nothing is lost to rounding
            memory.state += change - followed;
        }
        input - memory.state
    }

    fn settle(&self, before: &WayMemory, now: &mut WayMemory, _: f64) {
        now.state = settled_over_period(*before, *now, self.limit / CONTACT_STIFFNESS);
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
    pub(crate) fn check(self) -> Result<(), StageError> {
        check_positive("travel_um", self.travel_um)?;
        check_within("share of the accommodation", self.share, 0.0..=LARGEST_SHARE)
    }
}

/// An [`Accommodation`] made ready: `de = (1 - sgn(dx) e / travel) dx`, `y = x - share e`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AccommodationStep {
    pub(crate) travel: f64,
    pub(crate) share: f64,
}

impl Step for AccommodationStep {
    type Memory = WayMemory;

    fn start(&self, input: f64) -> (WayMemory, f64) {
        (WayMemory::at_rest(input), input)
    }

    #[inline]
    fn advance(&self, memory: &mut WayMemory, input: f64) -> f64 {
        let change = input - memory.input;
        memory.input = input;
        memory.travelled += change.abs();
        memory.state = settled_by_way(memory.state, self.travel, change, self.travel);
        input - self.share * memory.state
    }

    fn settle(&self, before: &WayMemory, now: &mut WayMemory, _: f64) {
        now.state = settled_over_period(*before, *now, self.travel);
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
    pub(crate) fn check(&self) -> Result<(), StageError> {
        check_not_negative("stiffness_ratio", self.stiffness_ratio)?;
        check_not_negative("compliance_um_per_newton", self.compliance_um_per_newton)
    }

    pub(crate) fn prepared(&self, deg_per_um: f64) -> LoadStep {
        LoadStep {
            share: 1.0 / (1.0 + self.stiffness_ratio),
            deg_per_newton: deg_per_um * self.compliance_um_per_newton,
        }
    }
}

/// A [`LoadStiffness`] made ready.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadStep {
    share: f64,
    deg_per_newton: f64,
}

impl LoadStep {
    /// The flap angle, deg, under an external load, N.
    #[inline]
    pub fn under(&self, free_deg: f64, load_newton: f64) -> f64 {
        (free_deg - self.deg_per_newton * load_newton) * self.share
    }
}

impl Curve for LoadStep {
    #[inline]
    fn value(&self, input: f64) -> f64 {
        self.under(input, 0.0)
    }
}
