//! `dataset.ron`: what the files of a data folder are.

use serde::{Deserialize, Serialize};

/// The kinds of data folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum DatasetKind {
    /// Voltage and displacement of a piezo actuator on a bench.
    ActuatorBench,
}

/// What a run is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RunRole {
    /// A record of the actuator as it is: models are identified from it.
    Reference,
    /// A record to be explained: simulations are compared with it.
    Measured,
}

/// Which side of the split a run is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RunUse {
    /// Models may be fitted to it.
    Train,
    /// Models are only tested on it.
    HeldOut,
}

/// `dataset.ron` as users write it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DatasetFile {
    /// Kind of the data folder.
    pub kind: DatasetKind,
    /// One line about the data, printed wherever they are used.
    pub title: String,
    /// The records.
    pub runs: Vec<RunFile>,
    /// Equivalent flap angle per displacement, deg/um, positive; without it, identification sets the
    /// gain so that the slowest full-scale loop is +-10 deg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flap_deg_per_um: Option<f64>,
    /// Voltages the actuator may see, V, lower limit first.
    #[serde(default = "apa500l_range", rename = "command_range_V")]
    pub command_range_volt: (f64, f64),
}

/// One record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunFile {
    /// Name of the run, unique in the data set.
    pub id: String,
    /// File beside `dataset.ron`.
    pub file: String,
    /// What the run is for.
    pub role: RunRole,
    /// What was done.
    #[serde(default)]
    pub note: String,
    /// Seconds since switch-on at which the record begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_s: Option<f64>,
    /// Side of the split; without it, identification splits by the rule it prints.
    #[serde(default, rename = "use", skip_serializing_if = "Option::is_none")]
    pub use_as: Option<RunUse>,
}

/// Range of an APA500L-like stack, V.
fn apa500l_range() -> (f64, f64) {
    (-20.0, 150.0)
}
