//! The trimmed rotor with driven flaps as the plant of a controller.

mod answered;
mod memo;
mod pair_power;
mod power;
mod root_pitch;
mod rotor_plant;
mod tangent;

pub(crate) use answered::{LinearisedPlant, linearised_answer};
pub use hhc_control::{HUB_OUTPUTS, PowerOutputs, hub_outputs, output_weights};
pub use pair_power::given_watt_per_rad2;
pub(crate) use pair_power::watt_per_deg2;
pub use root_pitch::RootPitchPlant;
pub(crate) use rotor_plant::angles_rad;
pub use rotor_plant::{PlantState, RotorPlant};
