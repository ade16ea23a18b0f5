//! Errors of the base model: noise of the reading, structure it leaves, and how long that keeps its sign.

use crate::record::Record;
use rotor_base::{mean_square, variance};

/// What the base model leaves on one run, and how that error is made.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ErrorModel {
    /// White noise of the reading, output's unit.
    pub(crate) noise: f64,
    /// Structural error of the model, output's unit, rms.
    pub(crate) structure: f64,
    /// Samples over which the structural error keeps its sign.
    pub(crate) correlation: f64,
}

impl ErrorModel {
    /// Standard deviation that an independent sample would need to weigh as little.
    pub(crate) fn effective(&self) -> f64 {
        (self.noise.powi(2) + self.correlation * self.structure.powi(2)).sqrt()
    }
}

pub(super) fn pooled_spread(runs: &[&Record]) -> f64 {
    let count: usize = runs.iter().map(|r| r.judged_output().len()).sum();
    let sum: f64 =
        runs.iter().map(|r| variance(r.judged_output()) * r.judged_output().len() as f64).sum();
    (sum / count.max(1) as f64).sqrt()
}

/// White noise under a smooth residual: rms of its second differences over the root of 6, robustly
/// from the median, so that a few jumps do not count.
pub(crate) fn white_noise(residual: &[f64]) -> f64 {
    let mut sizes: Vec<f64> =
        residual.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    // median of |N(0,1)| is 0.6745
    *median / 0.6745 / 6.0_f64.sqrt()
}

/// Integrated correlation of a residual without its noise, samples: one and twice the sum of the
/// correlations up to the first that is not positive.
pub(super) fn correlation_samples(residual: &[f64], noise: f64) -> f64 {
    let n = residual.len();
    let total = mean_square(residual);
    let smooth = total - noise * noise;
    if smooth <= 0.05 * total {
        return 1.0;
    }
    let mut sum = 1.0;
    let mut lag = 1;
    let mut step = 1;
    while lag < n / 4 {
        let products: f64 = residual.iter().zip(&residual[lag..]).map(|(a, b)| a * b).sum::<f64>()
            / (n - lag) as f64;
        let rho = products / smooth;
        if rho <= 0.05 {
            break;
        }
        sum += 2.0 * rho.min(1.0) * step as f64;
        if lag >= 16 {
            step = lag / 8;
        }
        lag += step;
    }
    sum
}
