//! Diagnoses of points of test: with anyone's simulator as tables.

mod story;
mod table;

pub use story::{PointDiagnosis, PointStory};
pub use table::{TableData, read_table};
