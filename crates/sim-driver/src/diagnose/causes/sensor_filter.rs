//! Filter of the sensor.

use super::{BenchCause, Design, Part, logarithmic, singles};
use model_gap::{Cause, Side};
use preisach_dyn::{Lag, SensorStage};

/// Filter of the sensor.
pub(super) struct SensorFilter;

impl BenchCause for SensorFilter {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "sensor-filter",
            physics: "Low-pass filter of the displacement sensor, tau y' + y = x.",
            side: Side::Sensor,
            parameters: vec![logarithmic("tau", "s", 1e-5, 0.05)],
            fingerprint: "a lag of the reading behind everything else, amplitude and phase",
            confused_with: &["transport-delay", "electrical-lag", "rate-dependence"],
            separating: &["laser-cross-check", "multisine-5-181Hz"],
        }
    }

    fn starts(&self, _: &Design) -> Vec<Vec<f64>> {
        singles(&[2e-4, 1e-3, 4e-3, 0.015])
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        design.one_frequency()
    }

    fn part(&self, values: &[f64]) -> Part {
        Part::Sensor(SensorStage::Filter(Lag { tau_s: values[0] }))
    }
}
