//! CSV and other text tables, read line by line.

use super::columns::{Choice, Shape, choose, name_columns};
use super::gather::{Gather, Gathered, Reduction};
use super::{ColumnOptions, Table};
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::Listing;
use std::io::{BufRead, Read};

/// Longest line taken for text, bytes.
const LONGEST_LINE: u64 = 1 << 20;

/// The lines of a text, one at a time.
struct Lines<'a, R> {
    reader: R,
    file: &'a str,
    buffer: Vec<u8>,
    number: usize,
    offset: usize,
    ended: bool,
}

/// A line that holds data.
#[derive(Clone, Copy)]
struct TableLine<'a> {
    text: &'a str,
    /// Its number in the file, from 1.
    number: usize,
    /// Whether a line end follows.
    ended: bool,
}

impl<R: BufRead> Lines<'_, R> {
    /// The next line that holds data; none at the end of the file.
    fn next(&mut self) -> Result<Option<TableLine<'_>>, Problems> {
        loop {
            self.buffer.clear();
            let read = (&mut self.reader).take(LONGEST_LINE).read_until(b'\n', &mut self.buffer);
            let bytes = read.map_err(|e| {
                let fault = Fault::Unreadable { reason: e.to_string() };
                Problem::new(Place::file(self.file), fault)
            })?;
            if bytes == 0 {
                return Ok(None);
            }
            self.number += 1;
            self.ended = self.buffer.ends_with(b"\n");
            let start = self.offset;
            self.offset += bytes;
            let valid = std::str::from_utf8(&self.buffer).map_err(|e| start + e.valid_up_to());
            let too_long = bytes as u64 == LONGEST_LINE && !self.ended;
            if let Some(offset) = valid.err().or(too_long.then_some(start)) {
                let fault = Fault::NotText { offset };
                return Err(Problem::new(Place::file(self.file), fault).into());
            }
            let comment = self.buffer.starts_with(b"#");
            if !comment && !self.buffer.iter().all(u8::is_ascii_whitespace) {
                break;
            }
        }
        // checked just now; a byte-order mark belongs to no table
        let text = std::str::from_utf8(&self.buffer).unwrap_or_default();
        let text = text.trim_start_matches('\u{feff}').trim_end_matches(['\n', '\r']);
        Ok(Some(TableLine { text, number: self.number, ended: self.ended }))
    }
}

/// What separates the fields: the first of semicolon, tab and comma in the first line, else blanks. A
/// comma beside a semicolon is a decimal one, which the numbers then say.
fn separator(line: &str) -> Option<char> {
    [';', '\t', ','].into_iter().find(|s| line.contains(*s))
}

fn fields(line: &str, separator: Option<char>) -> Vec<&str> {
    match separator {
        Some(separator) => line.split(separator).map(plain).collect(),
        None => line.split_whitespace().map(plain).collect(),
    }
}

fn plain(text: &str) -> &str {
    text.trim().trim_matches('"').trim()
}

fn is_unit(text: &str) -> bool {
    (text.starts_with('(') && text.ends_with(')')) || (text.starts_with('[') && text.ends_with(']'))
}

/// Reads a text table.
///
/// The header is optional: a first line of numbers is data, and then `--columns` names them.
pub(super) fn read_csv(
    reader: impl BufRead,
    file: &str,
    options: &ColumnOptions,
    shape: Option<Shape>,
    reduction: Reduction,
) -> Result<Table, Problems> {
    let mut lines = Lines { reader, file, buffer: Vec::new(), number: 0, offset: 0, ended: false };
    let Some(first) = lines.next()? else {
        let fault = Fault::TooFewRows { rows: 0, least: 3 };
        return Err(Problem::new(Place::file(file), fault).into());
    };
    let first_line = first.number;
    let separator = separator(first.text);
    let owned = |text: &str| -> Vec<String> {
        fields(text, separator).into_iter().map(str::to_owned).collect()
    };
    let mut cells = owned(first.text);
    let is_number = |t: &String| t.is_empty() || t.parse::<f64>().is_ok();
    let headless = cells.iter().all(is_number);
    let count = cells.len();
    let mut pending = None;
    if headless {
        pending = Some((cells.clone(), (first_line, true)));
    } else if let Some(second) = lines.next()? {
        // a second row of units belongs to the header
        let row = owned(second.text);
        if row.iter().all(|u| is_unit(u)) {
            for (cell, unit) in cells.iter_mut().zip(row) {
                cell.push_str(&unit);
            }
        } else {
            pending = Some((row, (second.number, second.ended)));
        }
    }
    let own = (!headless).then_some(cells.as_slice());
    let place = Place::at(file, first_line, 1);
    let choice = name_columns(options, own, count)
        .and_then(|named| choose(named, options, shape, reduction.sampling_hz))
        .map_err(|fault| Problem::new(place, fault.into()))?;
    let gathered = rows(&mut lines, &choice, pending, (count, separator), reduction)?;
    Ok(Table { gathered, choice })
}

