//! Stiffness of the load.

use super::cause::{BenchCause, amount, singles, usual};
use super::design::{Design, SHOWS};
use model_gap::{Candidate, Class};
use preisach_dyn::{LinkageStage, LoadStiffness};

/// Stiffness of the load.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "load-stiffness",
        physics: "A load spring takes part of the stroke, y = h k_a / (k_a + k_load).",
        parameters: vec![amount("stiffness_ratio", "1", 0.0, 2.0)],
        class: Class::StaticGain,
        is_common: true,
        is_told: design.load_told_runs > 0,
        fingerprint: "pure gain below 1, no harmonics",
        confused_with: &[
            "amplifier-gain",
            "sensor-gain",
            "dielectric-heating",
            "creep",
            "sensor-nonlinearity",
        ],
        separating: &["laser-cross-check", "amplifier-monitor"],
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
            "the load cell reads no load that follows the displacement beyond that of the reference runs: {slope:.1e} N/um, give or take {error:.1e}"
        )
    })
}
