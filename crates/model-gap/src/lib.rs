//! Measured against simulated: measures of misfit, and the causes of a misfit.
//!
//! A record of an output is compared with a simulation of the same input. This crate knows neither actuator nor rotor: it is handed
//! numbers with their unit and gives numbers back.
//!
//! - [`Misfit`]: NRMSE, rms and bias of one record;
//! - [`HarmonicFit`], [`FirstHarmonicError`]: mean and harmonics of a record, and how far amplitude and
//!   phase of the first one are off;
//! - [`noise_variance`]: measurement noise from repeated cycles, never from the residual;
//! - [`Thinning`]: samples of a record that were interpolated between measured ones;
//! - [`EnergySplit`]: which part of the measured energy is explained, which is noise, and which is
//!   structure that the simulation misses;
//! - [`discovery`]: which of given causes explain a misfit, if any does;
//! - [`points`]: the same at points of test, with anyone's simulation as tables;
//! - [`in_common`]: what the misfits of several specimens have in common.
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

mod bands;
mod cause;
pub mod discovery;
mod energy;
mod error;
mod findings;
mod harmonics;
mod in_common;
mod memo;
mod misfit;
mod noise;
pub mod points;
mod quantile;
mod resampling;
mod sine;
mod spectrum;
mod trace;

pub use cause::{Candidate, Class, Effect, Parameter, Scale, places};
pub use energy::EnergySplit;
pub use error::GapError;
pub use findings::{
    BandValue, ChannelGainValue, ComparedValue, Findings, GainValue, GivenModelValue,
    ParameterValue, ScreenValue, Told, names,
};
pub use harmonics::{FirstHarmonicError, HarmonicFit};
pub use in_common::{InCommon, in_common};
pub use memo::Memo;
pub use misfit::Misfit;
pub use noise::{Thinning, noise_variance};
pub use resampling::{NoiseDraw, SplitMix};
pub use sine::Sine;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
pub use quantile::student_exceeded;
pub use spectrum::{Spectrum, cosine_lines};
