//! Data folders: `dataset.ron` and the records it names, all problems in one report.

mod accuracy;
mod any;
mod bench;
mod curves;
mod effect_tables;
mod file;
mod loops;
mod open;
mod points;
mod run;
mod sweep;

pub use accuracy::{Accuracy, DisplacementAccuracy, VoltageAccuracy};
pub use any::{DataSet, dataset_kind, read_dataset};
pub use bench::{BenchData, read_bench};
pub(crate) use bench::{PLAUSIBLE_RANGE_VOLT, check_bench_record, monitor_volts, range_unused};
pub use curves::{CurveData, CurveRun, ReversalCurve, read_curves};
pub use effect_tables::{ChannelAccuracy, EffectFile, EffectTables, read_effect_tables};
pub use file::{
    DEFAULT_COMMAND_RANGE_VOLT, DatasetFile, DatasetKind, Fitting, RunFile, RunRole, Sensor,
};
pub use loops::{LoopData, read_loops};
pub use open::DATASET;
pub use points::{PointColumn, PointData, Scatter};
pub use run::Run;
pub use sweep::{SweepData, read_sweep};
