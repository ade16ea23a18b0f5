//! Current limit of the amplifier.

use super::cause::{BenchCause, logarithmic, singles, usual};
use model_gap::{Candidate, Class};
use preisach_dyn::{AmplifierStage, CurrentLimit};

/// Part of its effect that a limit of the model lacks: the loop of an amplifier asks for its whole current at some error
/// only, so the terminals lag a little below the limit too.
const SOFTNESS: f64 = 0.1;

/// Current limit of the amplifier.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        let fast_rate = design.fast_rate.max(1.0);
        Candidate {
            id: "amplifier-current-limit",
            physics: "The amplifier's current is limited into the capacitance, V' within +-I / C.",
            parameters: vec![logarithmic("slew_rate", "V/s", 0.02 * fast_rate, 50.0 * fast_rate)],
            class: Class::Slew,
            is_common: true,
            fingerprint: "nothing below a threshold of amplitude times frequency, then triangular, third harmonic",
            confused_with: &["electrical-lag", "voltage-saturation", "rate-dependence"],
            separating: &["amplifier-monitor", "amplitude-sweep"],
            starts: singles([1.8, 1.2, 0.9, 0.6, 0.4, 0.25].map(|part| part * fast_rate)),
            blocked: design.one_frequency(),
            form_error: SOFTNESS,
            ..usual()
        }
    },
    apply: |chain, values| {
        let limit = CurrentLimit { slew_rate_volt_per_s: values[0] };
        chain.front.amplifier.push(AmplifierStage::CurrentLimit(limit));
    },
};
