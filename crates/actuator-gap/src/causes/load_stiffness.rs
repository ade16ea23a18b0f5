//! Stiffness of the load.

use super::cause::{BenchCause, amount, singles, usual};
use super::design::Design;
use model_gap::Candidate;
use preisach_dyn::{LinkageStage, LoadStiffness};

/// Standard errors that the slope of a load cell must stand out by.
const SHOWS: f64 = 5.0;

/// Stiffness of the load.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "load-stiffness",
        physics: "A load spring takes part of the stroke, y = h k_a / (k_a + k_load).",
        parameters: vec![amount("stiffness_ratio", "1", 0.0, 2.0)],
        fingerprint: "pure gain, no harmonics",
        confused_with: &["dielectric-heating", "creep", "sensor-nonlinearity"],
        separating: &["laser-cross-check", "bias-sweep"],
        starts: singles([0.01, 0.05]),
        blocked: design.no_reference(),
        refuted: refuted(design),
        ..usual()
    },
    apply: |chain, values| {
        chain.rear.linkage.push(LinkageStage::LoadStiffness(LoadStiffness {
            stiffness_ratio: values[0].max(0.0),
            compliance_um_per_newton: 0.0,
        }));
    },
};

fn refuted(design: &Design) -> Option<String> {
    let (slope, error) = design.load_per_um?;
    (slope.abs() < SHOWS * error).then(|| {
        format!(
            "the load cell reads no load that follows the displacement: {slope:.1e} N/um, give or take {error:.1e}"
        )
    })
}
