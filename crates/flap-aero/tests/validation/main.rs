//! Rows of the validation page: the section.

mod errors;
mod known_errors;
mod measured_flap;
mod section;
mod section_beyond;
mod section_compressible;

use validation::hold;

#[test]
fn section_rows() {
    hold(section::ROWS);
}

#[test]
fn section_compressible_rows() {
    hold(section_compressible::ROWS);
}

#[test]
fn section_beyond_rows() {
    hold(section_beyond::ROWS);
}

#[test]
fn measured_flap_rows() {
    hold(measured_flap::ROWS);
}
