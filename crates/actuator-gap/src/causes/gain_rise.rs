//! A larger gain, which no cause of the library brings about.

use super::cause::{BenchCause, FORM_ERROR, amount, singles};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;

/// Every output larger by one factor: a sensor set anew, another support, another scale.
///
/// It stands among the candidates so that data which only show it are not given the name of a cause that can bend
/// its way there, as a characteristic of the sensor can; a smaller gain is what a load spring does.
pub(crate) struct GainRise;

impl BenchCause for GainRise {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "gain-rise",
            physics: "All outputs larger than those of the base model by one factor, y = (1 + rise) h.",
            parameters: vec![amount("rise", "1", 0.0, 2.0)],
            form_error: FORM_ERROR,
            fingerprint: "pure gain, no harmonics",
            confused_with: &["sensor-nonlinearity", "load-stiffness"],
            separating: &["laser-cross-check"],
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

    fn decoy(&self) -> Option<&'static str> {
        Some("a sensor or a scale set anew")
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.rear.gain = Some(1.0 + values[0].max(0.0));
    }
}
