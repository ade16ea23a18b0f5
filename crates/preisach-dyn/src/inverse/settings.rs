//! What a periodic inverse is asked for, and its answer.

use crate::{PeriodicResponse, PeriodicSettings};
use serde::{Deserialize, Serialize};

/// Settings of a periodic inverse.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct InverseSettings {
    /// How orbits are simulated.
    pub periodic: PeriodicSettings,
    /// Harmonics of the voltage: as many harmonics of the flap are made right.
    pub voltage_harmonics: usize,
    /// Largest error of the mean and of every coefficient of these harmonics, deg.
    pub tolerance_deg: f64,
    /// Newton steps to try at one amplitude.
    pub largest_iterations: usize,
}

impl Default for InverseSettings {
    /// 48 harmonics to 1e-4 deg, within 25 steps: the corners that plays make at reversals need many.
    fn default() -> Self {
        Self {
            periodic: PeriodicSettings::default(),
            voltage_harmonics: 48,
            tolerance_deg: 1e-4,
            largest_iterations: 25,
        }
    }
}

/// A voltage and what it does.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicInverse {
    /// The closed orbit of the voltage found: voltage, flap, steps.
    pub response: PeriodicResponse,
    /// Largest error of the flap over the revolution, deg: what the harmonics beyond
    /// [`InverseSettings::voltage_harmonics`] leave.
    pub largest_error_deg: f64,
    /// Root mean square error over the revolution, deg.
    pub rms_error_deg: f64,
    /// Half peak to peak of the wanted motion, deg.
    pub amplitude_deg: f64,
    /// Newton steps in all.
    pub iterations: usize,
}
