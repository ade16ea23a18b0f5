//! First mechanical mode.

use super::cause::{BenchCause, FORM_ERROR, logarithmic};
use super::chain::Chain;
use super::design::Design;
use model_gap::Cause;
use preisach_dyn::{LinkageStage, Resonance};

/// Highest frequency of a first mode, Hz. One above the runs shows by its tail, (f / fn)^2.
const HIGHEST_HZ: f64 = 2000.0;

/// Frequency up to which a mode may ring within the runs, Hz: 400 Hz or what sampling carries well.
fn ringing_hz(design: &Design) -> f64 {
    (0.8 * design.nyquist_hz).clamp(30.0, 400.0)
}

/// First mechanical mode.
pub(super) struct MechanicalResonance;

impl BenchCause for MechanicalResonance {
    fn cause(&self, _: &Design) -> Cause {
        Cause {
            id: "mechanical-resonance",
            physics: "First mode of actuator, linkage and flap, y'' + 2 zeta w y' + w^2 y = w^2 h.",
            parameters: vec![
                logarithmic("frequency", "Hz", 20.0, HIGHEST_HZ),
                logarithmic("damping_ratio", "1", 1e-3, 0.2),
            ],
            form_error: FORM_ERROR,
            fingerprint: "gain growing as (f / fn)^2, ringing after steps",
            confused_with: &["sensor-filter", "electrical-lag", "transport-delay"],
            separating: &["ring-down", "multisine-5-181Hz"],
        }
    }

    fn starts(&self, design: &Design) -> Vec<Vec<f64>> {
        let ringing = ringing_hz(design);
        let mut starts = Vec::new();
        let mut hz = 30.0;
        while hz < HIGHEST_HZ {
            starts.push(vec![hz, 0.03]);
            // peaks are narrow, tails are not
            hz *= if hz < ringing { 1.07 } else { 1.5 };
        }
        starts
    }

    fn blocked(&self, design: &Design) -> Option<String> {
        design.one_frequency().or_else(|| {
            (design.nyquist_hz < 60.0).then(|| {
                format!("sampling carries {:.0} Hz; a first mode lies higher", design.nyquist_hz)
            })
        })
    }

    fn apply(&self, chain: &mut Chain, values: &[f64]) {
        chain.rear.linkage.push(LinkageStage::Resonance(Resonance {
            frequency_hz: values[0],
            damping_ratio: values[1],
        }));
    }
}
