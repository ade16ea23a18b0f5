//! `dataset.ron`: what the files of a data folder are.

use super::accuracy::Accuracy;
use crate::tables::ChannelFile;
use rotor_base::RecordUse;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The kinds of data folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum DatasetKind {
    /// Voltage and displacement of a piezo actuator on a bench.
    ActuatorBench,
    /// Any input and any output of a hysteretic system, in the units of the header.
    GenericLoop,
    /// First-order reversal curves, quasi-static: a curve number instead of a time.
    ReversalCurves,
    /// Points of test of a rotor: one table, a row for each point.
    RotorSweep,
    /// Frequencies of a blade: one table, a row for each mode at each rotor speed.
    BladeFrequencies,
    /// Loads of an oscillating section: one table, a row for each motion, or histories.
    SectionLoops,
}

impl DatasetKind {
    /// Kinds of one table of points, each with columns that all of its tables have.
    pub const OF_POINTS: [(Self, &'static [&'static str]); 3] = [
        (Self::RotorSweep, &["advance_ratio"]),
        (Self::BladeFrequencies, &["rotor_speed_rpm", "mode", "frequency_hz"]),
        (Self::SectionLoops, &["reduced_frequency", "mach"]),
    ];

    /// Columns of such a table that hold words.
    pub fn words(self) -> &'static [&'static str] {
        match self {
            Self::BladeFrequencies => &["mode"],
            Self::SectionLoops => &["motion", "loop"],
            _ => &[],
        }
    }
}

/// What a run is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum RunRole {
    /// A record of the actuator as it is: models are identified from it.
    #[default]
    Reference,
    /// A record to be explained: simulations are compared with it.
    Measured,
}

/// Which sensor read the output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Sensor {
    /// The sensor of the bench.
    #[default]
    Bench,
    /// A second one that reads the motion as it is, such as a laser.
    Ideal,
}

/// How the system was fitted to the bench.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Fitting {
    /// As always.
    #[default]
    Plain,
    /// The lever was preloaded, so that no joint has play.
    Preloaded,
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
    /// gain so that the slowest full-scale loop is +-10 deg. `ActuatorBench` only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flap_deg_per_um: Option<f64>,
    /// Voltages the actuator may see, V, lower limit first; without it those of an APA500L-like
    /// stack, -20 to 150 V. `ActuatorBench` only.
    #[serde(default, rename = "command_range_V", skip_serializing_if = "Option::is_none")]
    pub command_range_volt: Option<(f64, f64)>,
    /// How well the channels keep their calibration; without it the usual of a bench. `ActuatorBench` only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Which column is the input; without it the first one besides the time. Not `ActuatorBench`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input: Option<ChannelFile>,
    /// Which column is the output; without it the second one besides the time. Not `ActuatorBench`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output: Option<ChannelFile>,
    /// Inputs the system may see, in the unit of the input, lower limit first; without it from the
    /// smallest to the largest input of all runs. Not `ActuatorBench`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_range: Option<(f64, f64)>,
}

impl DatasetFile {
    /// A data set of a kind, with what all kinds have.
    pub fn of(kind: DatasetKind, title: String, runs: Vec<RunFile>) -> Self {
        Self {
            kind,
            title,
            runs,
            flap_deg_per_um: None,
            command_range_volt: None,
            accuracy: None,
            input: None,
            output: None,
            input_range: None,
        }
    }
}

/// One record.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
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
    pub use_as: Option<RecordUse>,
    /// Times of the record, s, between which it trains or is judged; simulations still begin at its
    /// first sample. A file may be used by several runs with different windows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window_s: Option<(f64, f64)>,
    /// Sensor that read the output; left out, the sensor of the bench. Not `ReversalCurves`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<Sensor>,
    /// How the system was fitted; left out, as always. Not `ReversalCurves`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fitting: Option<Fitting>,
    /// What was held constant: names with unit and numbers, such as `"temperature_C": 40`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub conditions: BTreeMap<String, f64>,
    /// Table of the drift calibration, one row per curve. `ReversalCurves` only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<String>,
}

/// Range of an APA500L-like stack, V: that of an `ActuatorBench` which names none.
pub const DEFAULT_COMMAND_RANGE_VOLT: (f64, f64) = (-20.0, 150.0);
