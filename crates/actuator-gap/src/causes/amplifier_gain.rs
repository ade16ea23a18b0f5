//! An amplifier of another gain, which is no cause of the library.

use super::cause::{BenchCause, FORM_ERROR, amount};
use super::chain::{Chain, Command};
use super::design::Design;
use model_gap::Cause;

/// A terminal voltage that follows the command by another gain and zero.
///
/// It stands among the candidates where the terminal voltage was measured, so that what an amplifier set anew does
/// is not given the name of a load or of a characteristic of the sensor. Without a monitor nothing tells it from
/// these.
pub(crate) struct AmplifierGain;

impl BenchCause for AmplifierGain {
    fn cause(&self, design: &Design) -> Cause {
        let span = design.input.1 - design.input.0;
        Cause {
            id: "amplifier-gain",
            physics: "The terminal voltage follows the command by another gain, V = (1 + rise) u + zero.",
            parameters: vec![
                amount("rise", "1", -0.5, 0.5),
                amount("zero", "V", -0.2 * span, 0.2 * span),
            ],
            form_error: FORM_ERROR,
            fingerprint: "the input scaled before the hysteresis",
            confused_with: &["load-stiffness", "sensor-nonlinearity"],
            separating: &["amplifier-monitor"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        let middle = f64::midpoint(design.input.0, design.input.1);
        [0.02, -0.02].iter().flat_map(|&g| [vec![g, 0.0], vec![g, -g * middle]]).collect()
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        (design.monitored_runs == 0)
            .then(|| "without the terminal voltage nothing tells it from a load".to_owned())
    }

    fn decoy(&self) -> Option<&'static str> {
        Some("an amplifier set anew")
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.front.command = Some(Command { gain: 1.0 + values[0], zero_volt: values[1] });
    }
}
