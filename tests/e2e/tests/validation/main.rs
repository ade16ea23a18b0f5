//! Rows of the validation page: the whole program.
#![expect(clippy::disallowed_methods, reason = "a test writes the set that is diagnosed")]

mod actuator;
mod actuator_data;
mod discovery;
mod measured_rotors;
mod refinement;
mod study;

use validation::hold;

#[test]
fn actuator_rows() {
    hold(actuator::ROWS);
}

#[test]
fn actuator_data_rows() {
    hold(actuator_data::ROWS);
}

#[test]
fn discovery_rows() {
    hold(discovery::ROWS);
}

#[test]
fn measured_rotors_rows() {
    hold(measured_rotors::ROWS);
}

#[test]
fn refinement_rows() {
    hold(refinement::ROWS);
}

#[test]
fn study_rows() {
    hold(study::ROWS);
}
