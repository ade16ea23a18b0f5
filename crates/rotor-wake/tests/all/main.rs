//! The free wake: kernel and properties.

mod kernel;
mod properties;
