//! Transport delay of the reading.

use super::{BenchCause, Design, FORM_ERROR, Part, logarithmic, singles};
use model_gap::{Cause, Side};
use preisach_dyn::{Delay, SensorStage};

/// Transport delay of the reading.
pub(super) struct TransportDelay;

impl BenchCause for TransportDelay {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "transport-delay",
            physics: "The reading comes late, y(t - T).",
            side: Side::Sensor,
            parameters: vec![logarithmic("delay", "s", 1e-5, 0.05)],
            form_error: FORM_ERROR,
            fingerprint: "phase exactly straight in frequency, gain 1",
            confused_with: &["electrical-lag", "sensor-filter", "rate-dependence"],
            separating: &["multisine-5-181Hz", "laser-cross-check"],
        }
    }

    fn starts(&self, _: &Design) -> Vec<Vec<f64>> {
        singles(&[2e-4, 1e-3, 4e-3, 0.015])
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        design.one_frequency()
    }

    fn part(&self, values: &[f64]) -> Part {
        Part::Sensor(vec![SensorStage::Delay(Delay { delay_s: values[0] })])
    }
}
