//! The free vortex wake on the grid of azimuth and wake age.

mod blades;
mod circulation;
mod filament;
mod influence;
mod inflow_map;
mod march;
mod rotor;
mod settings;
mod solve;
mod sources;
mod sweep;

pub use blades::BladeLines;
pub use circulation::CirculationMap;
pub use influence::{FrozenWake, LineInduction};
pub use inflow_map::InflowMap;
pub use march::{WakeMarch, contraction_drift};
pub use rotor::WakeRotor;
pub use settings::{
    CoreSettings, FarTrailers, FreeWakeSettings, NearWakeMotion, ShedVorticity, StrainEffect,
};
pub use solve::{ClosestPassage, WakeConvergence};
pub use sweep::{FreeWake, WakeFilament};
