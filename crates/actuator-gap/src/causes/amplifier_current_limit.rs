//! Current limit of the amplifier.

use super::cause::{BenchCause, FORM_ERROR, logarithmic};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{AmplifierStage, CurrentLimit};

/// Current limit of the amplifier.
pub(super) struct AmplifierCurrentLimit;

impl BenchCause for AmplifierCurrentLimit {
    fn cause(&self, design: &Design) -> Cause {
        Cause {
            id: "amplifier-current-limit",
            physics: "The amplifier's current is limited into the capacitance, |V'| <= I / C.",
            parameters: vec![logarithmic(
                "slew_rate",
                "V/s",
                0.02 * design.fast_rate.max(1.0),
                50.0 * design.fast_rate.max(1.0),
            )],
            form_error: FORM_ERROR,
            fingerprint: "nothing below a threshold of amplitude times frequency, then triangular, third harmonic",
            confused_with: &["electrical-lag", "voltage-saturation", "rate-dependence"],
            separating: &["amplifier-monitor", "amplitude-sweep"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        [1.8, 1.2, 0.9, 0.6, 0.4, 0.25]
            .iter()
            .map(|part| vec![part * design.fast_rate.max(1.0)])
            .collect()
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        design.one_frequency()
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain
            .front
            .amplifier
            .push(AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: values[0] }));
    }
}