fn rows<R: BufRead>(
    lines: &mut Lines<'_, R>,
    choice: &Choice,
    pending: Option<(Vec<String>, (usize, bool))>,
    (expected, separator): (usize, Option<char>),
    reduction: Reduction,
) -> Result<Gathered, Problems> {
    let mut problems = Problems::default();
    let file = lines.file;
    let mut gather = Gather::new(file, choice.labels(), reduction);
    let step_s = reduction.sampling_hz.map_or(0.0, |hz| 1.0 / hz);
    let mut row = Row {
        file,
        choice,
        expected,
        values: vec![0.0; expected],
        taken: Vec::new(),
        decimals: None,
        step_s,
        lists: Default::default(),
    };
    if let Some((cells, place)) = pending {
        let cells: Vec<&str> = cells.iter().map(String::as_str).collect();
        row.push(&cells, place, &mut gather, &mut problems);
    }
    while let Some(line) = lines.next()? {
        let cells = fields(line.text, separator);
        row.push(&cells, (line.number, line.ended), &mut gather, &mut problems);
    }
    for list in row.lists {
        list.finish(&mut problems);
    }
    let found = gather.finish(&mut problems);
    problems.into_result(found)
}

/// One row after the other, with what is wrong with them.
struct Row<'a> {
    file: &'a str,
    choice: &'a Choice,
    expected: usize,
    values: Vec<f64>,
    taken: Vec<f64>,
    /// Decimals of the last field of the row before.
    decimals: Option<usize>,
    step_s: f64,
    lists: [Listing; 3],
}

impl Row<'_> {
    fn push(
        &mut self,
        cells: &[&str],
        (line, ended): (usize, bool),
        gather: &mut Gather,
        problems: &mut Problems,
    ) {
        let decimals = cells.last().and_then(|t| t.split_once('.')).map(|(_, d)| d.len());
        let cut = !ended
            && (cells.len() < self.expected
                || cells.last().is_some_and(|t| t.is_empty())
                || self.decimals.is_some_and(|usual| decimals.is_none_or(|d| d < usual)));
        let place = || Place::at(self.file, line, 1);
        if cut {
            let fault = Fault::Truncated { text: cells.join(","), expected: self.expected };
            problems.push(place(), fault);
            return;
        }
        self.decimals = decimals;
        if cells.len() != self.expected {
            let fault = Fault::FieldCount { found: cells.len(), expected: self.expected };
            self.lists[0].push(problems, place(), fault);
            gather.leave_out();
            return;
        }
        let mut good = true;
        for taken in self.choice.time.iter().chain(&self.choice.columns) {
            let text = cells[taken.source];
            let field = || place().field(taken.channel.label());
            match text.parse::<f64>() {
                Ok(value) if value.is_finite() => self.values[taken.source] = value,
                Ok(value) => {
                    good = false;
                    self.lists[1].push(problems, field(), Fault::NotFinite { value });
                }
                Err(_) => {
                    good = false;
                    let fault = Fault::NotANumber { text: text.to_owned() };
                    self.lists[2].push(problems, field(), fault);
                }
            }
        }
        if good {
            let index = gather.count();
            self.choice.take(&self.values, self.step_s, index, &mut self.taken);
            gather.push(&self.taken, line, problems);
        } else {
            gather.leave_out();
        }
    }
}

#[cfg(test)]
#[path = "csv_tests.rs"]
mod tests;
