//! Measured tables: CSV with a header that carries units.

use super::Source;
use crate::problem::{Fault, Place, Problems, nearest};

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
}

/// Problems of one kind listed one by one before the rest is only counted.
const LISTED: usize = 5;
/// Rows below which nothing can be said about sampling.
const LEAST_ROWS: usize = 3;
/// Deviation of a time step from the median step that is still uniform, as a fraction of it.
const STEP_TOLERANCE: f64 = 0.02;

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
    let table = Rows::read(source, &lines[first_row..], &columns, &mut problems);
    let table = table.finish(source, &columns, &mut problems);
    problems.into_result(table)
}

/// A line of the file that holds data.
#[derive(Debug, Clone, Copy)]
struct Line<'a> {
    number: usize,
    text: &'a str,
    /// Whether a line end follows.
    ended: bool,
}

impl<'a> Line<'a> {
    /// Fields with the column of their first character, from 1.
    fn fields(self) -> Vec<(&'a str, usize)> {
        let mut column = 1;
        self.text
            .split(',')
            .map(|raw| {
                let blanks = raw.chars().take_while(|c| c.is_whitespace()).count();
                let at = column + blanks;
                column += raw.chars().count() + 1;
                (raw.trim().trim_matches('"').trim(), at)
            })
            .collect()
    }
}

fn split_lines(text: &str) -> Vec<Line<'_>> {
    text.split_inclusive('\n')
        .enumerate()
        .map(|(i, line)| Line {
            number: i + 1,
            ended: line.ends_with('\n'),
            text: line.trim_end_matches(['\n', '\r']),
        })
        .filter(|line| !line.text.trim().is_empty() && !line.text.starts_with('#'))
        .collect()
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

fn is_unit_cell(text: &str) -> bool {
    (text.starts_with('(') && text.ends_with(')')) || (text.starts_with('[') && text.ends_with(']'))
}

