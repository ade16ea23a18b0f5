//! Tests of the rotor against values it did not make, and of the sets.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod cases;
mod crosscheck;
mod sets;
