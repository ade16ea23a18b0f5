//! The trimmed rotor, with and without a free wake.

mod free_wake;
mod trimmed;
