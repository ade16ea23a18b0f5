//! Synthetic bench sets with the errors that every laboratory makes.
//!
//! A second generator beside the one of hidden effects, sharing nothing with it nor with the product: other
//! hystereses ([`family`]), another actuator for every seed ([`actuator`]), and errors of gain, zero, monitor
//! and reference runs that no list of causes holds ([`catalogue`]).
//!
//! ```text
//! command -> amplifier -> hysteresis + reversible part -> relaxations -> ceramic -> load -> sensor
//! ```
//!
//! ```
//! use everyday_bench::family::Family;
//! use everyday_bench::hidden::Deal;
//! use everyday_bench::set::{Request, set};
//!
//! let hidden = "sensor-gain:-0.03".parse()?;
//! let set = set(&Request { hidden, ..Request::new(Family::Relays, 7, Deal::All) });
//! assert!((set.answer.effect_share - 0.03).abs() < 1e-9);
//! assert_eq!(set.answer.truths, ["sensor-gain"]);
//! # Ok::<(), everyday_bench::error::EverydayError>(())
//! ```
//!
//! Same seed, same bytes. Every stage is exact while its input runs in straight lines, but for lags whose time
//! constants move and the soft current limit; inputs are straight between steps at least 8 times finer than the record.

pub mod actuator;
pub mod answer;
pub mod catalogue;
mod draw;
mod effect;
pub mod error;
pub mod family;
mod filters;
pub mod hidden;
mod physics;
pub mod runs;
pub mod set;
pub mod simulate;
pub mod text;
pub mod waveform;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
