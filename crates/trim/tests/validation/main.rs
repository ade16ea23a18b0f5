//! Rows of the validation page: the trimmed rotor.

mod trim_reference;
mod trimmed;
mod wake_trim;

use validation::hold;

#[test]
fn trimmed_rows() {
    hold(trimmed::ROWS);
}

#[test]
fn wake_trim_rows() {
    hold(wake_trim::ROWS);
}
