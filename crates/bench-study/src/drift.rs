//! Drift of the instrument, from readings in saturation.

use preisach_dyn::PreisachError;
use preisach_dyn::forc::ForcData;
use serde::{Deserialize, Serialize};

/// What drifts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum DriftKind {
    /// The sensitivity: outputs are multiplied by mean reading over present reading.
    #[default]
    Gain,
    /// The zero: mean reading minus present reading is added to the outputs.
    Offset,
}

/// Curves with the drift of the instrument taken off.
///
/// ```text
/// c(t)   moving average of 2 half_window + 1 readings, straight between them
/// Gain:    y <- y mean(c) / c(t)        Offset:  y <- y + mean(c) - c(t)
/// ```
/// `t` counts all points in the order measured, a calibration reading being one point: the
/// instrument is assumed to take equal time for each. Without readings nothing changes.
/// The corrected family carries no readings: they have been used.
///
/// # Errors
/// As [`ForcData::check`]; [`PreisachError::OutOfRange`] if the gain is asked for and a reading
/// has not the sign of their mean.
pub fn without_drift(
    data: &ForcData,
    kind: DriftKind,
    half_window: usize,
) -> Result<ForcData, PreisachError> {
    data.check()?;
    let mut corrected = ForcData { curves: data.curves.clone(), calibration: Vec::new() };
    if data.calibration.is_empty() {
        return Ok(corrected);
    }
    let readings: Vec<f64> = data.calibration.iter().map(|c| c.output).collect();
    let mean = readings.iter().sum::<f64>() / readings.len() as f64;
    if kind == DriftKind::Gain {
        for reading in &readings {
            let value = reading / mean;
            if !(value.is_finite() && value > 0.0) {
                let quantity = "calibration reading over the mean reading";
                let expected = "a positive finite number".into();
                return Err(PreisachError::OutOfRange { quantity, value, expected });
            }
        }
    }
    let smooth: Vec<f64> = (0..readings.len())
        .map(|i| {
            // the same number of readings on both sides, so that a steady drift is kept
            let half = half_window.min(i).min(readings.len() - 1 - i);
            let window = &readings[i - half..=i + half];
            window.iter().sum::<f64>() / window.len() as f64
        })
        .collect();
    for (index, curve) in corrected.curves.iter_mut().enumerate() {
        let here = smooth[index];
        let next = smooth.get(index + 1).copied().unwrap_or(here);
        let points = curve.output.len() as f64 + 1.0;
        for (place, output) in curve.output.iter_mut().enumerate() {
            let now = here + (next - here) * (place as f64 + 1.0) / points;
            match kind {
                DriftKind::Gain => *output *= mean / now,
                DriftKind::Offset => *output += mean - now,
            }
        }
    }
    Ok(corrected)
}
