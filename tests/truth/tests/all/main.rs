//! Synthetic sets: physics, stages, fixture and command line.

mod command_line;
mod fixture;
mod hidden;
mod hidden_physics;
mod physics;
mod stages;
