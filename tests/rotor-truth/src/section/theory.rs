//! Exact loads of a thin aerofoil in harmonic motion, for any downwash along the chord (Kuessner and Schwarz).
//!
//! ```text
//! x = -cos t, semichords, leading edge at t = 0     g(t) = sum A_n cos n t    angle of the flow to the surface
//! cp below - above = 4 (B_0 cot(t/2) + sum B_n sin n t)
//! B_0 = C(k) (A_0 - A_1/2) + A_1/2        B_n = -A_n + (ik/2n) (A_(n-1) - A_(n+1)),   A_0 twice in B_1
//! cn = 2 pi (B_0 + B_1/2)      cm = -(pi/4) (B_1 - B_2)      ch = -sum B_n J_n
//! ```
//! Moments are over the square of the chord, about the quarter chord and the hinge, nose up and trailing edge down positive. The
//! second term of `B_n` is the apparent mass. A surface that bends in a kink has a series that falls as `1/n`; the loads' falls as
//! `1/n^3`.
//!
//! Compressible flow, at low frequency: loads over `beta`, `C(k/beta^2) exp(i k f/beta^2)` in place of `C`, with
//! `f = (1 - beta) ln M + beta ln(1 + beta) - ln 2`. Source: Amiet, AIAA Journal 12 (1974), 253.

use super::wake::{ReturningWake, deficiency};
use nalgebra::Complex;
use std::f64::consts::PI;

/// Terms of the series.
const TERMS: usize = 600;
/// Quarter chord, semichords behind the middle.
pub const QUARTER_CHORD: f64 = -0.5;

/// Normal force, moment about the quarter chord, hinge moment: complex amplitudes, `exp(i omega t)`.
pub type Loads = [Complex<f64>; 3];

/// What moves by 1 rad, or by a plunge of 1 semichord.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Pitch, nose up.
    Pitch,
    /// Flap, trailing edge down.
    Flap,
    /// Plunge, down.
    Plunge,
}

/// A section with a trailing-edge flap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// Flap chord over chord.
    pub flap_chord: f64,
    /// Axis of pitch, semichords behind the middle.
    pub pitch_axis: f64,
}

/// How the flow answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flow {
    /// Mach number of the flow that the section feels.
    pub mach: f64,
    /// Wakes that return.
    pub returning: Option<ReturningWake>,
    /// Share of unsteady flow; the rest is quasi-steady: no lag, no apparent mass.
    pub unsteady: f64,
    /// Share of the lag by the wake alone.
    pub wake_lag: f64,
}

/// `int cos m t` from the hinge to the trailing edge.
fn outboard(hinge: f64, m: usize) -> f64 {
    if m == 0 { PI - hinge } else { -(m as f64 * hinge).sin() / m as f64 }
}

impl Geometry {
    /// Position of the hinge, semichords behind the middle.
    pub fn hinge(&self) -> f64 {
        1.0 - 2.0 * self.flap_chord
    }

    /// Series of the angle of the flow to the surface.
    pub fn downwash(&self, motion: Motion, k: f64) -> Vec<Complex<f64>> {
        let ik = Complex::new(0.0, k);
        let mut series = vec![Complex::new(0.0, 0.0); TERMS + 2];
        match motion {
            // 1 + ik (x - axis)
            Motion::Pitch => {
                series[0] = 1.0 - ik * self.pitch_axis;
                series[1] = -ik;
            }
            Motion::Plunge => series[0] = ik,
            Motion::Flap => {
                let c = self.hinge();
                let at = (-c).acos();
                let one = 1.0 - ik * c;
                for (n, own) in series.iter_mut().enumerate() {
                    let beside = outboard(at, n.abs_diff(1)) + outboard(at, n + 1);
                    let integral = one * outboard(at, n) - ik * 0.5 * beside;
                    *own = integral * if n == 0 { 1.0 / PI } else { 2.0 / PI };
                }
            }
        }
        series
    }

    /// Loads of a series; `k` is the reduced frequency of the apparent mass, 0 without.
    fn of_series(&self, a: &[Complex<f64>], k: f64, circulation: Complex<f64>) -> Loads {
        let ik = Complex::new(0.0, k);
        let b = |n: usize| -> Complex<f64> {
            let before = if n == 1 { 2.0 * a[0] } else { a[n - 1] };
            -a[n] + ik / (2.0 * n as f64) * (before - a[n + 1])
        };
        let b0 = circulation * (a[0] - 0.5 * a[1]) + 0.5 * a[1];
        let (b1, b2) = (b(1), b(2));
        let c = self.hinge();
        let at = (-c).acos();
        let o = |m: usize| outboard(at, m);
        let mut hinge = b0 * (-(1.0 + c) * o(1) - c * o(0) - 0.5 * (o(0) + o(2)));
        for n in 1..=TERMS {
            let curved = -0.25 * (o(n.abs_diff(2)) - o(n + 2));
            hinge += b(n) * (curved - 0.5 * c * (o(n - 1) - o(n + 1)));
        }
        [2.0 * PI * (b0 + 0.5 * b1), -0.25 * PI * (b1 - b2), -hinge]
    }

