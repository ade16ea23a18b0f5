//! What the wake of an oscillating section does to its circulation.
//!
//! ```text
//! C(k)    = H1 / (H1 + i H0),   H = J - i Y                                     Theodorsen
//! C'(k)   = (H1 + 2 J1 W) / (H1 + i H0 + 2 (J1 + i J0) W)                       Loewy
//! W       = 1 / (exp(k h) exp(i k t) - 1)
//! ```
//! with returning wakes `h` semichords apart that come back after `t` semichords of travel.

use nalgebra::Complex;
use std::f64::consts::{FRAC_2_PI, PI};

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;
/// Terms of the power series, enough to rounding for arguments to 5.
const TERMS: u32 = 40;

/// `J0, J1, Y0, Y1` at `x` in (0, 5], by their power series.
pub fn bessel(x: f64) -> [f64; 4] {
    let half = 0.5 * x;
    let log = half.ln();
    let (mut j0, mut j1, mut y0, mut y1) = (0.0, 0.0, 0.0, 0.0);
    // (x/2)^2m / (m!)^2 with its sign, and the harmonic number of m
    let (mut term, mut harmonic) = (1.0, 0.0);
    for m in 0..TERMS {
        let next = f64::from(m + 1);
        let odd = term * half / next;
        j0 += term;
        j1 += odd;
        y0 -= harmonic * term;
        y1 -= (2.0 * (harmonic - EULER) + 1.0 / next) * odd;
        term *= -half * half / (next * next);
        harmonic += 1.0 / next;
    }
    let y0 = FRAC_2_PI * ((log + EULER) * j0 + y0);
    let y1 = FRAC_2_PI * log * j1 - 2.0 / (PI * x) + y1 / PI;
    [j0, j1, y0, y1]
}

/// Returning wakes below a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReturningWake {
    /// Distance from one to the next, semichords.
    pub spacing: f64,
    /// Travel until it returns, semichords.
    pub travel: f64,
}

/// Circulation over its quasi-steady value at a reduced frequency of 0 to 5; 1 of a section that does not move.
pub fn deficiency(k: f64, returning: Option<ReturningWake>) -> Complex<f64> {
    if k <= 0.0 {
        return Complex::new(1.0, 0.0);
    }
    let [j0, j1, y0, y1] = bessel(k);
    let i = Complex::new(0.0, 1.0);
    let (h0, h1) = (Complex::new(j0, -y0), Complex::new(j1, -y1));
    let w = returning.map_or(Complex::new(0.0, 0.0), |own| {
        let far = Complex::new(k * own.spacing, k * own.travel).exp();
        1.0 / (far - 1.0)
    });
    (h1 + 2.0 * j1 * w) / (h1 + i * h0 + 2.0 * (j1 + i * j0) * w)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Abramowitz and Stegun, tables 9.1.
    #[test]
    fn bessel_functions_are_those_of_the_tables() {
        let near = |own: f64, exact: f64| assert!((own - exact).abs() < 2e-10, "{own} {exact}");
        let [j0, j1, y0, y1] = bessel(1.0);
        near(j0, 0.765_197_686_6);
        near(j1, 0.440_050_585_7);
        near(y0, 0.088_256_964_2);
        near(y1, -0.781_212_821_3);
        // Wronskian
        for x in [0.05, 0.7, 2.3, 4.5] {
            let [j0, j1, y0, y1] = bessel(x);
            near(j1 * y0 - j0 * y1, 2.0 / (PI * x));
        }
    }

    /// Theodorsen and Garrick, NACA Report 685.
    #[test]
    fn theodorsens_function_is_that_of_the_table() {
        for (k, real, imaginary) in [
            (0.05, 0.909, -0.1307),
            (0.1, 0.832, -0.1723),
            (0.5, 0.5979, -0.1507),
            (1.0, 0.5394, -0.1003),
        ] {
            let own = deficiency(k, None);
            assert!((own.re - real).abs() < 1e-3 && (own.im - imaginary).abs() < 1e-3, "{k} {own}");
        }
    }

    /// A wake far below is none; one close below takes the lift.
    #[test]
    fn a_returning_wake_matters_when_it_is_close() {
        let far = ReturningWake { spacing: 400.0, travel: 30.0 };
        let (none, own) = (deficiency(0.2, None), deficiency(0.2, Some(far)));
        assert!((none - own).norm() < 1e-12);
        let close = ReturningWake { spacing: 2.0, travel: std::f64::consts::TAU / 0.05 };
        assert!(deficiency(0.05, Some(close)).norm() < 0.6);
    }
}
