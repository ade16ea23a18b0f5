//! A data folder of any kind.

use super::file::{DatasetFile, DatasetKind};
use super::open::read_description;
use super::{
    BenchData, CurveData, LoopData, SweepData, read_bench, read_curves, read_loops, read_sweep,
};
use crate::files::{Folder, read_ron};
use crate::problem::{Problem, Problems};

/// A data folder of any kind, checked.
#[derive(Debug, Clone, PartialEq)]
pub enum DataSet {
    /// Kind `ActuatorBench`.
    Bench(BenchData),
    /// Kind `GenericLoop`.
    Loops(LoopData),
    /// Kind `ReversalCurves`.
    Curves(CurveData),
    /// Points of test: `RotorSweep`, `BladeFrequencies`, `SectionLoops`.
    Sweep(SweepData),
}

impl DataSet {
    fn runs_and_warnings(&self) -> (usize, &[Problem]) {
        match self {
            Self::Bench(data) => (data.runs.len(), &data.warnings),
            Self::Loops(data) => (data.runs.len(), &data.warnings),
            Self::Curves(data) => (data.runs.len(), &[]),
            Self::Sweep(data) => (1, &data.warnings),
        }
    }

    /// What a reader should know about the data.
    pub fn warnings(&self) -> &[Problem] {
        self.runs_and_warnings().1
    }

    /// Number of runs.
    pub fn run_count(&self) -> usize {
        self.runs_and_warnings().0
    }
}

/// The kind of a data folder; none where its `dataset.ron` cannot be read.
pub fn dataset_kind(folder: &Folder) -> Option<DatasetKind> {
    let source = read_description(folder).ok()?;
    read_ron::<DatasetFile>(&source).value.map(|file| file.kind)
}

/// Reads a data folder of any kind.
///
/// # Errors
/// Every problem of `dataset.ron` and of every record, ordered by file and line.
pub fn read_dataset(folder: &Folder) -> Result<DataSet, Problems> {
    read_description(folder)?;
    // a kind that cannot be read is reported by the reader of benches
    match dataset_kind(folder) {
        Some(DatasetKind::GenericLoop) => read_loops(folder).map(DataSet::Loops),
        Some(DatasetKind::ReversalCurves) => read_curves(folder).map(DataSet::Curves),
        Some(DatasetKind::ActuatorBench) | None => read_bench(folder).map(DataSet::Bench),
        Some(kind) => read_sweep(folder, kind).map(DataSet::Sweep),
    }
}
