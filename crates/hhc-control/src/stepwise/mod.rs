//! Control one sample and one cycle at a time: the parts of a loop that flies, without a plant.
//!
//! Every object holds its memory from the start: a sample or a cycle allocates nothing.
//!
//! | part | takes | gives |
//! |---|---|---|
//! | [`HarmonicAnalyser`] | a sample of every channel | harmonics of the last whole revolutions, once a revolution |
//! | [`LoadEstimator`] | a pair (u, Z) | T, Z0 and the noise |
//! | [`RelaxedController`] | T and Z | the next control, within its limits |
//! | [`CycleController`] | Z | the same with the T of the estimator |

mod analyser;
mod cycle;
mod estimator;
mod program;
mod relaxed;

pub use analyser::HarmonicAnalyser;
pub use cycle::CycleController;
pub use estimator::{EstimatorSettings, LoadEstimator, Observed};
pub use relaxed::{RelaxedController, RelaxedSettings};
