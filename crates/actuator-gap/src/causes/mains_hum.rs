//! Mains frequency in the reading.

use super::cause::{BenchCause, growing, linear, logarithmic, usual};
use super::design::Design;
use model_gap::{Candidate, Class, Parameter};
use preisach_dyn::{MainsHum, SensorStage};

/// Mains frequency in the reading.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "mains-hum",
        physics: "Mains frequency in the reading, A sin(2 pi f t + phase), its phase another in every record.",
        parameters: vec![
            growing(logarithmic("amplitude", "um", 1e-5 * design.half_stroke, design.half_stroke)),
            // a phase turns over the length of a run: the slope is that of a small part of a turn
            Parameter {
                step: Some(0.02 / design.longest_s),
                ..linear("frequency", "Hz", 45.0, 65.0)
            },
        ],
        class: Class::Line,
        is_common: true,
        fingerprint: "a line fixed in Hz, present without input, not locked to the excitation",
        confused_with: &["mechanical-resonance"],
        separating: &["zero-input-record"],
        starts: starts(design),
        blocked: (design.nyquist_hz < 66.0)
            .then(|| "sampling does not carry 50 and 60 Hz".to_owned()),
        ..usual()
    },
    apply: |chain, values| {
        let hum = MainsHum { amplitude_um: values[0], frequency_hz: values[1], phase_rad: 0.0 };
        chain.rear.sensor.push(SensorStage::MainsHum(hum));
    },
};

/// Half a turn over the longest run is what a search finds home from; mains keep within 0.5 Hz.
fn starts(design: &Design) -> Vec<Vec<f64>> {
    let spacing = (0.5 / design.longest_s).clamp(0.02, 0.2);
    let mut starts = Vec::new();
    for nominal in [50.0, 60.0] {
        starts.push(vec![0.01 * design.half_stroke, nominal]);
        let mut off = spacing;
        while off <= 0.5 {
            starts.extend(
                [nominal - off, nominal + off].map(|hz| vec![0.01 * design.half_stroke, hz]),
            );
            off += spacing;
        }
    }
    starts
}
