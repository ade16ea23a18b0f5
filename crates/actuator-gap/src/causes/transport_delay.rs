//! Transport delay of the reading.

use super::cause::{BenchCause, lag, lags_s, singles, usual};
use model_gap::{Candidate, Class};
use preisach_dyn::{Delay, SensorStage};

/// Transport delay of the reading.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "transport-delay",
        physics: "The reading comes late, y(t - T).",
        parameters: vec![lag("delay", design)],
        class: Class::LagBehindTerminals,
        is_common: true,
        fingerprint: "phase exactly straight in frequency, gain 1",
        confused_with: &["electrical-lag", "sensor-filter", "rate-dependence"],
        separating: &["multisine-5-181Hz", "laser-cross-check"],
        starts: singles(lags_s(design)),
        blocked: design.one_frequency(),
        ..usual()
    },
    apply: |chain, values| {
        chain.rear.sensor.push(SensorStage::Delay(Delay { delay_s: values[0] }));
    },
};
