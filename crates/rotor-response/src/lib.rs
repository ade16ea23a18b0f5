//! Aeroelastic coupling: periodic blade response, force-summation blade loads, hub loads.

mod air;
mod blade;
mod error;
mod flap_inertia;
mod flap_mass;
mod flight_air;
mod hinge;
mod lag;
mod loads;
mod model;
mod motion;
mod rigid;
mod rotor;
mod span;
mod structure;
mod system;

pub use blade::{Couplings, FlapMass, ResponseBlade, TrailingEdgeFlap};
pub use error::ResponseError;
pub use flap_mass::with_flap_masses;
pub use hinge::HingeMoment;
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
