//! The `hhc` command.
fn main() {}
