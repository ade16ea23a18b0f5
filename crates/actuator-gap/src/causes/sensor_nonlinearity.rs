//! Characteristic of the sensor.

use super::cause::{BenchCause, amount, linear, shape, usual};
use model_gap::{Candidate, Class};
use preisach_dyn::{Nonlinearity, NonlinearityShape, SensorStage};

/// Half the measuring range of a displacement sensor for amplified stacks, um.
const HALF_RANGE_UM: f64 = 250.0;

/// Amplitude at which a search begins, um.
const START_UM: f64 = 0.004 * HALF_RANGE_UM;

/// A real characteristic is no cubic: its largest error over the range is known from a part of the range to
/// so much.
const CHARACTERISTIC: f64 = 0.15;

/// Characteristic of the sensor.
///
/// A cubic bend about a line that is fitted with it: sheets state linearity from the line through the ends,
/// from the best line or from the tangent, and each calls another gain the sensor's own.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "sensor-nonlinearity",
        physics: "Error of the sensor's characteristic, y = x + amplitude (x^3 - c x) over the largest of that, within +-250 um.",
        parameters: vec![
            amount("amplitude", "um", -0.2 * HALF_RANGE_UM, 0.2 * HALF_RANGE_UM),
            shape(linear("straight", "1", 0.0, 1.0)),
        ],
        form_error: CHARACTERISTIC,
        fingerprint: "a static function of the reading, the same at every rate",
        class: Class::StaticGain,
        is_told: design.second_sensor_runs > 0,
        confused_with: &[
            "voltage-saturation",
            "depolarisation",
            "load-stiffness",
            "sensor-gain",
            "amplifier-gain",
        ],
        separating: &["laser-cross-check", "bias-sweep"],
        // the largest error changes its place at a slope of 3/4: no search begins there
        starts: [0.6, 0.9, 0.2]
            .map(|straight| [START_UM, -START_UM].map(|um| vec![um, straight]))
            .concat(),
        blocked: (!design.is_bench).then(|| "the range of the sensor is not known".to_owned()),
        ..usual()
    },
    apply: |chain, values| {
        chain.rear.sensor.push(SensorStage::Nonlinearity(Nonlinearity {
            amplitude_um: values[0],
            half_range_um: HALF_RANGE_UM,
            shape: NonlinearityShape::CubicAbout { straight: values[1] },
        }));
    },
};
