//! Tables of generic loops and curves: any columns, each with its unit in the header.

use super::measured_csv::{MeasuredTable, check_unit_of, missing_column};
use super::text::{TextTable, columns};
use super::units::{Channel, Unit, unknown_unit};
use crate::files::Source;
use crate::problem::{Fault, Problems};
use serde::{Deserialize, Serialize};

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

/// What `dataset.ron` says about the columns of input and output.
pub(crate) type Declared = [Option<ChannelFile>; 2];

/// Input and output among the columns besides the time: those asked for; with one of two asked for,
/// the other one is the other; else the two there are.
pub(crate) fn input_and_output(others: &[usize], asked: [Option<usize>; 2]) -> Option<[usize; 2]> {
    let two = <[usize; 2]>::try_from(others).ok();
    let other = |taken: usize| two.map(|[a, b]| if a == taken { b } else { a });
    match asked {
        [Some(input), Some(output)] => Some([input, output]),
        [Some(input), None] => Some([input, other(input)?]),
        [None, Some(output)] => Some([other(output)?, output]),
        [None, None] => two,
    }
}

/// The first column of the table: the time in s, or the curve number.
fn leading(
    table: &TextTable<&[u8]>,
    wanted: &'static str,
    problems: &mut Problems,
) -> Option<usize> {
    let expected = Channel::parse(wanted);
    let leads = |text: &str, channel: Option<Channel>| match &expected {
        Some(time) => channel.map_or_else(|| Channel::plain_name(text), |c| c.name) == time.name,
        None => text == wanted,
    };
    let at = table.header.iter().position(|cell| leads(&cell.text, Channel::parse(&cell.full)));
    let Some(at) = at else {
        problems.push(table.header_place(), missing_column(wanted.to_owned(), table.names()));
        return None;
    };
    let cell = &table.header[at];
    let unit = Channel::parse(&cell.full).map(|channel| channel.unit.symbol);
    if let Some(time) = expected {
        problems.note(check_unit_of(cell, unit, wanted, time.unit.symbol));
    }
    Some(at)
}

/// Input and output: as declared, else the two columns there are.
fn channels(
    table: &TextTable<&[u8]>,
    leading: usize,
    declared: &Declared,
    problems: &mut Problems,
) -> Option<[(usize, Channel); 2]> {
    let header = &table.header;
    let mut asked = [None; 2];
    for (asked, given) in asked.iter_mut().zip(declared) {
        let Some(given) = given else { continue };
        let wanted = Channel::plain_name(&given.column);
        *asked = header.iter().position(|cell| {
            cell.text == given.column
                || Channel::plain_name(&cell.text) == wanted
                || Channel::parse(&cell.full).is_some_and(|c| c.name == wanted)
        });
        if asked.is_none() {
            let (wanted, found) = (given.column.clone(), table.names());
            let remedy = "correct input or output in dataset.ron";
            problems.push(table.header_place(), Fault::MissingColumn { wanted, found, remedy });
        }
    }
    if declared.iter().flatten().count() > asked.iter().flatten().count() {
        return None;
    }
    let others: Vec<usize> = (0..header.len()).filter(|i| *i != leading).collect();
    let Some(found) = input_and_output(&others, asked) else {
        let fault = if others.len() < 2 {
            missing_column("NAME_UNIT of the output".to_owned(), table.names())
        } else {
            let columns: Vec<&str> = others.iter().map(|i| header[*i].text.as_str()).collect();
            let remedy = "input: (column: \"NAME\"), output: (column: \"NAME\") in dataset.ron";
            Fault::AmbiguousColumns { columns: columns.join(", "), remedy }
        };
        problems.push(table.header_place(), fault);
        return None;
    };
    let mut channel = |at: usize, given: &Option<ChannelFile>| {
        let cell = &header[at];
        let given = given.as_ref().and_then(|given| Unit::find(given.unit.as_deref()?));
        let channel = Channel::parse(&cell.full)
            .or_else(|| Some(Channel { name: Channel::plain_name(&cell.text), unit: given? }));
        if channel.is_none() {
            problems.push(cell.place.clone(), unknown_unit(&cell.text));
        }
        channel.map(|channel| (at, channel))
    };
    let [input, output] = [channel(found[0], &declared[0]), channel(found[1], &declared[1])];
    Some([input?, output?])
}

/// Reads a table of a generic loop: `time_s` and the declared or the only two other columns.
///
/// # Errors
/// Every problem found, with line and column.
pub(crate) fn parse_loop_csv(
    source: &Source,
    declared: &Declared,
) -> Result<(MeasuredTable, Channels), Problems> {
    let mut problems = Problems::default();
    let rows = parse_rows(source, "time_s", declared)?;
    let [input, output] = rows.channels.both().map(Channel::label);
    let labels = ["time_s", input.as_str(), output.as_str()];
    let columns = [Some(rows.leading), Some(rows.input), Some(rows.output), None, None, None];
    let table = MeasuredTable::new(&source.name, labels, columns, rows.lines, &mut problems);
    problems.into_result(Some((table, rows.channels)))
}

/// The columns of a table of any input and output.
pub(crate) struct Rows {
    /// Time, s, or curve number.
    pub(crate) leading: Vec<f64>,
    pub(crate) input: Vec<f64>,
    pub(crate) output: Vec<f64>,
    pub(crate) lines: Vec<usize>,
    pub(crate) channels: Channels,
}

/// Reads a table of `first`, `time_s` or `curve`, and the declared or the only two other columns.
///
/// # Errors
/// Every problem found, with line and column.
pub(crate) fn parse_rows(
    source: &Source,
    first: &'static str,
    declared: &Declared,
) -> Result<Rows, Problems> {
    let table = TextTable::of_folder(source)?;
    let mut problems = Problems::default();
    let found = leading(&table, first, &mut problems)
        .and_then(|at| Some((at, channels(&table, at, declared, &mut problems)?)));
    let Some((first, [(input_at, input), (output_at, output)])) = found else {
        return problems.into_result(None);
    };
    let all: Vec<_> = table.header.iter().map(|cell| cell.text.clone()).enumerate().collect();
    let (values, lines) = columns(table, &all, &mut problems);
    let [leading, input_values, output_values] =
        [first, input_at, output_at].map(|column| values[column].clone());
    problems.into_result(Some(Rows {
        leading,
        input: input_values,
        output: output_values,
        lines,
        channels: Channels { input, output },
    }))
}
