//! A table of points of test into a data folder.

use super::folder::{ImportResult, ImportedRun, span};
use super::{ImportKind, ImportRequest, SourceKind};
use crate::dataset::{DATASET, DatasetFile, DatasetKind, PointData, RunFile, RunRole};
use crate::error::DataError;
use crate::files::{Source, ron_text, write_folder};
use crate::problem::{Fault, Place, Problem};
use std::path::Path;

/// File of the table in the folder.
const TABLE: &str = "points.csv";

/// The kind of points whose column the header of a text table has.
fn kind_of(text: &str) -> Option<DatasetKind> {
    let header = text.lines().find(|line| !line.starts_with('#') && !line.trim().is_empty())?;
    let has = |column: &str| header.split(',').any(|cell| cell.trim() == column);
    let is_of = |own: &(DatasetKind, &[&str])| own.1.iter().all(|column| has(column));
    DatasetKind::OF_POINTS.into_iter().find(is_of).map(|(kind, _)| kind)
}

/// Imports a table of points as it is, checked.
///
/// # Errors
/// Every problem of the table; a folder that cannot be written.
pub(super) fn import_sweep(
    request: &ImportRequest,
    path: &Path,
    kind: DatasetKind,
) -> Result<ImportResult, DataError> {
    let source = Source::read(path)?;
    let refused = |message: &str| {
        let fault = Fault::Other(message.to_owned());
        DataError::from(Problem::new(Place::file(&source.name), fault))
    };
    if request.files.len() > 1 {
        return Err(refused("points are one table: import it alone"));
    }
    let data = PointData::read_with(&source, kind.words())?;
    let needed = DatasetKind::OF_POINTS.into_iter().filter(|own| own.0 == kind);
    let mut needed = needed.flat_map(|(_, columns)| columns);
    if let Some(column) = needed.find(|column| !data.table.has(column)) {
        return Err(refused(&format!(
            "there is no column `{column}`, which every point of {kind:?} has"
        )));
    }
    let not_written = |reason: String| DataError::NotWritten { path: request.out.clone(), reason };
    let name = path.file_name().map_or_else(String::new, |own| own.to_string_lossy().into_owned());
    let title = request.title.clone().unwrap_or_else(|| format!("imported from {name}"));
    let id = "points".to_owned();
    let entry = RunFile {
        id: id.clone(),
        file: TABLE.to_owned(),
        role: RunRole::Measured,
        ..RunFile::default()
    };
    let dataset = DatasetFile::of(kind, title.clone(), vec![entry]);
    let text = ron_text(&dataset).map_err(|e| not_written(e.to_string()))?;
    let files =
        [(DATASET.to_owned(), text.into_bytes()), (TABLE.to_owned(), source.text.into_bytes())];
    write_folder(&request.out, &files)?;
    let columns = data.columns.iter().map(|own| {
        let read: Vec<f64> = own.values.iter().flatten().copied().collect();
        span(&own.name, &read)
    });
    let rows = data.ids.len();
    let run = ImportedRun {
        source: path.display().to_string(),
        source_kind: SourceKind::Csv,
        recognised: "points of test".to_owned(),
        id,
        file: TABLE.to_owned(),
        samples_read: rows,
        samples_written: rows,
        block: 1,
        step_s: None,
        jitter_percent: None,
        curves: None,
        columns: columns.collect(),
        left_out: Vec::new(),
        renamed: Vec::new(),
    };
    Ok(ImportResult {
        folder: request.out.display().to_string(),
        kind,
        title,
        runs: vec![run],
        range: None,
        range_rule: "",
        warnings: Vec::new(),
    })
}

/// The kind of points that a request is of: as said, or recognised by the header of its first file.
pub(super) fn asked_for(request: &ImportRequest) -> Option<DatasetKind> {
    let of_table = || {
        let source = request.files.first().and_then(|path| Source::read(path).ok());
        source.and_then(|source| kind_of(&source.text))
    };
    match request.kind {
        Some(ImportKind::RotorSweep) => Some(DatasetKind::RotorSweep),
        Some(ImportKind::BladeFrequencies) => Some(DatasetKind::BladeFrequencies),
        Some(ImportKind::SectionLoops) => Some(DatasetKind::SectionLoops),
        Some(ImportKind::ActuatorBench | ImportKind::GenericLoop) => None,
        None => request.source.is_none_or(|own| own == SourceKind::Csv).then(of_table)?,
    }
}
