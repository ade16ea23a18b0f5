//! Points of test of a rotor.
//!
//! | idea | module |
//! |---|---|
//! | what a sweep measured, and what its columns mean | `sweep`, `columns` |
//! | a rotor with its drives and the way its loads are read | `model` |
//! | that rotor at a point of test | `flight` |
//! | the cause library: what a rotor may lack | `causes` |
//! | inputs of a case that are not known well, other levels of fidelity | `spread` |
//! | what hysteresis costs and feedback wins back | `feedback` |
//! | a diagnosis | `diagnosis` |

mod causes;
mod columns;
mod diagnosis;
mod feedback;
mod flight;
mod model;
mod spread;
mod sweep;

pub use causes::{LIBRARY, RotorCause};
pub use columns::{Column, Load, PartOf, Reading, Setting, check_columns};
pub use diagnosis::{RotorDiagnosis, RotorQuestion, diagnose};
pub use feedback::WonBack;
pub use flight::predict;
pub use model::{FlapDriveModel, LoadPath, RotorModel};
pub(crate) use spread::in_percent;
pub(crate) use spread::moved_inputs;
pub use spread::{USUAL_UNCERTAIN, alternatives, stated, usual_uncertain, with_inputs};
pub use sweep::{Aside, Sweep, SweepChannel, SweepPoint};
