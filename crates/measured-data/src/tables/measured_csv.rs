//! Measured tables: CSV with a header that carries units.

use super::table_text::{
    LEAST_ROWS, Line, ROUNDING_JITTER, Rows, check_time, increases_evenly, other_separator,
    resample, resampled, split_lines,
};
use crate::files::Source;
use crate::problem::{Fault, Place, Problem, Problems, RecordFault, nearest};

/// A quantity a measured table may hold.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Quantity {
    /// Name without unit.
    name: &'static str,
    /// Name with unit, the form the program writes.
    column: &'static str,
    /// Unit.
    unit: &'static str,
    /// Spellings of the same unit.
    spellings: &'static [&'static str],
    /// Other units of the quantity and the factor into `unit`; none where a shift is needed too.
    others: &'static [(&'static str, Option<f64>)],
    required: bool,
}

const VOLTS: &[(&str, Option<f64>)] = &[("mV", Some(1e-3)), ("kV", Some(1e3)), ("uV", Some(1e-6))];

const QUANTITIES: [Quantity; 6] = [
    Quantity {
        name: "time",
        column: "time_s",
        unit: "s",
        spellings: &["s", "sec"],
        others: &[("ms", Some(1e-3)), ("us", Some(1e-6)), ("min", Some(60.0)), ("h", Some(3600.0))],
        required: true,
    },
    Quantity {
        name: "command",
        column: "command_V",
        unit: "V",
        spellings: &["V"],
        others: VOLTS,
        required: true,
    },
    Quantity {
        name: "displacement",
        column: "displacement_um",
        unit: "um",
        spellings: &["um", "µm", "μm"],
        others: &[("nm", Some(1e-3)), ("mm", Some(1e3)), ("cm", Some(1e4)), ("m", Some(1e6))],
        required: true,
    },
    Quantity {
        name: "amplifier",
        column: "amplifier_V",
        unit: "V",
        spellings: &["V"],
        others: VOLTS,
        required: false,
    },
    Quantity {
        name: "temperature",
        column: "temperature_C",
        unit: "C",
        spellings: &["C", "degC", "°C"],
        others: &[("K", None), ("F", None), ("degF", None), ("°F", None)],
        required: false,
    },
    Quantity {
        name: "load",
        column: "load_N",
        unit: "N",
        spellings: &["N"],
        others: &[
            ("mN", Some(1e-3)),
            ("kN", Some(1e3)),
            ("kgf", Some(9.806_65)),
            ("lbf", Some(4.448_222)),
        ],
        required: false,
    },
];

/// Position of each quantity in [`QUANTITIES`].
const TIME: usize = 0;
const COMMAND: usize = 1;
const DISPLACEMENT: usize = 2;

/// A measured record, uniformly sampled, every number finite.
///
/// All columns have the same length.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredTable {
    /// Time, s, increasing in equal steps.
    pub time_s: Vec<f64>,
    /// Sampling step, s.
    pub time_step_s: f64,
    /// Command, V.
    pub command_volt: Vec<f64>,
    /// Displacement, um.
    pub displacement_um: Vec<f64>,
    /// Amplifier output, V, if measured.
    pub amplifier_volt: Option<Vec<f64>>,
    /// Temperature, degrees Celsius, if measured.
    pub temperature_celsius: Option<Vec<f64>>,
    /// Load on the actuator, N, if measured.
    pub load_newton: Option<Vec<f64>>,
    /// Line of every row in its file, from 1.
    pub lines: Vec<usize>,
    /// What was done to it that a reader should know: times brought onto even steps.
    pub warnings: Vec<Problem>,
}

/// Reads a measured table.
///
/// The header names every column with its unit: `time_s`, `time [s]`, or `time` with a second row
/// `(s)`. Required: `time_s`, `command_V`, `displacement_um`; known besides: `amplifier_V`,
/// `temperature_C`, `load_N`. Lines that begin with `#` are comments.
///
/// # Errors
/// Every problem found, with line and column; of many alike, the first five and their number.
pub fn parse_measured_csv(source: &Source) -> Result<MeasuredTable, Problems> {
    let mut problems = Problems::default();
    let lines = split_lines(&source.text);
    let (columns, first_row) = read_header(source, &lines, &mut problems);
    if !problems.is_empty() {
        return problems.into_result(None);
    }
    let labels: Vec<&str> = columns.iter().map(|&c| QUANTITIES[c].column).collect();
    let rows = Rows::read(source, &lines[first_row..], &labels, &mut problems);
    let table = finish(rows, source, &columns, &mut problems);
    problems.into_result(table)
}

