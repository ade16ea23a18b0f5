//! Rotor and free wake marched in time together: no period is asked for, so that there is an answer where none exists.

mod coupled;
mod statistics;
mod steady;

pub use coupled::{CoupledInTime, FlapMotion, InTimeSettings};
pub use statistics::{Interval, steady_mean};
pub use steady::{RevolutionInTime, SteadyInTime, SteadySettings, steady_in_time};
