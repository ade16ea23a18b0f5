//! Files: reading with places, atomic writing, RON with located problems, measured tables.

mod bench;
mod dataset;
mod folder;
mod measured_csv;
mod ron_index;
mod ron_read;
mod shipped;
mod write;

pub use bench::{BenchData, BenchRun, read_bench};
pub use dataset::{DatasetFile, DatasetKind, RunFile, RunRole, RunUse};
pub use folder::{Folder, Source};
pub use measured_csv::{MeasuredTable, parse_measured_csv};
pub use ron_index::RonIndex;
pub use ron_read::{RonFile, read_ron, ron_text};
pub use shipped::{SHIPPED_BENCH, SHIPPED_CASES, shipped_file, shipped_files};
pub use write::{write_atomic, write_new};
