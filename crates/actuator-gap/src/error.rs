//! The errors of this crate.

use model_gap::GapError;
use preisach_dyn::PreisachError;

/// What a diagnosis can end with.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DiagnosisError {
    /// There is nothing to be explained.
    #[error(
        "no run has the role Measured: all {runs} are references; write `role: Measured` for those to be explained"
    )]
    NothingMeasured {
        /// Runs there.
        runs: usize,
    },
    /// The numerics, or a cause that is not in the library.
    #[error(transparent)]
    Misfit(#[from] GapError),
    /// The actuator model.
    #[error(transparent)]
    Actuator(#[from] PreisachError),
}
