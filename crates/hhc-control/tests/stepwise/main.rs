//! The loop that flies: noise, jumps, losses and a wrong T, on linear rotors with a known optimum.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

mod dither;
mod flown;
mod margins;
mod rotor;
