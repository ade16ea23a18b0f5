//! Studies: the trimmed rotor, its driven flaps and the controller put together.

mod drive;
mod error;
mod lines;
mod plant;
mod run;

pub use drive::{FlapDrive, FlapMotion, MEAN_FLAP_TOLERANCE_DEG};
pub use lines::control_line;
pub use error::{PlantError, StudyError};
pub use plant::{PlantState, RotorPlant, TrimmedRotor};
pub use run::{ControlStudy, Drives, control_all, control_set};
