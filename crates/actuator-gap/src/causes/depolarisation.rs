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
            physics: "Below a threshold polarisation is lost, and the gain with it: at once, by the volts below, and for as long as the voltage stays there, p' = rate (threshold - V).",
            parameters: vec![
                linear("threshold", "V", low - 0.01, inside(0.25)),
                shape(logarithmic("loss_per_volt_second", "1/(V s)", 1e-6, 1.0)),
                shape(linear("about", "1", -0.5, 1.5)),
                shape(logarithmic("loss_per_volt", "1/V", 1e-6, 0.1)),
            ],
            class: Class::LossOfPolarisation,
            fingerprint: "a gain that falls with the volts and the time below the threshold and stays lost",
            confused_with: &["voltage-saturation", "sensor-nonlinearity", "load-stiffness"],
            separating: &["bias-sweep"],
            starts: [0.04, 0.1, 0.18]
                .map(|part| {
                    let loss = |with_time, at_once| vec![inside(part), with_time, 0.0, at_once];
                    [loss(1e-3, 1e-6), loss(1e-2, 1e-6), loss(1e-6, 3e-3)]
                })
                .concat(),
            blocked,
            ..usual()
        }
    },
    apply: |chain, values| {
        let stage = Depolarisation {
            threshold_volt: values[0],
            loss_per_volt: values[3],
            loss_per_volt_second: values[1],
            repoling_volt: None,
        };
        chain.front.amplifier.push(AmplifierStage::Depolarisation(stage));
        chain.front.loss_about = values[2];
    },
};
