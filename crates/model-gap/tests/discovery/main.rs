//! Decisions of the engine on a system whose answers are known.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod inputs;
mod joint;
mod names;
mod points;
mod refusals;
mod tables;
mod thresholds;
mod toy;
