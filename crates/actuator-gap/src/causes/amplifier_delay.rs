//! An amplifier that delays, which is no cause of the library.

use super::cause::{BenchCause, lag, lags_s, singles, usual};
use model_gap::{Candidate, Class};

/// A terminal voltage that follows the command late and undistorted.
///
/// It stands among the candidates so that a digital output stage, or an amplifier of higher order, is not given the
/// name of a lag of one pole.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "amplifier-delay",
        physics: "The terminal voltage is the command of a while ago, V(t) = u(t - delay).",
        parameters: vec![lag("delay", design)],
        class: Class::LagBeforeTerminals,
        fingerprint: "phase exactly straight in frequency, before the hysteresis",
        confused_with: &[
            "electrical-lag",
            "amplifier-current-limit",
            "transport-delay",
            "sensor-filter",
            "rate-dependence",
        ],
        separating: &["amplifier-monitor", "multisine-5-181Hz"],
        starts: singles(lags_s(design)),
        blocked: design.one_frequency().or_else(|| {
            (design.monitored_runs == 0)
                .then(|| "without the terminal voltage nothing tells it from a lag".to_owned())
        }),
        decoy: Some("an amplifier that delays"),
        ..usual()
    },
    apply: |chain, values| chain.front.late_s = Some(values[0]),
};
