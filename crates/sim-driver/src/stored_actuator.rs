//! Actuator files: an identified actuator with where it comes from and how well it fits.

use crate::SimError;
use crate::files::{RonFile, Source, read_ron, ron_text, write_atomic};
use crate::problem::{Fault, Problems};
use preisach_dyn::identify::Settings;
use preisach_dyn::{ActuatorLaw, ActuatorModel};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The kind of an actuator file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StoredKind {
    /// An actuator.
    Actuator,
}

/// An actuator file, as `hhc identify` writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredActuator {
    /// Kind of the file.
    pub kind: StoredKind,
    /// Title of the data it was identified from.
    pub title: String,
    /// Folder of the data.
    pub dataset: String,
    /// blake3 of the data.
    pub data_hash: String,
    /// Version of the program that wrote the file.
    pub program_version: String,
    /// Input and output of a model that is no actuator, with their units: they stand where the model
    /// says volt and deg. None for an actuator.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channels: Option<StoredChannels>,
    /// How it was identified.
    pub settings: Settings,
    /// How it fits.
    pub runs: Vec<StoredFit>,
    /// The model.
    pub model: ActuatorModel,
}

/// Input and output of a generic loop, names with units such as `displacement_in`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredChannels {
    /// The input.
    pub input: String,
    /// The output.
    pub output: String,
}

/// How the model fits one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredFit {
    /// The run.
    pub id: String,
    /// Side of the split.
    #[serde(rename = "use")]
    pub use_as: FitUse,
    /// Frequency of the strongest harmonic of the command, Hz.
    pub frequency_hz: f64,
    /// Half peak to peak of the command, V.
    #[serde(rename = "amplitude_V")]
    pub amplitude_volt: f64,
    /// RMS error over the standard deviation of the measured output, percent.
    pub nrmse_percent: f64,
    /// The same of the static model alone, percent.
    pub static_nrmse_percent: f64,
    /// Amplitude error, percent; none for transients.
    #[serde(default)]
    pub amplitude_error_percent: Option<f64>,
    /// Phase error, deg of harmonic phase, positive if the model lags too much; none for transients.
    #[serde(default)]
    pub phase_error_deg: Option<f64>,
    /// Share of the output's energy that is neither explained nor noise, percent; none without
    /// repeated cycles.
    #[serde(default)]
    pub structured_percent: Option<f64>,
}

/// Side of the split of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FitUse {
    /// The model was fitted to it.
    #[serde(rename = "trained", alias = "Trained")]
    Trained,
    /// The model has not seen it.
    #[serde(rename = "held_out", alias = "HeldOut")]
    HeldOut,
}

impl StoredActuator {
    /// Writes the file atomically.
    ///
    /// # Errors
    /// [`SimError::NotWritten`].
    pub fn write(&self, path: &Path) -> Result<(), SimError> {
        let text = ron_text(self).map_err(|e| SimError::NotWritten {
            path: path.to_path_buf(),
            reason: e.to_string(),
        })?;
        let comment = format!(
            "// Actuator identified by hhc {} from: {}\n// Written by `hhc identify`; identify again rather than edit.\n",
            self.program_version, self.title
        );
        write_atomic(path, text.replacen('\n', &format!("\n{comment}"), 1).as_bytes())
    }
}

/// Reads an actuator file and checks its model.
///
/// # Errors
/// Every problem of the file, with its line.
pub fn read_actuator(source: &Source) -> Result<StoredActuator, Problems> {
    let RonFile { value, index, mut problems } = read_ron::<StoredActuator>(source);
    if let Some(stored) = &value {
        let calibration = stored.model.calibration;
        let mut numbers = vec![
            ("model.calibration.deg_per_um", calibration.deg_per_um, calibration.deg_per_um != 0.0),
            ("model.calibration.zero_um", calibration.zero_um, true),
        ];
        if let ActuatorLaw::Linear(gain) = &stored.model.law {
            numbers.push(("model.law", gain.gain_deg_per_volt, gain.gain_deg_per_volt != 0.0));
            numbers.push(("model.law", gain.bias_volt, true));
        }
        for (field, value, ok) in numbers {
            if !(ok && value.is_finite()) {
                let message = format!("{value} is no actuator's number");
                problems.push(index.place(field), Fault::Refused { message });
            }
        }
    }
    problems.into_result(value)
}
