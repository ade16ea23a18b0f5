//! Creep beyond that of the reference runs.

use super::cause::{BenchCause, FORM_ERROR, amount, logarithmic, shape};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{LinkageStage, LogCreep};

/// Creep beyond that of the reference runs.
pub(super) struct Creep;

impl BenchCause for Creep {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "creep",
            physics: "Slow growth after a move, y = U [1 + rate log10(t / 0.1 s)], beyond the creep of the reference runs.",
            parameters: vec![
                amount("rate_per_decade", "1", 0.0, 0.3),
                shape(logarithmic("from", "s", 1e-3, 3.0)),
            ],
            form_error: FORM_ERROR,
            fingerprint: "grows as frequency falls, linear in amplitude, a straight line in log t after a step",
            confused_with: &["dielectric-heating", "load-stiffness", "rate-dependence"],
            separating: &["hold-steps-100s"],
        }
    }

    fn starts(&self, _: &Design) -> Vec<Vec<f64>> {
        vec![vec![0.01, 0.1], vec![0.01, 0.01]]
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        (design.longest_s < 1.0)
            .then(|| {
                format!("the longest run lasts {:.2} s; creep needs seconds", design.longest_s)
            })
            .or_else(|| design.one_frequency())
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.rear.linkage.push(LinkageStage::LogCreep(LogCreep {
            rate_per_decade: values[0].max(0.0),
            from_s: values[1],
            to_s: 1000.0,
        }));
    }
}
