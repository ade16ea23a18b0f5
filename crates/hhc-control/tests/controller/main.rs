//! The controller against closed-form answers, on plants that are known exactly.

#![expect(clippy::unwrap_used, clippy::float_cmp, reason = "a test that cannot unwrap has failed")]

mod bending;
mod constrained;
mod failures;
mod front;
mod hysteresis;
mod learning;
mod linear;
mod plants;
mod sensitivity;
mod stroke;
