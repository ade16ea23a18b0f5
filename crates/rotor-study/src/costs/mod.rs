//! What control costs: power, hinge moments and rates of the flaps, electrical power of the piezos, loads of the blade, and
//! what of them buys how much of `J`.

mod electrical;
mod flap;
mod front;
mod record;

pub use electrical::{ElectricalPower, electrical_power};
pub use flap::{FlapCost, LoadLineUse};
pub use front::{FrontAgainst, FrontLine, FrontState, fronts};
pub use record::{BladeCost, ControlCost, CostRecord, CostRecords, CostedSet, control_costs};
