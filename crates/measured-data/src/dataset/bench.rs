//! A whole actuator bench: `dataset.ron` and every record it names, all problems in one report.

use super::file::{DEFAULT_COMMAND_RANGE_VOLT, DatasetKind};
use super::open::{OpenDataset, numbered, run_field};
use super::run::Run;
use crate::files::Folder;
use crate::problem::{Fault, Place, Problem, Problems, RecordFault};
use crate::tables::{
    Listing, MeasuredTable, Record, check_lag, check_record, check_unit, parse_measured_csv,
};

/// A bench data set, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchData {
    /// One line about the data.
    pub title: String,
    /// Folder the data come from, for messages and results.
    pub folder: String,
    /// The records in the order of the file.
    pub runs: Vec<Run<MeasuredTable>>,
    /// Equivalent flap angle per displacement, deg/um, if the data set fixes it.
    pub flap_deg_per_um: Option<f64>,
    /// Voltages the actuator may see, V: lower and upper limit.
    pub command_range_volt: (f64, f64),
    /// What a reader should know: resampled, clipped or suspect records.
    pub warnings: Vec<Problem>,
    /// blake3 of `dataset.ron` and of every record, in order.
    pub content_hash: String,
}

/// Part of the command range by which a command may exceed it: digits of the converter.
const COMMAND_TOLERANCE: f64 = 1e-4;
/// Share of the command range below which no record of a bench stays.
const LEAST_RANGE_USED: f64 = 0.005;

/// Reads a bench data folder.
///
/// # Errors
/// Every problem of `dataset.ron` and of every record, ordered by file and line.
pub fn read_bench(folder: &Folder) -> Result<BenchData, Problems> {
    let mut open = OpenDataset::open(folder, DatasetKind::ActuatorBench)?;
    let given = open.dataset.command_range_volt.unwrap_or(DEFAULT_COMMAND_RANGE_VOLT);
    let range = open.check_range("command_range_V", given);
    if let Some(value) = open.dataset.flap_deg_per_um.filter(|v| !(v.is_finite() && *v > 0.0)) {
        let remedy = "leave it out to have identification set the gain";
        let fault = Fault::NotPositive { value, unit: "deg/um", remedy };
        open.problems.push(open.index.place("flap_deg_per_um"), fault);
    }
    let mut runs = Vec::with_capacity(open.dataset.runs.len());
    let mut warnings = Vec::new();
    for (number, run) in numbered(&open.dataset.runs) {
        let Some(source) = open.read(&run.file, &run_field(number, "file")) else { continue };
        match parse_measured_csv(&source) {
            Ok(mut table) => {
                warnings.append(&mut table.warnings);
                check_bench_record(&source.name, &table, range, &mut open.problems, &mut warnings);
                open.check_window(number, &table.time_s);
                open.check_run(number, &mut warnings);
                runs.push(Run::new(run, table));
            }
            Err(more) => open.problems.append(more),
        }
    }
    if let Some((low, high)) = range {
        let used = runs.iter().map(|run| span(&run.table.command_volt)).fold(0.0, f64::max);
        let percent = 100.0 * used / (high - low);
        if used > 0.0 && percent < 100.0 * LEAST_RANGE_USED {
            let fault = RecordFault::RangeUnused { percent, low, high };
            warnings.push(Problem::new(open.index.place("command_range_V"), fault.into()));
        }
    }
    let data = BenchData {
        folder: open.folder_name(),
        runs,
        flap_deg_per_um: open.dataset.flap_deg_per_um,
        command_range_volt: given,
        warnings,
        content_hash: open.content_hash(),
        title: open.dataset.title,
    };
    open.problems.into_result(Some(data))
}

fn span(values: &[f64]) -> f64 {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    high - low
}

/// The checks of an actuator's record: movement, clipping, range and unit of the command, lag.
pub(crate) fn check_bench_record(
    file: &str,
    table: &MeasuredTable,
    range: Option<(f64, f64)>,
    problems: &mut Problems,
    warnings: &mut Vec<Problem>,
) {
    let record = Record {
        file,
        lines: &table.lines,
        input: ("command_V", "V", &table.command_volt),
        output: ("displacement_um", "um", &table.displacement_um),
    };
    let moves = check_record(&record, problems, warnings);
    let in_range = range.is_none_or(|range| {
        check_unit(&record, range, problems) && check_commands(&record, range, problems)
    });
    if moves && in_range {
        check_lag(&record, problems);
    }
}

fn check_commands(record: &Record<'_>, range: (f64, f64), problems: &mut Problems) -> bool {
    let (low_volt, high_volt) = range;
    let slack = COMMAND_TOLERANCE * (high_volt - low_volt);
    let mut listing = Listing::default();
    let before = problems.as_slice().len();
    for (&voltage_volt, &line) in record.input.2.iter().zip(record.lines) {
        if voltage_volt < low_volt - slack || voltage_volt > high_volt + slack {
            let fault = Fault::CommandOutsideRange { voltage_volt, low_volt, high_volt };
            listing.push(problems, Place::at(record.file, line, 1).field("command_V"), fault);
        }
    }
    listing.finish(problems);
    problems.as_slice().len() == before
}
