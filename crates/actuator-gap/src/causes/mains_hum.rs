//! Mains frequency in the reading.

use super::cause::{BenchCause, FORM_ERROR, linear, logarithmic};
use super::chain::Chain;
use super::design::Design;
use model_gap::{Cause, Parameter};
use preisach_dyn::{MainsHum, SensorStage};

/// Mains frequency in the reading.
pub(super) struct Hum;

impl BenchCause for Hum {
    fn cause(&self, design: &Design) -> Cause {
        Cause {
            id: "mains-hum",
            physics: "Mains frequency in the reading, A sin(2 pi f t + phase), its phase another in every record.",
            parameters: vec![
                logarithmic("amplitude", "um", 1e-5 * design.half_stroke, design.half_stroke),
                // a phase turns over the length of a run: the slope is that of a small part of a turn
                Parameter {
                    step: Some(0.02 / design.longest_s),
                    ..linear("frequency", "Hz", 45.0, 65.0)
                },
            ],
            form_error: FORM_ERROR,
            fingerprint: "a line fixed in Hz, present without input, not locked to the excitation",
            confused_with: &["mechanical-resonance"],
            separating: &["zero-input-record"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        // half a turn over the longest run is what a search finds home from; mains keep within 0.5 Hz
        let spacing = (0.5 / design.longest_s).clamp(0.02, 0.2);
        let around = |nominal: f64| {
            let mut all = vec![nominal];
            let mut off = spacing;
            while off <= 0.5 {
                all.extend([nominal - off, nominal + off]);
                off += spacing;
            }
            all
        };
        let mut all = around(50.0);
        all.extend(around(60.0));
        all.into_iter().map(|hz| vec![0.01 * design.half_stroke, hz]).collect()
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        (design.nyquist_hz < 66.0).then(|| "sampling does not carry 50 and 60 Hz".to_owned())
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        let hum = MainsHum { amplitude_um: values[0], frequency_hz: values[1], phase_rad: 0.0 };
        chain.rear.sensor.push(SensorStage::MainsHum(hum));
    }
}
