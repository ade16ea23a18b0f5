//! How well the channels of a bench keep their calibration from one session to the next.

use serde::{Deserialize, Serialize};

/// Gain and zero of one channel: standard deviations of what they change by from session to session.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DisplacementAccuracy {
    /// Of the gain, percent, `>= 0`.
    pub gain_percent: f64,
    /// Of the zero, um, `>= 0`.
    pub zero_um: f64,
}

/// The same of a voltage.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VoltageAccuracy {
    /// Of the gain, percent, `>= 0`.
    pub gain_percent: f64,
    /// Of the zero, V, `>= 0`.
    #[serde(rename = "zero_V")]
    pub zero_volt: f64,
}

/// Calibration of the channels of a bench from one session to the next, as standard deviations.
///
/// What is larger than these is a finding; what is not is nobody's fault. The defaults are those of a bench that is
/// looked after: 0.2 % and 1 um of a displacement sensor, 0.2 % and 0.3 V of an amplifier, 0.5 % and 0.5 V of a voltage
/// monitor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Accuracy {
    /// The sensor of the output.
    pub displacement: DisplacementAccuracy,
    /// The amplifier: terminal voltage over command.
    pub amplifier: VoltageAccuracy,
    /// The monitor of the terminal voltage.
    pub monitor: VoltageAccuracy,
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            displacement: DisplacementAccuracy { gain_percent: 0.2, zero_um: 1.0 },
            amplifier: VoltageAccuracy { gain_percent: 0.2, zero_volt: 0.3 },
            monitor: VoltageAccuracy { gain_percent: 0.5, zero_volt: 0.5 },
        }
    }
}

impl Accuracy {
    /// Every channel as it was, to the last digit.
    pub const EXACT: Self = Self {
        displacement: DisplacementAccuracy { gain_percent: 0.0, zero_um: 0.0 },
        amplifier: VoltageAccuracy { gain_percent: 0.0, zero_volt: 0.0 },
        monitor: VoltageAccuracy { gain_percent: 0.0, zero_volt: 0.0 },
    };

    /// The numbers with their fields, for checks and reports.
    pub fn rows(&self) -> [(&'static str, f64, &'static str); 6] {
        [
            ("displacement.gain_percent", self.displacement.gain_percent, "%"),
            ("displacement.zero_um", self.displacement.zero_um, "um"),
            ("amplifier.gain_percent", self.amplifier.gain_percent, "%"),
            ("amplifier.zero_V", self.amplifier.zero_volt, "V"),
            ("monitor.gain_percent", self.monitor.gain_percent, "%"),
            ("monitor.zero_V", self.monitor.zero_volt, "V"),
        ]
    }
}
