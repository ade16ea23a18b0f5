//! Voltage limits of the amplifier.

use super::cause::{BenchCause, FORM_ERROR, held, linear};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{AmplifierStage, Saturation};

/// Half-width of the widest knee over the range of the inputs.
const WIDEST_KNEE: f64 = 0.05;
/// That of the knee that is taken, and its standard deviation: no run says much of it, and it moves the
/// limits.
const USUAL_KNEE: f64 = 0.01;
const KNEE_STD: f64 = 0.02;

/// Voltage limits of the amplifier.
pub(super) struct VoltageSaturation;

impl BenchCause for VoltageSaturation {
    fn cause(&self, design: &Design) -> Cause {
        Cause {
            id: "voltage-saturation",
            physics: "The amplifier's voltage ends at its supply, V = clip(u, v_min, v_max), with a knee.",
            parameters: vec![
                linear(
                    "v_max",
                    "V",
                    f64::midpoint(design.input.0, design.input.1),
                    design.input.1 + 0.1 * (design.input.1 - design.input.0),
                ),
                linear(
                    "v_min",
                    "V",
                    design.input.0 - 0.1 * (design.input.1 - design.input.0),
                    f64::midpoint(design.input.0, design.input.1),
                ),
                held(
                    linear("knee", "V", 0.0, WIDEST_KNEE * (design.input.1 - design.input.0)),
                    KNEE_STD * (design.input.1 - design.input.0),
                ),
            ],
            form_error: FORM_ERROR,
            fingerprint: "depends on amplitude only, flat tops; one-sided gives even harmonics",
            confused_with: &["depolarisation", "sensor-nonlinearity"],
            separating: &["amplifier-monitor", "amplitude-sweep"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        let (low, high) = design.input;
        let span = high - low;
        let cut =
            |top: f64, bottom: f64| vec![high - top * span, low + bottom * span, USUAL_KNEE * span];
        let none = -0.02;
        vec![
            cut(0.02, none),
            cut(0.05, none),
            cut(0.1, none),
            cut(0.2, none),
            cut(none, 0.02),
            cut(none, 0.05),
            cut(none, 0.1),
            cut(none, 0.2),
            cut(0.03, 0.03),
            cut(0.08, 0.08),
            cut(0.15, 0.15),
        ]
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        let v_max_volt = values[0];
        let v_min_volt = values[1].min(v_max_volt - 1e-6);
        let knee_volt = values[2].min(0.5 * (v_max_volt - v_min_volt));
        let limits = Saturation { v_min_volt, v_max_volt, knee_volt };
        chain.front.amplifier.push(AmplifierStage::Saturation(limits));
    }
}