/// For every column of the file its index in [`QUANTITIES`], and the number of header lines.
fn read_header(
    source: &Source,
    lines: &[Line<'_>],
    problems: &mut Problems,
) -> (Vec<usize>, usize) {
    let Some(header) = lines.first() else {
        let fault = Fault::TooFewRows { rows: 0, least: LEAST_ROWS };
        problems.push(Place::file(&source.name), fault);
        return (vec![], 0);
    };
    if let Some(fault) = other_separator(header.text) {
        problems.push(Place::at(&source.name, header.number, 1), fault.into());
        return (vec![], 0);
    }
    let names = header.fields();
    let units = lines.get(1).map(|l| l.fields()).filter(|f| f.iter().all(|(t, _)| is_unit_cell(t)));
    let first_row = if units.is_some() { 2 } else { 1 };
    let place = |at: usize| Place::at(&source.name, header.number, at);
    let known = || QUANTITIES.map(|q| q.column).join(", ");
    let mut columns = Vec::new();
    for (index, (name, at)) in names.iter().enumerate() {
        let second = units.as_ref().and_then(|u| u.get(index)).map(|(t, _)| strip_brackets(t));
        let Some((quantity, unit)) = split_name(name, second) else {
            let nearest = nearest(name, QUANTITIES.iter().flat_map(|q| [q.column, q.name]));
            let fault = Fault::UnknownColumn { found: (*name).into(), known: known(), nearest };
            problems.push(place(*at), fault);
            continue;
        };
        let q = &QUANTITIES[quantity];
        match unit {
            None => {
                let fault = Fault::MissingUnit { found: (*name).into(), expected: q.column };
                problems.push(place(*at), fault);
            }
            Some(unit) if !q.spellings.contains(&unit) => {
                let factor = q.others.iter().find(|(u, _)| *u == unit).and_then(|(_, f)| *f);
                let (column, expected) = (q.column, q.unit);
                let fault = Fault::WrongUnit { column, found: unit.into(), expected, factor };
                problems.push(place(*at).field(*name), fault);
            }
            Some(_) if columns.contains(&quantity) => {
                problems.push(place(*at), Fault::RepeatedColumn { column: q.column });
            }
            Some(_) => {}
        }
        columns.push(quantity);
    }
    for (index, quantity) in QUANTITIES.iter().enumerate() {
        if quantity.required && !columns.contains(&index) {
            let found = names.iter().map(|(n, _)| *n).collect::<Vec<_>>().join(", ");
            problems.push(place(1), Fault::MissingColumn { column: quantity.column, found });
        }
    }
    (columns, first_row)
}

pub(crate) fn is_unit_cell(text: &str) -> bool {
    (text.starts_with('(') && text.ends_with(')')) || (text.starts_with('[') && text.ends_with(']'))
}

pub(crate) fn strip_brackets(text: &str) -> &str {
    text.trim_matches(['(', ')', '[', ']']).trim()
}

/// The quantity and unit of a header cell; none if it names no known quantity.
fn split_name<'a>(cell: &'a str, second_row: Option<&'a str>) -> Option<(usize, Option<&'a str>)> {
    let find = |name: &str| QUANTITIES.iter().position(|q| q.name.eq_ignore_ascii_case(name));
    if let Some(open) = cell.find(['[', '(']) {
        return find(cell[..open].trim()).map(|q| (q, Some(strip_brackets(&cell[open..]))));
    }
    if let Some(q) = find(cell) {
        return Some((q, second_row));
    }
    let (name, unit) = cell.split_once('_')?;
    find(name).map(|q| (q, Some(unit)))
}

/// Checks the time column and hands out the columns by name.
fn finish(
    mut rows: Rows,
    source: &Source,
    columns: &[usize],
    problems: &mut Problems,
) -> Option<MeasuredTable> {
    let count = rows.lines.len();
    if count < LEAST_ROWS {
        let fault = Fault::TooFewRows { rows: count, least: LEAST_ROWS };
        problems.push(Place::file(&source.name), fault);
    }
    // rows that are no numbers tear holes into the time: nothing can be said about its steps
    if !problems.is_empty() {
        return None;
    }
    let mut take = |quantity: usize| {
        let column = columns.iter().position(|c| *c == quantity)?;
        Some(std::mem::take(&mut rows.values[column]))
    };
    let mut time_s = take(TIME)?;
    let label = QUANTITIES[TIME].column;
    let mut command_volt = take(COMMAND)?;
    let sampling = check_time(&source.name, label, &time_s, &rows.lines, problems);
    if !problems.is_empty() && increases_evenly(&command_volt) {
        let fault =
            RecordFault::TimeSwapped { other: QUANTITIES[COMMAND].column.to_owned() }.into();
        problems.push(Place::at(&source.name, rows.lines[0], 1).field(label), fault);
    }
    let mut displacement_um = take(DISPLACEMENT)?;
    let (mut amplifier, mut temperature, mut load) = (take(3), take(4), take(5));
    let mut warnings = Vec::new();
    if problems.is_empty() && sampling.jitter > ROUNDING_JITTER {
        let mut all = vec![&mut command_volt, &mut displacement_um];
        all.extend([&mut amplifier, &mut temperature, &mut load].into_iter().flatten());
        resample(&mut time_s, &mut all);
        warnings.push(resampled(&source.name, label, sampling));
    }
    Some(MeasuredTable {
        time_step_s: sampling.step_s,
        command_volt,
        displacement_um,
        amplifier_volt: amplifier,
        temperature_celsius: temperature,
        load_newton: load,
        time_s,
        lines: rows.lines,
        warnings,
    })
}

#[cfg(test)]
#[path = "measured_csv_tests.rs"]
mod tests;
