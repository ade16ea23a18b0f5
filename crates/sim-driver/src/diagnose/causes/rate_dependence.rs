//! Rate dependence of the hysteresis.

use super::{BenchCause, Design, FORM_ERROR, Part, linear, logarithmic, shape};
use model_gap::{Cause, Side};

/// Rate dependence of the hysteresis.
pub(super) struct RateDependence;

impl BenchCause for RateDependence {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "rate-dependence",
            physics: "Domains take time: the law relaxes towards its static value, with a time that depends on its state.",
            side: Side::State,
            parameters: vec![
                logarithmic("tau", "s", 1e-5, 0.05),
                shape(linear("position", "1", -0.6, 0.6)),
            ],
            form_error: FORM_ERROR,
            fingerprint: "phase and loop area grow with frequency and depend on amplitude and place; odd harmonics",
            confused_with: &["electrical-lag", "transport-delay", "sensor-filter"],
            separating: &["multisine-5-181Hz", "amplitude-sweep", "laser-cross-check"],
        }
    }

    fn starts(&self, _: &Design) -> Vec<Vec<f64>> {
        [2e-4, 1e-3, 4e-3, 0.015]
            .iter()
            .flat_map(|tau| [vec![*tau, 0.1], vec![*tau, -0.1]])
            .collect()
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        design.one_frequency()
    }

    fn part(&self, values: &[f64]) -> Part {
        Part::RateDependence { tau_s: values[0], position: values[1] }
    }
}

/// The law's output relaxing towards its static value.
///
/// ```text
/// y' = (h - y) / tau(y),   tau(y) = tau (1 + position (y - middle) / spread)
/// ```
/// Each step takes the relaxation time of its first state and is then exact for an `h` straight over
/// the step. `scale` is middle and spread of the output.
/// Source: I. D. Mayergoyz, *Dynamic Preisach models of hysteresis*, IEEE Transactions on Magnetics 24
/// (1988): relaxation towards the static value, with a state-dependent time.
pub(crate) fn rate_dependent(
    law: &[f64],
    tau_s: f64,
    position: f64,
    scale: (f64, f64),
    step_s: f64,
) -> Vec<f64> {
    let (middle, spread) = scale;
    let mut before = law.first().copied().unwrap_or_default();
    let mut deviation = 0.0;
    law.iter()
        .map(|&h| {
            let place = (before + deviation - middle) / spread;
            let tau = tau_s * (1.0 + position * place).clamp(0.1, 10.0);
            let x = step_s / tau;
            let decay = (-x).exp();
            deviation = decay * deviation - (1.0 - decay) / x * (h - before);
            before = h;
            h + deviation
        })
        .collect()
}
