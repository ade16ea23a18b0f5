//! Polarisation lost under reverse voltage.

use super::cause::{BenchCause, linear, logarithmic, shape, usual};
use model_gap::{Candidate, Class};
use preisach_dyn::{AmplifierStage, Depolarisation};

/// Polarisation lost under reverse voltage.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        let (low, high) = design.input;
        let inside = |part: f64| low + part * (high - low);
        let blocked = if design.is_bench {
            (low > -1.0).then(|| format!("no run goes below {low:.1} V"))
        } else {
            Some("polarisation belongs to a piezo actuator".into())
        };
        Candidate {
            id: "depolarisation",
            physics: "Below a threshold polarisation is lost for as long as the voltage stays there, p' = rate (threshold - V), and the gain with it.",
            parameters: vec![
                linear("threshold", "V", low - 0.01, inside(0.25)),
                shape(logarithmic("loss_per_volt_second", "1/(V s)", 1e-6, 1.0)),
                shape(linear("about", "1", -0.5, 1.5)),
            ],
            class: Class::LossOfPolarisation,
            fingerprint: "a gain that falls with the time below the threshold and stays lost",
            confused_with: &["voltage-saturation", "sensor-nonlinearity", "load-stiffness"],
            separating: &["bias-sweep"],
            starts: [0.04, 0.1, 0.18]
                .map(|part| [1e-3, 1e-2].map(|rate| vec![inside(part), rate, 0.0]))
                .concat(),
            blocked,
            ..usual()
        }
    },
    apply: |chain, values| {
        let stage = Depolarisation {
            threshold_volt: values[0],
            loss_per_volt: 0.0,
            loss_per_volt_second: values[1],
            repoling_volt: None,
        };
        chain.front.amplifier.push(AmplifierStage::Depolarisation(stage));
        chain.front.loss_about = values[2];
    },
};
