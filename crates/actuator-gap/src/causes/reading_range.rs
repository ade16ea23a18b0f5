//! A reading that ends at the range of the sensor, which is no cause of the library.

use super::cause::{BenchCause, linear, usual};
use super::reading::Reading;
use model_gap::{Candidate, Class};

/// A reading clipped at the ends of the range of the sensor.
///
/// It stands among the candidates so that flat tops of the reading are not given the name of a limit of the
/// amplifier, which cuts the command before the hysteresis.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        let (low, high) = design.output;
        let (span, middle) = (high - low, f64::midpoint(low, high));
        // measured readings that are cut end where they are cut
        let cuts = [[0.0, -0.02], [-0.02, 0.0], [0.01, 0.01]];
        Candidate {
            id: "reading-range",
            physics: "The reading ends at the range of the sensor, y = clip(x, least, most).",
            parameters: vec![
                linear("most", "um", middle, high + 0.1 * span),
                linear("least", "um", low - 0.1 * span, middle),
            ],
            class: Class::Clip,
            fingerprint: "flat tops at one reading, whatever the voltage",
            confused_with: &["voltage-saturation", "sensor-nonlinearity"],
            separating: &["amplifier-monitor", "laser-cross-check"],
            starts: cuts.map(|[top, bottom]| vec![high - top * span, low + bottom * span]).to_vec(),
            decoy: Some("the range of a sensor"),
            ..usual()
        }
    },
    apply: |chain, values| {
        chain.rear.readings.push(Reading { most: values[0], least: values[1], ..Reading::FREE });
    },
};
