//! Files of the driver: those shipped inside the program, and aerofoil tables. The rest is `measured-data`.

mod airfoil;
mod shipped;

pub use airfoil::{airfoil_place, airfoil_text, read_airfoil};
pub use measured_data::*;
pub use shipped::{SHIPPED_BENCH, SHIPPED_CASES, shipped, shipped_file, shipped_files};
