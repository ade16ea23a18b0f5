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

#[cfg(test)]
mod tests {
    use super::student_975;

    /// Against the printed table (Abramowitz and Stegun, table 26.10).
    #[test]
    fn students_quantile_is_that_of_the_table() {
        for (degrees, quantile) in [(5.0, 2.571), (10.0, 2.228), (39.0, 2.023)] {
            assert!((student_975(degrees) - quantile).abs() < 4e-3, "{degrees}");
        }
    }
}
