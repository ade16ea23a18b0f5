//! Unsteady thin-aerofoil aerodynamics of a section with a trailing-edge flap.

mod decay;
mod error;
mod free_stream;
mod hariharan_leishman;
mod incompressible;
mod march;
mod quasi_steady;
mod response;
mod section;
mod theodorsen;
mod values;

pub use error::AeroError;
pub use free_stream::{FreeStream, SectionLoads, lag_rates, section_loads};
pub use hariharan_leishman::{MIN_NONCIRCULATORY_MACH, initial_slopes, piston_start};
pub use march::{MarchingSection, SectionInputs, SectionState, StepFactors};
pub use response::{Motion, harmonic_response, indicial_response, steady_response};
pub use section::{AttachedFlowModel, LagChannel, Load, Mode, ModelRemarks, SectionCoefficients};
pub use theodorsen::TheodorsenFunctions;
pub use values::{FlapChord, HingePosition, Mach};
