//! `hhc import`: what it takes and what it prints.

use crate::output::Printable;
pub use bench_study::ImportReport;
pub use measured_data::import::*;

impl Printable for ImportReport {
    fn text(&self) -> String {
        Self::text(self)
    }
}