fn strip_brackets(text: &str) -> &str {
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

/// The numbers of a table while it is read.
struct Rows {
    values: Vec<Vec<f64>>,
    lines: Vec<usize>,
}

impl Rows {
    fn read(
        source: &Source,
        lines: &[Line<'_>],
        columns: &[usize],
        problems: &mut Problems,
    ) -> Self {
        let mut rows = Self { values: vec![Vec::new(); columns.len()], lines: Vec::new() };
        let mut lists = [Listing::default(), Listing::default(), Listing::default()];
        let [field_counts, words, infinities] = &mut lists;
        let last = lines.len().saturating_sub(1);
        for (i, line) in lines.iter().enumerate() {
            let fields = line.fields();
            let before = i.checked_sub(1).map(|b| lines[b].fields());
            if i == last && is_cut_off(line, &fields, before.as_deref(), columns.len()) {
                let fault =
                    Fault::Truncated { text: line.text.to_owned(), expected: columns.len() };
                problems.push(Place::at(&source.name, line.number, 1), fault);
                break;
            }
            if fields.len() != columns.len() {
                let fault = Fault::FieldCount { found: fields.len(), expected: columns.len() };
                field_counts.push(problems, Place::at(&source.name, line.number, 1), fault);
                continue;
            }
            rows.lines.push(line.number);
            for ((text, at), (values, &quantity)) in
                fields.iter().zip(rows.values.iter_mut().zip(columns))
            {
                let place =
                    || Place::at(&source.name, line.number, *at).field(QUANTITIES[quantity].column);
                let value = text.parse::<f64>();
                match value {
                    Ok(value) if value.is_finite() => {}
                    Ok(value) => infinities.push(problems, place(), Fault::NotFinite { value }),
                    Err(_) => {
                        let fault = Fault::NotANumber { text: (*text).to_owned() };
                        words.push(problems, place(), fault);
                    }
                }
                values.push(value.unwrap_or(f64::NAN));
            }
        }
        for list in lists {
            list.finish(problems);
        }
        rows
    }

    /// Checks the time column and hands out the columns by name.
    fn finish(
        mut self,
        source: &Source,
        columns: &[usize],
        problems: &mut Problems,
    ) -> Option<MeasuredTable> {
        let rows = self.lines.len();
        if rows < LEAST_ROWS {
            let fault = Fault::TooFewRows { rows, least: LEAST_ROWS };
            problems.push(Place::file(&source.name), fault);
            return None;
        }
        let mut take = |quantity: usize| {
            let column = columns.iter().position(|c| *c == quantity)?;
            Some(std::mem::take(&mut self.values[column]))
        };
        let time_s = take(TIME)?;
        let time_step_s = check_time(source, &time_s, &self.lines, problems);
        Some(MeasuredTable {
            time_step_s,
            command_volt: take(COMMAND)?,
            displacement_um: take(DISPLACEMENT)?,
            amplifier_volt: take(3),
            temperature_celsius: take(4),
            load_newton: take(5),
            time_s,
            lines: self.lines,
        })
    }
}

/// Whether the last line of a file stops early: too few fields, or no line end behind a last number
/// that has fewer decimals than all the table's lines before promise.
fn is_cut_off(
    line: &Line<'_>,
    fields: &[(&str, usize)],
    before: Option<&[(&str, usize)]>,
    expected: usize,
) -> bool {
    if line.ended {
        return false;
    }
    let decimals =
        |f: &[(&str, usize)]| f.last().and_then(|(t, _)| t.split_once('.')).map(|(_, d)| d.len());
    let shorter = match before.and_then(decimals) {
        Some(usual) => decimals(fields).is_none_or(|d| d < usual),
        None => false,
    };
    fields.len() < expected || fields.last().is_some_and(|(t, _)| t.is_empty()) || shorter
}

/// Median time step; problems for steps that go back or differ from it.
fn check_time(source: &Source, time_s: &[f64], lines: &[usize], problems: &mut Problems) -> f64 {
    let steps: Vec<f64> = time_s.windows(2).map(|w| w[1] - w[0]).collect();
    let mut sorted: Vec<f64> = steps.iter().copied().filter(|s| *s > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN);
    let (mut back, mut uneven) = (Listing::default(), Listing::default());
    for (i, &step) in steps.iter().enumerate() {
        let place = || Place::at(&source.name, lines[i + 1], 1).field(QUANTITIES[TIME].column);
        if step <= 0.0 {
            let fault = Fault::TimeNotIncreasing { time_s: time_s[i + 1], before_s: time_s[i] };
            back.push(problems, place(), fault);
        } else if i > 0 && steps[i - 1] <= 0.0 {
            // the step out of a time that ran back is long for that reason alone
        } else if (step - usual).abs() > STEP_TOLERANCE * usual {
            let fault = Fault::TimeStepUneven { step_s: step, usual_s: usual };
            uneven.push(problems, place(), fault);
        }
    }
    back.finish(problems);
    uneven.finish(problems);
    let span = time_s.last().zip(time_s.first()).map(|(b, a)| b - a);
    span.map_or(f64::NAN, |s| s / steps.len() as f64)
}

/// Lists the first few problems of one kind and counts the rest.
#[derive(Debug, Default)]
pub(crate) struct Listing {
    count: usize,
    next: Option<Place>,
}

impl Listing {
    pub(crate) fn push(&mut self, problems: &mut Problems, place: Place, fault: Fault) {
        self.count += 1;
        if self.count <= LISTED {
            problems.push(place, fault);
        } else if self.next.is_none() {
            self.next = Some(place);
        }
    }

    pub(crate) fn finish(self, problems: &mut Problems) {
        if let Some(place) = self.next {
            problems.push(place, Fault::More { count: self.count - LISTED });
        }
    }
}

#[cfg(test)]
#[path = "measured_csv_tests.rs"]
mod tests;
