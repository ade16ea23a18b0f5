//! The errors of this crate.

use actuator_export::ExportError;
use hhc_control::ControlError;

/// Why a controller was not written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RotorExportError {
    /// A name that would not compile.
    #[error(transparent)]
    Name(#[from] ExportError),
    /// Settings or matrices that a controller refuses.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// Knots of a schedule that do not rise, or as many T as there are not knots.
    #[error(
        "the schedule has {knots} advance ratios and {matrices} T, expected as many of both, 1 or more, and advance ratios that rise"
    )]
    Schedule {
        /// Advance ratios.
        knots: usize,
        /// T matrices.
        matrices: usize,
    },
}
