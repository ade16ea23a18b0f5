//! Data sets of generic loops: any input, any output, in their own units.

use super::file::DatasetKind;
use super::open::OpenDataset;
use super::run::Run;
use crate::files::Folder;
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::{Channel, Channels, Record, check_record, limits, parse_loop_csv};

/// A data set of generic loops, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopData {
    /// One line about the data.
    pub title: String,
    /// Folder the data come from, for messages and results.
    pub folder: String,
    /// Input and output with their units, the same in every run.
    pub channels: Channels,
    /// Inputs the system may see, in the unit of the input: lower and upper limit.
    pub input_range: (f64, f64),
    /// Where the range comes from.
    pub range_rule: &'static str,
    /// The records in the order of the file.
    pub runs: Vec<Run>,
    /// What a reader should know: resampled or clipped records.
    pub warnings: Vec<Problem>,
    /// blake3 of `dataset.ron` and of every record, in order.
    pub content_hash: String,
}

/// Reads a data folder of kind `GenericLoop`.
///
/// # Errors
/// Every problem of `dataset.ron` and of every record, ordered by file and line.
pub fn read_loops(folder: &Folder) -> Result<LoopData, Problems> {
    let mut open = OpenDataset::open(folder, DatasetKind::GenericLoop)?;
    let given = open.dataset.input_range.and_then(|range| open.check_range("input_range", range));
    let declared = open.declared();
    let mut channels: Option<Channels> = None;
    let runs = open.runs(|open, source| {
        let (mut table, found) = parse_loop_csv(source, &declared)?;
        let expected = channels.get_or_insert_with(|| found.clone());
        same_channels(&source.name, &found, expected, &mut open.problems);
        open.warnings.append(&mut table.warnings);
        let [input, output] = found.both().map(Channel::label);
        let record = Record {
            file: &source.name,
            lines: &table.lines,
            input: (&input, found.input.unit.symbol, &table.input),
            output: (&output, found.output.unit.symbol, &table.output),
        };
        check_record(&record, &mut open.problems, &mut open.warnings);
        if let Some(range) = given {
            check_inputs(&record, range, &mut open.problems);
        }
        Ok(table)
    });
    if let Some(channels) = &channels {
        let labels = channels.both().map(Channel::label);
        let units = channels.both().map(|channel| channel.unit.symbol);
        open.check_together(&runs, [(&labels[0], units[0]), (&labels[1], units[1])]);
    }
    let ends = runs.iter().map(|run| limits(&run.table.input));
    let ends: Vec<f64> = ends.flat_map(|(low, high)| [low, high]).collect();
    let (low, high) = limits(&ends);
    let of_all = if low < high {
        ((low, high), "from the smallest to the largest input of all runs")
    } else {
        ((low - 1.0, high + 1.0), "about the one input there is")
    };
    let (input_range, range_rule) = given.map_or(of_all, |range| (range, "given in dataset.ron"));
    let (folder, content_hash) = open.origin();
    let data = channels.map(|channels| LoopData {
        folder,
        channels,
        input_range,
        range_rule,
        runs,
        content_hash,
        warnings: open.warnings,
        title: open.dataset.title,
    });
    open.problems.into_result(data)
}

/// Notes columns that differ from those of the runs before.
pub(crate) fn same_channels(
    file: &str,
    found: &Channels,
    expected: &Channels,
    problems: &mut Problems,
) {
    let labels = |c: &Channels| c.both().map(Channel::label).join(", ");
    if found != expected {
        let fault = Fault::OtherColumns { found: labels(found), expected: labels(expected) };
        problems.push(Place::at(file, 1, 1), fault);
    }
}

/// Notes the first input outside the declared range.
fn check_inputs(record: &Record<'_>, (low, high): (f64, f64), problems: &mut Problems) {
    let (label, unit, values) = record.input;
    let slack = 1e-4 * (high - low);
    let outside = values.iter().position(|v| *v < low - slack || *v > high + slack);
    if let Some(at) = outside {
        let remedy = "correct input_range of dataset.ron, or leave it out to have it derived";
        let fault = Fault::OutOfRange { value: values[at], low, high, unit, remedy };
        problems.push(record.place(at, label), fault);
    }
}
