//! Rotor inflow models behind one trait.
//!
//! Every model maps the state of flight and the loading of the rotor to the induced part of the
//! inflow over the disk.
//!
//! | model | items |
//! |---|---|
//! | linear over the disk: prescribed, uniform (Glauert's momentum theory), Drees | [`LinearInflow`] |
//! | mean and gradients from thrust and its first harmonics | [`PittPeters`] |
//! | free wake: converged geometry, march in time, wake held still | [`FreeWake`], [`WakeMarch`], [`FrozenWake`] |
//! | flow round a fuselage | [`Body`] |
//! | vortex kernel | [`SegmentSet`], [`induced_velocities`] |
//!
//! ```text
//! lambda(psi, r) = mu tan(alpha_s) + lambda_i(psi, r),       positive down through the disk
//! ```
//!
//! # Example
//! ```
//! use rotor_wake::{FlightState, InflowModel, LinearInflow, RotorLoading};
//!
//! let flight = FlightState { advance_ratio: 0.30, shaft_tilt_rad: 5.0_f64.to_radians() };
//! let loading = RotorLoading::from_thrust_coefficient(0.0049);
//! let inflow = LinearInflow::Drees.induced(&flight, &loading)?;
//!
//! let over_the_tail = inflow.at(0.0, 0.8);
//! let over_the_nose = inflow.at(std::f64::consts::PI, 0.8);
//! assert!(over_the_tail > over_the_nose); // the wake sweeps aft
//! # Ok::<(), rotor_wake::WakeError>(())
//! ```
//!
//! # Conventions
//! Velocities are divided by the tip speed `Omega R`, radial stations by `R`; azimuth is zero with
//! the blade over the tail and grows with rotation, counter-clockwise seen from above.

mod body;
mod disk;
mod error;
mod inflow;
mod kernel;
mod linear;
mod momentum;
mod pitt_peters;
mod vector;
mod wake;

pub use body::Body;
pub use disk::blades::{BladeLines, BladePlace};
pub use disk::circulation::CirculationMap;
pub use disk::inflow_map::InflowMap;
pub use disk::rotor::WakeRotor;
pub use error::WakeError;
pub use inflow::{FlightState, InducedInflow, InflowModel, RotorLoading};
pub use kernel::{
    CoreModel, SegmentSet, arc_velocity, induced_velocities, induced_velocities_serial,
};
pub use linear::{LinearInflow, drees_factors};
pub use momentum::{
    VORTEX_RING_TRANSPORT, WAKE_BREAKDOWN_TRANSPORT, descent_transport, inflow_over_momentum,
    momentum_inflow, wake_skew_rad,
};
pub use pitt_peters::PittPeters;
pub use vector::Vec3;
pub use wake::{
    CirculationSlope, ClosestPassage, ControlPoint, CoreSettings, FarField, FarTrailers, FeltNow,
    FilamentStates, FreeWake, FreeWakeSettings, FrozenWake, LineInduction, MotionSlope,
    NearWakeMotion, ReleasePoint, SegmentState, ShedVorticity, VortexCrossing, WakeFilament,
    WakeInTime, WakeMarch, WakeMethod, WakeSymmetry,
};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
