//! Files of the driver: those shipped inside the program, and aerofoil tables. The rest is `measured-data`.

mod airfoil;
mod shipped;

pub use airfoil::{airfoil_place, airfoil_text, read_airfoil};
pub use measured_data::*;
pub use shipped::{SHIPPED_BENCH, SHIPPED_CASES, shipped};

use crate::problem::Fault;

/// What is wrong with a name that is no file of a folder.
pub(crate) fn missing_file(folder: &Folder, file: &str) -> Fault {
    let shown = folder.display("");
    let folder = if shown.is_empty() { "this folder".to_owned() } else { shown };
    Fault::MissingFile { file: file.to_owned(), folder }
}
