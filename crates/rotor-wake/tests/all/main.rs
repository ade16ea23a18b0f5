//! The free wake: kernel and properties.

mod body;
mod in_time;
mod kernel;
mod properties;
mod sweeps;
