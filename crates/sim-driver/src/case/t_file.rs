//! The T matrix that a case hands in.

use super::Case;
use crate::files::{Folder, RonIndex, Source, missing_file};
use crate::problem::{Fault, Place, Problem};
use rotor_case::HandedT;
use rotor_export::{Axis, Document, LabelledArray};
use rotor_flight::handed_t;
use serde::Deserialize;
use serde_json::Value;
use std::fmt::Display;
use std::sync::Arc;

/// Reads the T that a case names; none for a case without.
///
/// # Errors
/// A file that is missing, no JSON or CSV of `hhc export --what t`, or whose T is not of this case, in words.
pub(super) fn read_t_file(
    case: &Case,
    folder: &Folder,
    index: &RonIndex,
) -> Result<Option<Arc<HandedT>>, Problem> {
    // a name that is left out is a fault of the values
    let Some(file) = case.control.t_file.as_deref().filter(|file| !file.trim().is_empty()) else {
        return Ok(None);
    };
    if !folder.contains(file) {
        return Err(Problem::new(index.place("control.t_file"), missing_file(folder, file)));
    }
    let source = folder.read(file)?;
    let document = if source.text.trim_start().starts_with('{') {
        json(&source)?
    } else {
        Document { arrays: vec![csv(&source)?], ..Document::default() }
    };
    let found = handed_t(case, &document);
    found.map(|t| Some(Arc::new(t))).map_err(|error| refused(Place::file(&source.name), &error))
}

fn refused(place: Place, message: &dyn Display) -> Problem {
    Problem::new(place, Fault::Refused { message: message.to_string() })
}

#[derive(Deserialize)]
struct FileDocument {
    #[serde(default)]
    notes: Vec<String>,
    arrays: Vec<FileArray>,
}

#[derive(Deserialize)]
struct FileArray {
    name: String,
    #[serde(default)]
    meaning: String,
    axes: Vec<FileAxis>,
    values: Value,
}

#[derive(Deserialize)]
struct FileAxis {
    name: String,
    labels: Vec<String>,
    units: Vec<String>,
}

/// A document of `hhc export --to json`: every element where its indices say.
fn json(source: &Source) -> Result<Document, Problem> {
    let read: FileDocument = serde_json::from_str(&source.text).map_err(|error| {
        let place = Place::at(&source.name, error.line(), error.column());
        refused(place, &format!("{error}; expected the JSON of `hhc export --what t`"))
    })?;
    let array = |array: FileArray| {
        let axes: Vec<Axis> = array
            .axes
            .into_iter()
            .map(|FileAxis { name, labels, units }| Axis { name, labels, units })
            .collect();
        let whole =
            LabelledArray { axes, name: array.name, meaning: array.meaning, values: vec![] };
        let [rows, columns, pages] = whole.sizes();
        let depth = whole.axes.len();
        let mut values = Vec::with_capacity(rows * columns * pages);
        for (k, j, i) in places([pages, columns, rows]) {
            let indices = [i, j, k];
            let mut at = Some(&array.values);
            for index in indices.iter().take(depth) {
                at = at.and_then(|list| list.get(index));
            }
            let value = at.and_then(Value::as_f64).ok_or_else(|| {
                let labels = whole.axes.iter().zip(indices);
                let labels: Vec<&str> =
                    labels.filter_map(|(axis, i)| axis.labels.get(i).map(String::as_str)).collect();
                let message = format!("array `{}`: no number at {}", whole.name, labels.join(", "));
                refused(Place::file(&source.name), &message)
            })?;
            values.push(value);
        }
        Ok(LabelledArray { values, ..whole })
    };
    let arrays = read.arrays.into_iter().map(array).collect::<Result<_, Problem>>()?;
    Ok(Document { notes: read.notes, arrays, ..Document::default() })
}

/// All triples of indices, the last running fastest.
fn places([first, second, third]: [usize; 3]) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..first).flat_map(move |i| (0..second).flat_map(move |j| (0..third).map(move |k| (i, j, k))))
}

/// One table of `hhc export --to csv`, `NAME_T_HARMONICS.csv`: its harmonics follow from its controls.
fn csv(source: &Source) -> Result<LabelledArray, Problem> {
    const EXPECTED: &str = "expected the table NAME_T_HARMONICS.csv of `hhc export --what t --to csv`: point,load,unit, then a column for each control";
    let at = |line: usize, message: String| refused(Place::at(&source.name, line, 1), &message);
    let cells = |line: &str| -> Vec<String> {
        line.split(',').map(|cell| cell.trim().trim_matches('"').to_owned()).collect()
    };
    let mut lines = source.text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let head = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
    let Some(controls) = head.strip_prefix(&["point", "load", "unit"].map(str::to_owned)) else {
        return Err(at(1, format!("`{}`: {EXPECTED}", head.join(","))));
    };
    // flap1_3_per_rev_cos_V: the harmonics of the first flap, in order
    let own =
        controls.iter().filter_map(|name| name.strip_prefix("flap1_")?.split_once("_per_rev_cos_"));
    let harmonics: Vec<&str> = own.map(|(harmonic, _)| harmonic).collect();
    let unit = |name: &String| if name.ends_with("_V") { "V" } else { "" }.to_owned();
    let (mut points, mut loads, mut units) = (Vec::new(), Vec::new(), Vec::new());
    let mut table: Vec<Vec<f64>> = Vec::new();
    for (k, line) in lines {
        let row = cells(line);
        let [point, load, of, numbers @ ..] = &row[..] else {
            return Err(at(k + 1, EXPECTED.to_owned()));
        };
        if numbers.len() != controls.len() {
            let message = format!("{} numbers, expected {}", numbers.len(), controls.len());
            return Err(at(k + 1, message));
        }
        let number = |text: &String| {
            let no_number = || at(k + 1, format!("`{text}` is no number"));
            text.parse::<f64>().map_err(|_| no_number())
        };
        if points.last() != Some(point) {
            points.push(point.clone());
        }
        if points.len() == 1 {
            loads.push(load.clone());
            units.push(of.clone());
        }
        let place = table.len() % loads.len().max(1);
        if loads[place] != *load || units[place] != *of {
            let message = format!(
                "`{load}` in `{of}`, expected `{}` in `{}`: every point has the same loads in the same order",
                loads[place], units[place]
            );
            return Err(at(k + 1, message));
        }
        table.push(numbers.iter().map(number).collect::<Result<_, Problem>>()?);
    }
    if table.is_empty() || table.len() != points.len() * loads.len() {
        return Err(at(1, format!("{} rows: {EXPECTED}", table.len())));
    }
    let axes = vec![
        Axis { name: "load".to_owned(), units, labels: loads.clone() },
        Axis {
            name: "control".to_owned(),
            units: controls.iter().map(unit).collect(),
            labels: controls.to_vec(),
        },
        Axis::of_unit("point", points, ""),
    ];
    let name = format!("T_{}", harmonics.join("_"));
    let rows = loads.len();
    Ok(LabelledArray::from_fn(&name, "", axes, |i, j, k| table[k * rows + i][j]))
}
