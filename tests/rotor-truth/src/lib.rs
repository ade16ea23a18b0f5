//! An independent rotor that makes points of test with a hidden effect.
//!
//! A diagnosis can be judged only against something it did not make itself. This package shares nothing with the product: its
//! modes are polynomials, its periodic response is collocated in Fourier series, its lags and its hysteresis are its own.
//!
//! - [`physics`]: elastic blades, airloads, inflow, trim, hub loads, in rotor units.
//! - [`set`]: the machine in SI units, effects, points, noise, files.
//!
//! Same seed, same numbers, on any number of threads.

pub mod error;
pub mod physics;
pub mod set;
