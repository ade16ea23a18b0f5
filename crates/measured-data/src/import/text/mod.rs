//! Text tables of any instrument, read row by row.

mod decode;
mod layout;
mod numbers;
mod preamble;
mod row;

use super::columns::{ColumnOptions, choose, name_columns};
use super::gather::Reduction;
use super::{Reading, Table};
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::{Dimension, HeaderCell, TextTable};
pub(super) use decode::{foreign, from_utf16, is_text, utf16};
use layout::Layout;
use numbers::{number, stamp};
use std::io::{BufRead, Cursor, Read};

/// Lines of a table by which its layout is found.
const HEAD_LINES: usize = 600;
/// Most bytes of them.
const HEAD: usize = 1 << 19;
/// A time beyond this is the date of a clock, s: the record then begins at 0.
const CLOCK_S: f64 = 1e7;

/// A day, s.
const DAY_S: f64 = 86_400.0;
/// A number beyond this is an instrument's word for overflow.
const LARGEST: f64 = 1e12;
/// Most lines of text behind the last sample.
const MOST_BEHIND: usize = 20;

/// A table whose layout is known.
pub(super) struct Opened<'a> {
    layout: Layout,
    /// Its rows of numbers.
    rows: Box<dyn BufRead + 'a>,
}

impl<'a> Opened<'a> {
    /// Finds the layout of a table.
    pub(super) fn open(reader: impl BufRead + 'a, file: &str) -> Result<Self, Problem> {
        let refused = |fault| Problem::new(Place::file(file), fault);
        let mut lines = decode::Lines::new(reader).map_err(|e| refused(e.into()))?;
        let mut head = String::new();
        let mut count = 0;
        while count < HEAD_LINES && head.len() < HEAD {
            let read = lines.read_line(&mut head).map_err(|e| refused(e.into()))?;
            if read == 0 {
                break;
            }
            count += 1;
        }
        let split: Vec<&str> = head.split_inclusive('\n').collect();
        let found = Layout::find(&split).map_err(refused)?;
        let layout = found.ok_or_else(|| refused(no_numbers(&split)))?;
        let begin = split[..layout.before].iter().map(|line| line.len()).sum::<usize>();
        let rest = head.split_off(begin);
        Ok(Self { layout, rows: Box::new(Cursor::new(rest).chain(lines)) })
    }

    /// How it is laid out, in words.
    pub(super) fn words(&self) -> String {
        let Layout { separator, decimal, step_s, .. } = &self.layout;
        let separator = match separator {
            ';' => "semicolons",
            '\t' => "tabs",
            ' ' => "blanks",
            '|' => "bars",
            _ => "commas",
        };
        let decimal = if *decimal == ',' { ", decimal commas" } else { "" };
        let step = step_s.map(|step_s| format!(", a stated step of {step_s} s"));
        format!("{separator}{decimal}{}", step.unwrap_or_default())
    }

    /// Whether it holds a time and one channel, which another table may complete.
    pub(super) fn is_single(&self) -> bool {
        self.layout.is_single()
    }

    /// The rows of two tables side by side, of the same times; they are read whole.
    ///
    /// # Errors
    /// Tables of other separators, other numbers of rows or other times.
    pub(super) fn beside(self, other: Self, file: &str) -> Result<Opened<'static>, Problem> {
        let refused = |fault| Problem::new(Place::file(file), fault);
        let message = |words: &str| {
            let text = format!(
                "two files of one channel each are taken as one record, but {words}; export both channels of one recording, or into one file"
            );
            refused(Fault::Other(text))
        };
        let reading = |layout: &Layout| (layout.separator, layout.decimal);
        if reading(&self.layout) != reading(&other.layout) {
            return Err(message("their separators or decimals differ"));
        }
        let separator = self.layout.separator;
        let time = [&self.layout, &other.layout].map(|layout| layout.numeric[0]);
        let mut texts = [String::new(), String::new()];
        for (text, mut rows) in texts.iter_mut().zip([self.rows, other.rows]) {
            rows.read_to_string(text).map_err(|e| refused(e.into()))?;
        }
        let [a, b] = texts.each_ref().map(|text| {
            let is_row = |line: &&str| !line.trim().is_empty() && !line.starts_with('#');
            text.lines().filter(is_row).map(str::trim_end).collect::<Vec<_>>()
        });
        if a.len() != b.len() {
            return Err(message(&format!("they have {} and {} rows", a.len(), b.len())));
        }
        let time_of = |line: &str, of: usize| row::cells(line, separator).get(time[of]).cloned();
        let differs = |(a, b): (&&str, &&str)| time_of(a, 0) != time_of(b, 1);
        if let Some(row) = a.iter().zip(&b).position(differs) {
            return Err(message(&format!("their times differ in row {}", row + 1)));
        }
        let at = a.first().map_or(0, |line| row::cells(line, separator).len());
        let mut both = String::new();
        for (a, b) in a.iter().zip(&b) {
            both.extend([*a, &*separator.to_string(), *b, "\n"]);
        }
        let layout = self.layout.beside(other.layout, at);
        Ok(Opened { layout, rows: Box::new(Cursor::new(both)) })
    }
}

