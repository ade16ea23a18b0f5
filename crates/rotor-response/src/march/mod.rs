//! Blades marched in time, each on its own: no period is asked for.

mod blades;
mod instant;
mod panels;

pub use blades::{BladesInTime, RotorInTime};
pub use instant::{Instant, InstantDrive};
pub use panels::BladePanels;
