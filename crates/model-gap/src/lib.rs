//! Measured against simulated: experiments, splits by experiment and measures of misfit.
//!
//! An [`Experiment`] holds one record of an input and an output; a simulation of the same input is
//! compared with the measured output. This crate knows neither actuator nor rotor: it is handed
//! numbers with their unit and gives numbers back.
//!
//! - [`Misfit`]: NRMSE, rms, bias and largest error of one record;
//! - [`FirstHarmonicError`], [`ResidualHarmonics`]: how far amplitude and phase are off, and what the
//!   simulation leaves at harmonics 1, 2, 3...;
//! - [`NoiseEstimate`]: measurement noise from repeated cycles, never from the residual;
//! - [`EnergySplit`]: which part of the measured energy is explained, which is noise, and which is
//!   structure that the simulation misses;
//! - [`SplitRule`], [`Summary`]: which experiments train and which are held out, and the errors of
//!   both sets apart.
//!
//! Residuals are measured minus simulated throughout.
//!
//! # Example
//! ```
//! use model_gap::{FirstHarmonicError, Misfit};
//! use std::f64::consts::TAU;
//!
//! let time_step_s = 1e-3;
//! let wave = |amplitude: f64, lag_rad: f64| -> Vec<f64> {
//!     (0..1000).map(|i| amplitude * (TAU * 5.0 * f64::from(i) * time_step_s - lag_rad).cos()).collect()
//! };
//! let (measured, simulated) = (wave(2.0, 0.5), wave(2.2, 0.4));
//! let misfit = Misfit::of(&measured, &simulated)?;
//! assert!((misfit.nrmse - 0.145).abs() < 1e-3); // |2 - 2.2 exp(0.1 i)| / 2
//! let first = FirstHarmonicError::of(&measured, &simulated, time_step_s, 5.0)?;
//! assert!((first.amplitude_ratio - 1.1).abs() < 1e-12);
//! assert!((first.phase_error_deg + 0.1_f64.to_degrees()).abs() < 1e-9); // too early
//! # Ok::<(), model_gap::GapError>(())
//! ```

mod cause;
pub mod discovery;
mod energy;
mod error;
mod experiment;
mod harmonics;
mod misfit;
mod noise;
mod resampling;
mod split;
mod stimulus;
mod summary;

pub use cause::{Candidate, Cause, Effect, Parameter, Scale, Side};
pub use energy::EnergySplit;
pub use error::GapError;
pub use experiment::{Channel, Experiment, Role, Use};
pub use harmonics::{FirstHarmonicError, HarmonicFit, ResidualHarmonic, ResidualHarmonics};
pub use misfit::Misfit;
pub use noise::NoiseEstimate;
pub use resampling::NoiseDraw;
pub use split::SplitRule;
pub use stimulus::Stimulus;
pub use summary::{RunError, Summary, WorstRun};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
