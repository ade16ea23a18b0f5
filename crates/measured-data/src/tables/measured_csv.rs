//! Records of an actuator bench: CSV whose columns are known by name, each with its unit.

use super::sampling::{ROUNDING_JITTER, check_time, note_swapped, resample, resampled};
use super::text::{HeaderCell, TextTable, columns};
use super::units::{Unit, strip_brackets};
use crate::files::Source;
use crate::problem::{Fault, Place, Problem, Problems, nearest};

/// A quantity a bench may record: its name, the unit it is in, and whether it has to be there.
pub(crate) type Quantity = (&'static str, &'static str, bool);

/// Every quantity of a bench: time, input and output first.
pub(crate) const QUANTITIES: [Quantity; 6] = [
    ("time", "s", true),
    ("command", "V", true),
    ("displacement", "um", true),
    ("amplifier", "V", false),
    ("temperature", "C", false),
    ("load", "N", false),
];

/// Name and unit of a quantity, the form the program writes.
fn label((name, unit, _): Quantity) -> String {
    format!("{name}_{unit}")
}

/// A measured record, uniformly sampled, every number finite.
///
/// All columns have the same length.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasuredTable {
    /// Time, s, increasing in equal steps.
    pub time_s: Vec<f64>,
    /// Sampling step, s.
    pub time_step_s: f64,
    /// Input, in the unit of its channel: of a bench the command, V.
    pub input: Vec<f64>,
    /// Output, in the unit of its channel: of a bench the displacement, um.
    pub output: Vec<f64>,
    /// Amplifier output of a bench, V, if measured.
    pub amplifier_volt: Option<Vec<f64>>,
    /// Temperature of a bench, degrees Celsius, if measured.
    pub temperature_celsius: Option<Vec<f64>>,
    /// Load on the actuator of a bench, N, if measured.
    pub load_newton: Option<Vec<f64>>,
    /// Line of every row in its file, from 1.
    pub lines: Vec<usize>,
    /// What was done to it that a reader should know: times brought onto even steps.
    pub warnings: Vec<Problem>,
}

impl MeasuredTable {
    /// A table of time, input, output and what a bench has besides; `labels` name the first three.
    /// Times that are nearly even are brought onto even steps.
    pub(super) fn new(
        file: &str,
        labels: [&str; 3],
        columns: [Option<Vec<f64>>; 6],
        lines: Vec<usize>,
        problems: &mut Problems,
    ) -> Self {
        let [time, input, output, mut amplifier, mut temperature, mut load] = columns;
        let [mut time_s, mut input, mut output] =
            [time, input, output].map(Option::unwrap_or_default);
        let sampling = check_time(file, labels[0], &time_s, &lines, problems);
        let mut warnings = Vec::new();
        if !problems.is_empty() {
            let place = Place::at(file, lines[0], 1).field(labels[0]);
            note_swapped(&place, [(labels[1], &input), (labels[2], &output)], problems);
        } else if sampling.jitter > ROUNDING_JITTER {
            let mut all = vec![&mut input, &mut output];
            all.extend([&mut amplifier, &mut temperature, &mut load].into_iter().flatten());
            resample(&mut time_s, &mut all);
            warnings.push(resampled(file, labels[0], sampling));
        }
        Self {
            time_step_s: sampling.step_s,
            time_s,
            input,
            output,
            amplifier_volt: amplifier,
            temperature_celsius: temperature,
            load_newton: load,
            lines,
            warnings,
        }
    }
}

