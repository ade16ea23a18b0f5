//! The controller against closed-form answers, on plants that are known exactly.

mod failures;
mod hysteresis;
mod linear;
mod plants;
mod sensitivity;
mod stroke;
