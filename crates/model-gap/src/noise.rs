//! Measurement noise from repeated cycles.

use crate::{GapError, error, misfit::mean};

/// Measurement noise, estimated from what differs between repetitions of one cycle.
///
/// ```text
/// variance = sum_{k,n} (y_kn - mean_k y_kn)^2 / (N (K - 1)),     K blocks of N samples
/// ```
/// Unbiased for noise that is independent between blocks, whatever the wave: no model enters. A
/// block is the smallest number of cycles that fills a whole number of samples.
///
/// Assumes: the response is steady. A drift counts as noise; [`NoiseEstimate::drift`] shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseEstimate {
    /// Noise variance, in the output's unit squared.
    pub variance: f64,
    /// Degrees of freedom `N (K - 1)`: the relative standard error of the variance is about
    /// `sqrt(2 / degrees_of_freedom)`.
    pub degrees_of_freedom: usize,
    /// Blocks compared, `K`.
    pub blocks: usize,
    /// Cycles in each block.
    pub cycles_per_block: usize,
    /// Samples in each block, `N`.
    pub block_samples: usize,
    /// Mean of the last block minus mean of the first, in the output's unit.
    pub drift: f64,
}

/// Cycles tried to fill a whole number of samples.
const LONGEST_BLOCK: usize = 50;

/// Phase slip allowed over the whole record, in samples.
const LARGEST_SLIP: f64 = 1e-3;

impl NoiseEstimate {
    /// Noise of a steady periodic record; time step in s, frequency in Hz. The transient must have
    /// been cut off.
    ///
    /// # Errors
    /// [`GapError::NoRepeat`] if cycles never fall on the same sampling instants,
    /// [`GapError::TooFewCycles`] for fewer than two blocks, and what makes no record.
    pub fn from_cycles(
        samples: &[f64],
        time_step_s: f64,
        frequency_hz: f64,
    ) -> Result<Self, GapError> {
        error::check_positive("time step (s)", time_step_s)?;
        error::check_positive("fundamental frequency (Hz)", frequency_hz)?;
        error::check_record("record", samples, 2)?;
        let samples_per_cycle = 1.0 / (time_step_s * frequency_hz);
        let cycles = samples.len() as f64 / samples_per_cycle;
        if cycles < 2.0 - LARGEST_SLIP {
            let what = "a noise estimate";
            return Err(GapError::TooFewCycles { what, cycles, needed: 2 });
        }
        let repeats = |block: usize| {
            let exact = block as f64 * samples_per_cycle;
            let slip = (exact - exact.round()).abs() * samples.len() as f64 / exact;
            slip <= LARGEST_SLIP && exact.round() >= 1.0
        };
        let Some(cycles_per_block) = (1..=LONGEST_BLOCK).find(|&block| repeats(block)) else {
            return Err(GapError::NoRepeat { samples_per_cycle, tried: LONGEST_BLOCK });
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "positive, whole, and no more than the record is long or the next check refuses it"
        )]
        let block_samples = (cycles_per_block as f64 * samples_per_cycle).round() as usize;
        let blocks = samples.len() / block_samples;
        if blocks < 2 {
            let (what, needed) = ("a noise estimate", 2 * cycles_per_block);
            return Err(GapError::TooFewCycles { what, cycles, needed });
        }
        let at = |block: usize, n: usize| samples[block * block_samples + n];
        let mut sum = 0.0;
        for n in 0..block_samples {
            let centre = (0..blocks).map(|k| at(k, n)).sum::<f64>() / blocks as f64;
            sum += (0..blocks).map(|k| (at(k, n) - centre).powi(2)).sum::<f64>();
        }
        let degrees_of_freedom = block_samples * (blocks - 1);
        let last = (blocks - 1) * block_samples;
        Ok(Self {
            variance: sum / degrees_of_freedom as f64,
            degrees_of_freedom,
            blocks,
            cycles_per_block,
            block_samples,
            drift: mean(&samples[last..last + block_samples]) - mean(&samples[..block_samples]),
        })
    }

    /// Standard deviation of the noise, in the output's unit.
    pub fn std(&self) -> f64 {
        self.variance.sqrt()
    }

    /// The drift in units of what white noise alone would make of it:
    /// `drift / sqrt(2 variance / N)`. Beyond about 4 the record is not steady. Zero without noise and
    /// drift.
    pub fn drift_in_sigmas(&self) -> f64 {
        if self.drift == 0.0 {
            0.0
        } else {
            self.drift / (2.0 * self.variance / self.block_samples as f64).sqrt()
        }
    }
}
