//! What ignoring the lag of an actuator costs, in closed form.

use crate::{ControlError, LoadWeights, TMatrix, error};

/// What is lost when a lag is ignored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LagLoss {
    /// Part of the attainable fall of `J_Z` that is lost: above 1, ignoring the lag is worse than no
    /// control.
    pub part: f64,
    /// `4 sin^2(lag / 2)`: the same if T acts alike on all controls, `T' W_Z T` a multiple of the unit
    /// matrix, and all pairs lag alike (the largest lag is taken).
    pub isotropic: f64,
}

/// Part of the attainable reduction lost when the optimum `u*` of an ideal actuator is applied to one
/// that turns every voltage harmonic by a lag.
///
/// ```text
/// (J_ignored - J*) / (J_0 - J*) = | W_Z^(1/2) T (R - I) u* |^2 / | W_Z^(1/2) T u* |^2
/// ```
/// because `Z(u*)` is orthogonal to the range of `T` at a free optimum, and with it
/// `J_ignored = J* + |T (R - I) u*|^2`, `J_0 = J* + |T u*|^2`.
///
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `t` | `T` | 1/V | |
/// | `load_weights` | `W_Z` | - | |
/// | `optimum_volt` | `u*` | V | the *unweighted* optimum |
/// | `lag_rad` | | rad | one per pair of controls |
///
/// # Errors
/// Vectors of the wrong length; [`ControlError::NoAuthority`] if the optimum does nothing.
///
/// Source: this project; the geometry is that of least squares.
pub fn lag_loss(
    t: &TMatrix,
    load_weights: &LoadWeights,
    optimum_volt: &[f64],
    lag_rad: &[f64],
) -> Result<LagLoss, ControlError> {
    let weights = load_weights.diagonal(t.loads())?;
    error::check_vector("optimal control (volt)", optimum_volt, t.controls())?;
    error::check_vector("lag of each pair (rad)", lag_rad, t.controls() / 2)?;
    let turned = optimum_volt.chunks_exact(2).zip(lag_rad).flat_map(|(u, lag)| {
        let (sin, cos) = lag.sin_cos();
        [cos * u[0] - sin * u[1] - u[0], sin * u[0] + cos * u[1] - u[1]]
    });
    let norm = |change: &[f64]| -> Result<f64, ControlError> {
        Ok(t.loads_for(change)?.iter().zip(&weights).map(|(z, w)| w * z * z).sum())
    };
    let whole = norm(optimum_volt)?;
    if whole == 0.0 {
        return Err(ControlError::NoAuthority);
    }
    let largest = lag_rad.iter().fold(0.0_f64, |m, lag| lag.abs().max(m));
    Ok(LagLoss {
        part: norm(&turned.collect::<Vec<f64>>())? / whole,
        isotropic: 4.0 * (0.5 * largest).sin().powi(2),
    })
}
