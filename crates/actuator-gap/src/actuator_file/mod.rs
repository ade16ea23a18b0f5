//! The content of an actuator file: a model with where it comes from and how well it fits.

pub(crate) mod at_work;
pub(crate) mod doubts;
pub(crate) mod history_inverse;

use doubts::Doubt;
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::Settings;
use rotor_base::RecordUse;
use serde::{Deserialize, Serialize};

/// The kind of an actuator file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StoredKind {
    /// An actuator.
    Actuator,
}

/// An actuator file, as `hhc identify` writes it, or written by hand: then the kind, a title and the
/// model are enough.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredActuator {
    /// Kind of the file.
    pub kind: StoredKind,
    /// Title of the data it was identified from.
    pub title: String,
    /// Folder of the data.
    #[serde(default)]
    pub dataset: String,
    /// blake3 of the data.
    #[serde(default)]
    pub data_hash: String,
    /// Version of the program that wrote the file.
    #[serde(default)]
    pub program_version: String,
    /// Input and output of a model that is no actuator, with their units: they stand where the model
    /// says volt and deg. None for an actuator.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channels: Option<StoredChannels>,
    /// Where the flap angle per displacement comes from; none if the file was written by hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<GainRule>,
    /// How it was identified.
    #[serde(default)]
    pub settings: Settings,
    /// How it fits.
    #[serde(default)]
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

/// Where the flap angle per displacement of an identified actuator comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum GainRule {
    /// `flap_deg_per_um` of the data set.
    DataSet,
    /// The widest slow loop was made +-10 deg, as the paper does.
    WidestSlowLoop,
    /// There was nothing to tell it: 1 deg/um.
    Assumed,
}

impl GainRule {
    /// The rule in words, for tables.
    pub fn text(self) -> &'static str {
        match self {
            Self::DataSet => "flap_deg_per_um of dataset.ron",
            Self::WidestSlowLoop => "so that the widest slow loop is +-10 deg",
            Self::Assumed => {
                "ASSUMED: no slow loop to scale by; give flap_deg_per_um in dataset.ron"
            }
        }
    }
}

/// How the model fits one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredFit {
    /// The run.
    pub id: String,
    /// Side of the split.
    #[serde(rename = "use")]
    pub use_as: RecordUse,
    /// Frequency of the strongest harmonic of the command, Hz.
    pub frequency_hz: f64,
    /// Half peak to peak of the command, V.
    #[serde(rename = "amplitude_V")]
    pub amplitude_volt: f64,
    /// RMS error over the standard deviation of the measured output, percent.
    pub nrmse_percent: f64,
    /// RMS error with its mean removed over the range of the measured output, percent.
    #[serde(default)]
    pub range_percent: Option<f64>,
    /// Mean error, measured less simulated, in the unit of the output.
    #[serde(default)]
    pub offset: Option<f64>,
    /// Largest error before the run's window over the range of the measured output, percent; none
    /// without a window that begins later than the record.
    #[serde(default)]
    pub start_up_percent: Option<f64>,
    /// RMS error before the run's window, about the mean error inside, over the same range, percent.
    #[serde(default)]
    pub start_up_rms_percent: Option<f64>,
    /// NRMSE of the static model alone, percent.
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
    /// Measured gain and lag at the strongest harmonic of the command; none for transients.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub response: Option<HarmonicResponse>,
}

/// Gain and lag of a measured output at one harmonic of its command, over the steady cycles judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HarmonicResponse {
    /// Amplitude of the output over that of the command, in the units of the data.
    pub gain: f64,
    /// Phase by which the output comes later, deg of that harmonic, -180 to 180.
    pub lag_deg: f64,
    /// Standard deviations of both, the lag in deg, for white noise of the size that repeated cycles
    /// show; none without repeated cycles.
    pub std_deviation: Option<[f64; 2]>,
}

impl StoredFit {
    /// Gain and lag, deg, of the model at the strongest harmonic of the command; none for transients.
    pub fn model_response(&self) -> Option<[f64; 2]> {
        let measured = self.response?;
        let ratio = 1.0 + self.amplitude_error_percent? / 100.0;
        Some([ratio * measured.gain, measured.lag_deg + self.phase_error_deg?])
    }
}

impl StoredActuator {
    /// Name and unit of its input: `command_V`, or those of the data of a generic loop.
    pub fn input_column(&self) -> String {
        self.channels.as_ref().map_or_else(|| "command_V".to_owned(), |own| own.input.clone())
    }

    /// The same of its output: `displacement_um`, or those of the data of a generic loop.
    pub fn output_column(&self) -> String {
        self.channels
            .as_ref()
            .map_or_else(|| "displacement_um".to_owned(), |own| own.output.clone())
    }

    /// What is impossible or unlikely about the actuator; nothing is known of that of a generic loop.
    pub fn doubts(&self) -> Vec<Doubt> {
        if self.channels.is_some() { Vec::new() } else { doubts::doubts(&self.model) }
    }
}
