//! The blade: its modes, its stability, its loads, and blades dissimilar from the rest.

mod dissimilar;
mod loads;
mod mean_loads;
mod modes;
mod stability;

pub use dissimilar::{
    UnlikeBladeLine, UnlikeLine, each_unlike_blade, unlike_lines, unlike_warnings,
};
pub use loads::{LoadLine, MomentLine, StationLine, station_lines};
pub use mean_loads::MeanLoads;
pub use modes::{
    AboutState, FAN_SPEEDS, ModeLine, ModesQuestion, ModesResult, SteadyTip, modes_at_speeds,
    numbered, rotating_modes,
};
pub use stability::{MotionLine, StabilityLine};
