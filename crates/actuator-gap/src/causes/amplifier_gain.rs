//! An amplifier of another gain, which is no cause of the library.

use super::cause::{BenchCause, amount, usual};
use super::chain::Command;
use model_gap::Candidate;

/// A terminal voltage that follows the command by another gain and zero.
///
/// It stands among the candidates where the terminal voltage was measured, so that what an amplifier set anew does
/// is not given the name of a load or of a characteristic of the sensor. Without a monitor nothing tells it from
/// these.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        let (low, high) = design.input;
        let (span, middle) = (high - low, f64::midpoint(low, high));
        Candidate {
            id: "amplifier-gain",
            physics: "The terminal voltage follows the command by another gain, V = (1 + rise) u + zero.",
            parameters: vec![
                amount("rise", "1", -0.5, 0.5),
                amount("zero", "V", -0.2 * span, 0.2 * span),
            ],
            fingerprint: "the input scaled before the hysteresis",
            confused_with: &["load-stiffness", "sensor-nonlinearity"],
            separating: &["amplifier-monitor"],
            starts: [0.02, -0.02].map(|g| [vec![g, 0.0], vec![g, -g * middle]]).concat(),
            blocked: (design.monitored_runs == 0)
                .then(|| "without the terminal voltage nothing tells it from a load".to_owned()),
            decoy: Some("an amplifier set anew"),
            ..usual()
        }
    },
    apply: |chain, values| {
        chain.front.command = Some(Command { gain: 1.0 + values[0], zero_volt: values[1] });
    },
};
