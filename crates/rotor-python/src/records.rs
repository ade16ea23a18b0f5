//! Records in memory as a data folder: they are read and checked as a folder on disk is.

use crate::answers::{raised, refused, worked};
use crate::arrays::numbers;
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
    let mut records = Vec::new();
    for item in runs.items()?.iter() {
        let (id, columns): (String, Vec<Bound<'_, PyAny>>) = item.extract()?;
        let columns = columns_of(py, &id, &columns)?;
        records.push((id, columns));
    }
    // a million samples take a second to be written
    worked(py, || Ok(described(records, said)?))
}

/// Records with what is said of them as a folder.
fn described(records: Vec<(String, Record)>, said: &Description) -> Result<Folder, Problem> {
    let title = said.title.clone().unwrap_or_else(|| "records in memory".to_owned());
    let (mut files, mut texts) = (Vec::new(), Vec::new());
    for (id, columns) in records {
        let file = format!("{id}.csv");
        files.push(RunFile { id, file: file.clone(), ..RunFile::default() });
        texts.push((file, record_text(&columns)));
    }
    let dataset = DatasetFile {
        flap_deg_per_um: said.flap_deg_per_um,
        command_range_volt: said.command_range_volt,
        ..DatasetFile::of(DatasetKind::ActuatorBench, title, files)
    };
    let text = ron_text(&dataset).map_err(|e| refused("data", e.to_string()))?;
    texts.push((DATASET.to_owned(), text));
    Ok(Folder::Embedded(Embedded::of_texts(ARRAYS, texts)))
}

/// Time, command and displacement of a record.
type Record = [Vec<f64>; 3];

/// The numbers of a record in memory; what is wrong with them is told with its name.
fn columns_of(py: Python<'_>, id: &str, columns: &[Bound<'_, PyAny>]) -> PyResult<Record> {
    let [time, command, displacement] = columns else {
        let message = format!("{} arrays, expected {}", columns.len(), COLUMNS.join(", "));
        return Err(raised(py, refused(&format!("{ARRAYS}/{id}"), message)));
    };
    let names = COLUMNS.map(|name| format!("{ARRAYS}/{id}: {name}"));
    let time_s = numbers(&names[0], time)?;
    let other = |at: usize, given: &Bound<'_, PyAny>| {
        let values = numbers(&names[at], given)?;
        let counted = same_count(&names[at], &values, &time_s);
        counted.map(|()| values).map_err(|problem| raised(py, problem))
    };
    let (command, displacement) = (other(1, command)?, other(2, displacement)?);
    Ok([time_s, command, displacement])
}

/// The table of a record.
fn record_text([time_s, command, displacement]: &Record) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for ((time, command), displacement) in time_s.iter().zip(command).zip(displacement) {
        // writing to a text does not fail
        let _ = writeln!(text, "{time},{command},{displacement}");
    }
    text
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
