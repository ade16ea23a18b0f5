//! Voltage limits of the amplifier.

use super::cause::{BenchCause, linear, shape, usual};
use model_gap::{Candidate, Class, Parameter};
use preisach_dyn::{AmplifierStage, Saturation};

/// Half-width of the widest knee over the range of the inputs.
const WIDEST_KNEE: f64 = 0.05;
/// That of the knee that is taken, and its standard deviation: no run says much of it, and it moves the
/// limits.
const USUAL_KNEE: f64 = 0.01;
const KNEE_STD: f64 = 0.02;

/// Parts of the range of the inputs that are cut off at the top and at the bottom where a search begins.
const CUTS: [[f64; 2]; 11] = [
    [0.02, -0.02],
    [0.05, -0.02],
    [0.1, -0.02],
    [0.2, -0.02],
    [-0.02, 0.02],
    [-0.02, 0.05],
    [-0.02, 0.1],
    [-0.02, 0.2],
    [0.03, 0.03],
    [0.08, 0.08],
    [0.15, 0.15],
];

/// Voltage limits of the amplifier.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        let (low, high) = design.input;
        let (span, middle) = (high - low, f64::midpoint(low, high));
        let start = |[top, bottom]: [f64; 2]| {
            vec![high - top * span, low + bottom * span, USUAL_KNEE * span]
        };
        Candidate {
            id: "voltage-saturation",
            physics: "The amplifier's voltage ends at its supply, V = clip(u, v_min, v_max), with a knee.",
            parameters: vec![
                linear("v_max", "V", middle, high + 0.1 * span),
                linear("v_min", "V", low - 0.1 * span, middle),
                Parameter {
                    held: Some(KNEE_STD * span),
                    ..shape(linear("knee", "V", 0.0, WIDEST_KNEE * span))
                },
            ],
            class: Class::Clip,
            is_common: true,
            fingerprint: "depends on amplitude only, flat tops; one-sided gives even harmonics",
            confused_with: &["depolarisation", "sensor-nonlinearity"],
            separating: &["amplifier-monitor", "amplitude-sweep"],
            starts: CUTS.map(start).to_vec(),
            ..usual()
        }
    },
    apply: |chain, values| {
        let v_max_volt = values[0];
        let v_min_volt = values[1].min(v_max_volt - 1e-6);
        let knee_volt = values[2].min(0.5 * (v_max_volt - v_min_volt));
        let limits = Saturation { v_min_volt, v_max_volt, knee_volt };
        chain.front.amplifier.push(AmplifierStage::Saturation(limits));
    },
};
