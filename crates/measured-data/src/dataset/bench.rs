//! A whole actuator bench: `dataset.ron` and every record it names, all problems in one report.

use super::accuracy::Accuracy;
use super::file::{DEFAULT_COMMAND_RANGE_VOLT, DatasetKind};
use super::open::OpenDataset;
use super::run::Run;
use crate::files::Folder;
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::{
    Record, Spans, check_lag, check_record, check_unit, limits, parse_measured_csv,
};
use rotor_base::significant;

/// A bench data set, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchData {
    /// One line about the data.
    pub title: String,
    /// Folder the data come from, for messages and results.
    pub folder: String,
    /// The records in the order of the file.
    pub runs: Vec<Run>,
    /// Equivalent flap angle per displacement, deg/um, if the data set fixes it.
    pub flap_deg_per_um: Option<f64>,
    /// Voltages the actuator may see, V: lower and upper limit.
    pub command_range_volt: (f64, f64),
    /// How well the channels keep their calibration from one session to the next.
    pub accuracy: Accuracy,
    /// What a reader should know: resampled, clipped or suspect records.
    pub warnings: Vec<Problem>,
    /// blake3 of `dataset.ron` and of every record, in order.
    pub content_hash: String,
}

/// Part of the command range by which a command may exceed it: digits of the converter.
const COMMAND_TOLERANCE: f64 = 1e-4;
/// Share of the command range below which no record of a bench stays, percent.
const LEAST_RANGE_USED_PERCENT: f64 = 0.5;

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
    let accuracy = open.dataset.accuracy.unwrap_or_default();
    for (field, value, unit) in accuracy.rows() {
        if !(value.is_finite() && value >= 0.0) {
            let message = format!("is {value} {unit}, expected a standard deviation of 0 or more");
            let place = open.index.place(&format!("accuracy.{field}"));
            open.problems.push(place, Fault::Other(message));
        }
    }
    let is_given = open.dataset.command_range_volt.is_some();
    // a range that nobody gave tells nothing of the unit
    let of_unit = if is_given { range } else { Some(PLAUSIBLE_RANGE_VOLT) };
    let runs = open.runs(|open, source| {
        let mut table = parse_measured_csv(source)?;
        open.warnings.append(&mut table.warnings);
        let record = Record {
            file: &source.name,
            lines: &table.lines,
            input: ("command_V", "V", &table.input),
            output: ("displacement_um", "um", &table.output),
        };
        let ranges = [range, of_unit];
        check_bench_record(&record, ranges, &mut open.problems, &mut open.warnings);
        Ok(table)
    });
    let placed = |run: &Run, sample: usize| {
        let name = folder.display(&run.entry.file);
        let line = run.table.lines.get(sample);
        line.map_or(Place::file(&name), |line| Place::at(&name, *line, 1)).field("command_V")
    };
    let beyond = range.and_then(|range| beyond_range(&runs, range, is_given, placed));
    open.problems.note(beyond.map_or(Ok(()), Err));
    let spans = open.check_together(&runs, [("command_V", "V"), ("displacement_um", "um")]);
    if let Some(fault) = monitor_volts(&spans) {
        open.warnings.push(Problem::new(open.index.place("runs"), fault));
    }
    let spans = runs.iter().map(|run| limits(&run.table.input)).map(|(low, high)| high - low);
    let used_volt = spans.fold(0.0, f64::max);
    if let Some(fault) = range.and_then(|range| range_unused(used_volt, range)) {
        open.warnings.push(Problem::new(open.index.place("command_range_V"), fault));
    }
    let (folder, content_hash) = open.origin();
    let data = BenchData {
        folder,
        runs,
        flap_deg_per_um: open.dataset.flap_deg_per_um,
        command_range_volt: given,
        accuracy,
        content_hash,
        warnings: open.warnings,
        title: open.dataset.title,
    };
    open.problems.into_result(Some(data))
}

/// The fault of commands that use next to nothing of a range of voltages, V.
pub(crate) fn range_unused(used_volt: f64, (low, high): (f64, f64)) -> Option<Fault> {
    let percent = 100.0 * used_volt / (high - low);
    let is_unused = used_volt > 0.0 && percent < LEAST_RANGE_USED_PERCENT;
    is_unused.then(|| {
        Fault::Other(format!(
            "no command uses more than {percent:.2} % of command_range_V ({low}, {high}): are the commands in kV, or in V over a divider?"
        ))
    })
}

