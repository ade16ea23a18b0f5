//! A voltage monitor of another gain or zero.

use super::cause::{BenchCause, gain_and_zero, usual};
use super::chain::Command;
use model_gap::{Candidate, Class};

/// The voltage monitor reads another multiple of the terminal voltage, or an offset. The output knows nothing of it.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        let (low, high) = design.input;
        let span = high - low;
        Candidate {
            id: "monitor-calibration",
            physics: "The voltage monitor reads another gain and zero, V_read = (1 + gain_error) V + zero; the output does not change.",
            parameters: gain_and_zero(span),
            class: Class::Monitor,
            is_beside_output: true,
            fingerprint: "a terminal voltage off by a gain and a zero that the output does not feel",
            confused_with: &["amplifier-gain"],
            separating: &["repeat-reference"],
            starts: vec![
                vec![0.02, 0.0],
                vec![-0.02, 0.0],
                vec![0.0, 0.01 * span],
                vec![0.0, -0.01 * span],
            ],
            blocked: (design.monitored_runs == 0)
                .then(|| "no terminal voltage was recorded".to_owned()),
            ..usual()
        }
    },
    apply: |chain, values| {
        chain.monitor = Some(Command { gain: 1.0 + values[0], zero_volt: values[1] });
    },
};
