//! Azimuth grids, harmonics, quadrature, frames, nondimensional groups and numbers side by side, shared by every crate of
//! rotor-hhc.
//!
//! This is floor 0 of the house: it knows no blade, no actuator and no file.
//!
//! # Conventions
//! - azimuth `psi` is zero with the blade over the tail (aft) and grows in the sense of rotation,
//!   counter-clockwise seen from above;
//! - hub axes: X aft, Y starboard (`psi = 90 deg`), Z up, right-handed;
//! - rotating blade axes: x outboard, y toward the leading edge, z up;
//! - a harmonic is written `c cos(n psi) + s sin(n psi) = A cos(n psi - phase)`.

mod error;
mod frames;
mod harmonics;
mod lanes;
pub mod limit;
pub mod once;
mod quadrature;
mod record_use;
mod rests;
mod scales;
pub mod series;
mod stats;

pub use error::BaseError;
pub use frames::rotating_to_fixed;
pub use harmonics::{Harmonic, HarmonicSeries, harmonic_waves, uniform_azimuths_rad, wrap_degrees};
pub use lanes::{LANES, Lanes, Number};
pub use limit::{Limit, UNBOUNDED};
pub use quadrature::{LagrangeBasis, QuadratureRule, gauss_legendre, gauss_lobatto_nodes};
pub use record_use::RecordUse;
pub use rests::rests;
pub use scales::RotorScales;
pub use stats::{mean, mean_square, significant, variance};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
