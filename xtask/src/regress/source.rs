//! Computes a case of the sweep with the program.

use super::sweep::{SweepPoint, SweepResult};

/// Why a case could not be computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The program has no study to sweep yet.
    #[error("{point}: the program cannot compute this case yet")]
    NotConnected {
        /// The case.
        point: SweepPoint,
    },
}

/// Computes one case with the program.
///
/// # Errors
/// [`SweepError`] with the case.
pub fn sweep_point(point: SweepPoint) -> Result<SweepResult, SweepError> {
    Err(SweepError::NotConnected { point })
}
