//! Tables of generic loops and curves: any columns, each with its unit in the header.

use super::measured_csv::{is_unit_cell, strip_brackets};
use super::table_text::{
    LEAST_ROWS, Line, ROUNDING_JITTER, Rows, Sampling, check_time, increases_evenly,
    other_separator, resample, resampled, split_lines,
};
use super::units::{Channel, Unit};
use crate::files::Source;
use crate::problem::{Fault, Place, Problem, Problems, RecordFault};
use serde::{Deserialize, Serialize};

/// A record of a generic system, uniformly sampled, every number finite.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopTable {
    /// Time, s, increasing in equal steps.
    pub time_s: Vec<f64>,
    /// Sampling step, s.
    pub time_step_s: f64,
    /// Input, in the unit of its channel.
    pub input: Vec<f64>,
    /// Output, in the unit of its channel.
    pub output: Vec<f64>,
    /// Line of every row in its file, from 1.
    pub lines: Vec<usize>,
    /// What was done to it that a reader should know.
    pub warnings: Vec<Problem>,
}

/// Input and output of a data set.
#[derive(Debug, Clone, PartialEq)]
pub struct Channels {
    /// The input.
    pub input: Channel,
    /// The output.
    pub output: Channel,
}

impl Channels {
    /// Input and output, in this order.
    pub fn both(&self) -> [&Channel; 2] {
        [&self.input, &self.output]
    }
}

/// A column of the records, named in `dataset.ron`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelFile {
    /// The column as the header names it, with or without its unit.
    pub column: String,
    /// Its unit, where the header gives none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
}

/// What `dataset.ron` says about the columns.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Declared<'a> {
    pub(crate) input: Option<&'a ChannelFile>,
    pub(crate) output: Option<&'a ChannelFile>,
}

/// A cell of the header.
struct Cell<'a> {
    text: &'a str,
    /// The text with the unit of the second row.
    full: String,
    line: usize,
    at: usize,
}

struct Header<'a> {
    cells: Vec<Cell<'a>>,
    first_row: usize,
}

fn header<'a>(lines: &[Line<'a>]) -> Header<'a> {
    let Some(line) = lines.first() else {
        return Header { cells: vec![], first_row: 0 };
    };
    let units = lines.get(1).map(|l| l.fields()).filter(|f| f.iter().all(|(t, _)| is_unit_cell(t)));
    let cells = line.fields().into_iter().enumerate().map(|(i, (text, at))| {
        let unit = units.as_ref().and_then(|u| u.get(i)).map(|(t, _)| strip_brackets(t));
        let full = unit.map_or_else(|| text.to_owned(), |unit| format!("{text} ({unit})"));
        Cell { text, full, line: line.number, at }
    });
    Header { cells: cells.collect(), first_row: if units.is_some() { 2 } else { 1 } }
}

impl Header<'_> {
    fn names(&self) -> String {
        self.cells.iter().map(|c| c.text).collect::<Vec<_>>().join(", ")
    }

    /// The first column of the table: the time in s, or the curve number.
    fn leading(&self, file: &str, wanted: &'static str, problems: &mut Problems) -> Option<usize> {
        let expected = Channel::parse(wanted);
        for (i, cell) in self.cells.iter().enumerate() {
            let place = || Place::at(file, cell.line, cell.at).field(cell.text);
            match (&expected, Channel::parse(&cell.full)) {
                (None, _) if cell.text == wanted => return Some(i),
                (Some(time), Some(channel)) if channel.name == time.name => {
                    if channel.unit != time.unit {
                        let factor = channel.unit.factor_to(time.unit);
                        let (found, expected) = (channel.unit.symbol.to_owned(), time.unit.symbol);
                        let fault = Fault::WrongUnit { column: wanted, found, expected, factor };
                        problems.push(place(), fault);
                    }
                    return Some(i);
                }
                (Some(time), None) if Channel::plain_name(cell.text) == time.name => {
                    let fault = Fault::MissingUnit { found: cell.text.into(), expected: wanted };
                    problems.push(place(), fault);
                    return Some(i);
                }
                _ => {}
            }
        }
        let place = Place::at(file, self.cells.first().map_or(1, |c| c.line), 1);
        problems.push(place, Fault::MissingColumn { column: wanted, found: self.names() });
        None
    }

    /// Input and output: as declared, else the two columns there are.
    fn channels(
        &self,
        file: &str,
        leading: usize,
        declared: Declared<'_>,
        problems: &mut Problems,
    ) -> Option<[(usize, Channel); 2]> {
        let others: Vec<usize> = (0..self.cells.len()).filter(|i| *i != leading).collect();
        if others.len() != 2 && (declared.input.is_none() || declared.output.is_none()) {
            let columns = others.iter().map(|i| self.cells[*i].text).collect::<Vec<_>>();
            let place = Place::at(file, self.cells.first().map_or(1, |c| c.line), 1);
            if columns.len() < 2 {
                let column = "NAME_UNIT of the output";
                problems.push(place, Fault::MissingColumn { column, found: self.names() });
            } else {
                let columns = columns.join(", ");
                let remedy = "input: (column: \"NAME\"), output: (column: \"NAME\") in dataset.ron";
                problems.push(place, RecordFault::AmbiguousColumns { columns, remedy }.into());
            }
            return None;
        }
        let mut find = |given: Option<&ChannelFile>, default: usize| {
            let Some(given) = given else {
                return self.channel(file, default, None, problems).map(|c| (default, c));
            };
            let wanted = Channel::plain_name(&given.column);
            let matches = |cell: &Cell<'_>| {
                cell.text == given.column
                    || Channel::plain_name(cell.text) == wanted
                    || Channel::parse(&cell.full).is_some_and(|c| c.name == wanted)
            };
            let Some(at) = self.cells.iter().position(matches) else {
                let (wanted, found) = (given.column.clone(), self.names());
                let remedy = "correct input or output in dataset.ron";
                let fault = RecordFault::NoSuchColumn { wanted, found, remedy };
                problems.push(Place::at(file, self.cells[leading].line, 1), fault.into());
                return None;
            };
            self.channel(file, at, given.unit.as_deref(), problems).map(|c| (at, c))
        };
        // with one of two columns declared, the other one is the other
        let rest = |taken: Option<usize>, default: usize| {
            others
                .iter()
                .copied()
                .find(|i| Some(*i) != taken)
                .filter(|_| taken.is_some())
                .or_else(|| others.get(default).copied())
        };
        let (input, output) = if declared.output.is_some() && declared.input.is_none() {
            let output = find(declared.output, 0);
            (find(None, rest(output.as_ref().map(|o| o.0), 0)?), output)
        } else {
            let input = find(declared.input, *others.first()?);
            let default = rest(input.as_ref().map(|o| o.0), 1)?;
            (input, find(declared.output, default))
        };
        Some([input?, output?])
    }

    fn channel(
        &self,
        file: &str,
        at: usize,
        unit: Option<&str>,
        problems: &mut Problems,
    ) -> Option<Channel> {
        let cell = &self.cells[at];
        let channel = Channel::parse(&cell.full).or_else(|| {
            Some(Channel { name: Channel::plain_name(cell.text), unit: Unit::find(unit?)? })
        });
        if channel.is_none() {
            let fault =
                RecordFault::UnknownUnit { found: cell.text.to_owned(), known: Unit::known() };
            problems.push(Place::at(file, cell.line, cell.at), fault.into());
        }
        channel
    }
}

