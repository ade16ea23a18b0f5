//! Rotating blade finite elements: the 15-dof beam element, rotating modes, finite elements in time.
//!
//! Floor 1 of the house: it knows structure and time, but no air, no trim and no file.
//!
//! | question | answer |
//! |---|---|
//! | What is the blade? | [`BladeSpec`], checked by [`BladeProperties`] |
//! | What are its matrices? | [`BladeModel`] |
//! | At which frequencies does it vibrate? | [`modes`] |
//! | How does it deflect, and vibrate about that? | [`ModerateModel`], [`deflected_modes`] |
//! | What are its modal equations then? | [`ModalBlade`] |
//! | Which shapes does the response use? | [`uncoupled_modes`] and its [`ModeSet`] |
//! | Which motion repeats every revolution? | [`PeriodicSolver`] for any [`PeriodicSystem`] |
//! | Is that motion stable? | [`Floquet`] |
//!
//! # Conventions
//! Rotor units throughout: length R, mass m0 R, time 1/Omega, so stiffnesses are EI / (m0 Omega^2 R^4)
//! and rates are per rad of azimuth. Rotating blade axes: x outboard, y toward the leading edge, z up;
//! displacements u, v, w along them and twist phi nose up. Stations are radii r/R, the tip at 1.
//!
//! # Example
//! ```
//! use rotor_fem::{
//!     BladeProperties, BladeSpec, ModalBasis, ModeCount, ModeKind, uncoupled_modes,
//! };
//!
//! // flap, lag, torsion and axial stiffness of a hingeless blade
//! let blade = BladeProperties::new(BladeSpec::uniform(0.0108, 0.0268, 0.00615, 200.0))?;
//! let set = uncoupled_modes(&blade, 20, ModeCount::default(), ModalBasis::Natural)?;
//! let first_flap = &set.of(ModeKind::Flap)[0];
//! assert!((first_flap.per_rev - 1.125_79).abs() < 1e-5);
//! assert_eq!(first_flap.shape(1.0)?[0], 1.0);
//! # Ok::<(), rotor_fem::FemError>(())
//! ```

mod beam;
mod error;
mod moderate;
mod modes;
mod periodic;
mod stability;

pub use beam::assembly::{BladeModel, SectionMotion};
pub use beam::distribution::Distribution;
pub use beam::mode_kind::{ModeKind, PerFamily};
pub use beam::properties::{BladeProperties, BladeSpec, Twist};
pub use beam::root_support::{Joint, RootSupport};
pub use error::FemError;
pub use moderate::{
    AxialMotion, ModalBlade, ModalLoads, ModalMotion, ModalShape, ModerateBlade, ModerateModel,
    ModerateSpec, NodalMotion, PitchMotion, SectionShape, StaticSettings, StaticState, Tangents,
    TorsionTerms, TwistAngle, Untwist, deflected_modes,
};
pub use modes::coupled::{CoupledMode, EnergyShares, GyroscopicTerms, modes};
pub use modes::mode_set::{ModalBasis, ModeCount, ModeSet, UncoupledMode, uncoupled_modes};
pub use periodic::acceleration::Anderson;
pub use periodic::error::PeriodicError;
pub use periodic::linear_response::LinearResponse;
pub use periodic::orbit_memory::OrbitMemory;
pub use periodic::solver::{OrbitBound, PeriodicSettings, PeriodicSolution, PeriodicSolver};
pub use periodic::system::{LocalTangent, PeriodicSystem};
pub use periodic::time_elements::{Orbit, OrbitSamples, TimeElements};
pub use stability::floquet::{Floquet, FloquetMode};
pub use stability::monodromy::{LagChannel, LagPlace};
pub use stability::oscillations::{Oscillation, oscillations};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
