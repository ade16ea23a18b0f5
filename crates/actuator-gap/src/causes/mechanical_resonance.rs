//! First mechanical mode.

use super::cause::{BenchCause, logarithmic, usual};
use super::design::Design;
use model_gap::{Candidate, Class};
use preisach_dyn::{LinkageStage, Resonance};

/// Highest frequency of a first mode, Hz. One above the runs shows by its tail, (f / fn)^2.
const HIGHEST_HZ: f64 = 2000.0;

/// First mechanical mode.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "mechanical-resonance",
        physics: "First mode of actuator, linkage and flap, y'' + 2 zeta w y' + w^2 y = w^2 h.",
        parameters: vec![
            logarithmic("frequency", "Hz", 20.0, HIGHEST_HZ),
            logarithmic("damping_ratio", "1", 1e-3, 0.2),
        ],
        class: Class::Resonance,
        is_common: true,
        fingerprint: "gain growing as (f / fn)^2, ringing after steps",
        confused_with: &["sensor-filter", "electrical-lag", "transport-delay"],
        separating: &["ring-down", "multisine-5-181Hz"],
        starts: starts(design),
        blocked: design.one_frequency().or_else(|| {
            (design.nyquist_hz < 60.0).then(|| {
                format!("sampling carries {:.0} Hz; a first mode lies higher", design.nyquist_hz)
            })
        }),
        ..usual()
    },
    apply: |chain, values| {
        let mode = Resonance { frequency_hz: values[0], damping_ratio: values[1] };
        chain.rear.linkage.push(LinkageStage::Resonance(mode));
    },
};

fn starts(design: &Design) -> Vec<Vec<f64>> {
    // a mode may ring within the runs up to 400 Hz or what sampling carries well
    let ringing_hz = (0.8 * design.nyquist_hz).clamp(30.0, 400.0);
    // peaks are narrow, tails are not
    let next = |hz: &f64| Some(hz * if *hz < ringing_hz { 1.07 } else { 1.5 });
    let frequencies = std::iter::successors(Some(30.0), next).take_while(|hz| *hz < HIGHEST_HZ);
    frequencies.map(|hz| vec![hz, 0.03]).collect()
}
