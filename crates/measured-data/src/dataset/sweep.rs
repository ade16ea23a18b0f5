//! Points of test as a data folder.

use super::file::DatasetKind;
use super::open::{OpenDataset, run_field};
use super::points::PointData;
use crate::files::Folder;
use crate::problem::{Fault, Problem, Problems};

/// Points of test, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepData {
    /// Kind of the folder: one of [`DatasetKind::OF_POINTS`].
    pub kind: DatasetKind,
    /// One line about the data.
    pub title: String,
    /// Folder the data come from, for messages and results.
    pub folder: String,
    /// The points.
    pub points: PointData,
    /// What a reader should know.
    pub warnings: Vec<Problem>,
    /// blake3 of `dataset.ron` and of the table.
    pub content_hash: String,
}

/// Reads a data folder of a kind of [`DatasetKind::OF_POINTS`]: one table, a row for each point.
///
/// # Errors
/// Every problem of `dataset.ron` and of the table, each with its line.
pub fn read_sweep(folder: &Folder, kind: DatasetKind) -> Result<SweepData, Problems> {
    let mut open = OpenDataset::open(folder, kind)?;
    let runs = open.dataset.runs.clone();
    if runs.len() > 1 {
        let message = "points are one table: give them as rows of one file, with `group` for those of one sweep";
        open.problems.push(open.index.place("runs[1]"), Fault::Other(message.to_owned()));
    }
    let source = runs.first().and_then(|run| open.read(&run.file, &run_field(0, "file")));
    let points = source.and_then(|source| match PointData::read_with(&source, kind.words()) {
        Ok(points) => Some(points),
        Err(more) => {
            open.problems.append(more);
            None
        }
    });
    let (folder, content_hash) = open.origin();
    let OpenDataset { dataset, problems, warnings, .. } = open;
    let title = dataset.title;
    problems.into_result(points.map(|points| SweepData {
        kind,
        title,
        folder,
        points,
        warnings,
        content_hash,
    }))
}
