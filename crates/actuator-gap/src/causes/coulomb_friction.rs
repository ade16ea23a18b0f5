//! Dry friction in the linkage.

use super::cause::{BenchCause, FORM_ERROR, logarithmic};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{CoulombFriction, LinkageStage};

/// Dry friction in the linkage.
pub(super) struct DryFriction;

impl BenchCause for DryFriction {
    fn cause(&self, design: &Design) -> Cause {
        Cause {
            id: "coulomb-friction",
            physics: "Dry friction against the elasticity of the linkage, width 2 F_c / k.",
            parameters: vec![logarithmic(
                "width",
                "um",
                1e-4 * design.half_stroke,
                0.5 * design.half_stroke,
            )],
            form_error: FORM_ERROR,
            fingerprint: "as backlash with rounded corners, changed by preload",
            confused_with: &["backlash"],
            separating: &["preload", "small-motion"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        [0.005, 0.015, 0.04, 0.1].iter().map(|part| vec![part * design.half_stroke]).collect()
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain
            .rear
            .linkage
            .push(LinkageStage::CoulombFriction(CoulombFriction { width_um: values[0] }));
    }
}
