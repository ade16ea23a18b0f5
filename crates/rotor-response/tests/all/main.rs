//! The rotor in flight, against exact theory, reference tables and itself.

mod common;
mod crosscheck;
mod details;
mod hinge;
mod hover_torque;
mod joints;
mod lag_memory;
mod linearised;
mod march;
mod nonlinear;
mod physics;
mod power;
mod stability;
mod state_space;
mod station_loads;
mod wake_circulation;
mod wake_lines;
