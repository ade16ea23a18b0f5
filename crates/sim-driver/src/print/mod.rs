//! Results of a study for people and files: tables and CSV.

pub mod airloads;
pub mod blade_loads;
pub mod modes;
mod revolution;
pub mod root_pitch;
pub mod wake;
