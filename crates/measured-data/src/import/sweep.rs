//! A table of points of a rotor into a data folder.

use super::folder::{ImportResult, ImportedRun, span};
use super::{ImportKind, ImportRequest, SourceKind};
use crate::dataset::{DATASET, DatasetFile, DatasetKind, PointData, RunFile, RunRole};
use crate::error::DataError;
use crate::files::{Source, ron_text, write_folder};
use crate::problem::{Fault, Place, Problem};
use std::path::Path;

/// Column that every point of a rotor has.
const ADVANCE_RATIO: &str = "advance_ratio";
/// File of the table in the folder.
const TABLE: &str = "sweep.csv";

/// Whether the header of a text table is that of points of a rotor.
pub(super) fn is_sweep(text: &str) -> bool {
    let header = text.lines().find(|line| !line.starts_with('#') && !line.trim().is_empty());
    header.is_some_and(|line| line.split(',').any(|cell| cell.trim() == ADVANCE_RATIO))
}

/// Imports a table of points as it is, checked.
///
/// # Errors
/// Every problem of the table; a folder that cannot be written.
pub(super) fn import_sweep(
    request: &ImportRequest,
    path: &Path,
) -> Result<ImportResult, DataError> {
    let source = Source::read(path)?;
    let refused = |message: &str| {
        let fault = Fault::Other(message.to_owned());
        DataError::from(Problem::new(Place::file(&source.name), fault))
    };
    if request.files.len() > 1 {
        return Err(refused("a sweep is one table: import it alone"));
    }
    let data = PointData::read(&source)?;
    if !data.table.has(ADVANCE_RATIO) {
        return Err(refused(
            "there is no column `advance_ratio`, which every point of a RotorSweep has",
        ));
    }
    let not_written = |reason: String| DataError::NotWritten { path: request.out.clone(), reason };
    let name = path.file_name().map_or_else(String::new, |own| own.to_string_lossy().into_owned());
    let title = request.title.clone().unwrap_or_else(|| format!("imported from {name}"));
    let id = "sweep".to_owned();
    let entry = RunFile {
        id: id.clone(),
        file: TABLE.to_owned(),
        role: RunRole::Measured,
        ..RunFile::default()
    };
    let dataset = DatasetFile::of(DatasetKind::RotorSweep, title.clone(), vec![entry]);
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
        recognised: "points of a rotor".to_owned(),
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
    };
    Ok(ImportResult {
        folder: request.out.display().to_string(),
        kind: DatasetKind::RotorSweep,
        title,
        runs: vec![run],
        range: None,
        range_rule: "",
        warnings: Vec::new(),
    })
}

/// Whether a request is of a sweep: said so, or recognised by the header of its first file.
pub(super) fn is_asked_for(request: &ImportRequest) -> bool {
    let is_table = || {
        let source = request.files.first().and_then(|path| Source::read(path).ok());
        source.is_some_and(|source| is_sweep(&source.text))
    };
    match request.kind {
        Some(kind) => kind == ImportKind::RotorSweep,
        None => request.source.is_none_or(|own| own == SourceKind::Csv) && is_table(),
    }
}
