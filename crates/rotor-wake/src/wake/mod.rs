//! The free vortex wake on the grid of azimuth and wake age.

mod crossing;
mod filament;
mod free_wake;
mod in_time;
mod influence;
mod march;
mod passage;
mod placement;
mod row_blocks;
mod settings;
mod sources;
mod sweep;
mod velocity;

pub use crossing::VortexCrossing;
pub use free_wake::{FreeWake, WakeFilament};
pub use in_time::{FeltNow, WakeInTime};
pub use influence::{CirculationSlope, FrozenWake, LineInduction, MotionSlope};
pub use march::WakeMarch;
pub use passage::{ClosestPassage, FilamentStates, SegmentState};
pub use settings::{
    ControlPoint, CoreSettings, FarField, FarTrailers, FreeWakeSettings, NearWakeMotion,
    ReleasePoint, ShedVorticity, WakeMethod, WakeSymmetry,
};
