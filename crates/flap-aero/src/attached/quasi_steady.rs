//! Quasi-steady section: Theodorsen's loads with his function set to 1 and no apparent mass.

use crate::{FlapChord, Mach, SectionCoefficients, TheodorsenFunctions};
use std::f64::consts::{PI, TAU};

/// Coefficients of the quasi-steady model.
///
/// ```text
/// Cn = (2 pi / beta) w,    w = alpha + q/2 + (T10/pi) delta + (T11/4 pi) q_delta
/// Cm = -(pi/4) q - (T15/2 delta + T16/4 q_delta) / beta
/// Ch = -(T17/4) q - (T12/2 w + T18/(2 pi) delta - T4 T11/(8 pi) q_delta) / beta
/// ```
/// The terms in the rates are those of Theodorsen in full: half of each belongs, strictly, to the
/// apparent mass of the angle's growth, and a rate of an angle cannot be had without it. All other
/// apparent mass is left out.
///
/// Assumes: loads follow the motion at once. The Prandtl-Glauert factor does not scale the damping
/// of the pitch rate, which is of apparent-mass kind.
///
/// Source: Theodorsen, NACA Report 496, equations of lift and moments with `C = 1`.
pub(crate) fn coefficients(mach: Mach, flap: FlapChord) -> SectionCoefficients {
    let t = TheodorsenFunctions::new(flap.hinge());
    let compress = 1.0 / mach.beta();
    let circulation = t.circulatory_input().map(|w| w * compress);
    let lift = circulation.map(|w| TAU * w);
    let moment = [0.0, -0.25 * PI, -0.5 * compress * t.t::<15>(), -0.25 * compress * t.t::<16>()];
    let mut hinge = circulation.map(|w| t.circulatory_hinge() * w);
    hinge[1] -= 0.25 * t.t::<17>();
    hinge[2] -= compress * t.t::<18>() / TAU;
    hinge[3] += compress * t.t::<4>() * t.t::<11>() / (8.0 * PI);
    SectionCoefficients { direct: [lift, moment, hinge], ..SectionCoefficients::default() }
}
