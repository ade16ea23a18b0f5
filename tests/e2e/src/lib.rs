//! End-to-end tests: shipped files in, published or independently computed numbers out.
//!
//! The tests are in `tests/`; this library is empty. What the `hhc` process prints, writes and returns
//! is tested beside the command, in `crates/sim-driver/tests/command`.
