//! Mains frequency in the reading.

use super::{BenchCause, Design, Part, linear, logarithmic};
use model_gap::{Cause, Side};

/// Mains frequency in the reading.
pub(super) struct Hum;

impl BenchCause for Hum {
    fn cause(&self, design: &Design) -> Cause {
        Cause {
            id: "mains-hum",
            physics: "Mains frequency in the reading, A sin(2 pi f t + phase), its phase another in every record.",
            side: Side::Sensor,
            parameters: vec![
                logarithmic("amplitude", "um", 1e-5 * design.half_stroke, design.half_stroke),
                linear("frequency", "Hz", 45.0, 65.0),
            ],
            fingerprint: "a line fixed in Hz, present without input, not locked to the excitation",
            confused_with: &["mechanical-resonance"],
            separating: &["zero-input-record"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        [
            48.0, 49.0, 49.5, 49.8, 49.9, 50.0, 50.1, 50.2, 50.5, 51.0, 52.0, 59.5, 59.9, 60.0,
            60.1, 60.5,
        ]
        .iter()
        .map(|hz| vec![0.01 * design.half_stroke, *hz])
        .collect()
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        (design.nyquist_hz < 66.0).then(|| "sampling does not carry 50 and 60 Hz".to_owned())
    }

    fn part(&self, values: &[f64]) -> Part {
        Part::Hum { amplitude: values[0], frequency_hz: values[1] }
    }
}
