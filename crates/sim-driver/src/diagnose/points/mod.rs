//! Diagnoses of points of test: with a case, or with anyone's simulator as tables.

mod case;
mod story;

pub use case::CasePoints;
pub use story::{PointDiagnosis, PointStory};
