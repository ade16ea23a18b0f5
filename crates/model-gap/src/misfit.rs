//! The misfit of one record.

use crate::{GapError, error};
use rotor_base::{mean, mean_square};

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
}

impl Misfit {
    /// The misfit of two records of one length.
    ///
    /// # Errors
    /// [`GapError::Length`], [`GapError::NotFinite`], [`GapError::TooShort`], and
    /// [`GapError::Constant`] for a measured record without variation.
    pub fn of(measured: &[f64], simulated: &[f64]) -> Result<Self, GapError> {
        let (residual, variance) = compared(measured, simulated)?;
        let rms = mean_square(&residual).sqrt();
        Ok(Self { nrmse: rms / variance.sqrt(), rms, bias: mean(&residual) })
    }
}

/// Measured minus simulated, and the variance of the measured record about its mean; refused where
/// that is none.
pub(crate) fn compared(measured: &[f64], simulated: &[f64]) -> Result<(Vec<f64>, f64), GapError> {
    error::check_pair(measured, simulated, 2)?;
    let value = measured[0];
    if measured.iter().all(|v| (v - value).abs() <= 0.0) {
        return Err(GapError::Constant { what: "the measured output".into(), value });
    }
    let residual = measured.iter().zip(simulated).map(|(m, s)| m - s).collect();
    Ok((residual, rotor_base::variance(measured)))
}
