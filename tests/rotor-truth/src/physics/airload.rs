//! Airloads of a section with a flap: thin-aerofoil theory in rotor units.
//!
//! ```text
//! q  = U_T th - U_P + (b - x_a) om + (T10/pi) U_T d + (T11 b / 2 pi) d'          downwash at three quarters of the chord
//! l  = K |U_T| q_eff,  K = rho c a / (2 beta),   F_y = -K sgn(U_T) q_eff U_P - (rho c/2) c_d |U_T| U_T
//! M  = -pi rho b^3 |U_T| om - (rho b^2/beta)(T15 |U_T| U_T d + T16 b |U_T| d')   about the quarter chord
//! apparent mass:  F_z += pi rho b^2 w_m + rho b^2 (-T4 U_T d' - T1 b d'')
//!                 M   += -pi rho b^3 [(mu cos psi th - U_P')/2 + (3/8) b th''] + rho b^4 (T7 + (e + 1/2) T1) d''
//! ```
//! `x_a` is the quarter chord ahead of the elastic axis; the lift acts there. Source: Theodorsen, NACA Report 496 (1935).

use super::blade::{Airloads, Blade, Flap, Stall};
use std::f64::consts::{PI, TAU};

/// Coefficients of Theodorsen for a hinge at `e` semichords aft of midchord.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Theodorsen {
    t1: f64,
    t4: f64,
    t7: f64,
    t10: f64,
    t11: f64,
    t15: f64,
    t16: f64,
    /// `T7 + (e - a) T1` with the axis at a quarter chord.
    t7a: f64,
}

impl Theodorsen {
    /// Of a flap of a part of the chord.
    pub fn new(chord_fraction: f64) -> Self {
        let e = 1.0 - 2.0 * chord_fraction;
        let (s, a) = ((1.0 - e * e).sqrt(), e.acos());
        let t1 = -s * (2.0 + e * e) / 3.0 + e * a;
        let t4 = -a + e * s;
        let t7 = -(0.125 + e * e) * a + e * s * (7.0 + 2.0 * e * e) / 8.0;
        let t8 = -s * (2.0 * e * e + 1.0) / 3.0 + e * a;
        let t10 = s + a;
        let t11 = (1.0 - 2.0 * e) * a + (2.0 - e) * s;
        let behind = e + 0.5;
        let t16 = t1 - t8 - behind * t4 + 0.5 * t11;
        Self { t1, t4, t7, t10, t11, t15: t4 + t10, t16, t7a: t7 + behind * t1 }
    }
}

/// A flap at a station, ready for its airloads and inertia.
#[derive(Debug, Clone, Copy)]
pub struct FlapSection {
    theory: Theodorsen,
    lift: f64,
    moment: f64,
    /// `m X` of the force by `d''`.
    pub static_moment: f64,
    /// Coefficient of `-d''` in the moment about the elastic axis.
    pub inertia: f64,
    /// Coefficient of `-d` there.
    pub spring: f64,
}

impl FlapSection {
    /// Of a flap of a blade.
    ///
    /// Its chord reaches from the hinge to the trailing edge; without a mass of its own along the chord, its inertia is that
    /// of a thin rod.
    pub fn new(blade: &Blade, flap: &Flap) -> Self {
        let chord = flap.chord_fraction * blade.chord;
        let (mass, behind) = (flap.mass_fraction, flap.cg_fraction * chord);
        let hinge = (0.75 - flap.chord_fraction) * blade.chord - blade.aerodynamic_centre;
        let spring = mass * (hinge + behind) * behind;
        Self {
            theory: Theodorsen::new(flap.chord_fraction),
            lift: flap.lift,
            moment: flap.moment,
            static_moment: mass * behind,
            inertia: spring + mass * chord * chord / 12.0,
            spring,
        }
    }
}

/// A flap with its angle, rate and acceleration.
pub type Deflected<'a> = Option<(&'a FlapSection, [f64; 3])>;

/// Air seen by a section.
#[derive(Debug, Clone, Copy, Default)]
pub struct Air {
    /// In the plane, toward the leading edge.
    pub u_t: f64,
    /// From above, at the elastic axis.
    pub u_p: f64,
    /// Rate of that through the motion of the blade.
    pub u_p_rate: f64,
    /// `mu cos psi`.
    pub along: f64,
    /// Pitch with its rate and acceleration.
    pub theta: [f64; 3],
    /// Angular velocity of the section, nose up.
    pub turn: f64,
}

/// Loads of a section on the elastic axis, per length.
#[derive(Debug, Clone, Copy, Default)]
pub struct Loads {
    /// Toward the leading edge.
    pub f_y: f64,
    /// Up.
    pub f_z: f64,
    /// Nose up.
    pub moment: f64,
}

