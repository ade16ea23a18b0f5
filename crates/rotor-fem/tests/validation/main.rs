//! Rows of the validation page: the blade and of time elements.

mod blade;
#[path = "../all/free_motion/mod.rs"]
mod free_motion;
#[path = "../all/linear/mod.rs"]
mod linear;
mod moderate;
mod moderate_blades;
mod time_elements;

use validation::hold;

#[test]
fn blade_rows() {
    hold(blade::ROWS);
}

#[test]
fn moderate_rows() {
    hold(moderate::ROWS);
}

#[test]
fn time_elements_rows() {
    hold(time_elements::ROWS);
}
