//! `hhc check`: what kind of file it is, and every problem in it.

use crate::case::read_case;
use crate::files::{Folder, RonIndex, Source, read_bench};
use crate::output::Printable;
use crate::problem::{Fault, Place, Problems};
use crate::stored_actuator::read_actuator;
use serde::Serialize;
use std::path::Path;

/// The kinds of file that can be checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FileKind {
    /// A case.
    Case,
    /// A bench data folder: `dataset.ron` and its records.
    Bench,
    /// An actuator written by `hhc identify`.
    Actuator,
}

/// A file without problems.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CheckResult {
    /// The file.
    pub file: String,
    /// Its kind.
    pub kind: FileKind,
    /// What it holds, in one line.
    pub summary: String,
}

/// Checks a case, a data folder (or its `dataset.ron`) or an actuator file.
///
/// # Errors
/// Every problem found.
pub fn check_file(path: &Path) -> Result<CheckResult, Problems> {
    let name = path.display().to_string();
    if path.is_dir() {
        return check_bench(&Folder::Disk(path.to_path_buf()), name);
    }
    let source = Source::read(path)?;
    let index = RonIndex::new(&source.name, &source.text);
    match kind_of(&source, &index) {
        Some(FileKind::Bench) => check_bench(&Folder::of_file(path), name),
        Some(FileKind::Actuator) => {
            let stored = read_actuator(&source)?;
            let summary = format!("{}, {} runs", stored.title, stored.runs.len());
            Ok(CheckResult { file: name, kind: FileKind::Actuator, summary })
        }
        Some(FileKind::Case) => {
            let summary = read_case(&source, &Folder::of_file(path))?.case.title;
            Ok(CheckResult { file: name, kind: FileKind::Case, summary })
        }
        None => {
            let mut problems = Problems::default();
            problems.push(Place::file(name), Fault::UnknownKind);
            problems.into_result(None)
        }
    }
}

/// What a RON file is, from its first keys.
fn kind_of(source: &Source, index: &RonIndex) -> Option<FileKind> {
    if let Some(kind) = index.value_text("kind") {
        return if kind.starts_with("Actuator") && !kind.starts_with("ActuatorBench") {
            Some(FileKind::Actuator)
        } else {
            Some(FileKind::Bench)
        };
    }
    if index.contains("runs") {
        return Some(FileKind::Bench);
    }
    // any other text in brackets is taken for a case, whose reader then names what is wrong
    let begins = source.text.lines().map(str::trim).any(|line| line.starts_with('('));
    begins.then_some(FileKind::Case)
}

fn check_bench(folder: &Folder, file: String) -> Result<CheckResult, Problems> {
    let data = read_bench(folder)?;
    let samples: usize = data.runs.iter().map(|run| run.table.time_s.len()).sum();
    let summary = format!("{}: {} runs, {samples} samples", data.title, data.runs.len());
    Ok(CheckResult { file, kind: FileKind::Bench, summary })
}

impl Printable for CheckResult {
    fn text(&self) -> String {
        let kind = match self.kind {
            FileKind::Case => "case",
            FileKind::Bench => "bench data",
            FileKind::Actuator => "actuator",
        };
        format!("{}: {kind}, no problems ({})", self.file, self.summary)
    }
}
