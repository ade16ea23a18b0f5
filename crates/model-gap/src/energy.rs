//! The measured energy: explained, noise, structured.

use crate::misfit::{mean_square, residual, variance};
use crate::{GapError, error};

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
    /// from [`crate::NoiseEstimate`] and never from the residual itself.
    ///
    /// # Errors
    /// As [`crate::Misfit::of`], and [`GapError::OutOfRange`] for a negative variance.
    pub fn of(measured: &[f64], simulated: &[f64], noise_variance: f64) -> Result<Self, GapError> {
        error::check_pair(measured, simulated, 2)?;
        if !(noise_variance.is_finite() && noise_variance >= 0.0) {
            return Err(GapError::OutOfRange {
                what: "noise variance",
                value: noise_variance,
                expected: "a finite number, 0 or above",
            });
        }
        let total = variance(measured)?;
        let left = mean_square(&residual(measured, simulated));
        let noise = noise_variance.min(left);
        Ok(Self {
            explained: 1.0 - left / total,
            noise: noise / total,
            structured: (left - noise) / total,
        })
    }
}
