//! Stiffness of the load.

use super::cause::{BenchCause, FORM_ERROR, amount, singles};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{LinkageStage, LoadStiffness};

/// Standard errors that the slope of a load cell must stand out by.
const SHOWS: f64 = 5.0;

/// Stiffness of the load.
pub(super) struct Load;

impl BenchCause for Load {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "load-stiffness",
            physics: "A load spring takes part of the stroke, y = h k_a / (k_a + k_load).",
            parameters: vec![amount("stiffness_ratio", "1", 0.0, 2.0)],
            form_error: FORM_ERROR,
            fingerprint: "pure gain, no harmonics",
            confused_with: &["dielectric-heating", "creep", "sensor-nonlinearity"],
            separating: &["laser-cross-check", "bias-sweep"],
        }
    }

    fn starts(&self, _: &Design) -> Vec<Vec<f64>> {
        singles(&[0.01, 0.05])
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        (!design.has_reference).then(|| {
            "without reference runs a pure gain cannot be told from the actuator's own".to_owned()
        })
    }

    fn refuted(&self, design: &Design) -> Option<String> {
        let (slope, error) = design.load_per_um?;
        (slope.abs() < SHOWS * error).then(|| {
            format!(
                "the load cell reads no load that follows the displacement: {slope:.1e} N/um, give or take {error:.1e}"
            )
        })
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.rear.linkage.push(LinkageStage::LoadStiffness(LoadStiffness {
            stiffness_ratio: values[0].max(0.0),
            compliance_um_per_newton: 0.0,
        }));
    }
}
