//! Rotor and vehicle equilibrium over the aeroelastic response.

mod balance;
mod coupling;
mod error;
mod in_time;
mod solve;
mod vehicle;
mod wake;
mod wake_linearised;
mod wake_response;
mod wake_settings;

pub use balance::TrimTarget;
pub use error::TrimError;
pub use in_time::{
    CoupledInTime, FlapMotion, InTimeSettings, Interval, RevolutionInTime, SteadyInTime,
    SteadySettings, steady_in_time, steady_mean,
};
pub use solve::{TrimSettings, TrimSlope, TrimSolution, imbalance, mean_lift_coefficient, trim};
pub use vehicle::{AirframeLoads, Attitude, HorizontalTail, Vehicle, equilibrium};
pub use wake::{WakeTrim, trim_in_free_wake, trim_in_free_wake_near};
pub use wake_linearised::{WakeLinearised, linearised_in_wake};
pub use wake_response::{WakeDifference, wake_difference};
pub use wake_settings::{WakeOutcome, WakeTrimSettings, WakeUpdate};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
