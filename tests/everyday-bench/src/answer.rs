//! The answer to a set: for the scorer alone, never in the data folders.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::family::Family;
use crate::hidden::Kind;

/// A number with its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// The value.
    pub value: f64,
    /// Its unit.
    pub unit: String,
}

/// The answer to a set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Family of the hysteresis.
    pub family: Family,
    /// Seed of actuator, hidden thing and noise.
    pub seed: u64,
    /// Signal to noise ratio, dB.
    pub snr_db: f64,
    /// Id of what is hidden: `null`, an effect, two joined by `+`.
    pub hidden: String,
    /// Its kind.
    pub kind: Kind,
    /// Names of a diagnosis that are right; empty where none is.
    pub truths: Vec<String>,
    /// The closest class of one hidden thing; none where no class is right, and for two.
    pub class: Option<String>,
    /// All right classes: those of [`Self::class`], of the right name, of both parts of a pair, and the wider one of a
    /// lag on either side of the terminals.
    pub classes: Vec<String>,
    /// Rms of what is hidden over rms of the output, all samples of the driven runs weighted by run.
    pub effect_share: f64,
    /// Standard deviation of the noise of the displacement, um.
    pub noise_um: f64,
    /// Whether `amplifier_V` is a column.
    pub monitored: bool,
    /// True parameters by name of the effect, then by name.
    pub parameters: BTreeMap<String, BTreeMap<String, Quantity>>,
}
