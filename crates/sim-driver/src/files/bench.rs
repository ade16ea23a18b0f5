//! A whole bench: `dataset.ron` and every record it names, all problems in one report.

use super::measured_csv::Listing;
use super::{
    DatasetFile, Folder, MeasuredTable, RonIndex, RunRole, RunUse, parse_measured_csv, read_ron,
};
use crate::problem::{Fault, Place, Problems};
use std::collections::BTreeMap;
use std::path::{Component, Path};

/// A bench data set, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchData {
    /// One line about the data.
    pub title: String,
    /// Folder the data come from, for messages and results.
    pub folder: String,
    /// The records in the order of the file.
    pub runs: Vec<BenchRun>,
    /// Equivalent flap angle per displacement, deg/um, if the data set fixes it.
    pub flap_deg_per_um: Option<f64>,
    /// Voltages the actuator may see, V: lower and upper limit.
    pub command_range_volt: (f64, f64),
    /// blake3 of `dataset.ron` and of every record, in order.
    pub content_hash: String,
}

/// One record of a bench.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchRun {
    /// Name of the run.
    pub id: String,
    /// File name.
    pub file: String,
    /// What it is for.
    pub role: RunRole,
    /// What was done.
    pub note: String,
    /// Seconds since switch-on at which the record begins, if known.
    pub start_s: Option<f64>,
    /// Side of the split, if the data set fixes it.
    pub use_as: Option<RunUse>,
    /// The numbers.
    pub table: MeasuredTable,
}

/// Name of the file that describes a data folder.
const DATASET: &str = "dataset.ron";
/// Part of the command range by which a command may exceed it: digits of the converter.
const COMMAND_TOLERANCE: f64 = 1e-4;

/// Reads a bench data folder.
///
/// # Errors
/// Every problem of `dataset.ron` and of every record, ordered by file and line.
pub fn read_bench(folder: &Folder) -> Result<BenchData, Problems> {
    let source = folder.read(DATASET).map_err(|mut problem| {
        if let Fault::Unreadable { reason } = &mut problem.fault {
            reason.push_str("; a data folder is described by its dataset.ron");
        }
        problem
    })?;
    let mut hash = blake3::Hasher::new();
    hash.update(source.text.as_bytes());
    let file = read_ron::<DatasetFile>(&source);
    let mut problems = file.problems;
    let Some(dataset) = file.value else {
        return problems.into_result(None);
    };
    let range = check_range(&dataset, &file.index, &mut problems);
    check_fields(&dataset, &file.index, &mut problems);
    let mut runs = Vec::with_capacity(dataset.runs.len());
    for (i, run) in dataset.runs.iter().enumerate() {
        let place = file.index.place(&format!("runs[{i}].file"));
        if !is_plain(&run.file) {
            problems.push(place, Fault::NotPlainFile { path: run.file.clone() });
            continue;
        }
        if !folder.contains(&run.file) {
            let fault = Fault::MissingFile { file: run.file.clone(), folder: folder.display("") };
            problems.push(place, fault);
            continue;
        }
        let source = match folder.read(&run.file) {
            Ok(source) => source,
            Err(problem) => {
                problems.push(problem.place, problem.fault);
                continue;
            }
        };
        hash.update(source.text.as_bytes());
        match parse_measured_csv(&source) {
            Ok(table) => {
                if let Some(range) = range {
                    check_commands(&source.name, &table, range, &mut problems);
                }
                runs.push(BenchRun {
                    id: run.id.clone(),
                    file: run.file.clone(),
                    role: run.role,
                    note: run.note.clone(),
                    start_s: run.start_s,
                    use_as: run.use_as,
                    table,
                });
            }
            Err(more) => problems.append(more),
        }
    }
    let data = BenchData {
        title: dataset.title,
        folder: folder.display("").trim_end_matches('/').to_owned(),
        runs,
        flap_deg_per_um: dataset.flap_deg_per_um,
        command_range_volt: dataset.command_range_volt,
        content_hash: hash.finalize().to_hex().to_string(),
    };
    problems.into_result(Some(data))
}

fn is_plain(file: &str) -> bool {
    let mut components = Path::new(file).components();
    matches!(components.next(), Some(Component::Normal(_)))
        && components.all(|c| matches!(c, Component::Normal(_)))
}

fn check_range(
    dataset: &DatasetFile,
    index: &RonIndex,
    problems: &mut Problems,
) -> Option<(f64, f64)> {
    let (low, high) = dataset.command_range_volt;
    if low.is_finite() && high.is_finite() && low < high {
        return Some((low, high));
    }
    problems.push(index.place("command_range_V"), Fault::EmptyRange { low, high });
    None
}

fn check_fields(dataset: &DatasetFile, index: &RonIndex, problems: &mut Problems) {
    if dataset.title.trim().is_empty() {
        let of = "one line about the data: what was measured, where, on what";
        problems.push(index.place("title"), Fault::EmptyText { of });
    }
    if dataset.runs.is_empty() {
        problems.push(index.place("runs"), Fault::EmptyList { of: "run" });
    }
    if let Some(value) = dataset.flap_deg_per_um.filter(|v| !(v.is_finite() && *v > 0.0)) {
        let remedy = "leave it out to have identification set the gain";
        let fault = Fault::NotPositive { value, unit: "deg/um", remedy };
        problems.push(index.place("flap_deg_per_um"), fault);
    }
    let mut ids = BTreeMap::new();
    let mut files = BTreeMap::new();
    for (i, run) in dataset.runs.iter().enumerate() {
        for (key, value, seen, of) in
            [("id", &run.id, &mut ids, "run"), ("file", &run.file, &mut files, "run file")]
        {
            let path = format!("runs[{i}].{key}");
            if value.trim().is_empty() {
                problems.push(index.place(&path), Fault::EmptyText { of: "a name" });
                continue;
            }
            let line = index.line(&path).unwrap_or_default();
            if let Some(first_line) = seen.insert(value.clone(), line) {
                let fault = Fault::Repeated { name: value.clone(), of, first_line };
                problems.push(index.place(&path), fault);
            }
        }
        if let Some(value) = run.start_s.filter(|v| !(v.is_finite() && *v >= 0.0)) {
            let (low, high, unit) = (0.0, 1e9, "s");
            let remedy = "give the seconds since switch-on, or leave it out";
            let fault = Fault::OutOfRange { value, low, high, unit, remedy };
            problems.push(index.place(&format!("runs[{i}].start_s")), fault);
        }
    }
}

fn check_commands(file: &str, table: &MeasuredTable, range: (f64, f64), problems: &mut Problems) {
    let (low_volt, high_volt) = range;
    let slack = COMMAND_TOLERANCE * (high_volt - low_volt);
    let mut listing = Listing::default();
    for (&voltage_volt, &line) in table.command_volt.iter().zip(&table.lines) {
        if voltage_volt < low_volt - slack || voltage_volt > high_volt + slack {
            let fault = Fault::CommandOutsideRange { voltage_volt, low_volt, high_volt };
            listing.push(problems, Place::at(file, line, 1).field("command_V"), fault);
        }
    }
    listing.finish(problems);
}
