//! Writes the synthetic bench records.
fn main() {}
