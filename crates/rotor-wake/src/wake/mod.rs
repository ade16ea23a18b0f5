//! The free vortex wake on the grid of azimuth and wake age.

mod blades;
mod circulation;
mod filament;
mod free_wake;
mod inflow_map;
mod influence;
mod march;
mod passage;
mod placement;
mod rotor;
mod settings;
mod solve;
mod sources;
mod sweep;
mod velocity;

pub use blades::BladeLines;
pub use circulation::CirculationMap;
pub use free_wake::{FreeWake, WakeFilament};
pub use inflow_map::InflowMap;
pub use influence::{FrozenWake, LineInduction};
pub use march::{WakeMarch, contraction_drift};
pub use passage::{ClosestPassage, FilamentStates, SegmentState};
pub use rotor::WakeRotor;
pub use settings::{
    ControlPoint, CoreSettings, FarField, FarTrailers, FreeWakeSettings, NearWakeMotion,
    ReleasePoint, ShedVorticity, StrainEffect, WakeMethod, WakeSymmetry,
};
pub use solve::WakeConvergence;
