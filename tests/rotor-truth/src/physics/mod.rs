//! The rotor: elastic blades in modes, unsteady thin-aerofoil loads, inflow, trim, hub loads.
//!
//! Units of this module: radius `R`, mass per length `m0`, time `1/Omega`. A blade rotates about `z`, `x` out along it, `y`
//! toward its leading edge, azimuth 0 aft and counter-clockwise from above. Hub axes: `X` aft, `Y` starboard, `Z` up.

pub mod airload;
pub mod balance;
pub mod blade;
pub mod fourier;
pub mod hub;
pub mod inflow;
pub mod kinematics;
pub mod lag;
pub mod modes;
pub mod newton;
pub mod residual;
pub mod span;
pub mod trim;
