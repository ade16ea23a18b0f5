//! Rows of the validation page: the free wake of the reference rotors.

mod measured_inflow;
mod measured_trim;
mod wake;
mod wake_hover;
mod wake_measured;

use validation::hold;

#[test]
fn wake_rows() {
    hold(wake::ROWS);
}

#[test]
fn wake_hover_rows() {
    hold(wake_hover::ROWS);
}

#[test]
fn wake_measured_rows() {
    hold(wake_measured::ROWS);
}

#[test]
fn measured_trim_rows() {
    hold(measured_trim::ROWS);
}