/// Largest output of the monitor of an amplifier, V.
const MONITOR_VOLT: f64 = 12.0;

/// The fault of commands that all stay within what the monitor output of an amplifier gives.
pub(crate) fn monitor_volts(all: &[Spans]) -> Option<Fault> {
    let moving = all.iter().filter(|spans| spans.input.1 > spans.input.0);
    let sizes = moving.map(|spans| spans.input.0.abs().max(spans.input.1.abs()));
    let largest = sizes.fold(0.0, f64::max);
    (largest > 0.0 && largest <= MONITOR_VOLT).then(|| {
        Fault::Other(format!(
            "no command exceeds {largest} V: if this is the monitor output of an amplifier or its input, multiply by its gain: hhc import --scale command=15 for 0 to 10 V of 0 to 150 V"
        ))
    })
}

/// Voltages that piezo stacks, benders and their amplifiers reach, V.
pub(crate) const PLAUSIBLE_RANGE_VOLT: (f64, f64) = (-1000.0, 1000.0);

/// The checks of an actuator's record: movement, clipping, unit of the command, lag where it keeps to its range. The
/// ranges are that of the command, and the one that tells its unit.
pub(crate) fn check_bench_record(
    record: &Record<'_>,
    [range, of_unit]: [Option<(f64, f64)>; 2],
    problems: &mut Problems,
    warnings: &mut Vec<Problem>,
) {
    let moves = check_record(record, problems, warnings);
    let in_range = of_unit.is_none_or(|range| check_unit(record, range, problems))
        && range.is_none_or(|range| first_beyond(record.input.2, range).is_none());
    if moves && in_range {
        check_lag(record, problems);
    }
}

/// The first command that leaves the range by more than the digits of a converter.
fn first_beyond(values: &[f64], (low, high): (f64, f64)) -> Option<usize> {
    let slack = COMMAND_TOLERANCE * (high - low);
    values.iter().position(|volt| *volt < low - slack || *volt > high + slack)
}

/// The fault of records that leave the command range, at the first sample that does: what the range has to be.
fn beyond_range(
    runs: &[Run],
    range: (f64, f64),
    is_given: bool,
    place: impl Fn(&Run, usize) -> Place,
) -> Option<Problem> {
    let leaves = |run: &&Run| first_beyond(&run.table.input, range).is_some();
    let first = runs.iter().find(leaves)?;
    let sample = first_beyond(&first.table.input, range)?;
    let ids: Vec<&str> = runs.iter().filter(leaves).map(|run| run.entry.id.as_str()).collect();
    let ends: Vec<f64> =
        runs.iter().flat_map(|run| <[f64; 2]>::from(limits(&run.table.input))).collect();
    let (least, most) = outward(limits(&ends));
    let (low, high) = range;
    let whose = if is_given {
        "of dataset.ron"
    } else {
        "of a common stack, which stands for the one that dataset.ron does not give"
    };
    let message = format!(
        "the command {} V lies outside command_range_V ({low}, {high}) {whose}; command_range_V is what the amplifier may put on this actuator: the records need `command_range_V: ({least}, {most})` or more in dataset.ron. Beyond it: {}; of a record with another unit or device correct or remove that record",
        first.table.input[sample],
        ids.join(", ")
    );
    Some(Problem::new(place(first, sample), Fault::Other(message)))
}

/// Limits moved outwards to a whole number of a tenth of the power of ten below their distance: what a reader would write.
fn outward((low, high): (f64, f64)) -> (f64, f64) {
    let step = 10_f64.powf((high - low).log10().floor() - 1.0);
    if !(step.is_finite() && step > 0.0) {
        return (low, high);
    }
    // digits of a converter beyond a whole step are none
    let slack = COMMAND_TOLERANCE * (high - low) / step;
    let whole = |value: f64| significant(value * step, 6) + 0.0;
    (whole((low / step + slack).floor()), whole((high / step - slack).ceil()))
}
