//! Creep beyond that of the reference runs.

use super::cause::{BenchCause, amount, logarithmic, shape, usual};
use model_gap::{Candidate, Class};
use preisach_dyn::{LinkageStage, LogCreep};

/// Creep beyond that of the reference runs.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "creep",
        physics: "Slow growth after a move, y = U [1 + rate log10(t / 0.1 s)], beyond the creep of the reference runs.",
        parameters: vec![
            amount("rate_per_decade", "1", 0.0, 0.3),
            shape(logarithmic("from", "s", 1e-3, 3.0)),
        ],
        class: Class::SlowDrift,
        is_common: true,
        fingerprint: "grows as frequency falls, linear in amplitude, a straight line in log t after a step",
        confused_with: &["dielectric-heating", "load-stiffness", "rate-dependence"],
        separating: &["hold-steps-100s"],
        starts: vec![vec![0.01, 0.1], vec![0.01, 0.01]],
        blocked: (design.longest_s < 1.0)
            .then(|| {
                format!("the longest run lasts {:.2} s; creep needs seconds", design.longest_s)
            })
            .or_else(|| design.one_frequency()),
        ..usual()
    },
    apply: |chain, values| {
        chain.rear.linkage.push(LinkageStage::LogCreep(LogCreep {
            rate_per_decade: values[0].max(0.0),
            from_s: values[1],
            to_s: 1000.0,
        }));
    },
};
