//! A reading that changes no faster than the sensor can, which is no cause of the library.

use super::cause::{BenchCause, logarithmic, singles, usual};
use super::reading::Reading;
use model_gap::{Candidate, Class};

/// A reading of limited rate.
///
/// It stands among the candidates so that a sensor that is too slow for large steps is not given the name of a
/// limit of the amplifier's current, which acts before the hysteresis.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        // rate of the output at the fast rate of the input, output's unit per s
        let span = (design.input.1 - design.input.0).max(1e-9);
        let usual_rate = (design.fast_rate * 2.0 * design.half_stroke / span).max(1e-3);
        Candidate {
            id: "reading-rate",
            physics: "The reading follows the motion no faster than the sensor can, |y'| <= fastest.",
            parameters: vec![logarithmic("fastest", "um/s", 0.02 * usual_rate, 50.0 * usual_rate)],
            class: Class::Slew,
            fingerprint: "nothing below a rate of the motion, then triangular, third harmonic",
            confused_with: &["amplifier-current-limit", "sensor-filter"],
            separating: &["amplifier-monitor", "laser-cross-check"],
            starts: singles([1.5, 0.9, 0.5, 0.25].map(|part| part * usual_rate)),
            blocked: design.one_frequency(),
            decoy: Some("a sensor that is too slow"),
            ..usual()
        }
    },
    apply: |chain, values| {
        chain.rear.readings.push(Reading { fastest: values[0], ..Reading::FREE });
    },
};
