//! Backlash in the lever.

use super::cause::{BenchCause, growing, logarithmic, singles, usual};
use model_gap::{Candidate, Class};
use preisach_dyn::{Backlash, LinkageStage};

/// Backlash in the lever.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        let of_stroke = |part: f64| part * design.half_stroke;
        Candidate {
            id: "backlash",
            physics: "Lost motion in a joint: the output stands until the gap is taken up; a free density absorbs it.",
            parameters: vec![growing(logarithmic("width", "um", of_stroke(1e-4), of_stroke(0.5)))],
            class: Class::LostMotion,
            fingerprint: "flat after every reversal, relatively larger at small motion",
            confused_with: &["coulomb-friction"],
            separating: &["preload", "small-motion"],
            starts: singles([0.005, 0.015, 0.04, 0.1].map(of_stroke)),
            ..usual()
        }
    },
    apply: |chain, values| {
        chain.rear.linkage.push(LinkageStage::Backlash(Backlash { width_um: values[0] }));
    },
};
