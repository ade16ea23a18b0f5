//! Dry friction in the linkage.

use super::backlash;
use super::cause::BenchCause;
use model_gap::Candidate;
use preisach_dyn::{CoulombFriction, LinkageStage};

/// Dry friction in the linkage; a joint of a width as backlash is, and searched alike.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "coulomb-friction",
        physics: "Dry friction against the elasticity of the linkage, width 2 F_c / k.",
        fingerprint: "as backlash with rounded corners, changed by preload",
        confused_with: &["backlash"],
        ..(backlash::CAUSE.candidate)(design)
    },
    apply: |chain, values| {
        let friction = CoulombFriction { width_um: values[0] };
        chain.rear.linkage.push(LinkageStage::CoulombFriction(friction));
    },
};
