//! Characteristic of the sensor.

use super::{BenchCause, Design, Part, linear, singles};
use model_gap::{Cause, Side};
use preisach_dyn::{Nonlinearity, NonlinearityShape, SensorStage};

/// Half the measuring range of a displacement sensor for amplified stacks, um.
const HALF_RANGE_UM: f64 = 250.0;

/// Characteristic of the sensor.
pub(super) struct SensorNonlinearity;

impl BenchCause for SensorNonlinearity {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "sensor-nonlinearity",
            physics: "Error of the sensor's characteristic, y = x + amplitude (4 x^3 - 3 x) over its range of +-250 um.",
            side: Side::Sensor,
            parameters: vec![linear("amplitude", "um", -0.2 * HALF_RANGE_UM, 0.2 * HALF_RANGE_UM)],
            fingerprint: "a static function of the reading, the same at every rate",
            confused_with: &["voltage-saturation", "depolarisation", "load-stiffness"],
            separating: &["laser-cross-check", "bias-sweep"],
        }
    }

    fn starts(&self, _: &Design) -> Vec<Vec<f64>> {
        singles(&[0.004 * HALF_RANGE_UM, -0.004 * HALF_RANGE_UM])
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        (!design.is_bench).then(|| "the range of the sensor is not known".to_owned())
    }

    fn part(&self, values: &[f64]) -> Part {
        Part::Sensor(vec![SensorStage::Nonlinearity(Nonlinearity {
            amplitude_um: values[0],
            half_range_um: HALF_RANGE_UM,
            shape: NonlinearityShape::Cubic,
        })])
    }
}
