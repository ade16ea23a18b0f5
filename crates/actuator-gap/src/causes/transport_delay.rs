//! Transport delay of the reading.

use super::cause::{BenchCause, FORM_ERROR, logarithmic, singles};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{Delay, SensorStage};

/// Transport delay of the reading.
pub(super) struct TransportDelay;

impl BenchCause for TransportDelay {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "transport-delay",
            physics: "The reading comes late, y(t - T).",
            parameters: vec![logarithmic("delay", "s", 1e-5, 0.05)],
            form_error: FORM_ERROR,
            fingerprint: "phase exactly straight in frequency, gain 1",
            confused_with: &["electrical-lag", "sensor-filter", "rate-dependence"],
            separating: &["multisine-5-181Hz", "laser-cross-check"],
        }
    }

    fn starts(&self, _: &Design) -> Vec<Vec<f64>> {
        singles(&[2e-4, 1e-3, 4e-3, 0.015])
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        design.one_frequency()
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.rear.sensor.push(SensorStage::Delay(Delay { delay_s: values[0] }));
    }
}
