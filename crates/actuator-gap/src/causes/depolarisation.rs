//! Polarisation lost under reverse voltage.

use super::cause::{BenchCause, FORM_ERROR, linear, logarithmic, shape};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{AmplifierStage, Depolarisation};

/// Polarisation lost under reverse voltage.
pub(super) struct ReverseVoltage;

impl BenchCause for ReverseVoltage {
    fn cause(&self, design: &Design) -> Cause {
        Cause {
            id: "depolarisation",
            physics: "Below a threshold polarisation is lost for as long as the voltage stays there, p' = rate (threshold - V), and the gain with it.",
            parameters: vec![
                linear(
                    "threshold",
                    "V",
                    design.input.0 - 0.01,
                    design.input.0 + 0.25 * (design.input.1 - design.input.0),
                ),
                shape(logarithmic("loss_per_volt_second", "1/(V s)", 1e-6, 1.0)),
                shape(linear("about", "1", -0.5, 1.5)),
            ],
            form_error: FORM_ERROR,
            fingerprint: "a gain that falls with the time below the threshold and stays lost",
            confused_with: &["voltage-saturation", "sensor-nonlinearity", "load-stiffness"],
            separating: &["bias-sweep"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        let (low, high) = design.input;
        [0.04, 0.1, 0.18]
            .iter()
            .map(|part| low + part * (high - low))
            .flat_map(|volt| [1e-3, 1e-2].map(|rate| vec![volt, rate, 0.0]))
            .collect()
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        if !design.is_bench {
            return Some("polarisation belongs to a piezo actuator".into());
        }
        (design.input.0 > -1.0).then(|| format!("no run goes below {:.1} V", design.input.0))
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        let stage = Depolarisation {
            threshold_volt: values[0],
            loss_per_volt: 0.0,
            loss_per_volt_second: values[1],
            repoling_volt: None,
        };
        chain.front.amplifier.push(AmplifierStage::Depolarisation(stage));
        chain.front.loss_about = values[2];
    }
}
