//! Why the models of a case cannot be built.

use rotor_fem::FemError;
use rotor_response::ResponseError;

/// Why the models of a case cannot be built, with the field of the case that asked for what failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// The blade and its modes.
    #[error("{field}: {source}")]
    Blade {
        /// Field of the case.
        field: String,
        /// What went wrong.
        source: FemError,
    },
    /// The rotor.
    #[error("{field}: {source}")]
    Response {
        /// Field of the case.
        field: String,
        /// What went wrong.
        source: ResponseError,
    },
}
