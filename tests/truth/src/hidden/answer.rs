//! The answer to a set: what is hidden in it. For the scorer alone, never in the data folder.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A number with its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// The value.
    pub value: f64,
    /// Its unit.
    pub unit: String,
}

/// One hidden effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HiddenEffect {
    /// Its id.
    pub id: String,
    /// Its true parameters by name; empty outside the library.
    pub parameters: BTreeMap<String, Quantity>,
    /// Rms of what it alone changes, over the driven runs with equal weight, um.
    pub effect_um: f64,
    /// The same over the rms output of these runs.
    pub effect_share: f64,
}

/// What one run shows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunAnswer {
    /// Id of the run.
    pub id: String,
    /// Rms of what all hidden effects change, um.
    pub effect_um: f64,
    /// Rms of the displacement without them, um.
    pub output_um: f64,
}

/// The answer to a set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Seed of the set.
    pub seed: u64,
    /// Signal to noise ratio, dB.
    pub snr_db: f64,
    /// The base.
    pub base: u64,
    /// The design of the measured folder.
    pub design: String,
    /// Whether amplifier voltage, temperature and load are columns.
    pub monitored: bool,
    /// The id of what is hidden: `null`, a cause, `cause+cause`, `outside-...`.
    pub hidden: String,
    /// The effects, none for null.
    pub effects: Vec<HiddenEffect>,
    /// Standard deviation of the noise, um.
    pub noise_um: f64,
    /// Rms of what all effects together change, over the driven runs with equal weight, um.
    pub effect_um: f64,
    /// The same over the rms output of these runs.
    pub effect_share: f64,
    /// The runs of the measured folder.
    pub runs: Vec<RunAnswer>,
    /// The experiment that was added.
    pub experiment: Option<String>,
}
