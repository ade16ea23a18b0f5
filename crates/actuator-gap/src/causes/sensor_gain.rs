//! A sensor of another gain.

use super::cause::{BenchCause, amount, singles, usual};
use super::reading::Reading;
use model_gap::{Candidate, Class};

/// Every reading larger or smaller by one factor: a sensor set anew, another conditioner, another scale.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "sensor-gain",
        physics: "The sensor reads another multiple of the motion, y = (1 + gain_error) x.",
        parameters: vec![amount("gain_error", "1", -0.6, 2.0)],
        class: Class::StaticGain,
        is_common: true,
        is_told: design.second_sensor_runs > 0,
        fingerprint: "pure gain of either sign, no harmonics",
        confused_with: &["load-stiffness", "amplifier-gain", "sensor-nonlinearity"],
        separating: &["laser-cross-check"],
        starts: singles([0.02, -0.02]),
        blocked: design.no_reference(),
        ..usual()
    },
    apply: |chain, values| {
        chain.rear.readings.push(Reading { gain: 1.0 + values[0], ..Reading::FREE });
    },
};
