//! Unsteady thin-aerofoil aerodynamics of a section with a trailing-edge flap.
//!
//! Every attached-flow model of the crate comes down to one structure, [`SectionCoefficients`]:
//!
//! ```text
//! y = direct m + rate dm/dS + sum output x,     dx/dS = pole (input . m - x),     S = U t / b
//! m = [alpha, q, delta, q_delta]                y = [Cn, Cm, Ch]
//! ```
//! and everything that is asked of a section is computed from it: harmonic, steady and indicial
//! responses, time marching that is exact on ramps, and loads in a stream that varies.
//!
//! # Example
//! ```
//! use flap_aero::{AttachedFlowModel, FlapChord, Mach, Motion, harmonic_response};
//!
//! let flap = FlapChord::new(0.20)?;
//! let section = AttachedFlowModel::Incompressible.coefficients(Mach::ZERO, flap)?;
//! let [cn, _cm, _ch] = harmonic_response(&section, 0.5, Motion::Flap);
//! assert!((cn.re - 2.117_807).abs() < 0.05); // Theodorsen, within the error of two lags
//! # Ok::<(), flap_aero::AeroError>(())
//! ```
//!
//! # Conventions
//! | quantity | definition | positive |
//! |---|---|---|
//! | `S` | `U t / b`, semichords travelled, `b = c/2` | |
//! | `k` | `omega c / (2 U)` | |
//! | `alpha` | normal velocity at the quarter chord over `U`, rad | nose-up; plunge down |
//! | `q`, `q_delta` | `theta_dot c / U`, `delta_dot c / U` | nose-up; trailing edge down |
//! | `delta` | flap angle, rad | trailing edge down |
//! | `Cn` | on `rho U^2 c / 2` | up |
//! | `Cm` | on `rho U^2 c^2 / 2`, about the quarter chord | nose-up |
//! | `Ch` | on `rho U^2 c^2 / 2` (full chord), about the hinge | in the sense of `delta` |
//!
//! The flap is plain: no gap, no aerodynamic balance, its leading edge is the hinge.
//!
//! # Modules
//! `theodorsen` the flap functions; `quasi_steady`, `incompressible`, `hariharan_leishman`,
//! `calibrated` the models; `section` the structure they share; `response`, `march`, `free_stream` its uses.

mod airfoil;
mod attached;
mod error;
mod motion;
mod stall;

pub use airfoil::c81::{AirfoilSpan, C81Airfoil, C81Table, SteadyCoefficients, SteadyPoint};
pub use airfoil::steady_flow::{LinearisedForces, SectionFlow, SectionForces, TabulatedSection};
pub use attached::calibrated::CalibratedSection;
pub use attached::coefficients::{LagChannel, Load, Mode, ModelRemarks, SectionCoefficients};
pub use attached::effectiveness::FlapEffectiveness;
pub use attached::hariharan_leishman::{initial_slopes, piston_start};
pub use attached::model::{AttachedFlowModel, FlappedModel};
pub use attached::theodorsen::TheodorsenFunctions;
pub use attached::values::{FlapChord, HingePosition, MIN_NONCIRCULATORY_MACH, Mach};
pub use error::AeroError;
pub use motion::free_stream::{
    FreeStream, SectionLoads, lag_rates, loads_of_outputs, section_loads,
};
pub use motion::known_error::{
    KNOWN_ERROR_BANDS, KNOWN_ERROR_FLAP_CHORDS, KNOWN_ERROR_MACHS, known_error_percent,
};
pub use motion::layout::{MarchingSection, SectionInputs, StepFactors};
pub use motion::linearise::{LagRateSlopes, LoadSlopes, lag_rate_slopes, load_slopes};
pub use motion::march::SectionState;
pub use motion::periodic::{CycleStep, periodic_state};
pub use motion::response::{
    Motion, ResponseParts, harmonic_response, indicial_response, steady_response,
};
pub use stall::{
    FittedStall, StallAirfoil, StallParameters, StallSection, StallState, StalledLoads,
};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