/// Reads a record of an actuator bench.
///
/// The header names every column with its unit: `time_s`, `time [s]`, or `time` with a second row
/// `(s)`. Required: `time_s`, `command_V`, `displacement_um`; known besides: `amplifier_V`,
/// `temperature_C`, `load_N`. Lines that begin with `#` are comments.
///
/// # Errors
/// Every problem found, with line and column; of many alike, the first five and their number.
pub fn parse_measured_csv(source: &Source) -> Result<MeasuredTable, Problems> {
    let table = TextTable::of_folder(source)?;
    let mut problems = Problems::default();
    let mut found: Vec<usize> = Vec::new();
    for cell in &table.header {
        if let Some(quantity) = known_quantity(cell, &found, &mut problems) {
            found.push(quantity);
        }
    }
    for (index, quantity) in QUANTITIES.into_iter().enumerate() {
        if quantity.2 && !found.contains(&index) {
            let fault = missing_column(label(quantity), table.names());
            problems.push(table.header_place(), fault);
        }
    }
    if !problems.is_empty() {
        return problems.into_result(None);
    }
    let labels = QUANTITIES.map(label);
    let wanted: Vec<_> =
        found.iter().map(|quantity| labels[*quantity].clone()).enumerate().collect();
    let (mut values, lines) = columns(table, &wanted, &mut problems);
    // rows that are no numbers tear holes into the time: nothing can be said about its steps
    if !problems.is_empty() {
        return problems.into_result(None);
    }
    let columns = std::array::from_fn(|quantity| {
        let column = found.iter().position(|q| *q == quantity)?;
        Some(std::mem::take(&mut values[column]))
    });
    let labels = [labels[0].as_str(), &labels[1], &labels[2]];
    let table = MeasuredTable::new(&source.name, labels, columns, lines, &mut problems);
    problems.into_result(Some(table))
}

/// The fault of a header that lacks a column.
pub(super) fn missing_column(wanted: String, found: String) -> Fault {
    Fault::MissingColumn { wanted, found, remedy: "add the column, or correct its name" }
}

/// The quantity of a header cell, with what is wrong with its unit; none if it names none.
fn known_quantity(cell: &HeaderCell, before: &[usize], problems: &mut Problems) -> Option<usize> {
    let (found, place) = (cell.text.clone(), cell.place.clone());
    let Some((index, unit)) = split_name(&cell.full) else {
        let labels = QUANTITIES.map(label);
        let words = labels.iter().map(String::as_str).chain(QUANTITIES.map(|q| q.0));
        let nearest = nearest(&found, words);
        let fault = Fault::Unknown { what: "column", found, known: labels.join(", "), nearest };
        problems.push(place, fault);
        return None;
    };
    let expected = label(QUANTITIES[index]);
    let has_unit = problems.note(check_unit_of(cell, unit, &expected, QUANTITIES[index].1));
    if has_unit.is_some() && before.contains(&index) {
        let message = format!("the column `{expected}` is there twice; remove one of them");
        problems.push(place, Fault::Other(message));
    }
    Some(index)
}

/// Checks the unit of a column that is to be `label`, in `expected`.
pub(super) fn check_unit_of(
    cell: &HeaderCell,
    found: Option<&str>,
    label: &str,
    expected: &str,
) -> Result<(), Problem> {
    let Some(unit) = found else {
        let message = format!(
            "the column `{}` has no unit; name it `{label}` (or `name [unit]`, or give a second row of units in brackets)",
            cell.text
        );
        return Err(Problem::new(cell.place.clone(), Fault::Other(message)));
    };
    let (from, to) = (Unit::find(unit), Unit::find(expected));
    if from == to {
        return Ok(());
    }
    let remedy = match from.zip(to).and_then(|(from, to)| from.factor_to(to)) {
        Some(factor) => format!("multiply the column by {factor} and name it `{label}`"),
        None => format!("give the column as `{label}`"),
    };
    let message = format!("the unit is {unit}, expected {expected}; {remedy}");
    Err(Problem::new(cell.place.clone().field(&cell.text), Fault::Other(message)))
}

/// The quantity and unit of a header cell; none if it names no known quantity.
fn split_name(cell: &str) -> Option<(usize, Option<&str>)> {
    let find = |name: &str| QUANTITIES.iter().position(|q| q.0.eq_ignore_ascii_case(name.trim()));
    match (cell.find(['[', '(']), find(cell)) {
        (Some(open), _) => Some((find(&cell[..open])?, Some(strip_brackets(&cell[open..])))),
        (None, Some(quantity)) => Some((quantity, None)),
        (None, None) => {
            let (name, unit) = cell.split_once('_')?;
            Some((find(name)?, Some(unit)))
        }
    }
}

#[cfg(test)]
#[path = "measured_csv_tests.rs"]
mod tests;
