//! Case files, data files, studies and the `hhc` command of rotor-hhc.

pub mod case;
mod error;
pub mod files;
pub mod problem;

pub use error::{Family, SimError};
