//! Driven flaps: from a voltage to the motion of a flap, and what the hinge moment makes of it.

mod coupling;
mod drive;
mod error;
mod full_scale;
mod hinge_power;
mod motion;

pub use coupling::{COUPLING_TOLERANCE_DEG, CouplingResidual, HingeCoupling};
pub use drive::{FlapDrive, MEAN_FLAP_TOLERANCE_DEG};
pub use error::PlantError;
pub use full_scale::FullScale;
pub use hinge_power::HingePower;
pub use motion::FlapMotion;
