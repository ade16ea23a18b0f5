//! An amplifier of another gain or zero.

use super::cause::{BenchCause, gain_and_zero, usual};
use super::chain::Command;
use model_gap::{Candidate, Class};

/// A terminal voltage that follows the command by another gain and zero.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        let (low, high) = design.input;
        let (span, middle) = (high - low, f64::midpoint(low, high));
        Candidate {
            id: "amplifier-gain",
            physics: "The terminal voltage follows the command by another gain and zero, V = (1 + gain_error) u + zero.",
            parameters: gain_and_zero(span),
            class: Class::StaticGain,
            is_common: true,
            is_told: design.monitored_runs > 0,
            fingerprint: "the input scaled before the hysteresis, of either sign",
            confused_with: &["load-stiffness", "sensor-gain", "sensor-nonlinearity", "sensor-zero"],
            separating: &["amplifier-monitor"],
            starts: [0.02, -0.02]
                .map(|g| [vec![g, 0.0], vec![g, -g * middle], vec![0.0, g * span]])
                .concat(),
            blocked: design.no_reference(),
            ..usual()
        }
    },
    apply: |chain, values| {
        chain.front.command = Some(Command { gain: 1.0 + values[0], zero_volt: values[1] });
    },
};
