//! Rows of the validation page: the trimmed rotor.

mod in_time;
mod trim_reference;
mod trimmed;
mod wake_trim;

use validation::hold;

#[test]
fn in_time_rows() {
    hold(in_time::ROWS);
}

#[test]
fn trimmed_rows() {
    hold(trimmed::ROWS);
}

#[test]
fn wake_trim_rows() {
    hold(wake_trim::ROWS);
}
