//! Rows of the validation page: inflow and free wake.

mod inflow;
mod wake_flight;

use validation::hold;

#[test]
fn inflow_rows() {
    hold(inflow::ROWS);
}

#[test]
fn wake_flight_rows() {
    hold(wake_flight::ROWS);
}