/// What every section of a blade has.
#[derive(Debug, Clone, Copy)]
pub struct Section {
    b: f64,
    air_mass: f64,
    lift_ratio: f64,
    drag: f64,
    ahead: f64,
    tip_mach: Option<f64>,
    has_apparent_mass: bool,
    stall: Option<Stall>,
}

impl Section {
    /// Of a blade.
    pub fn new(blade: &Blade) -> Self {
        Self {
            b: 0.5 * blade.chord,
            air_mass: blade.air_mass(),
            lift_ratio: blade.lift_ratio,
            drag: blade.drag,
            ahead: blade.aerodynamic_centre,
            tip_mach: blade.tip_mach,
            has_apparent_mass: blade.airloads != Airloads::QuasiSteady,
            stall: blade.stall,
        }
    }

    /// Square of the Prandtl-Glauert factor at a velocity, 1 of incompressible air.
    pub fn beta_squared(&self, u_t: f64) -> f64 {
        self.tip_mach.map_or(1.0, |mach| 1.0 - (mach * u_t).powi(2).min(0.9))
    }

    /// Downwash at three quarters of the chord.
    pub fn downwash(&self, air: &Air, flap: Deflected<'_>) -> f64 {
        let clean = air.u_t * air.theta[0] - air.u_p + (self.b - self.ahead) * air.turn;
        flap.map_or(clean, |(own, [d, rate, _])| {
            let t = &own.theory;
            clean + own.lift * (t.t10 / PI * air.u_t * d + t.t11 * self.b / TAU * rate)
        })
    }

    /// Share of the section that static separation leaves attached.
    pub fn attached(&self, u_t: f64, q: f64) -> f64 {
        self.stall.map_or(1.0, |own| {
            let incidence = (q / u_t.abs().max(0.02)).abs();
            0.04 + 0.96 / (1.0 + ((incidence - own.angle_rad) / own.width_rad).min(50.0).exp())
        })
    }

    /// Loads with the downwash that circulation follows, and the share that is attached.
    pub fn loads(&self, air: &Air, flap: Deflected<'_>, q: f64, attached: f64) -> Loads {
        let (b, rc) = (self.b, self.air_mass);
        let (u, speed) = (air.u_t, air.u_t.abs());
        let rb2 = 0.5 * rc * b;
        let beta = self.beta_squared(u).sqrt();
        let kirchhoff =
            if self.stall.is_some() { 0.25 * (1.0 + attached.sqrt()).powi(2) } else { 1.0 };
        let slope = rc * PI * self.lift_ratio / beta * kirchhoff;
        let sign = if u < 0.0 { -1.0 } else { 1.0 };
        let lift = slope * speed * q;
        let mut drag = self.drag;
        let mut moment = -PI * rb2 * b * speed * air.turn;
        if let Some(own) = self.stall {
            let incidence = q / speed.max(0.02);
            let lost = 1.0 - attached;
            drag += own.drag * lost * incidence.sin().powi(2);
            // the centre of pressure moves aft
            moment += own.moment * lost * (10.0 * incidence).tanh() * rc * b * u * speed;
        }
        let f_y = -slope * sign * q * air.u_p - 0.5 * rc * drag * speed * u;
        let mut f_z = lift;
        if let Some((own, [d, rate, _])) = flap {
            let t = &own.theory;
            moment -= own.moment * rb2 / beta * (t.t15 * speed * u * d + t.t16 * b * speed * rate);
        }
        if self.has_apparent_mass {
            let [theta, theta_rate, theta_acceleration] = air.theta;
            let quarter_rate = air.u_p_rate + self.ahead * theta_acceleration;
            let turned = air.along * theta - quarter_rate;
            let midchord = turned + u * theta_rate + 0.5 * b * theta_acceleration;
            f_z += PI * rb2 * midchord;
            moment -= PI * rb2 * b * (0.5 * turned + 0.375 * b * theta_acceleration);
            if let Some((own, [_, rate, acceleration])) = flap {
                let t = &own.theory;
                f_z += own.lift * rb2 * (-t.t4 * u * rate - t.t1 * b * acceleration);
                moment += own.moment * rb2 * t.t7a * b * b * acceleration;
            }
        }
        Loads { f_y, f_z, moment: moment + self.ahead * f_z }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NACA 496 with the hinge at .6 of the semichord.
    #[test]
    fn coefficients_are_the_tabulated_ones() {
        let t = Theodorsen::new(0.2);
        let pairs = [
            (t.t1, -0.072_956_20),
            (t.t4, -0.447_295_22),
            (t.t7, 0.013_461_82),
            (t.t10, 1.727_295_22),
            (t.t11, 0.934_540_96),
            (t.t15, 1.28),
            (t.t16, 0.788_628_55),
        ];
        for (found, exact) in pairs {
            assert!((found - exact).abs() < 1e-8, "{found} {exact}");
        }
    }
}
