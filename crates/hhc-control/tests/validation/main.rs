//! Rows of the validation page: the controller.

mod control;

use validation::hold;

#[test]
fn control_rows() {
    hold(control::ROWS);
}
