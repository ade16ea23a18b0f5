//! How well the channels of a bench keep their calibration from one session to the next.

use serde::{Deserialize, Serialize};

/// Gain and zero of one channel: standard deviations of what they change by from session to session.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DisplacementAccuracy {
    /// Of the gain, percent, `>= 0`.
    pub gain_percent: f64,
    /// Of the zero, um, `>= 0`.
    pub zero_um: f64,
}

/// The same of a voltage.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
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
/// monitor. A file may give any of the numbers alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "Given")]
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

/// What a file gives.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Given {
    displacement: GivenDisplacement,
    amplifier: GivenVoltage,
    monitor: GivenVoltage,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct GivenDisplacement {
    gain_percent: Option<f64>,
    zero_um: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct GivenVoltage {
    gain_percent: Option<f64>,
    #[serde(rename = "zero_V")]
    zero_volt: Option<f64>,
}

impl From<Given> for Accuracy {
    fn from(given: Given) -> Self {
        let usual = Self::default();
        let voltage = |given: GivenVoltage, usual: VoltageAccuracy| VoltageAccuracy {
            gain_percent: given.gain_percent.unwrap_or(usual.gain_percent),
            zero_volt: given.zero_volt.unwrap_or(usual.zero_volt),
        };
        let Given { displacement: GivenDisplacement { gain_percent, zero_um }, .. } = given;
        Self {
            displacement: DisplacementAccuracy {
                gain_percent: gain_percent.unwrap_or(usual.displacement.gain_percent),
                zero_um: zero_um.unwrap_or(usual.displacement.zero_um),
            },
            amplifier: voltage(given.amplifier, usual.amplifier),
            monitor: voltage(given.monitor, usual.monitor),
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use ron::extensions::Extensions;

    #[test]
    fn one_number_is_given_alone_and_a_misspelt_one_refused() {
        let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        let of = |text: &str| options.from_str::<Accuracy>(text);
        let found = of("(displacement: (gain_percent: 0.7), monitor: (zero_V: 0.1))").unwrap();
        let usual = Accuracy::default();
        let mut expected = usual;
        expected.displacement.gain_percent = 0.7;
        expected.monitor.zero_volt = 0.1;
        assert_eq!((found, of("()").unwrap()), (expected, usual));
        assert!(of("(amplifier: (gain: 0.1))").is_err());
    }
}
