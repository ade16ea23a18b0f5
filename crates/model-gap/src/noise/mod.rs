//! Measurement noise from repeated cycles; samples that have none of their own.

mod oversampling;

pub use oversampling::Thinning;

use crate::{GapError, error};

/// Cycles tried to fill a whole number of samples.
const LONGEST_BLOCK: usize = 50;

/// Phase slip allowed over the whole record, in samples.
const LARGEST_SLIP: f64 = 1e-3;

/// Variance of the measurement noise of a steady periodic record, in the output's unit squared, from what
/// differs between repetitions of one cycle; time step in s, frequency in Hz. The transient must have been
/// cut off.
///
/// ```text
/// variance = sum_{k,n} (y_kn - mean_k y_kn)^2 / (N (K - 1)),     K blocks of N samples
/// ```
/// Unbiased for noise that is independent between blocks, whatever the wave: no model enters. A block is
/// the smallest number of cycles that fills a whole number of samples. The relative standard error is about
/// `sqrt(2 / (N (K - 1)))`.
///
/// Assumes: the response is steady. A drift counts as noise.
///
/// # Errors
/// [`GapError::NoRepeat`] if cycles never fall on the same sampling instants,
/// [`GapError::TooFewCycles`] for fewer than two blocks, and what makes no record.
pub fn noise_variance(
    samples: &[f64],
    time_step_s: f64,
    frequency_hz: f64,
) -> Result<f64, GapError> {
    error::check_positive("time step (s)", time_step_s)?;
    error::check_positive("fundamental frequency (Hz)", frequency_hz)?;
    error::check_record("record", samples, 2)?;
    let samples_per_cycle = 1.0 / (time_step_s * frequency_hz);
    let cycles = samples.len() as f64 / samples_per_cycle;
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
    Ok(sum / (block_samples * (blocks - 1)) as f64)
}
