//! Bessel functions of order 0 and 1, split into what is entire and what is a logarithm.
//!
//! ```text
//! Y0(s) = (2/pi) ln(s/2) J0(s) + y0(s)
//! Y1(s) = (2/pi) ln(s/2) J1(s) - 2/(pi s) + y1(s)
//! ```
//! `J0`, `J1`, `y0`, `y1` are entire: power series, good to 1e-9 of the largest term for `|s| <= 20`.
//!
//! Source: Abramowitz and Stegun, 9.1.10 to 9.1.13.

use num_complex::Complex64;
use std::f64::consts::PI;

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// The entire parts at one argument.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Entire {
    pub(crate) j0: f64,
    pub(crate) j1: f64,
    pub(crate) y0: f64,
    pub(crate) y1: f64,
}

impl Entire {
    /// At any real argument, negative ones included (`j0`, `y0` are even, `j1`, `y1` odd).
    pub(crate) fn at(s: f64) -> Self {
        let q = 0.25 * s * s;
        // (-q)^m / (m!)^2 and (-q)^m / (m! (m + 1)!), harmonic numbers H_m and H_{m+1}
        let (mut even, mut odd) = (1.0, 1.0);
        let (mut h, mut h_next) = (0.0, 1.0);
        let [mut j0, mut j1, mut y0, mut y1] = [0.0; 4];
        let mut m = 0.0;
        while m < 200.0 {
            j0 += even;
            j1 += odd;
            y0 -= h * even;
            y1 += (h + h_next - 2.0 * EULER) * odd;
            m += 1.0;
            even *= -q / (m * m);
            odd *= -q / (m * (m + 1.0));
            h += 1.0 / m;
            h_next += 1.0 / (m + 1.0);
            if even.abs() < 1e-18 && m * m > q {
                break;
            }
        }
        let half = 0.5 * s;
        Self { j0, j1: half * j1, y0: 2.0 / PI * (EULER * j0 + y0), y1: -half * y1 / PI }
    }
}

/// Hankel functions of the second kind, orders 0 and 1, of a positive argument.
fn hankel(k: f64) -> [Complex64; 2] {
    let e = Entire::at(k);
    let log = 2.0 / PI * (0.5 * k).ln();
    let h0 = Complex64::new(e.j0, -(log * e.j0 + e.y0));
    let h1 = Complex64::new(e.j1, -(log * e.j1 - 2.0 / (PI * k) + e.y1));
    [h0, h1]
}

/// Theodorsen's function `C(k) = H1 / (H1 + i H0)`, Hankel functions of the second kind.
///
/// `k` is the reduced frequency `omega c / (2 U)`, above 0 and up to 20; at 0 and below the limit 1.
///
/// Source: Theodorsen, NACA Report 496 (1935).
pub fn theodorsen_function(k: f64) -> Complex64 {
    if k <= 0.0 {
        return Complex64::ONE;
    }
    let [h0, h1] = hankel(k);
    h1 / (h1 + Complex64::I * h0)
}

/// Bound circulation of a flat plate in oscillating incidence over that in steady incidence, `e^(-ik) S(k)`: what the
/// aerofoil sheds is what is left of it.
///
/// ```text
/// Gamma/Gamma_0 = e^(-ik) / (ik [K0(ik) + K1(ik)])
/// ```
/// `k` as in [`theodorsen_function`].
///
/// Source: von Karman and Sears, J. Aeronautical Sciences 5 (1938), from Kelvin's theorem and the Kutta condition.
pub fn bound_circulation(k: f64) -> Complex64 {
    if k <= 0.0 {
        return Complex64::ONE;
    }
    let [h0, h1] = hankel(k);
    let sum = -0.5 * PI * (h1 + Complex64::I * h0);
    Complex64::from_polar(1.0, -k) / (Complex64::I * k * sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn tabulated_values() {
        // Abramowitz and Stegun, table 9.1
        for (s, j0, j1, y0, y1) in [
            (1.0_f64, 0.765_197_686_6, 0.440_050_585_7, 0.088_256_964_2, -0.781_212_821_3),
            (5.0, -0.177_596_771_3, -0.327_579_137_6, -0.308_517_625_2, 0.147_863_143_4),
            (10.0, -0.245_935_764_5, 0.043_472_746_2, 0.055_671_167_3, 0.249_015_424_2),
        ] {
            let e = Entire::at(s);
            let log = 2.0 / PI * (0.5 * s).ln();
            assert_abs_diff_eq!(e.j0, j0, epsilon = 1e-9);
            assert_abs_diff_eq!(e.j1, j1, epsilon = 1e-9);
            assert_abs_diff_eq!(log * e.j0 + e.y0, y0, epsilon = 1e-9);
            assert_abs_diff_eq!(log * e.j1 + e.y1 - 2.0 / (PI * s), y1, epsilon = 1e-9);
            let mirrored = Entire::at(-s);
            assert_abs_diff_eq!(mirrored.y0, e.y0);
            assert_abs_diff_eq!(mirrored.y1, -e.y1);
        }
    }

    #[test]
    fn theodorsens_function_in_numbers() {
        for (k, re, im) in
            [(0.1, 0.831_924_104_97, -0.172_302_228_73), (0.5, 0.597_936_064_25, -0.150_709_503_16)]
        {
            let c = theodorsen_function(k);
            assert_abs_diff_eq!(c.re, re, epsilon = 1e-10);
            assert_abs_diff_eq!(c.im, im, epsilon = 1e-10);
        }
        assert_abs_diff_eq!(theodorsen_function(0.0).re, 1.0);
    }
}
