//! The constants of the stall, and its static curve.

use crate::error::check;
use crate::{AeroError, Mach};
use std::f64::consts::PI;

/// How an aerofoil stalls, at one Mach number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StallParameters {
    /// Incidence from zero lift at which the flow separates at 0.7 chord, rad.
    pub alpha1_rad: f64,
    /// Sharpness of the separation below `alpha1`, rad.
    pub s1_rad: f64,
    /// The same above.
    pub s2_rad: f64,
    /// Aerodynamic centre ahead of the quarter chord, chords: `Cm = k0 Cn` in attached flow.
    pub k0: f64,
    /// Moment per normal force of separated flow.
    pub k1: f64,
    /// Shape of the moment break.
    pub k2: f64,
    /// Recovery of the leading-edge suction.
    pub eta: f64,
    /// How fast the suction is lost when the normal force exceeds the critical one.
    pub df: f64,
    /// Normal force at which the leading edge lets go.
    pub cn1: f64,
    /// Lag of the leading-edge pressure, semichords.
    pub tp: f64,
    /// Lag of the boundary layer while the flow separates, semichords.
    pub tf: f64,
    /// The same while it attaches again, semichords.
    pub tf_attaching: f64,
    /// Force of the vortex over the circulation that the separation has shed into it; 1 in the source.
    pub vortex_strength: f64,
    /// Half of the way of the vortex force from the quarter chord, chords: its lever is `arm (1 - cos(pi tau/Tvl))`; 0.2 in
    /// the source.
    pub vortex_arm: f64,
    /// Decay of the vortex lift, semichords.
    pub tv: f64,
    /// Travel of the vortex over the chord, semichords.
    pub tvl: f64,
}

/// NACA 0012, one row per Mach number: `M`, `alpha1`, `S1`, `S2` (deg), `K0`, `K1`, `K2`, `eta`,
/// `Df`, `Cn1`, `Tp`, `Tf`, `Tv`, `Tvl`.
///
/// Source: Leishman and Beddoes, J. Am. Helicopter Soc. 34(3), 1989, table 1; the values agree with
/// those of the public program laurapla/BLcode2.0.
const NACA_0012: [[f64; 14]; 7] = [
    [0.3, 15.25, 3.0, 2.3, 0.0025, -0.135, 0.04, 0.965, 8.0, 1.45, 1.7, 3.0, 6.0, 7.0],
    [0.4, 12.5, 3.25, 1.6, 0.006, -0.135, 0.05, 0.96, 7.75, 1.2, 1.8, 2.5, 6.0, 9.0],
    [0.5, 10.5, 3.5, 1.2, 0.02, -0.125, 0.04, 0.96, 6.2, 1.05, 2.0, 2.2, 6.0, 9.0],
    [0.6, 8.5, 4.0, 0.7, 0.038, -0.12, 0.04, 0.96, 6.0, 0.92, 2.5, 2.0, 6.0, 9.0],
    [0.7, 5.6, 4.5, 0.5, 0.03, -0.09, 0.15, 0.96, 5.9, 0.68, 3.0, 2.0, 6.0, 9.0],
    [0.75, 3.5, 3.5, 0.8, 0.001, -0.13, -0.02, 0.955, 5.5, 0.5, 3.3, 2.0, 6.0, 9.0],
    [0.8, 0.7, 0.7, 0.18, -0.01, 0.02, -0.01, 0.955, 4.0, 0.18, 4.3, 2.0, 4.0, 9.0],
];

impl StallParameters {
    /// The same constants of an aerofoil that stalls later by an incidence, rad; its critical normal force in proportion.
    #[must_use]
    pub fn later(self, by_rad: f64) -> Self {
        let alpha1_rad = self.alpha1_rad + by_rad;
        Self { alpha1_rad, cn1: self.cn1 * alpha1_rad / self.alpha1_rad, ..self }
    }

