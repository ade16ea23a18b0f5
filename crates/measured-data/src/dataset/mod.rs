//! Data folders: `dataset.ron` and the records it names, all problems in one report.

mod any;
mod bench;
mod curves;
mod file;
mod loops;
mod open;
mod run;

pub use any::{DataSet, read_dataset};
pub(crate) use bench::check_bench_record;
pub use bench::{BenchData, read_bench};
pub use curves::{CurveData, CurveRun, ReversalCurve, read_curves};
pub use file::{
    DEFAULT_COMMAND_RANGE_VOLT, DatasetFile, DatasetKind, Fitting, RunFile, RunRole, RunUse, Sensor,
};
pub use loops::{InputRange, LoopData, read_loops};
pub use open::DATASET;
pub use run::{Run, Timed, samples_within};
