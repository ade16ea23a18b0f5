//! The misfit of one record.

use crate::{GapError, error};

/// How far a simulated record is from the measured one.
///
/// ```text
/// r_i = measured_i - simulated_i
/// rms = sqrt(mean r^2),   bias = mean r,   NRMSE = rms / std(measured)
/// ```
/// The standard deviation is that of the record, `sqrt(mean (y - mean y)^2)`: a simulation that
/// only knows the mean has NRMSE 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// Root mean square error over the standard deviation of the measured record (1 = 100 %).
    pub nrmse: f64,
    /// Root mean square error, in the output's unit.
    pub rms: f64,
    /// Mean error, in the output's unit; positive if the simulation lies too low.
    pub bias: f64,
    /// Largest error in magnitude, in the output's unit.
    pub largest: f64,
    /// Sample (from 0) of the largest error.
    pub largest_at: usize,
    /// Standard deviation of the measured record, in the output's unit.
    pub measured_std: f64,
    /// Number of samples.
    pub samples: usize,
}

impl Misfit {
    /// The misfit of two records of one length.
    ///
    /// # Errors
    /// [`GapError::Length`], [`GapError::NotFinite`], [`GapError::TooShort`], and
    /// [`GapError::Constant`] for a measured record without variation.
    pub fn of(measured: &[f64], simulated: &[f64]) -> Result<Self, GapError> {
        error::check_pair(measured, simulated, 2)?;
        let measured_std = variance(measured)?.sqrt();
        let residual: Vec<f64> = residual(measured, simulated);
        let rms = mean_square(&residual).sqrt();
        let largest_at = (0..residual.len())
            .max_by(|&a, &b| residual[a].abs().total_cmp(&residual[b].abs()).then(b.cmp(&a)))
            .unwrap_or_default();
        Ok(Self {
            nrmse: rms / measured_std,
            rms,
            bias: mean(&residual),
            largest: residual[largest_at].abs(),
            largest_at,
            measured_std,
            samples: measured.len(),
        })
    }
}

/// Measured minus simulated.
pub(crate) fn residual(measured: &[f64], simulated: &[f64]) -> Vec<f64> {
    measured.iter().zip(simulated).map(|(m, s)| m - s).collect()
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub(crate) fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64
}

/// Variance of a measured record about its mean; refused if there is none.
pub(crate) fn variance(measured: &[f64]) -> Result<f64, GapError> {
    let centre = mean(measured);
    let (low, high) = measured
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
    if low >= high {
        return Err(GapError::Constant { what: "the measured output".into(), value: low });
    }
    Ok(measured.iter().map(|v| (v - centre).powi(2)).sum::<f64>() / measured.len() as f64)
}
