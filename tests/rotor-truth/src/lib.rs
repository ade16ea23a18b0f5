//! An independent rotor that makes points of test.
pub mod error;
pub mod physics;
