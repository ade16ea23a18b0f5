//! Case files: the values of a case, and their reading from a text.
//!
//! | idea | module |
//! |---|---|
//! | sections, ranges, models and warnings of a case, faults by field path; no file | [`rotor_case`] |
//! | tables of the fields for the book, and the case of `hhc init` | `describe` |
//! | the unit of a field by its path | `units` |
//! | RON text, lines of fields, old names, tables, measured files and actuators that a case names | `read`, `airfoils`, `measured`, `t_file` |
//!
//! [`read_case`] reports every problem of a file at once. A [`LoadedCase`] is the values with the places of
//! their fields.

mod airfoils;
mod describe;
mod measured;
mod read;
mod t_file;
#[cfg(test)]
mod tests;
mod units;

pub use describe::{case_format_page, starting_case};
pub use measured::MeasuredRotor;
pub(crate) use read::is_actuator_file;
pub use read::{
    ActuatorSource, CONTROLLERS_CASE, LoadedCase, PAPER_CASE, load_case, read_case, shipped_case,
    with_actuator_file,
};
pub use rotor_case::*;
pub use units::unit_of;
