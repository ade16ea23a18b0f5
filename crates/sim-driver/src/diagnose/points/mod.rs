//! Diagnoses of points of test: with a rotor, or with anyone's simulator as tables.

mod rotor;
mod story;
mod table;

pub use rotor::RotorPoints;
pub use story::{PointDiagnosis, PointStory};
pub use table::{TableData, read_table};
