//! The measured energy: explained, noise, structured.

use crate::GapError;
use crate::misfit::compared;
use rotor_base::mean_square;

/// Where the energy of a measured record about its mean goes, as fractions that sum to 1.
///
/// ```text
/// explained  = 1 - mean r^2 / var y,     noise = min(sigma^2, mean r^2) / var y,
/// structured = max(mean r^2 - sigma^2, 0) / var y
/// ```
/// with `r` the residual and `sigma^2` the noise variance. The structured part is what a better
/// model could still explain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergySplit {
    /// Explained by the simulation; negative if it is worse than the mean of the record.
    pub explained: f64,
    /// Noise that no model can explain.
    pub noise: f64,
    /// Left over and not noise.
    pub structured: f64,
}

impl EnergySplit {
    /// The split of one record, given the variance of the measurement noise (output's unit squared),
    /// from [`crate::noise_variance`] and never from the residual itself.
    ///
    /// # Errors
    /// As [`crate::Misfit::of`], and [`GapError::OutOfRange`] for a negative variance.
    pub fn of(measured: &[f64], simulated: &[f64], noise_variance: f64) -> Result<Self, GapError> {
        let (residual, variance) = compared(measured, simulated)?;
        if !(noise_variance.is_finite() && noise_variance >= 0.0) {
            return Err(GapError::OutOfRange {
                what: "noise variance",
                value: noise_variance,
                expected: "a finite number, 0 or above",
            });
        }
        Ok(Self::of_residual(&residual, variance, noise_variance))
    }

    /// The split of a record of a variance about its mean, above 0, from its residual.
    pub fn of_residual(residual: &[f64], variance: f64, noise_variance: f64) -> Self {
        let left = mean_square(residual);
        let noise = noise_variance.min(left);
        Self {
            explained: 1.0 - left / variance,
            noise: noise / variance,
            structured: (left - noise) / variance,
        }
    }
}
