//! Records in memory as a data folder: they are read and checked as a folder on disk is.

use crate::answers::raised;
use crate::arrays::{numbers, refused};
use measured_data::problem::Problem;
use measured_data::{
    DATASET, DatasetFile, DatasetKind, Embedded, EvenRecord, Folder, RunFile, ron_text,
};
use pyo3::prelude::*;
use pyo3::types::PyMapping;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Name of the folder of records in memory.
const ARRAYS: &str = "arrays";
/// Columns of a record of a bench.
const COLUMNS: [&str; 3] = ["time_s", "command_V", "displacement_um"];

/// What is said of records in memory; a folder says it in its `dataset.ron`.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Description {
    pub(crate) title: Option<String>,
    pub(crate) command_range_volt: Option<(f64, f64)>,
    pub(crate) flap_deg_per_um: Option<f64>,
}

/// The data folder at a path, or of runs in memory: names with time, command and displacement.
pub(crate) fn folder_of(data: &Bound<'_, PyAny>, said: &Description) -> PyResult<Folder> {
    let py = data.py();
    let Ok(runs) = data.cast::<PyMapping>() else {
        if *said != Description::default() {
            let message = "a folder says title, range and gain in its dataset.ron: give them there"
                .to_owned();
            return Err(raised(py, refused("data", message)));
        }
        return Ok(Folder::Disk(data.extract::<PathBuf>()?));
    };
    let mut texts = Vec::new();
    let mut files = Vec::new();
    for item in runs.items()?.iter() {
        let (id, columns): (String, Vec<Bound<'_, PyAny>>) = item.extract()?;
        let text = record_text(&id, &columns)?;
        let file = format!("{id}.csv");
        files.push(RunFile { id, file: file.clone(), ..RunFile::default() });
        texts.push((file, text));
    }
    let title = said.title.clone().unwrap_or_else(|| "records in memory".to_owned());
    let described = DatasetFile {
        flap_deg_per_um: said.flap_deg_per_um,
        command_range_volt: said.command_range_volt,
        ..DatasetFile::of(DatasetKind::ActuatorBench, title, files)
    };
    let text = ron_text(&described).map_err(|e| raised(py, refused("data", e.to_string())))?;
    texts.push((DATASET.to_owned(), text));
    Ok(Folder::Embedded(Embedded::of_texts(ARRAYS, texts)))
}

/// The table of a record.
fn record_text(id: &str, columns: &[Bound<'_, PyAny>]) -> PyResult<String> {
    let [time, command, displacement] = columns else {
        let message = format!("{} arrays, expected {}", columns.len(), COLUMNS.join(", "));
        return Err(match columns.first() {
            Some(first) => raised(first.py(), refused(id, message)),
            None => Python::attach(|py| raised(py, refused(id, message))),
        });
    };
    let py = time.py();
    let time_s = numbers(COLUMNS[0], time)?;
    let named = [(COLUMNS[1], command), (COLUMNS[2], displacement)];
    let mut others = Vec::new();
    for (name, given) in named {
        let values = numbers(name, given)?;
        same_count(name, &values, &time_s).map_err(|problem| raised(py, problem))?;
        others.push(values);
    }
    let mut text = COLUMNS.join(",") + "\n";
    for ((time, command), displacement) in time_s.iter().zip(&others[0]).zip(&others[1]) {
        // writing to a text does not fail
        let _ = writeln!(text, "{time},{command},{displacement}");
    }
    Ok(text)
}

/// Refuses an array that has not a value for each time.
pub(crate) fn same_count(name: &str, values: &[f64], time_s: &[f64]) -> Result<(), Problem> {
    let (found, expected) = (values.len(), time_s.len());
    let message = || format!("{found} samples, but time_s has {expected}: give one for each time");
    if found == expected { Ok(()) } else { Err(refused(name, message())) }
}

/// Time between two samples, s.
pub(crate) fn step_of(time_s: &[f64]) -> Result<f64, Problem> {
    EvenRecord::step_of(time_s)
        .map_err(|(sample, message)| refused(&format!("time_s[{sample}]"), message))
}
