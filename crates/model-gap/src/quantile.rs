//! Quantiles of the normal and of Student's distribution.

/// Quantile 0.975 of the normal distribution.
pub(crate) const NORMAL_975: f64 = 1.959_963_985;

/// Quantile 0.975 of Student's distribution, by the first terms of its expansion about the normal one: right to
/// 4e-3 from five degrees of freedom on. Source: M. Abramowitz and I. A. Stegun, *Handbook of Mathematical
/// Functions*, 26.7.5.
pub(crate) fn student_975(degrees: f64) -> f64 {
    let z = NORMAL_975;
    let (z3, z5, z7) = (z.powi(3), z.powi(5), z.powi(7));
    z + (z3 + z) / (4.0 * degrees)
        + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * degrees.powi(2))
        + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * degrees.powi(3))
}

/// Chi-square of so many degrees of freedom that is exceeded as often as a normal deviate exceeds `deviations`: right to 3 %
/// from two degrees on. Source: E. B. Wilson and M. M. Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684.
pub(crate) fn chi2_quantile(degrees: f64, deviations: f64) -> f64 {
    let spread = 2.0 / (9.0 * degrees);
    degrees * (1.0 - spread + deviations * spread.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::{chi2_quantile, student_975};

    /// Against the printed table (Abramowitz and Stegun, table 26.10).
    #[test]
    fn students_quantile_is_that_of_the_table() {
        for (degrees, quantile) in [(5.0, 2.571), (10.0, 2.228), (39.0, 2.023)] {
            assert!((student_975(degrees) - quantile).abs() < 4e-3, "{degrees}");
        }
    }

    /// Against the printed table (Abramowitz and Stegun, table 26.8), probabilities 0.05 and 0.001.
    #[test]
    fn the_quantile_of_chi_square_is_that_of_the_table() {
        for (degrees, deviations, quantile) in [
            (2.0, 1.6449, 5.991),
            (10.0, 1.6449, 18.307),
            (2.0, 3.0902, 13.816),
            (30.0, 3.0902, 59.703),
        ] {
            assert!(
                (chi2_quantile(degrees, deviations) / quantile - 1.0).abs() < 0.03,
                "{degrees}"
            );
        }
    }
}
