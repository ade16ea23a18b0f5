//! A larger gain, which no cause of the library brings about.

use super::cause::{BenchCause, amount, singles, usual};
use model_gap::Candidate;

/// Every output larger by one factor: a sensor set anew, another support, another scale.
///
/// It stands among the candidates so that data which only show it are not given the name of a cause that can bend
/// its way there, as a characteristic of the sensor can; a smaller gain is what a load spring does.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "gain-rise",
        physics: "All outputs larger than those of the base model by one factor, y = (1 + rise) h.",
        parameters: vec![amount("rise", "1", 0.0, 2.0)],
        fingerprint: "pure gain, no harmonics",
        confused_with: &["sensor-nonlinearity", "load-stiffness"],
        separating: &["laser-cross-check"],
        starts: singles([0.01, 0.05]),
        blocked: design.no_reference(),
        decoy: Some("a sensor or a scale set anew"),
        ..usual()
    },
    apply: |chain, values| chain.rear.gain = Some(1.0 + values[0].max(0.0)),
};
