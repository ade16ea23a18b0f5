//! Periodic response by finite elements in time.

pub(crate) mod acceleration;
pub(crate) mod error;
pub(crate) mod krylov;
pub(crate) mod linear_response;
pub(crate) mod newton_matrix;
pub(crate) mod orbit_memory;
pub(crate) mod renewal;
pub(crate) mod solver;
pub(crate) mod system;
pub(crate) mod time_elements;