    /// Loads of an angle of the flow at a reduced frequency.
    pub fn loads(&self, angle: &[Complex<f64>], k: f64, flow: &Flow) -> Loads {
        let beta = (1.0 - flow.mach * flow.mach).sqrt();
        let slower = k / (beta * beta);
        let phase = if flow.mach > 0.0 {
            (1.0 - beta) * flow.mach.ln() + beta * beta.ln_1p() - std::f64::consts::LN_2
        } else {
            0.0
        };
        let circulation = 1.0 - flow.wake_lag * (1.0 - deficiency(slower, flow.returning));
        let circulation = circulation * Complex::from_polar(1.0, slower * phase);
        let unsteady = self.of_series(angle, k, circulation);
        let at_once = self.of_series(angle, 0.0, Complex::new(1.0, 0.0));
        std::array::from_fn(|n| {
            (flow.unsteady * unsteady[n] + (1.0 - flow.unsteady) * at_once[n]) / beta
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: Flow = Flow { mach: 0.0, returning: None, unsteady: 1.0, wake_lag: 1.0 };

    fn near(own: Complex<f64>, exact: Complex<f64>) {
        assert!((own - exact).norm() < 2e-5 * (1.0 + exact.norm()), "{own} {exact}");
    }

    fn of(geometry: Geometry, motion: Motion, k: f64) -> Loads {
        geometry.loads(&geometry.downwash(motion, k), k, &STILL)
    }

    /// Glauert's steady flap.
    #[test]
    fn a_steady_flap_is_glauerts() {
        let own = Geometry { flap_chord: 0.25, pitch_axis: QUARTER_CHORD };
        let at = (-0.5_f64).acos();
        let [cn, cm, _] = of(own, Motion::Flap, 0.0);
        near(cn, Complex::new(2.0 * (PI - at + at.sin()), 0.0));
        near(cm, Complex::new(-0.5 * at.sin() * (1.0 - at.cos()), 0.0));
        let [cn, cm, _] = of(own, Motion::Pitch, 0.0);
        near(cn, Complex::new(2.0 * PI, 0.0));
        near(cm, Complex::new(0.0, 0.0));
    }

    /// Theodorsen, NACA Report 496, with his T-functions.
    #[test]
    fn flap_pitch_and_plunge_are_theodorsens() {
        for (flap_chord, k) in [(0.25, 0.3), (0.15, 0.8), (0.4, 0.06)] {
            let own = Geometry { flap_chord, pitch_axis: QUARTER_CHORD };
            let c = own.hinge();
            let (s, a) = ((1.0 - c * c).sqrt(), c.acos());
            let t1 = -s * (2.0 + c * c) / 3.0 + c * a;
            let t3 = -s * s / 8.0 * (5.0 * c * c + 4.0) + 0.25 * c * (7.0 + 2.0 * c * c) * s * a
                - (0.125 + c * c) * a * a;
            let t4 = -a + c * s;
            let t5 = -s * s - a * a + 2.0 * c * s * a;
            let (t10, t11) = (s + a, a * (1.0 - 2.0 * c) + s * (2.0 - c));
            let t12 = s * (2.0 + c) - a * (2.0 * c + 1.0);
            let ik = Complex::new(0.0, k);
            let circulation = deficiency(k, None);
            let angle = t10 / PI + ik * t11 / (2.0 * PI);
            let [cn, _, ch] = of(own, Motion::Flap, k);
            near(cn, 2.0 * PI * circulation * angle - ik * t4 - ik * ik * t1);
            let held = (t5 - t4 * t10) / PI - ik * t4 * t11 / (2.0 * PI) - ik * ik * t3 / PI;
            near(ch, -0.5 * held - 0.5 * t12 * circulation * angle);
            // about the quarter chord, a = -1/2
            let [cn, cm, _] = of(own, Motion::Pitch, k);
            near(cn, 2.0 * PI * circulation * (1.0 + ik) + PI * ik + 0.5 * PI * ik * ik);
            near(cm, -0.5 * PI * ik - 0.5 * PI * 0.375 * ik * ik);
            let [cn, ..] = of(own, Motion::Plunge, k);
            near(cn, 2.0 * PI * circulation * ik + PI * ik * ik);
        }
    }

    /// Prandtl and Glauert at rest; in motion the wake is that of a slower section.
    #[test]
    fn a_compressible_section_is_prandtls_at_rest() {
        let own = Geometry { flap_chord: 0.2, pitch_axis: QUARTER_CHORD };
        let flow = Flow { mach: 0.6, ..STILL };
        let [cn, ..] = own.loads(&own.downwash(Motion::Pitch, 0.0), 0.0, &flow);
        near(cn, Complex::new(2.0 * PI / 0.8, 0.0));
        let k = 0.05;
        let [fast, ..] = own.loads(&own.downwash(Motion::Pitch, k), k, &flow);
        assert!(
            fast.im / fast.re < of(own, Motion::Pitch, k)[0].im / of(own, Motion::Pitch, k)[0].re
        );
    }

    #[test]
    fn a_quasi_steady_section_has_no_lag() {
        let own = Geometry { flap_chord: 0.2, pitch_axis: QUARTER_CHORD };
        let flow = Flow { unsteady: 0.0, ..STILL };
        let [cn, cm, _] = own.loads(&own.downwash(Motion::Pitch, 0.3), 0.3, &flow);
        near(cn, 2.0 * PI * Complex::new(1.0, 0.3));
        near(cm, Complex::new(0.0, -0.3 * PI / 4.0));
    }
}
