//! Backlash in the lever.

use super::cause::{BenchCause, FORM_ERROR, logarithmic};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{Backlash, LinkageStage};

/// Backlash in the lever.
pub(super) struct BacklashInLever;

impl BenchCause for BacklashInLever {
    fn cause(&self, design: &Design) -> Cause {
        Cause {
            id: "backlash",
            physics: "Lost motion in a joint: the output stands until the gap is taken up; a free density absorbs it.",
            parameters: vec![logarithmic(
                "width",
                "um",
                1e-4 * design.half_stroke,
                0.5 * design.half_stroke,
            )],
            form_error: FORM_ERROR,
            fingerprint: "flat after every reversal, relatively larger at small motion",
            confused_with: &["coulomb-friction"],
            separating: &["preload", "small-motion"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        [0.005, 0.015, 0.04, 0.1].iter().map(|part| vec![part * design.half_stroke]).collect()
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.rear.linkage.push(LinkageStage::Backlash(Backlash { width_um: values[0] }));
    }
}
