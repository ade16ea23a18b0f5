//! Aeroelastic coupling: periodic blade response, force-summation blade loads, hub loads.

mod answers;
mod error;
mod loads;
mod march;
mod model;
mod response;
mod sections;
mod structure;

pub use answers::airloads::{SectionAirload, StationAirloads, TipMotion};
pub use answers::changes::{StateChange, WakeDrive};
pub use answers::coupled_modes::{CoupledBladeMode, LOW_DAMPING_RATIO, RESONANCE_PER_REV};
pub use answers::dissimilar::{OtherBlade, dissimilar_hub_loads};
pub use answers::linearised::{
    Disturbance, FlapDirection, HubSensitivity, InflowState, LinearisedRotor,
};
pub use answers::section_lift::SectionLift;
pub use answers::stability::{BladeMotion, SectionLags, Stability};
pub use answers::state_space::{BladeStateSpace, BladesTogether, MultibladeStateSpace};
pub use answers::station_loads::{LoadHistory, StationLoads};
pub use error::ResponseError;
pub use loads::power::PowerBalance;
pub use loads::wrenches::{SixLoads, hub_loads};
pub use march::{BladePanels, BladesInTime, Instant, InstantDrive, RotorInTime};
pub use model::flap::{FlapMass, TrailingEdgeFlap};
pub use model::flap_mass::with_flap_masses;
pub use model::rotor_model::{
    Compressibility, Controls, Couplings, Discretisation, Planform, ReverseFlow, RotorModel,
    SectionOffsets,
};
pub use model::section_settings::{Camber, DynamicStall, NonlinearSections};
pub use model::span::SpanGrid;
pub use response::hinge::HingeMoment;
pub use response::rotor::{Condition, Rotor};
pub use response::solver::{ResponseResiduals, ResponseTolerances, RotorSolution, RotorSolver};
pub use structure::blade::ResponseBlade;

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