/// The fault of a table in whose first lines no row holds two numbers.
fn no_numbers(lines: &[&str]) -> Fault {
    let mut filled = lines.iter().filter(|line| !line.trim().is_empty());
    let last: String = filled.next_back().map_or("", |line| line.trim()).chars().take(60).collect();
    Fault::Other(format!(
        "has 0 rows of numbers, expected at least 3 with two numbers in each (the last line read: `{last}`); write numbers alone into the cells, with the units in the header"
    ))
}

/// Reads a text table.
///
/// The header is optional: without one, `--columns` names the columns.
pub(super) fn read_csv(
    opened: Opened<'_>,
    file: &str,
    options: &ColumnOptions,
    into: Reading,
    reduction: Reduction,
) -> Result<Table, Problems> {
    let Opened { layout, rows } = opened;
    let place = Place::at(file, layout.header_line, 1);
    let own = layout.names.as_deref();
    let stated_hz = layout.step_s.map(|step_s| 1.0 / step_s);
    let named = name_columns(options, own, layout.width);
    let named = named.map_err(|fault| Problem::new(place.clone(), fault))?;
    let has_time = named.0.iter().any(|(_, channel)| channel.unit.dimension == Dimension::Time);
    let stated_hz = stated_hz.filter(|_| !has_time);
    let reduction = Reduction { sampling_hz: reduction.sampling_hz.or(stated_hz), ..reduction };
    let choice = choose(named, options, into, reduction.sampling_hz)
        .map_err(|fault| Problem::new(place.clone(), fault))?;
    let cell = |i: usize| HeaderCell::new(own.map_or("", |own| &own[i]), place.clone());
    let header = (0..layout.width).map(cell).collect();
    let mut table = TextTable::behind(file, rows, (layout.separator, layout.before), header);
    let is_untimed = choice.time.is_none();
    if is_untimed {
        table = table.with_blank_rows();
    }
    let counter = layout.counter(&choice, options).filter(|_| is_untimed);
    let mut problems = Problems::default();
    let mut gather = choice.gather(file, reduction);
    let mut wanted: Vec<_> = choice.taken().map(|t| (t.source, t.channel.label())).collect();
    wanted.extend(counter.map(|(column, _)| (column, "number of the row".to_owned())));
    let read = |column: usize, text: &str| {
        let value = number(text, layout.decimal);
        let value = value.or_else(|| stamp(text).filter(|_| layout.stamps.contains(&column)));
        let value = value.or(counter.is_some_and(|(own, _)| own == column).then_some(f64::NAN));
        value.ok_or_else(|| Fault::NotANumber { text: text.to_owned() })
    };
    let (mut last_line, mut behind) = (0, 0);
    let mut origin = choice.time.is_none().then_some(0.0);
    // times of day begin anew at midnight
    let is_clock = choice.time.as_ref().is_some_and(|own| layout.stamps.contains(&own.source));
    let (mut midnights, mut clock_s) = (0.0, f64::NEG_INFINITY);
    let most_s = if choice.time.is_some() { f64::INFINITY } else { LARGEST };
    table.numbers(&wanted, read, &mut problems, |numbers, at, problems| {
        let Some(numbers) = numbers else {
            behind += 1;
            return gather.leave_out();
        };
        let line = at.line;
        if is_untimed {
            gather.blank_lines(at.blank_before, line, problems);
        }
        if let (Some((_, step)), Some(number)) = (counter, numbers.last()) {
            gather.counted((*number, step), line, problems);
        }
        let mut row: Vec<f64> = choice.converted(numbers.iter().copied()).collect();
        if is_clock && row[0] <= DAY_S && row[0] + 0.5 * DAY_S < clock_s {
            midnights += 1.0;
        }
        clock_s = row[0];
        row[0] += midnights * DAY_S;
        let zero = *origin.get_or_insert(if row[0] > CLOCK_S { row[0] } else { 0.0 });
        row[0] -= zero;
        for (i, value) in row.iter_mut().enumerate() {
            let most = if i == 0 { most_s } else { LARGEST };
            *value = if value.abs() <= most { *value } else { f64::NAN };
        }
        (last_line, behind) = (line, 0);
        gather.push_or_miss(row, line, problems);
    })?;
    // lines of text behind the last sample are no part of the record
    let is_behind = |problem: &Problem| {
        let is_text = !matches!(problem.fault, Fault::Truncated { .. });
        is_text && problem.place.line.is_some_and(|line| line > last_line)
    };
    let is_footer = last_line > 0 && (1..=MOST_BEHIND).contains(&behind);
    let footer = is_footer && problems.as_slice().iter().all(is_behind);
    if footer {
        problems = Problems::default();
    }
    let mut parts = gather.finish(&mut problems);
    if let (true, Some(last)) = (footer, parts.as_mut().and_then(|parts| parts.last_mut())) {
        let message = format!("{behind} lines behind the last sample are no samples and left out");
        let place = Place::at(file, last_line + 1, 1);
        last.warnings.push(Problem::new(place, Fault::Other(message)));
    }
    problems.into_result(parts.map(|parts| Table { parts, choice }))
}

#[cfg(test)]
mod tests;
