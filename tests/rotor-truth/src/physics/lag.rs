//! States of the sections that follow with a lag: periodic solutions of `x' = r (f - x)`.
//!
//! By collocation, `(D + r_0) x = r f + (r_0 - r) x`, with `r_0` the rate of a blade that does not move. The last term is small,
//! so three passes are enough. `(D + r_0)^-1` is the same for every motion at one advance ratio.

use super::fourier::{Fourier, differentiation};
use crate::error::RotorTruthError;
use nalgebra::DMatrix;

/// Passes of the fixed point.
const PASSES: usize = 4;

/// One lag at every station: its rate per semichord and the inverted matrices.
#[derive(Debug, Clone)]
pub struct LagState {
    /// Rate per semichord travelled.
    pub rate: f64,
    /// `r_0` by station and azimuth.
    still: Vec<Vec<f64>>,
    /// `(D + r_0)^-1` by station, row by row.
    inverse: Vec<Vec<f64>>,
}

impl LagState {
    /// A lag of some rate; `still` is `beta^2 |U_T| / b` of the still blade by station and azimuth.
    ///
    /// # Errors
    /// [`RotorTruthError::Singular`] where a section sees no air at all.
    pub fn new(fourier: &Fourier, rate: f64, still: &[Vec<f64>]) -> Result<Self, RotorTruthError> {
        let n = fourier.azimuths;
        let slope = differentiation(n);
        let still: Vec<Vec<f64>> =
            still.iter().map(|own| own.iter().map(|r| r * rate).collect()).collect();
        let inverse = still
            .iter()
            .map(|own| {
                let mut matrix = DMatrix::from_row_slice(n, n, &slope);
                for (k, r) in own.iter().enumerate() {
                    matrix[(k, k)] += r;
                }
                let inverse = matrix.try_inverse().ok_or(RotorTruthError::Singular)?;
                // a column of the transpose is a row
                Ok(inverse.transpose().as_slice().to_vec())
            })
            .collect::<Result<_, RotorTruthError>>()?;
        Ok(Self { rate, still, inverse })
    }

    /// The state at a station; `speed` is `beta^2 |U_T| / b`, `forcing` what it follows.
    pub fn follow(&self, station: usize, speed: &[f64], forcing: &[f64]) -> Vec<f64> {
        let n = forcing.len();
        let (still, inverse) = (&self.still[station], &self.inverse[station]);
        let mut state = forcing.to_vec();
        let mut right = vec![0.0; n];
        for _ in 0..PASSES {
            for k in 0..n {
                let rate = self.rate * speed[k];
                right[k] = rate * forcing[k] + (still[k] - rate) * state[k];
            }
            for (own, row) in state.iter_mut().zip(inverse.chunks_exact(n)) {
                *own = row.iter().zip(&right).map(|(a, b)| a * b).sum();
            }
        }
        state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x' = r (cos 2 psi - x)` has the textbook answer.
    #[test]
    fn a_constant_rate_gives_the_transfer_function() -> Result<(), RotorTruthError> {
        let fourier = Fourier::new(4, 24);
        let rate = 1.7;
        let still = vec![vec![1.0; 24]];
        let lag = LagState::new(&fourier, rate, &still)?;
        let forcing: Vec<f64> = (0..24).map(|k| (2.0 * fourier.azimuth(k)).cos()).collect();
        // a speed that differs by 3 % from the still one, and is found by the passes
        let found = lag.follow(0, &[1.03; 24], &forcing);
        let r = 1.03 * rate;
        let gain = r / (r * r + 4.0);
        for (k, own) in found.iter().enumerate() {
            let psi = fourier.azimuth(k);
            let exact = gain * (r * (2.0 * psi).cos() + 2.0 * (2.0 * psi).sin());
            assert!((own - exact).abs() < 1e-6, "{own} {exact}");
        }
        Ok(())
    }
}