/// Reads a table of a generic loop: `time_s` and the declared or the only two other columns.
///
/// # Errors
/// Every problem found, with line and column.
pub(crate) fn parse_loop_csv(
    source: &Source,
    declared: Declared<'_>,
) -> Result<(LoopTable, Channels), Problems> {
    let mut problems = Problems::default();
    let Some((mut columns, lines, channels)) = read(source, "time_s", declared, &mut problems)
    else {
        return problems.into_result(None);
    };
    let [time_s, input, output] = &mut columns;
    let sampling = check_time(&source.name, "time_s", time_s, &lines, &mut problems);
    if !problems.is_empty() {
        for (channel, values) in [(&channels.input, &*input), (&channels.output, &*output)] {
            if increases_evenly(values) {
                let fault = RecordFault::TimeSwapped { other: channel.label() };
                problems.push(Place::at(&source.name, lines[0], 1).field("time_s"), fault.into());
            }
        }
    }
    let warnings = even(source, sampling, time_s, &mut [input, output]);
    let [time_s, input, output] = columns;
    let time_step_s = sampling.step_s;
    let table = LoopTable { time_s, time_step_s, input, output, lines, warnings };
    problems.into_result(Some((table, channels)))
}

fn even(
    source: &Source,
    sampling: Sampling,
    time_s: &mut Vec<f64>,
    columns: &mut [&mut Vec<f64>],
) -> Vec<Problem> {
    if sampling.jitter <= ROUNDING_JITTER {
        return vec![];
    }
    resample(time_s, columns);
    vec![resampled(&source.name, "time_s", sampling)]
}

/// Curve numbers, inputs and outputs of a table of curves.
pub(crate) struct CurveRows {
    pub(crate) curve: Vec<f64>,
    pub(crate) input: Vec<f64>,
    pub(crate) output: Vec<f64>,
    pub(crate) lines: Vec<usize>,
    pub(crate) channels: Channels,
}

/// Reads a table of curves: `curve` and the declared or the only two other columns.
pub(crate) fn parse_curve_csv(
    source: &Source,
    declared: Declared<'_>,
) -> Result<CurveRows, Problems> {
    let mut problems = Problems::default();
    let read = read(source, "curve", declared, &mut problems);
    problems.into_result(read.map(|([curve, input, output], lines, channels)| CurveRows {
        curve,
        input,
        output,
        lines,
        channels,
    }))
}

fn read(
    source: &Source,
    leading: &'static str,
    declared: Declared<'_>,
    problems: &mut Problems,
) -> Option<([Vec<f64>; 3], Vec<usize>, Channels)> {
    let lines = split_lines(&source.text);
    let header = header(&lines);
    let file = &source.name;
    if header.cells.is_empty() {
        let fault = Fault::TooFewRows { rows: 0, least: LEAST_ROWS };
        problems.push(Place::file(file), fault);
        return None;
    }
    if let Some(fault) = lines.first().and_then(|line| other_separator(line.text)) {
        problems.push(Place::at(file, lines[0].number, 1), fault.into());
        return None;
    }
    let first = header.leading(file, leading, problems)?;
    let [(input_at, input), (output_at, output)] =
        header.channels(file, first, declared, problems)?;
    let labels: Vec<&str> = header.cells.iter().map(|c| c.text).collect();
    let mut rows = Rows::read(source, &lines[header.first_row..], &labels, problems);
    if rows.lines.len() < LEAST_ROWS {
        let fault = Fault::TooFewRows { rows: rows.lines.len(), least: LEAST_ROWS };
        problems.push(Place::file(file), fault);
    }
    if !problems.is_empty() {
        return None;
    }
    let columns = [first, input_at, output_at].map(|i| std::mem::take(&mut rows.values[i]));
    Some((columns, rows.lines, Channels { input, output }))
}
