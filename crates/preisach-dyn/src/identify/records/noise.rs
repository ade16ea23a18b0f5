//! Noise from what does not repeat, without any model.

use crate::check::extremes;
use crate::laws::play_map::split;
use serde::{Deserialize, Serialize};

/// What the repeated cycles of a record say about its noise.
///
/// ```text
/// d_i = y(i + period) - y(i),   y(i + period) straight between samples, p its fraction of a step
/// var d = sigma^2 [ 1 + (1 - p)^2 + p^2 ]        for white noise sigma
/// ```
/// The mean of `d` over a cycle is drift (creep, heating) and taken off first. No model and no
/// truncated series enters: what repeats drops out, whatever its shape.
///
/// Assumes: a steady response. What a transient leaves in the second cycle counts as noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CycleNoise {
    /// Standard deviation, deg.
    pub std_deg: f64,
    /// Mean change from one cycle to the next, deg.
    pub drift_deg_per_cycle: f64,
    /// Correlation of neighbouring samples of the noise, -1 to 1; near zero for white noise.
    pub autocorrelation: f64,
    /// Pairs of cycles compared.
    pub pairs: usize,
}

impl CycleNoise {
    /// The noise of steady samples with a period in samples; none for fewer than two cycles.
    pub(crate) fn of(samples: &[f64], period: f64) -> Option<Self> {
        let (whole, part) = split(period);
        let later = |i: usize| {
            let a = *samples.get(i + whole)?;
            if part > 1e-9 { Some(a + part * (samples.get(i + whole + 1)? - a)) } else { Some(a) }
        };
        let differences: Vec<f64> =
            (0..samples.len()).map_while(|i| Some(later(i)? - samples[i])).collect();
        // all but a cycle is compared with its successor; the last one may miss a sample
        let pairs = (differences.len() + 1) / whole.max(1);
        if pairs == 0 || differences.len() < 8 {
            return None;
        }
        let share = 1.0 + (1.0 - part) * (1.0 - part) + part * part;
        let (mut squares, mut products, mut drift) = (0.0, 0.0, 0.0);
        let chunk = differences.len().div_ceil(pairs);
        for cycle in differences.chunks(chunk) {
            let mean = cycle.iter().sum::<f64>() / cycle.len() as f64;
            drift += mean * cycle.len() as f64;
            squares += cycle.iter().map(|d| (d - mean).powi(2)).sum::<f64>();
            products += cycle.windows(2).map(|d| (d[0] - mean) * (d[1] - mean)).sum::<f64>();
        }
        let count = differences.len() as f64;
        Some(Self {
            std_deg: (squares / (count * share)).sqrt(),
            drift_deg_per_cycle: drift / count,
            autocorrelation: if squares > 0.0 { products / squares } else { 0.0 },
            pairs,
        })
    }
}

/// The fine grain of a signal: its white noise and the step it is rounded to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fine {
    /// Standard deviation of what is rough from sample to sample, deg.
    pub(crate) std_deg: f64,
    /// Step of the sensor, deg; 0 if the signal is not rounded.
    pub(crate) quantum_deg: f64,
}

impl Fine {
    /// From differences of neighbours alone, so that neither a model nor repeated cycles are needed.
    ///
    /// ```text
    /// t_i = y_(i+3) - 3 y_(i+2) + 3 y_(i+1) - y_i,   sigma = 1.4826 median |t| / sqrt(20)
    /// ```
    /// A parabola drops out, outliers do not count. Source: the normal-consistent median absolute
    /// deviation, F. R. Hampel, Journal of the American Statistical Association 69 (1974).
    pub(crate) fn of(values: &[f64]) -> Self {
        let thirds = values.windows(4).map(|v| (v[3] - v[0] + 3.0 * (v[1] - v[2])).abs());
        let std_deg = 1.4826 * median(thirds.collect()) / 20.0_f64.sqrt();
        // rounded: many neighbours are equal, and no other difference is smaller than a step
        let [low, high] = extremes(values.iter().copied());
        let least = 1e-9 * (high - low);
        let steps: Vec<f64> = values.windows(2).map(|v| (v[1] - v[0]).abs()).collect();
        let moved: Vec<f64> = steps.iter().copied().filter(|step| *step > least).collect();
        let smallest = moved.iter().copied().fold(f64::INFINITY, f64::min);
        let whole = |step: &f64| (step / smallest - (step / smallest).round()).abs() < 0.01;
        let small: Vec<f64> = moved.into_iter().filter(|step| *step < 20.0 * smallest).collect();
        let rounded = small.len() >= 8 && small.iter().all(whole);
        Self { std_deg, quantum_deg: if rounded { smallest } else { 0.0 } }
    }
}

/// The middle of some numbers; 0 of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() {
        return 0.0;
    }
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};

    #[test]
    fn white_noise_on_drifting_cycles_is_found_whatever_the_period() {
        for period in [200.0, 133.333_333] {
            let mut rng = ChaCha8Rng::seed_from_u64(11);
            let normal = Normal::new(0.0, 0.05).unwrap();
            let samples: Vec<f64> = (0..4000)
                .map(|i| {
                    let phase = std::f64::consts::TAU * f64::from(i) / period;
                    phase.sin()
                        + 0.3 * (3.0 * phase).cos().abs()
                        + 1e-4 * f64::from(i)
                        + normal.sample(&mut rng)
                })
                .collect();
            let noise = CycleNoise::of(&samples, period).unwrap();
            // 3800 differences: 2 % of statistical error; straight lines between samples add less
            assert!((noise.std_deg / 0.05 - 1.0).abs() < 0.06, "{period}: {noise:?}");
            assert!((noise.drift_deg_per_cycle - 1e-4 * period).abs() < 3e-3, "{noise:?}");
            assert!(noise.autocorrelation.abs() < 0.3, "{noise:?}");
        }
        assert!(CycleNoise::of(&[1.0; 30], 40.0).is_none());
    }
}
