//! Quantiles of the distributions that tests and intervals ask for.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

/// Quantile 0.975 of the normal distribution.
pub(crate) const NORMAL_975: f64 = 1.959_963_985;

/// Quantile 0.975 of Student's distribution of `degrees > 0`.
pub(crate) fn student_975(degrees: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees).map_or(f64::NAN, |student| student.inverse_cdf(0.975))
}

/// Probability that a deviate of Student's distribution of `degrees > 0` exceeds a value.
pub fn student_exceeded(degrees: f64, value: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees).map_or(f64::NAN, |student| student.sf(value))
}

/// Standard deviations that a normal deviate exceeds with a probability between 0 and 1.
pub(crate) fn normal_exceeded(probability: f64) -> f64 {
    -Normal::standard().inverse_cdf(probability)
}

/// Chi-square of `degrees > 0` that is exceeded with a probability between 0 and 1.
pub(crate) fn chi2_exceeded(degrees: f64, probability: f64) -> f64 {
    ChiSquared::new(degrees).map_or(f64::NAN, |chi2| chi2.inverse_cdf(1.0 - probability))
}

#[cfg(test)]
mod tests {
    use super::{chi2_exceeded, normal_exceeded, student_975};

    /// Against the printed tables (Abramowitz and Stegun, *Handbook of Mathematical Functions*, 26.8 and 26.10).
    #[test]
    fn the_quantiles_are_those_of_the_tables() {
        for (degrees, quantile) in [(5.0, 2.571), (10.0, 2.228), (39.0, 2.023)] {
            assert!((student_975(degrees) - quantile).abs() < 5e-4, "{degrees}");
        }
        for (degrees, probability, quantile) in [
            (1.0, 0.001, 10.828),
            (2.0, 0.05, 5.991),
            (10.0, 0.05, 18.307),
            (2.0, 0.001, 13.816),
            (30.0, 0.001, 59.703),
        ] {
            assert!((chi2_exceeded(degrees, probability) - quantile).abs() < 5e-4, "{degrees}");
        }
        assert!((normal_exceeded(0.001) - 3.0902).abs() < 5e-5);
    }
}
