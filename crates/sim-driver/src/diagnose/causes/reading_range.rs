//! A reading that ends at the range of the sensor, which is no cause of the library.

use super::{BenchCause, Design, FORM_ERROR, Part, linear};
use model_gap::{Cause, Side};

/// A reading clipped at the ends of the range of the sensor.
///
/// It stands among the candidates so that flat tops of the reading are not given the name of a limit of the
/// amplifier, which cuts the command before the hysteresis.
pub(crate) struct ReadingRange;

impl BenchCause for ReadingRange {
    fn cause(&self, design: &Design) -> Cause {
        let (low, high) = design.output;
        let (middle, tenth) = (f64::midpoint(low, high), 0.1 * (high - low));
        Cause {
            id: "reading-range",
            physics: "The reading ends at the range of the sensor, y = clip(x, least, most).",
            side: Side::Sensor,
            parameters: vec![
                linear("most", "um", middle, high + tenth),
                linear("least", "um", low - tenth, middle),
            ],
            form_error: FORM_ERROR,
            fingerprint: "flat tops at one reading, whatever the voltage",
            confused_with: &["voltage-saturation", "sensor-nonlinearity"],
            separating: &["amplifier-monitor", "laser-cross-check"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        let (low, high) = design.output;
        let span = high - low;
        let cut = |top: f64, bottom: f64| vec![high - top * span, low + bottom * span];
        let none = -0.02;
        vec![
            // measured readings that are cut end where they are cut
            cut(0.0, none),
            cut(none, 0.0),
            cut(0.01, 0.01),
        ]
    }

    fn blocked(&self, _: &Design) -> Option<String> {
        None
    }

    fn nameless(&self) -> Option<&'static str> {
        Some("the range of a sensor")
    }

    fn part(&self, values: &[f64]) -> Part {
        Part::Reading(Reading { most: values[0], least: values[1], ..Reading::FREE })
    }
}

/// What a sensor can read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reading {
    /// Highest reading, output's unit.
    pub(super) most: f64,
    /// Lowest reading, output's unit.
    pub(super) least: f64,
    /// Fastest change of the reading, output's unit per s.
    pub(super) fastest: f64,
}

impl Reading {
    pub(super) const FREE: Self =
        Self { most: f64::INFINITY, least: f64::NEG_INFINITY, fastest: f64::INFINITY };

    /// What it reads of a motion.
    pub(crate) fn of(&self, motion: &[f64], step_s: f64) -> Vec<f64> {
        let most = self.fastest * step_s;
        let mut read = motion.first().copied().unwrap_or_default();
        motion
            .iter()
            .map(|y| {
                read += (y - read).clamp(-most, most);
                read.min(self.most).max(self.least)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Reading;
    use approx::assert_abs_diff_eq;

    #[test]
    fn a_reading_ends_at_its_range_and_follows_no_faster_than_it_can() {
        let motion = [0.0, 10.0, 10.0, 10.0, -20.0];
        assert_eq!(
            Reading { most: 8.0, least: -9.0, ..Reading::FREE }.of(&motion, 0.1),
            [0.0, 8.0, 8.0, 8.0, -9.0]
        );
        let late = Reading { fastest: 40.0, ..Reading::FREE }.of(&motion, 0.1);
        for (read, expected) in late.iter().zip([0.0, 4.0, 8.0, 10.0, 6.0]) {
            assert_abs_diff_eq!(*read, expected, epsilon = 1e-12);
        }
    }
}
