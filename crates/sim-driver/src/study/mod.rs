//! Studies: the trimmed rotor, its driven flaps and the controller put together.

mod anderson;
mod coupling;
mod drive;
mod error;
mod hinge_power;
mod lines;
mod paper;
mod plant;
mod run;
mod sensitivity;
mod tables;

pub use coupling::{COUPLING_TOLERANCE_DEG, CouplingResidual, HingeCoupling};
pub use drive::{FlapDrive, FlapMotion, MEAN_FLAP_TOLERANCE_DEG};
pub use error::{PlantError, StudyError};
pub use hinge_power::HingePower;
pub use lines::control_line;
pub use plant::{PlantState, RotorPlant, TrimmedRotor};
pub use run::{ControlStudy, Drives, FullScale, control_all, control_set};
pub use sensitivity::{SENSITIVITY_ROWS, Sensitivity, sensitivities};
pub use tables::{histories_csv, study_report};
