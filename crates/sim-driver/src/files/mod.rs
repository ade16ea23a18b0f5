//! Files: reading with places, atomic writing, RON, measured tables, data folders.

mod airfoil;
mod bench;
mod curves;
mod dataset;
mod dataset_read;
mod folder;
mod loop_csv;
mod loops;
mod measured_csv;
mod record_checks;
mod ron_index;
mod ron_read;
mod shipped;
mod table_text;
mod units;
mod write;

pub use airfoil::{airfoil_text, read_airfoil};
pub(crate) use bench::check_bench_record;
pub use bench::{BenchData, BenchRun, read_bench};
pub use curves::{CurveData, CurveRun, ReversalCurve, read_curves};
pub use dataset::{
    ChannelFile, DEFAULT_COMMAND_RANGE_VOLT, DatasetFile, DatasetKind, RunFile, RunRole, RunUse,
};
pub use dataset_read::{DATASET, DataSet, read_dataset, samples_within};
pub use folder::{Folder, Source, open_reader};
pub use loop_csv::{Channels, LoopTable};
pub use loops::{InputRange, LoopData, LoopRun, read_loops};
pub use measured_csv::{MeasuredTable, parse_measured_csv};
pub(crate) use record_checks::{Record, check_record, check_unit};
pub use ron_index::RonIndex;
pub use ron_read::{RonFile, read_ron, ron_text};
pub use shipped::{SHIPPED_BENCH, SHIPPED_CASES, shipped_file, shipped_files};
pub(crate) use table_text::{Listing, increases_evenly, resampled};
pub use table_text::{RESAMPLED_JITTER, ROUNDING_JITTER, Sampling, resample};
pub use units::{Channel, Dimension, UNITS, Unit, significant};
pub use write::{
    refuse_input, refuse_inside, refuse_unwritable, write_atomic, write_folder, write_new,
};
