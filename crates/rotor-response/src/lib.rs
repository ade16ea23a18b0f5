//! Aeroelastic coupling: periodic blade response, force-summation blade loads, hub loads.

mod acceleration;
mod air;
mod blade;
mod error;
mod flight_air;
mod lag;
mod loads;
mod model;
mod motion;
mod rigid;
mod rotor;
mod span;
mod structure;
mod system;
mod wake_coupling;

pub use blade::{Couplings, ResponseBlade, TrailingEdgeFlap};
pub use error::ResponseError;
pub use loads::{SixLoads, hub_loads};
pub use model::{Compressibility, Controls, Discretisation, ReverseFlow, RotorModel};
pub use rotor::{
    Condition, ResponseResiduals, ResponseTolerances, RootBending, Rotor, RotorSolution,
    RotorSolver,
};
pub use span::SpanGrid;

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
