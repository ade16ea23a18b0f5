//! Diagnoses of points of test: with a case, or with anyone's simulator as tables.

mod case;
mod story;
mod table;

pub use case::CasePoints;
pub use story::{PointDiagnosis, PointStory};
pub use table::{TableData, read_table};
