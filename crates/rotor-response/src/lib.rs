//! Aeroelastic coupling: periodic blade response, force-summation blade loads, hub loads.

mod air;
mod blade;
mod coupled_modes;
mod dissimilar;
mod divergence;
mod error;
mod fine_azimuth;
mod flap_inertia;
mod flap_mass;
mod flight_air;
mod hinge;
mod lag;
mod lag_memory;
mod linearised;
mod load_station;
mod loads;
mod model;
mod motion;
mod nonlinear;
mod power;
mod revolution;
mod rigid;
mod root_reaction;
mod rotor;
mod section_lift;
mod section_moments;
mod settling;
mod span;
mod stability;
mod stall_history;
mod station_loads;
mod structure;
mod system;
mod wake_coupling;

pub use blade::{Couplings, FlapMass, ResponseBlade, TrailingEdgeFlap};
pub use coupled_modes::{CoupledBladeMode, HARDLY_DAMPED, RESONANCE_PER_REV};
pub use dissimilar::{OtherBlade, dissimilar_hub_loads};
pub use error::ResponseError;
pub use flap_mass::with_flap_masses;
pub use hinge::HingeMoment;
pub use linearised::{FlapDirection, HubSensitivity, InflowState, LinearisedRotor};
pub use loads::{SixLoads, hub_loads};
pub use model::{
    Compressibility, Controls, Discretisation, ReverseFlow, RotorModel, SectionOffsets,
};
pub use nonlinear::{DynamicStall, NonlinearSections};
pub use power::PowerBalance;
pub use rotor::{
    Condition, ResponseResiduals, ResponseTolerances, Rotor, RotorSolution, RotorSolver,
};
pub use section_lift::SectionLift;
pub use span::SpanGrid;
pub use stability::{BladeMotion, SectionLags, Stability};
pub use station_loads::{LoadHistory, StationLoads};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
