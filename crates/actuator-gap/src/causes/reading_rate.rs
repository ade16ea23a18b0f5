//! A reading that changes no faster than the sensor can, which is no cause of the library.

use super::cause::{BenchCause, FORM_ERROR, logarithmic};
use super::chain::Chain;
use super::design::Design;
use super::reading::Reading;
use model_gap::Cause;

/// A reading of limited rate.
///
/// It stands among the candidates so that a sensor that is too slow for large steps is not given the name of a
/// limit of the amplifier's current, which acts before the hysteresis.
pub(crate) struct ReadingRate;

/// Rate of the output at the fast rate of the input, output's unit per s.
fn usual(design: &Design) -> f64 {
    let span = (design.input.1 - design.input.0).max(1e-9);
    (design.fast_rate * 2.0 * design.half_stroke / span).max(1e-3)
}

impl BenchCause for ReadingRate {
    fn cause(&self, design: &Design) -> Cause {
        let usual = usual(design);
        Cause {
            id: "reading-rate",
            physics: "The reading follows the motion no faster than the sensor can, |y'| <= fastest.",
            parameters: vec![logarithmic("fastest", "um/s", 0.02 * usual, 50.0 * usual)],
            form_error: FORM_ERROR,
            fingerprint: "nothing below a rate of the motion, then triangular, third harmonic",
            confused_with: &["amplifier-current-limit", "sensor-filter"],
            separating: &["amplifier-monitor", "laser-cross-check"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        let usual = usual(design);
        [1.5, 0.9, 0.5, 0.25].iter().map(|part| vec![part * usual]).collect()
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        design.one_frequency()
    }

    fn decoy(&self) -> Option<&'static str> {
        Some("a sensor that is too slow")
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.rear.readings.push(Reading { fastest: values[0], ..Reading::FREE });
    }
}
