//! Control in time along a flight whose advance ratio changes and whose flaps may fail.
//!
//! - *Rotor* ([`RotorPath`]): trims at knots of advance ratio; loads and their answer to the flaps are linearised there and
//!   interpolated linearly in between. Every revolution is a steady state.
//! - *Flaps* ([`FlapMarch`]): every actuator is marched sample by sample through its hysteresis, all harmonics at once, its
//!   bias slowly led so that the mean flap angle vanishes.
//! - *Loop* ([`fly`]): a cycle is some revolutions to settle and a window of the analyser; then the next control.
//!
//! Values in, values out: no file, no terminal.

mod error;
mod flaps;
mod flight;
mod path;

pub use error::FlightError;
pub use flaps::FlapMarch;
pub use flight::{FlapFailure, Flight, FlightPoint, Guidance, fly};
pub use path::RotorPath;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
