//! Generators of synthetic measurements with a known physics that no model of the product contains.
//!
//! A model can be judged only against something it did not make itself. This package makes that
//! something. It depends on no crate of the product, shares no code with it, and its hysteresis is
//! of a family the product does not ship.
//!
//! ```text
//! command (V) -> hysteresis -> relaxation -> creep -> sensor (um)
//! ```
//!
//! Each effect is a [`stage::Stage`] in a file of its own; an actuator is a list of them, stepped at
//! 16 kHz ([`record::INTERNAL_RATE_HZ`]) and read at the rate of the record. Another effect is
//! another stage in the list.
//!
//! ```
//! use truth::actuator::ActuatorParameters;
//! use truth::stage::Stage;
//!
//! let mut actuator = ActuatorParameters::apa500l().chain()?;
//! actuator.settle(65.0);
//! for _ in 0..16_000 {
//!     actuator.step(150.0, 1.0 / 16_000.0);
//! }
//! let after_1_s_um = actuator.step(150.0, 1.0 / 16_000.0);
//! assert!((200.0..300.0).contains(&after_1_s_um));
//! # Ok::<(), truth::error::TruthError>(())
//! ```
//!
//! Same seed, same bytes. The records are rounded to the sensor's counts, far coarser than the
//! last-digit differences between the mathematical libraries of two platforms.

pub mod actuator;
pub mod bench;
pub mod command;
pub mod creep;
pub mod error;
pub mod hidden;
pub mod hysteresis;
pub mod lag;
pub mod lvdt;
pub mod measure;
pub mod record;
pub mod relaxation;
pub mod report;
pub mod stage;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
