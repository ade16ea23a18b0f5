//! Natural modes: eigenvalue problems, coupled modes, sets of uncoupled modes.

pub(crate) mod coupled;
pub(crate) mod eigen;
pub(crate) mod mode_set;
