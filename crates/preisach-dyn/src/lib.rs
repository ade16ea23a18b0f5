//! Hysteretic piezo actuators: static and dynamic Preisach models, identification from bench
//! records, periodic response.
//!
//! Voltage in volt, output in degrees of equivalent flap angle (displacement times a bench gain).
//!
//! | idea | module items |
//! |---|---|
//! | memory: plays on the Preisach triangle | [`PreisachGrid`], [`PlayMemory`], [`PlayMap`] |
//! | static model, paper eq. (2) | [`StaticPreisach`]; classical cross-check [`EverettStaircase`] |
//! | dynamic model, paper eq. (5) | [`DynamicPreisach`], [`output_rate`] |
//! | one actuator, closed orbits, bias, stroke | [`ActuatorModel`], [`PeriodicResponse`] |
//! | identification from bench records | [`identify`](mod@identify) |
//!
//! Source: S. R. Viswamurthy and R. Ganguli, *Experimental and computational investigation of
//! piezoceramic actuator hysteresis phenomenon in helicopter vibration control using dual
//! trailing-edge flaps*; I. D. Mayergoyz, *Dynamic Preisach models of hysteresis*, IEEE
//! Transactions on Magnetics 24 (1988).

mod actuator;
mod dynamics;
mod error;
mod everett;
pub mod forc;
mod grid;
pub mod identify;
mod inverse;
mod memory;
mod periodic;
mod play_map;
mod statics;

pub use actuator::{
    ActuatorLaw, ActuatorMemory, ActuatorModel, Calibration, LinearGain, Simulation, TrainedRange,
};
pub use dynamics::{
    DynamicParameters, DynamicPreisach, OutputHistory, OutputRate, RateForm, StepCounts, TimeOrder,
    output_rate,
};
pub use error::PreisachError;
pub use everett::EverettStaircase;
pub use grid::{PreisachGrid, VoltageRange};
pub use inverse::{InverseSettings, PeriodicInverse};
pub use memory::{PlayMemory, StartState};
pub use periodic::{PeriodicResponse, PeriodicSettings};
pub use play_map::PlayMap;
pub use statics::StaticPreisach;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
