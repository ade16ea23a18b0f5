//! Rotor and vehicle equilibrium over the aeroelastic response.

mod error;
mod solve;
mod vehicle;
mod wake;

pub use error::TrimError;
pub use solve::{TrimSettings, TrimSolution, TrimTarget, imbalance, trim};
pub use vehicle::{Attitude, Vehicle, equilibrium, fuselage_drag};
pub use wake::{WakeOutcome, WakeTrim, WakeTrimSettings, WakeUpdate, trim_in_free_wake};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
