//! The default parts of records: which train, which test.

use crate::check::extremes;
use crate::identify::{BenchRecord, Drive, RecordUse, Waveform};
use serde::{Deserialize, Serialize};

/// Which records train and which test, where the data set does not say.
///
/// Trained: everything quasi-static, and single-harmonic records at `trained_hz` whose amplitude is
/// the largest or the smallest of that frequency. Everything else is held out: by experiment, never
/// by sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SplitRule {
    /// Up to this frequency a record is quasi-static, Hz.
    pub quasi_static_hz: f64,
    /// Frequencies to train at, Hz.
    pub trained_hz: Vec<f64>,
}

impl Default for SplitRule {
    /// Quasi-static to 0.5 Hz; trained at 1 and 10 Hz, the paper's choice.
    fn default() -> Self {
        Self { quasi_static_hz: 0.5, trained_hz: vec![1.0, 10.0] }
    }
}

impl SplitRule {
    /// Whether a command is quasi-static.
    pub fn is_quasi_static(&self, drive: &Drive) -> bool {
        drive.strongest_hz() <= self.quasi_static_hz
    }

    /// The use of every record, in order; what a record says itself goes first.
    pub fn uses(&self, records: &[BenchRecord], drives: &[Drive]) -> Vec<RecordUse> {
        let near = |drive: &Drive, hz: f64| {
            drive.waveform == Waveform::SingleHarmonic
                && (drive.strongest_hz() / hz - 1.0).abs() <= 0.05
        };
        records
            .iter()
            .zip(drives)
            .map(|(record, drive)| {
                if let Some(given) = record.record_use {
                    return given;
                }
                let extreme = self.trained_hz.iter().any(|&hz| {
                    let amplitudes =
                        drives.iter().filter(|d| near(d, hz)).map(|d| d.amplitude_volt);
                    let [low, high] = extremes(amplitudes);
                    let own = drive.amplitude_volt;
                    near(drive, hz) && (own <= 1.02 * low || own >= 0.98 * high)
                });
                if extreme || (self.is_quasi_static(drive) && drive.waveform != Waveform::Constant)
                {
                    RecordUse::Train
                } else {
                    RecordUse::HeldOut
                }
            })
            .collect()
    }
}
