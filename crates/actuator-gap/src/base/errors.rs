//! Errors of the base model: noise of the reading, structure it leaves, and how long that keeps its sign.

use crate::record::Record;
use model_gap::cosine_lines;
use rotor_base::{mean_square, variance};
use std::collections::BTreeMap;

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

/// Power spectrum of the structural error of runs over the variance of their outputs, one-sided, by half octaves.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ErrorSpectrum {
    /// Level by band, s; band `b` begins at `2^(b / 2)` Hz.
    levels_s: BTreeMap<i32, f64>,
}

impl ErrorSpectrum {
    /// From what a model leaves of runs where they are judged: the mean over the lines of a band of all runs, less noise.
    ///
    /// ```text
    /// S(f) = 2 h mean (c_k^2 - noise^2) / mean var y,   f = k / (2 n h),   c_k the orthonormal cosine transform
    /// ```
    /// Its integral over frequency is the structural error's variance over that of the output.
    pub(super) fn of<'r>(left: impl Iterator<Item = (&'r Record, Vec<f64>)>) -> Self {
        let mut bands: BTreeMap<i32, (f64, f64)> = BTreeMap::new();
        for (run, residual) in left {
            let noise = white_noise(&residual).powi(2);
            let own = variance(run.judged_output());
            for (k, line) in cosine_lines(&residual).iter().enumerate() {
                let sums = bands.entry(band(k, residual.len(), run.step_s)).or_default();
                sums.0 += 2.0 * run.step_s * (line * line - noise);
                sums.1 += own;
            }
        }
        let level = |(power, variance): (f64, f64)| {
            if variance > 0.0 { (power / variance).max(0.0) } else { 0.0 }
        };
        Self { levels_s: bands.into_iter().map(|(band, sums)| (band, level(sums))).collect() }
    }

    /// Variance of each line of `samples` samples of a step, over that of the output; the nearest band where the runs
    /// had none.
    pub(super) fn lines(&self, samples: usize, step_s: f64) -> impl Iterator<Item = f64> {
        (0..samples).map(move |k| {
            let at = band(k, samples, step_s);
            let slower = self.levels_s.range(..=at).next_back();
            let level_s = slower.or_else(|| self.levels_s.iter().next()).map_or(0.0, |own| *own.1);
            0.5 * level_s / step_s
        })
    }
}

/// Band of line `k` of `samples` samples of a step; the mean counts to the slowest.
#[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
fn band(k: usize, samples: usize, step_s: f64) -> i32 {
    let hz = (k as f64).max(0.5) / (2.0 * samples as f64 * step_s);
    (2.0 * hz.log2()).floor() as i32
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A slow error and white noise: the spectrum holds the error's variance, where it is, whatever the step.
    #[test]
    fn the_spectrum_holds_the_error_where_it_is() {
        let n = 4000;
        let mut state = 1_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let time_s = |i: usize| i as f64 * 1e-3;
        let output: Vec<f64> = (0..n).map(|i| 10.0 * (TAU * 0.5 * time_s(i)).sin()).collect();
        let error: Vec<f64> =
            (0..n).map(|i| 0.2 * (TAU * 3.0 * time_s(i)).cos() + 0.1 * uniform()).collect();
        let run = Record::new("sine", 1e-3, output.clone(), output);
        let spectrum = ErrorSpectrum::of(std::iter::once((&run, error)));
        for (step_s, samples) in [(1e-3, 4000), (4e-3, 1000)] {
            let lines: Vec<f64> = spectrum.lines(samples, step_s).collect();
            let hz = |k: usize| k as f64 / (2.0 * samples as f64 * step_s);
            let within = |low: f64, high: f64| -> f64 {
                let inside = |(k, _): &(usize, &f64)| (low..high).contains(&hz(*k));
                lines.iter().enumerate().filter(inside).map(|own| own.1).sum::<f64>()
                    / samples as f64
            };
            // 0.02 of error over 50 of output, in the half octave from 2.83 to 4 Hz
            assert!(
                (within(2.8, 4.01) / 4e-4 - 1.0).abs() < 0.05,
                "{step_s}: {}",
                within(2.8, 4.01)
            );
            assert!(within(8.0, 1e3) < 4e-6, "{step_s}: {}", within(8.0, 1e3));
        }
    }
}
