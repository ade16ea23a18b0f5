//! An independent rotor, blade and section that make points of test with a hidden effect.
//!
//! A diagnosis can be judged only against something it did not make itself. This package shares nothing with the product: its
//! modes are polynomials, its periodic response is collocated in Fourier series, its lags and its hysteresis are its own.
//!
//! - [`physics`]: elastic blades, airloads, inflow, trim, hub loads, in rotor units.
//! - [`set`]: a rotor: the machine in SI units, effects, points, noise, files.
//! - [`blade`]: frequencies of a rotating beam, its effects, files.
//! - [`section`]: loads of an oscillating thin aerofoil, its effects, files.
//! - [`kind`]: any of the three.
//!
//! Same seed, same numbers, on any number of threads.

pub mod asked;
pub mod blade;
pub mod draw;
pub mod error;
pub mod kind;
pub mod physics;
pub mod section;
pub mod set;
