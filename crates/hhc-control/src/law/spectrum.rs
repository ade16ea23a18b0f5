//! Whether a loop with a constant T contracts: the spectral radius of its iteration.

use crate::{ControlError, FeedbackLaw, TMatrix, error};
use nalgebra::DMatrix;

impl FeedbackLaw {
    /// Largest factor by which an error of the control may be multiplied from step to step where the true
    /// sensitivity is another than that of the law.
    ///
    /// ```text
    /// u_(k+1) - u* = M (u_k - u*),    M = I - (T0' W_Z T0 + rho I)^-1 (T0' W_Z T + rho I)
    /// ```
    /// Whole steps converge, wherever they start from near `u*`, if the largest eigenvalue of `M` in size is below 1;
    /// above it they do not, and only halving or a new T helps. With `T = g exp(i phi) T0` and `rho = 0` it is
    /// `|1 - g exp(i phi)|`.
    ///
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `rho` | `rho` | 1/V^2 | >= 0, held from step to step |
    /// | `there` | `T` | 1/V | where the loop is, or ends |
    ///
    /// # Errors
    /// A `T` of another shape, a negative `rho`.
    ///
    /// Source: eq. (10) as a fixed-point iteration.
    pub fn iteration_spectral_radius(
        &self,
        rho: f64,
        there: &TMatrix,
    ) -> Result<f64, ControlError> {
        self.relaxed_spectral_radius(rho, 1.0, there)
    }

    /// The same where a step goes only a part of the way, `gain` above 0 and at most 1: the eigenvalues of
    /// `(1 - gain) I + gain M`.
    ///
    /// # Errors
    /// As [`Self::iteration_spectral_radius`].
    pub fn relaxed_spectral_radius(
        &self,
        rho: f64,
        gain: f64,
        there: &TMatrix,
    ) -> Result<f64, ControlError> {
        error::check_not_negative("control weight rho (1/V^2)", rho)?;
        error::check_gain(gain)?;
        let (loads, controls) = self.shape();
        error::check_length("controls of the true T", there.controls(), controls)?;
        error::check_length("loads of the true T", there.loads(), loads)?;
        // column by column: where eq. (10) goes to from a unit error, less the unit
        let mut iteration = DMatrix::identity(controls, controls);
        for (mut column, change) in iteration.column_iter_mut().zip(there.columns()) {
            let unit: Vec<f64> = column.iter().copied().collect();
            column.copy_from_slice(&self.optimum_volt(rho, &unit, &change)?);
        }
        iteration = iteration * gain + DMatrix::identity(controls, controls) * (1.0 - gain);
        Ok(spectral_radius(iteration))
    }
}

/// Powers of two of a matrix whose norm gives its radius: those of a matrix far from normal are close by then.
const SQUARINGS: u32 = 40;

/// Largest eigenvalue in size, from Gelfand's formula `lim |M^k|^(1/k)`: it needs no eigenvalues, which a nearly exact T
/// has all but equal.
fn spectral_radius(mut matrix: DMatrix<f64>) -> f64 {
    let (mut log, mut share) = (0.0, 1.0);
    for _ in 0..SQUARINGS {
        let norm = matrix.norm();
        if norm == 0.0 {
            return 0.0;
        }
        log += share * norm.ln();
        share *= 0.5;
        matrix /= norm;
        matrix = &matrix * &matrix;
    }
    log.exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LoadWeights;

    /// A T wrong by a complex factor: the radius is known.
    #[test]
    fn a_wrong_gain_and_phase_give_the_factor_of_theory() {
        let column = |j: usize| -> Vec<f64> {
            (0..6).map(|i| (0.8 * f64::from(i) + 1.3 * j as f64).sin() + 0.1 * j as f64).collect()
        };
        let columns: Vec<Vec<f64>> = (0..4).map(column).collect();
        let t0 = TMatrix::from_columns(&columns).unwrap();
        let law = FeedbackLaw::new(&t0, &LoadWeights::Identity).unwrap();
        for (gain, phase_deg) in [(1.0, 0.0), (0.7, 0.0), (1.0, 40.0), (1.2, -75.0)] {
            let (sin, cos) = f64::to_radians(phase_deg).sin_cos();
            let there = t0.turned(gain, f64::to_radians(phase_deg)).unwrap();
            let found = law.iteration_spectral_radius(0.0, &there).unwrap();
            let exact = f64::hypot(1.0 - gain * cos, gain * sin);
            assert!((found - exact).abs() < 1e-10, "{gain} {phase_deg}: {found} {exact}");
        }
    }
}
