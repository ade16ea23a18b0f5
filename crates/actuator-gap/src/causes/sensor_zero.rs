//! A sensor of another zero.

use super::cause::{BenchCause, amount, singles, usual};
use super::reading::Reading;
use model_gap::{Candidate, Class};

/// Every reading of the measured runs higher by one offset: a sensor that was mounted or set anew.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "sensor-zero",
        physics: "The sensor reads an offset in all measured runs alike, y = x + zero.",
        parameters: vec![amount("zero", "um", -2.0 * design.half_stroke, 2.0 * design.half_stroke)],
        class: Class::Zero,
        fingerprint: "one offset at every voltage, in every run",
        confused_with: &["creep", "dielectric-heating", "amplifier-gain"],
        separating: &["laser-cross-check", "repeat-reference"],
        starts: singles([0.01, -0.01].map(|part| part * design.half_stroke)),
        blocked: design.no_reference(),
        ..usual()
    },
    apply: |chain, values| {
        chain.rear.readings.push(Reading { zero: values[0], ..Reading::FREE });
    },
};
