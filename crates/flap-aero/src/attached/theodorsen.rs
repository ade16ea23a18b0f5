//! Theodorsen's flap functions `T1 ... T19` and what a thin section makes of them.

use crate::HingePosition;
use std::f64::consts::PI;

/// Theodorsen's functions of the hinge position, for rotation about the quarter chord.
///
/// With `e` the hinge in semichords aft of mid-chord, `s = sqrt(1 - e^2)`, `A = arccos e` and the
/// pitch axis `a = -1/2`:
///
/// ```text
/// T1 = -s(2 + e^2)/3 + eA                     T2 = e s^2 - s(1 + e^2)A + e A^2
/// T3 = -(1/8 + e^2)A^2 + e s A(7 + 2e^2)/4 - s^2(5e^2 + 4)/8
/// T4 = -A + es                                T5 = -s^2 - A^2 + 2esA
/// T6 = T2                                     T7 = -(1/8 + e^2)A + es(7 + 2e^2)/8
/// T8 = -s(2e^2 + 1)/3 + eA                    T9 = (s^3/3 + a T4)/2
/// T10 = s + A                                 T11 = (1 - 2e)A + (2 - e)s
/// T12 = (2 + e)s - (2e + 1)A                  T13 = -(T7 + (e - a)T1)/2
/// T14 = 1/16 + ae/2                           T15 = T4 + T10
/// T16 = T1 - T8 - (e - a)T4 + T11/2           T17 = -2T9 - T1 + (a - 1/2)T4
/// T18 = T5 - T4 T10                           T19 = -T4 T11/2
/// ```
/// Source: Theodorsen, NACA Report 496 (1935).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TheodorsenFunctions {
    values: [f64; 19],
}

impl TheodorsenFunctions {
    /// Pitch axis `a` in semichords aft of mid-chord: the quarter chord.
    pub const PITCH_AXIS: f64 = -0.5;

    /// The functions at a hinge.
    pub fn new(hinge: HingePosition) -> Self {
        let e = hinge.semichords();
        let a = Self::PITCH_AXIS;
        let e2 = e * e;
        // (1 - e)(1 + e) and atan2 keep their digits as the hinge nears an edge
        let s2 = (1.0 - e) * (1.0 + e);
        let s = s2.sqrt();
        let angle = s.atan2(e);
        let t1 = -s * (2.0 + e2) / 3.0 + e * angle;
        let t2 = e * s2 - s * (1.0 + e2) * angle + e * angle * angle;
        let t3 = -(0.125 + e2) * angle * angle + 0.25 * e * s * angle * (7.0 + 2.0 * e2)
            - 0.125 * s2 * (5.0 * e2 + 4.0);
        let t4 = -angle + e * s;
        let t5 = -s2 - angle * angle + 2.0 * e * s * angle;
        let t7 = -(0.125 + e2) * angle + 0.125 * e * s * (7.0 + 2.0 * e2);
        let t8 = -s * (2.0 * e2 + 1.0) / 3.0 + e * angle;
        let t9 = 0.5 * (s * s2 / 3.0 + a * t4);
        let t10 = s + angle;
        let t11 = (1.0 - 2.0 * e) * angle + (2.0 - e) * s;
        let t12 = (2.0 + e) * s - (2.0 * e + 1.0) * angle;
        let t13 = -0.5 * (t7 + (e - a) * t1);
        let t14 = 0.0625 + 0.5 * a * e;
        let t15 = t4 + t10;
        let t16 = t1 - t8 - (e - a) * t4 + 0.5 * t11;
        let t17 = -2.0 * t9 - t1 + (a - 0.5) * t4;
        let t18 = t5 - t4 * t10;
        let t19 = -0.5 * t4 * t11;
        Self {
            values: [
                t1, t2, t3, t4, t5, t2, t7, t8, t9, t10, t11, t12, t13, t14, t15, t16, t17, t18,
                t19,
            ],
        }
    }

    /// `T1` to `T19` in order.
    pub fn all(&self) -> &[f64; 19] {
        &self.values
    }

    /// `T_N`; a number outside 1 to 19 does not compile.
    pub fn t<const N: usize>(&self) -> f64 {
        const { assert!(N >= 1 && N <= 19, "Theodorsen's functions are T1 to T19") };
        self.values[N - 1]
    }

    /// Weights of the four inputs in the downwash that makes circulation:
    /// `alpha + q/2 + (T10/pi) delta + (T11/4 pi) q_delta`.
    ///
    /// For the rigid modes this is the downwash at the three-quarter chord.
    pub fn circulatory_input(&self) -> [f64; 4] {
        [1.0, 0.5, self.t::<10>() / PI, self.t::<11>() / (4.0 * PI)]
    }

    /// Hinge moment per unit of circulatory downwash, `-T12 / 2`.
    pub fn circulatory_hinge(&self) -> f64 {
        -0.5 * self.t::<12>()
    }

    /// Moment about the quarter chord that a *held* downwash makes at once,
    /// `[0, -pi/8, -T15/2, -T16/8]` per input.
    ///
    /// The rate entries are half of what Theodorsen's `theta_dot` and `delta_dot` terms show: the
    /// other half comes from the growth of the angle that goes with the rate, and sits in
    /// [`apparent_mass`](Self::apparent_mass).
    pub fn held_moment(&self) -> [f64; 4] {
        [0.0, -PI / 8.0, -0.5 * self.t::<15>(), -0.125 * self.t::<16>()]
    }

    /// Hinge moment that a *held* downwash makes at once, circulation apart:
    /// `[0, (2 T9 + T4)/4, -T18/(2 pi), -(T19 + T2)/(4 pi)]` per input.
    pub fn held_hinge(&self) -> [f64; 4] {
        [
            0.0,
            0.25 * (2.0 * self.t::<9>() + self.t::<4>()),
            -self.t::<18>() / (2.0 * PI),
            -(self.t::<19>() + self.t::<2>()) / (4.0 * PI),
        ]
    }

    /// Loads per rate of each input in `S`, `[output][input]`, incompressible.
    pub fn apparent_mass(&self) -> [[f64; 4]; 3] {
        let e_minus_a = self.hinge_from_axis();
        [
            [PI, 0.25 * PI, -self.t::<4>(), -0.5 * self.t::<1>()],
            [
                -0.25 * PI,
                -3.0 * PI / 32.0,
                -0.25 * self.t::<16>(),
                0.25 * (self.t::<7>() + e_minus_a * self.t::<1>()),
            ],
            [
                0.5 * self.t::<1>(),
                -0.5 * self.t::<13>(),
                self.t::<2>() / (2.0 * PI),
                self.t::<3>() / (4.0 * PI),
            ],
        ]
    }

    /// `e - a`, from `T14 = 1/16 + a e / 2`.
    fn hinge_from_axis(&self) -> f64 {
        2.0 * (self.t::<14>() - 0.0625) / Self::PITCH_AXIS - Self::PITCH_AXIS
    }
}
