//! The rotor in trim: its inflow, its response to moving flaps, and what they do to the hub.

mod authority;
mod continuation;
mod disk;
mod hinge_response;
mod inflow;
mod reconverged;
mod resonance;
mod root_moments;
mod root_pitch;
mod trimmed;

pub use authority::FlapAuthority;
pub(crate) use authority::HARMONICS;
pub use continuation::continued_trim;
pub use disk::DiskLoads;
pub use inflow::{SettledTrim, WakeStatus, settled_trim, wake_status, wake_warnings};
pub(crate) use inflow::{descent_warning, passage_warning};
pub use reconverged::ReconvergedAuthority;
pub use resonance::refuse_resonance;
pub use root_pitch::RootPitchEffect;
pub use trimmed::{TrimmedRotor, UnlikeSolver};
