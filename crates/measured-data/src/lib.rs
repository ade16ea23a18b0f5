//! Measured data: data folders, tables with units, importers, and problems with file and line.
//!
//! | idea | module |
//! |---|---|
//! | what is wrong in a file, where, what was expected, the remedy | [`problem`] |
//! | reading with places, atomic writing, RON with the place of every field | `files` |
//! | tables with units in the header, checks of a record | `tables` |
//! | `dataset.ron` and its records, of each kind | `dataset` |
//! | data of other formats into a data folder | [`import`] |

mod dataset;
mod error;
mod files;
pub mod import;
pub mod problem;
mod tables;

pub use dataset::{
    Accuracy, BenchData, ChannelAccuracy, CurveData, CurveRun, DATASET, DEFAULT_COMMAND_RANGE_VOLT,
    DataSet, DatasetFile, DatasetKind, DisplacementAccuracy, EffectFile, EffectTables, Fitting,
    LoopData, PointColumn, PointData, ReversalCurve, Run, RunFile, RunRole, Scatter, Sensor,
    SweepData, VoltageAccuracy, dataset_kind, read_bench, read_curves, read_dataset,
    read_effect_tables, read_loops, read_sweep,
};
pub use error::DataError;
pub use files::{
    Change, Embedded, Folder, RonFile, RonIndex, Source, default_model_file, distinct_names,
    open_reader, read_ron, refuse_foreign, refuse_input, refuse_inside, refuse_other_kind,
    refuse_other_text, refuse_unwritable, remove_own, ron_text, with_field_moved, write_atomic,
    write_folder, write_new,
};
pub use import::EvenRecord;
pub use tables::{
    Channel, ChannelFile, Channels, ColumnTable, Dimension, MeasuredTable, PointCsv, UNITS, Unit,
    limits, parse_columns, parse_measured_csv, significant,
};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
