//! Polarisation lost under reverse voltage.

use super::{BenchCause, Design, Part, linear, logarithmic, shape};
use model_gap::{Cause, Side};
use preisach_dyn::Depolarisation;

/// Polarisation lost under reverse voltage.
pub(super) struct ReverseVoltage;

impl BenchCause for ReverseVoltage {
    fn cause(&self, design: &Design) -> Cause {
        Cause {
            id: "depolarisation",
            physics: "Below a threshold the polarisation is lost and the gain with it, until a higher voltage brings it back.",
            side: Side::State,
            parameters: vec![
                linear(
                    "threshold",
                    "V",
                    design.input.0 - 0.01,
                    design.input.0 + 0.25 * (design.input.1 - design.input.0),
                ),
                shape(logarithmic("loss_per_volt", "1/V", 1e-5, 0.1)),
                shape(linear("about", "1", -0.5, 1.5)),
            ],
            fingerprint: "even harmonics on the negative half, and a change that stays",
            confused_with: &["voltage-saturation", "sensor-nonlinearity", "load-stiffness"],
            separating: &["bias-sweep", "overdrive-two-biases"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        let (low, high) = design.input;
        [0.04, 0.08, 0.14]
            .iter()
            .map(|part| low + part * (high - low))
            .flat_map(|volt| [vec![volt, 0.001, 1.0], vec![volt, 0.005, 1.0]])
            .collect()
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        if !design.is_bench {
            return Some("polarisation belongs to a piezo actuator".into());
        }
        (design.input.0 > -1.0).then(|| format!("no run goes below {:.1} V", design.input.0))
    }

    fn part(&self, values: &[f64]) -> Part {
        let stage = Depolarisation {
            threshold_volt: values[0],
            loss_per_volt: values[1],
            repoling_volt: None,
        };
        Part::Depolarisation(stage, values[2])
    }
}

/// Gain of the law under a loss of polarisation, sample by sample.
///
/// Source: [`preisach_dyn::Depolarisation`], the same equations.
pub(crate) fn lost_gain(stage: &Depolarisation, terminal: &[f64]) -> Vec<f64> {
    let share = |depth: f64| (stage.loss_per_volt * depth).clamp(0.0, 1.0);
    let mut lost = 0.0_f64;
    terminal
        .iter()
        .map(|&v| {
            let most = stage.repoling_volt.map_or(1.0, |repoling| share(repoling - v));
            lost = lost.min(most).max(share(stage.threshold_volt - v));
            1.0 - lost
        })
        .collect()
}
