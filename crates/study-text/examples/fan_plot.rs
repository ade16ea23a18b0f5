//! Rotating modes of the default blade as a table, and the data of its fan plot for any plotting program.
//!
//! ```text
//! cargo run --release -p study-text --example fan_plot
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use rotor_case::Case;
use rotor_study::{ModesQuestion, StudyError, rotating_modes};
use study_text::{fan_csv, modes_text};

fn main() -> Result<(), StudyError> {
    let speed_ratios = vec![0.0, 0.25, 0.5, 0.75, 1.0];
    let question = ModesQuestion { speed_ratios, ..ModesQuestion::default() };
    let modes = rotating_modes(&Case::default(), &question)?;
    println!("{}", modes_text(&modes));
    println!("{}", fan_csv(&modes));
    Ok(())
}
