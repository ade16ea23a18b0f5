//! The free wake: kernel and properties.

mod body;
mod kernel;
mod properties;
mod sweeps;
