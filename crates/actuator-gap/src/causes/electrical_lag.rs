//! Electrical lag of amplifier and ceramic.

use super::cause::{BenchCause, lag, lags_s, singles, usual};
use model_gap::{Candidate, Class};
use preisach_dyn::{AmplifierStage, Lag};

/// Electrical lag of amplifier and ceramic.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "electrical-lag",
        physics: "Output resistance of the amplifier into the capacitance of the ceramic, tau V' + V = u, tau = R C.",
        parameters: vec![lag("tau", design)],
        class: Class::LagBeforeTerminals,
        is_common: true,
        fingerprint: "phase -atan(w tau) before the hysteresis, so that reversal points shrink",
        confused_with: &["transport-delay", "sensor-filter", "rate-dependence"],
        separating: &["amplifier-monitor", "multisine-5-181Hz"],
        starts: singles(lags_s(design)),
        blocked: design.one_frequency(),
        ..usual()
    },
    apply: |chain, values| {
        chain.front.amplifier.push(AmplifierStage::Lag(Lag { tau_s: values[0] }));
    },
};
