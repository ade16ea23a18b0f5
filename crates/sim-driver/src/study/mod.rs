//! Studies: the trimmed rotor, its driven flaps and the controller put together.

mod authority;
mod coupling;
mod drive;
mod error;
mod forecast;
mod hinge_power;
mod inverted;
mod lines;
mod model_plant;
mod pair_power;
mod paper;
mod plant;
mod recent;
mod reconverged;
mod robustness;
mod run;
mod sensitivity;
mod tables;

pub use authority::FlapAuthority;
pub use coupling::{COUPLING_TOLERANCE_DEG, CouplingResidual, HingeCoupling};
pub use drive::{FlapDrive, FlapMotion, MEAN_FLAP_TOLERANCE_DEG};
pub use error::{PlantError, StudyError};
pub use forecast::forecasts;
pub use hinge_power::HingePower;
pub use lines::control_line;
pub use pair_power::given_watt_per_rad2;
pub use plant::{PlantState, RotorPlant, TrimmedRotor, UnlikeSolver};
pub use reconverged::ReconvergedAuthority;
pub use robustness::{Disturbance, RobustnessCell, robustness, robustness_csv, robustness_maps};
pub(crate) use run::cost_tolerance;
pub use run::{ControlStudy, Drives, FullScale, control_all, control_set};
pub use sensitivity::{
    Assumptions, Sensitivity, SensitivityRecord, sensitivities, sensitivity_csv,
};
pub(crate) use sensitivity::{most_moved, refigure_sensitivity};
pub use tables::{PagePart, histories_csv, page_part, study_report};

#[cfg(test)]
mod power_weight_tests;