    /// The NACA 0012 at a Mach number, linear between the published columns (Mach 0.3 to 0.8), the
    /// end columns beyond.
    pub fn naca_0012(mach: Mach) -> Self {
        let m = mach.value();
        let after = NACA_0012.partition_point(|row| row[0] <= m).clamp(1, NACA_0012.len() - 1);
        let (low, high) = (&NACA_0012[after - 1], &NACA_0012[after]);
        let share = ((m - low[0]) / (high[0] - low[0])).clamp(0.0, 1.0);
        let value = |column: usize| low[column] + share * (high[column] - low[column]);
        Self {
            alpha1_rad: value(1).to_radians(),
            s1_rad: value(2).to_radians(),
            s2_rad: value(3).to_radians(),
            k0: value(4),
            k1: value(5),
            k2: value(6),
            eta: value(7),
            df: value(8),
            cn1: value(9),
            tp: value(10),
            tf: value(11),
            tf_attaching: value(11),
            vortex_strength: 1.0,
            vortex_arm: 0.2,
            tv: value(12),
            tvl: value(13),
        }
    }

    /// Chordwise place of separation, 1 (attached) to 0, at an incidence from zero lift in rad:
    ///
    /// ```text
    /// f = 1 - 0.3 e^((|alpha| - alpha1)/S1)          |alpha| <= alpha1
    /// f = 0.04 + 0.66 e^((alpha1 - |alpha|)/S2)      beyond
    /// ```
    pub fn separation(&self, alpha_rad: f64) -> f64 {
        let over = alpha_rad.abs() - self.alpha1_rad;
        if over <= 0.0 {
            1.0 - 0.3 * (over / self.s1_rad).exp()
        } else {
            0.04 + 0.66 * (-over / self.s2_rad).exp()
        }
    }

    /// Share of the attached normal force that is left with the flow separated at `f`, after
    /// Kirchhoff: `((1 + sqrt f)/2)^2`.
    pub fn kirchhoff(f: f64) -> f64 {
        let half = 0.5 * (1.0 + f.max(0.0).sqrt());
        half * half
    }

    /// Share of the leading-edge suction that is left at a place of separation and a delayed normal
    /// force, before `eta`:
    ///
    /// ```text
    /// sqrt(f) f^x,     x = 0 up to Cn1, then Df (|Cn'| - Cn1), at most 1
    /// ```
    pub(super) fn suction(&self, f: f64, delayed: f64) -> f64 {
        let lost = (self.df * (delayed.abs() - self.cn1)).clamp(0.0, 1.0);
        let f = f.max(0.0);
        f.sqrt() * f.powf(lost)
    }

    /// Moment about the quarter chord over the normal force: `k0 + k1 (1 - f) + k2 sin(pi f^2)`.
    pub(super) fn moment_arm(&self, f: f64) -> f64 {
        self.k0 + self.k1 * (1.0 - f) + self.k2 * (PI * f * f).sin()
    }

    pub(super) fn check(&self) -> Result<(), AeroError> {
        let positive = [
            ("alpha1 of the stall", self.alpha1_rad),
            ("S1 of the stall", self.s1_rad),
            ("S2 of the stall", self.s2_rad),
            ("Cn1 of the stall", self.cn1),
            ("Tp of the stall", self.tp),
            ("Tf of the stall", self.tf),
            ("Tf of the stall where the flow attaches", self.tf_attaching),
            ("Tv of the stall", self.tv),
            ("Tvl of the stall", self.tvl),
        ];
        check(&positive, "a number above 0", |value| value.is_finite() && value > 0.0)?;
        let finite = [
            ("k0", self.k0),
            ("k1", self.k1),
            ("k2", self.k2),
            ("eta", self.eta),
            ("Df", self.df),
            ("strength of the vortex", self.vortex_strength),
            ("arm of the vortex", self.vortex_arm),
        ];
        check(&finite, "a finite number", f64::is_finite)
    }
}
