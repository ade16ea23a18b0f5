//! Bench records.

use crate::actuator::model::SAMPLE_TOLERANCE;
use crate::check::check_positive;
use crate::{PreisachError, VoltageRange};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Whether a record trains the model or tests it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordUse {
    /// The identification may look at it.
    Train,
    /// Kept aside; only the finished model is compared with it.
    HeldOut,
}

/// The parts of a record that train and that judge, as samples.
///
/// Whatever they are, a record is always simulated from its first sample, so that the memory is what
/// the whole history made of it.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RecordWindows {
    /// Samples that train; none: all of them.
    pub train: Option<Range<usize>>,
    /// Samples the model is judged by; none: all of them.
    pub judge: Option<Range<usize>>,
}

/// One bench record: equally spaced samples of command and output.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BenchRecord {
    /// Name, used in reports and messages.
    pub id: String,
    /// Time between samples, s.
    pub time_step_s: f64,
    /// Command, V.
    pub voltage_volt: Vec<f64>,
    /// Measured output as equivalent flap angle, deg: displacement times the bench gain.
    pub output_deg: Vec<f64>,
    /// Training or test; none leaves it to [`crate::identify::SplitRule`].
    pub record_use: Option<RecordUse>,
    /// Frequency of the command's period, Hz; none has it found from the command.
    pub base_frequency_hz: Option<f64>,
    /// Parts that train and judge.
    pub windows: RecordWindows,
}

/// The fewest samples a record may have.
const FEWEST_SAMPLES: usize = 16;

impl BenchRecord {
    /// Checks lengths, numbers and range.
    ///
    /// # Errors
    /// [`PreisachError::UnequalColumns`], [`PreisachError::TooFew`],
    /// [`PreisachError::NotPositive`], [`PreisachError::BadRecord`].
    pub fn check(&self, range: VoltageRange) -> Result<(), PreisachError> {
        let (voltages, outputs) = (self.voltage_volt.len(), self.output_deg.len());
        if voltages != outputs {
            return Err(PreisachError::UnequalColumns { id: self.id.clone(), voltages, outputs });
        }
        if voltages < FEWEST_SAMPLES {
            return Err(PreisachError::TooFew {
                quantity: "samples of a record",
                value: voltages,
                least: FEWEST_SAMPLES,
            });
        }
        check_positive("time_step_s", self.time_step_s)?;
        if let Some(hz) = self.base_frequency_hz {
            check_positive("base_frequency_hz", hz)?;
        }
        let bad = |index: usize, problem: &'static str, value: f64| {
            Err(PreisachError::BadRecord { id: self.id.clone(), index, problem, value })
        };
        let tolerance = SAMPLE_TOLERANCE * range.span_volt();
        for (index, (&u, &y)) in self.voltage_volt.iter().zip(&self.output_deg).enumerate() {
            if !u.is_finite() {
                return bad(index, "the voltage is not a finite number", u);
            }
            if !y.is_finite() {
                return bad(index, "the output is not a finite number", y);
            }
            if range.excess_volt(u) > tolerance {
                return bad(index, "the voltage is outside the actuator's range", u);
            }
        }
        if spread(&self.output_deg) == 0.0 {
            return bad(0, "the output never changes", self.output_deg[0]);
        }
        for window in [&self.windows.train, &self.windows.judge].into_iter().flatten() {
            if window.end > outputs || window.len() < FEWEST_SAMPLES {
                return Err(PreisachError::BadWindow {
                    id: self.id.clone(),
                    start: window.start,
                    end: window.end,
                    samples: outputs,
                });
            }
        }
        Ok(())
    }

    /// The samples that train.
    pub fn trained_samples(&self) -> Range<usize> {
        self.windows.train.clone().unwrap_or(0..self.output_deg.len())
    }

    /// The samples the model is judged by.
    pub fn judged_samples(&self) -> Range<usize> {
        self.windows.judge.clone().unwrap_or(0..self.output_deg.len())
    }
}

/// Standard deviation.
pub(crate) fn spread(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}
