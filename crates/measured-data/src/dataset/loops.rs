//! Data sets of generic loops: any input, any output, in their own units.

use super::file::DatasetKind;
use super::open::{OpenDataset, numbered, run_field};
use super::run::Run;
use crate::files::Folder;
use crate::problem::{Fault, Place, Problem, Problems, RecordFault};
use crate::tables::{Channels, Declared, LoopTable, Record, check_record, parse_loop_csv};

/// A data set of generic loops, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopData {
    /// One line about the data.
    pub title: String,
    /// Folder the data come from, for messages and results.
    pub folder: String,
    /// Input and output with their units, the same in every run.
    pub channels: Channels,
    /// Inputs the system may see, in the unit of the input.
    pub input_range: InputRange,
    /// The records in the order of the file.
    pub runs: Vec<Run<LoopTable>>,
    /// What a reader should know: resampled or clipped records.
    pub warnings: Vec<Problem>,
    /// blake3 of `dataset.ron` and of every record, in order.
    pub content_hash: String,
}

/// Where the range of the inputs comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InputRange {
    /// `input_range` of `dataset.ron`.
    Given(f64, f64),
    /// From the smallest to the largest input of all runs.
    OfAllRuns(f64, f64),
}

impl InputRange {
    /// Lower and upper limit, in the unit of the input.
    pub fn limits(self) -> (f64, f64) {
        match self {
            Self::Given(low, high) | Self::OfAllRuns(low, high) => (low, high),
        }
    }

    /// The rule in words.
    pub fn rule(self) -> &'static str {
        match self {
            Self::Given(..) => "given in dataset.ron",
            Self::OfAllRuns(..) => "from the smallest to the largest input of all runs",
        }
    }
}

/// Reads a data folder of kind `GenericLoop`.
///
/// # Errors
/// Every problem of `dataset.ron` and of every record, ordered by file and line.
pub fn read_loops(folder: &Folder) -> Result<LoopData, Problems> {
    let mut open = OpenDataset::open(folder, DatasetKind::GenericLoop)?;
    let given = match open.dataset.input_range {
        Some(range) => open.check_range("input_range", range),
        None => None,
    };
    let (input, output) = (open.dataset.input.clone(), open.dataset.output.clone());
    let declared = Declared { input: input.as_ref(), output: output.as_ref() };
    let mut runs: Vec<Run<LoopTable>> = Vec::with_capacity(open.dataset.runs.len());
    let mut warnings = Vec::new();
    let mut channels: Option<Channels> = None;
    for (number, run) in numbered(&open.dataset.runs) {
        let Some(source) = open.read(&run.file, &run_field(number, "file")) else { continue };
        let (mut table, found) = match parse_loop_csv(&source, declared) {
            Ok(read) => read,
            Err(more) => {
                open.problems.append(more);
                continue;
            }
        };
        let expected = channels.get_or_insert_with(|| found.clone());
        same_channels(&source.name, &found, expected, &mut open.problems);
        warnings.append(&mut table.warnings);
        let (input_label, output_label) = (found.input.label(), found.output.label());
        let record = Record {
            file: &source.name,
            lines: &table.lines,
            input: (&input_label, found.input.unit.symbol, &table.input),
            output: (&output_label, found.output.unit.symbol, &table.output),
        };
        check_record(&record, &mut open.problems, &mut warnings);
        if let Some(range) = given {
            check_inputs(&record, range, &mut open.problems);
        }
        open.check_window(number, &table.time_s);
        open.check_run(number, &mut warnings);
        runs.push(Run::new(run, table));
    }
    let all = runs.iter().flat_map(|run| run.table.input.iter().copied());
    let (low, high) =
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let input_range =
        given.map_or(InputRange::OfAllRuns(low, high), |(low, high)| InputRange::Given(low, high));
    let data = channels.map(|channels| LoopData {
        folder: open.folder_name(),
        channels,
        input_range,
        runs,
        warnings,
        content_hash: open.content_hash(),
        title: open.dataset.title.clone(),
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
    let labels = |c: &Channels| format!("{}, {}", c.input.label(), c.output.label());
    if found != expected {
        let fault = RecordFault::OtherColumns { found: labels(found), expected: labels(expected) };
        problems.push(Place::at(file, 1, 1), fault.into());
    }
}

/// Notes the first input outside the declared range.
fn check_inputs(record: &Record<'_>, range: (f64, f64), problems: &mut Problems) {
    let (low, high) = range;
    let (label, unit, values) = record.input;
    let slack = 1e-4 * (high - low);
    let outside = values.iter().position(|v| *v < low - slack || *v > high + slack);
    if let Some(at) = outside {
        let remedy = "correct input_range of dataset.ron, or leave it out to have it derived";
        let fault = Fault::OutOfRange { value: values[at], low, high, unit, remedy };
        problems.push(Place::at(record.file, record.lines[at], 1).field(label), fault);
    }
}
