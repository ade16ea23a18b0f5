//! Flights, failures, margins and draws as people and programs read them.

mod notes;
mod pictures;
mod sections;
mod tables;

pub use notes::flight_notes;
pub use pictures::{draws_pictures, margins_pictures};
pub use sections::{
    controllers_section, draws_section, failures_section, harmonic_names, margins_section,
};
pub use tables::{
    BESIDE_FILES, draws_csv, failures_csv, flight_csv, is_own_table, load_amplitudes, margins_csv,
};
