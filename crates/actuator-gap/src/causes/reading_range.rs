//! A reading that ends at the range of the sensor, which is no cause of the library.

use super::cause::{BenchCause, FORM_ERROR, linear};
use super::chain::Chain;
use super::design::Design;
use super::reading::Reading;
use model_gap::Cause;

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

    fn decoy(&self) -> Option<&'static str> {
        Some("the range of a sensor")
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.rear.readings.push(Reading { most: values[0], least: values[1], ..Reading::FREE });
    }
}
