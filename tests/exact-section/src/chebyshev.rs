//! Chebyshev series of complex functions on an interval about zero.

use num_complex::Complex64;
use std::f64::consts::PI;

/// `f(z) = sum c_n T_n(z / half)`.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    half: f64,
    coefficients: Vec<Complex64>,
}

/// Nodes `cos(pi (i + 1/2) / count)`; an even count leaves out zero.
pub(crate) fn nodes(count: usize) -> Vec<f64> {
    (0..count).map(|i| (PI * (i as f64 + 0.5) / count as f64).cos()).collect()
}

/// Coefficients of the interpolant through values at [`nodes`].
pub(crate) fn transform(values: &[Complex64]) -> Vec<Complex64> {
    let n = values.len();
    (0..n)
        .map(|m| {
            let sum: Complex64 = values
                .iter()
                .enumerate()
                .map(|(i, v)| v * (PI * m as f64 * (i as f64 + 0.5) / n as f64).cos())
                .sum();
            sum * if m == 0 { 1.0 } else { 2.0 } / n as f64
        })
        .collect()
}

impl Series {
    /// Through values at the nodes scaled to `[-half, half]`.
    pub(crate) fn through(half: f64, values: &[Complex64]) -> Self {
        Self { half, coefficients: transform(values) }
    }

    /// Value at `z`, by Clenshaw's recurrence.
    pub(crate) fn at(&self, z: f64) -> Complex64 {
        let t = z / self.half;
        let (mut ahead, mut beyond) = (Complex64::ZERO, Complex64::ZERO);
        for c in self.coefficients.iter().skip(1).rev() {
            (ahead, beyond) = (ahead * 2.0 * t - beyond + c, ahead);
        }
        let first = self.coefficients.first().copied().unwrap_or_default();
        ahead * t - beyond + first
    }

    /// The integral from 0.
    pub(crate) fn integral(&self) -> Self {
        let n = self.coefficients.len();
        let c = |m: usize| self.coefficients.get(m).copied().unwrap_or_default();
        let mut coefficients = vec![Complex64::ZERO; n + 1];
        for (m, slot) in coefficients.iter_mut().enumerate().skip(1) {
            let before = if m == 1 { 2.0 * c(0) } else { c(m - 1) };
            *slot = (before - c(m + 1)) * self.half / (2.0 * m as f64);
        }
        let mut integral = Self { half: self.half, coefficients };
        let at_zero = integral.at(0.0);
        if let Some(first) = integral.coefficients.first_mut() {
            *first -= at_zero;
        }
        integral
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_integral_is_the_integral() {
        let values: Vec<Complex64> =
            nodes(40).iter().map(|t| Complex64::new(0.0, 3.0 * 2.0 * t).exp()).collect();
        let series = Series::through(2.0, &values);
        for z in [-2.0, -0.7, 0.0, 1.3] {
            let exact = (Complex64::new(0.0, 3.0 * z).exp() - 1.0) / Complex64::new(0.0, 3.0);
            assert!((series.integral().at(z) - exact).norm() < 1e-13, "{z}");
        }
    }
}
