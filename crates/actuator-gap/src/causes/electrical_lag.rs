//! Electrical lag of amplifier and ceramic.

use super::cause::{BenchCause, FORM_ERROR, logarithmic, singles};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{AmplifierStage, Lag};

/// Electrical lag of amplifier and ceramic.
pub(super) struct ElectricalLag;

impl BenchCause for ElectricalLag {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "electrical-lag",
            physics: "Output resistance of the amplifier into the capacitance of the ceramic, tau V' + V = u, tau = R C.",
            parameters: vec![logarithmic("tau", "s", 1e-5, 0.05)],
            form_error: FORM_ERROR,
            fingerprint: "phase -atan(w tau) before the hysteresis, so that reversal points shrink",
            confused_with: &["transport-delay", "sensor-filter", "rate-dependence"],
            separating: &["amplifier-monitor", "multisine-5-181Hz"],
        }
    }

    fn starts(&self, _: &Design) -> Vec<Vec<f64>> {
        singles(&[2e-4, 1e-3, 4e-3, 0.015])
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        design.one_frequency()
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.front.amplifier.push(AmplifierStage::Lag(Lag { tau_s: values[0] }));
    }
}
