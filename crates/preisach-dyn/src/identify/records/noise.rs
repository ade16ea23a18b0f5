//! Noise from what does not repeat, without any model.

use crate::check::extremes;
use crate::identify::BenchRecord;
use crate::laws::play_map::split;
use rotor_base::{mean_square, significant};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

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

/// What a record at rest says of its output.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct RestNoise {
    /// Standard deviation about a straight line, hum taken off, deg.
    pub std_deg: f64,
    /// Slope of that line, deg/min.
    pub drift_deg_per_min: f64,
    /// Amplitude of the hum of the mains, deg; 0 where none stands out.
    pub hum_deg: f64,
    /// Its frequency, Hz: 50 or 60.
    pub hum_hz: f64,
}

/// Frequencies of mains, Hz.
const MAINS_HZ: [f64; 2] = [50.0, 60.0];
/// Periods of the mains that a record holds at least for hum to be looked for.
const LEAST_PERIODS: f64 = 5.0;
/// How far a hum stands out from what noise puts at its frequency, in standard deviations.
const HUM_SIGMAS: f64 = 5.0;

impl RestNoise {
    /// The noise of a record at rest, where it is judged.
    pub fn of_record(record: &BenchRecord) -> Self {
        Self::of(&record.output_deg[record.judged_samples()], record.time_step_s)
    }

    /// The noise of the output of a record at rest.
    pub(crate) fn of(output_deg: &[f64], time_step_s: f64) -> Self {
        let count = output_deg.len() as f64;
        let middle = 0.5 * (count - 1.0);
        let mean = output_deg.iter().sum::<f64>() / count;
        let along: f64 =
            output_deg.iter().enumerate().map(|(i, y)| (i as f64 - middle) * (y - mean)).sum();
        let slope = along / (count * (count * count - 1.0) / 12.0).max(f64::MIN_POSITIVE);
        let left = |(i, y): (usize, &f64)| y - mean - slope * (i as f64 - middle);
        let left: Vec<f64> = output_deg.iter().enumerate().map(left).collect();
        let variance = mean_square(&left);
        let hums = MAINS_HZ.map(|hz| {
            let (per_sample, periods) = (hz * time_step_s, hz * time_step_s * count);
            if per_sample > 0.4 || periods < LEAST_PERIODS {
                return (0.0, hz);
            }
            let (mut sine, mut cosine) = (0.0, 0.0);
            for (i, y) in left.iter().enumerate() {
                let (s, c) = (TAU * (per_sample * i as f64).fract()).sin_cos();
                sine += s * y;
                cosine += c * y;
            }
            (2.0 * sine.hypot(cosine) / count, hz)
        });
        let (size, hum_hz) = if hums[1].0 > hums[0].0 { hums[1] } else { hums[0] };
        let rest = (variance - 0.5 * size * size).max(0.0);
        // white noise has an amplitude of sqrt(2 / n) times its deviation at any one frequency, in either phase
        let stands_out = size > HUM_SIGMAS * (2.0 * rest / count).sqrt() && size > 0.0;
        Self {
            std_deg: if stands_out { rest.sqrt() } else { variance.sqrt() },
            drift_deg_per_min: slope / time_step_s * 60.0,
            hum_deg: if stands_out { size } else { 0.0 },
            hum_hz,
        }
    }
}

impl RestNoise {
    /// Root mean square of noise and hum, deg: what no model of the actuator follows.
    pub fn rms_deg(&self) -> f64 {
        self.std_deg.hypot(self.hum_deg * FRAC_1_SQRT_2)
    }

    /// It in words, with the symbol of the unit of the output.
    pub fn words(&self, output: &str) -> String {
        let Self { std_deg, drift_deg_per_min, hum_deg, hum_hz } = *self;
        let [noise, drift, hum] =
            [std_deg, drift_deg_per_min, hum_deg].map(|value| significant(value, 3));
        let words = format!("noise {noise} {output} rms, drift {drift} {output}/min");
        if hum > 0.0 { format!("{words}, hum {hum} {output} at {hum_hz} Hz") } else { words }
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
    /// Root mean square of noise and rounding, deg.
    pub(crate) fn rms_deg(&self) -> f64 {
        self.std_deg.max(self.quantum_deg / 12.0_f64.sqrt())
    }

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
    use chacha20::ChaCha8Rng;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    #[test]
    fn a_rest_tells_noise_drift_and_hum() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let normal = Normal::new(0.0, 0.02).unwrap();
        let mut rest = |hum: f64| -> RestNoise {
            let sample = |i: u32| {
                let time = 1e-3 * f64::from(i);
                400.0 + 0.01 * time + hum * (TAU * 60.0 * time).sin() + normal.sample(&mut rng)
            };
            RestNoise::of(&(0..20_000).map(sample).collect::<Vec<f64>>(), 1e-3)
        };
        let found = rest(0.01);
        assert!((found.std_deg / 0.02 - 1.0).abs() < 0.03, "{found:?}");
        assert!((found.drift_deg_per_min - 0.6).abs() < 0.02, "{found:?}");
        assert!((found.hum_deg - 0.01).abs() < 1e-3 && (found.hum_hz - 60.0).abs() < 1e-9);
        assert!(rest(0.0).hum_deg <= 0.0);
    }

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
