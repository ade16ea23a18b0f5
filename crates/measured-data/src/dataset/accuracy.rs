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

/// The gain of a load cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LoadCellAccuracy {
    /// Of the gain, percent, `>= 0`.
    pub gain_percent: f64,
}

/// The zero of a thermometer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ThermometerAccuracy {
    /// Of the zero, K, `>= 0`.
    #[serde(rename = "zero_K")]
    pub zero_kelvin: f64,
}

/// Calibration of the channels of a bench from one session to the next, as standard deviations.
///
/// What is larger than these is a finding; what is not is nobody's fault. The defaults are those of a bench that is
/// looked after: 0.2 % and 1 um of a displacement sensor, 0.2 % and 0.3 V of an amplifier, 0.5 % and 0.5 V of a voltage
/// monitor, 1 % of a load cell, 1 K of a thermometer. Two runs of one input then differ by 0.1 % of the spread of the
/// output besides noise. A file may give any of the numbers alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "Given")]
pub struct Accuracy {
    /// The sensor of the output.
    pub displacement: DisplacementAccuracy,
    /// The amplifier: terminal voltage over command.
    pub amplifier: VoltageAccuracy,
    /// The monitor of the terminal voltage.
    pub monitor: VoltageAccuracy,
    /// The load cell.
    pub load_cell: LoadCellAccuracy,
    /// The thermometer.
    pub thermometer: ThermometerAccuracy,
    /// What two runs of one input differ by besides noise, percent of the standard deviation of the output, `>= 0`.
    pub repeatability_percent: f64,
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            displacement: DisplacementAccuracy { gain_percent: 0.2, zero_um: 1.0 },
            amplifier: VoltageAccuracy { gain_percent: 0.2, zero_volt: 0.3 },
            monitor: VoltageAccuracy { gain_percent: 0.5, zero_volt: 0.5 },
            load_cell: LoadCellAccuracy { gain_percent: 1.0 },
            thermometer: ThermometerAccuracy { zero_kelvin: 1.0 },
            repeatability_percent: 0.1,
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
    load_cell: GivenLoadCell,
    thermometer: GivenThermometer,
    repeatability_percent: Option<f64>,
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

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct GivenLoadCell {
    gain_percent: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct GivenThermometer {
    #[serde(rename = "zero_K")]
    zero_kelvin: Option<f64>,
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
            load_cell: LoadCellAccuracy {
                gain_percent: given.load_cell.gain_percent.unwrap_or(usual.load_cell.gain_percent),
            },
            thermometer: ThermometerAccuracy {
                zero_kelvin: given.thermometer.zero_kelvin.unwrap_or(usual.thermometer.zero_kelvin),
            },
            repeatability_percent: given
                .repeatability_percent
                .unwrap_or(usual.repeatability_percent),
        }
    }
}

impl Accuracy {
    /// Every channel as it was, to the last digit.
    pub const EXACT: Self = Self {
        displacement: DisplacementAccuracy { gain_percent: 0.0, zero_um: 0.0 },
        amplifier: VoltageAccuracy { gain_percent: 0.0, zero_volt: 0.0 },
        monitor: VoltageAccuracy { gain_percent: 0.0, zero_volt: 0.0 },
        load_cell: LoadCellAccuracy { gain_percent: 0.0 },
        thermometer: ThermometerAccuracy { zero_kelvin: 0.0 },
        repeatability_percent: 0.0,
    };

    /// The numbers with their fields, for checks and reports.
    pub fn rows(&self) -> [(&'static str, f64, &'static str); 9] {
        [
            ("displacement.gain_percent", self.displacement.gain_percent, "%"),
            ("displacement.zero_um", self.displacement.zero_um, "um"),
            ("amplifier.gain_percent", self.amplifier.gain_percent, "%"),
            ("amplifier.zero_V", self.amplifier.zero_volt, "V"),
            ("monitor.gain_percent", self.monitor.gain_percent, "%"),
            ("monitor.zero_V", self.monitor.zero_volt, "V"),
            ("load_cell.gain_percent", self.load_cell.gain_percent, "%"),
            ("thermometer.zero_K", self.thermometer.zero_kelvin, "K"),
            ("repeatability_percent", self.repeatability_percent, "%"),
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
        let found = of("(displacement: (gain_percent: 0.7), monitor: (zero_V: 0.1), load_cell: (gain_percent: 3.0), \
             thermometer: (zero_K: 2.0), repeatability_percent: 0.4)")
            .unwrap();
        let usual = Accuracy::default();
        let mut expected = usual;
        expected.displacement.gain_percent = 0.7;
        expected.monitor.zero_volt = 0.1;
        expected.load_cell.gain_percent = 3.0;
        expected.thermometer.zero_kelvin = 2.0;
        expected.repeatability_percent = 0.4;
        assert_eq!((found, of("()").unwrap()), (expected, usual));
        assert!(of("(amplifier: (gain: 0.1))").is_err());
    }
}
