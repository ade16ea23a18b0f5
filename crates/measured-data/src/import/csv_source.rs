//! CSV and other text tables, read row by row.

use super::columns::{ColumnOptions, choose, name_columns};
use super::gather::Reduction;
use super::{ImportKind, Table};
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::TextTable;
use std::io::{BufRead, Cursor, Read};

/// Longest line taken for text, bytes.
const LONGEST_LINE: u64 = 1 << 20;

/// The text up to the first line that holds data, and what separates its fields: the first of
/// semicolon, tab and comma, else blanks. A comma beside a semicolon is a decimal one, which the
/// numbers then say.
fn first_lines(reader: &mut impl BufRead, file: &str) -> Result<(Vec<u8>, u8), Problem> {
    let refused = |fault| Problem::new(Place::file(file), fault);
    let mut lines = Vec::new();
    loop {
        let start = lines.len();
        let read = reader.take(LONGEST_LINE).read_until(b'\n', &mut lines);
        let bytes = read.map_err(|e| refused(e.into()))? as u64;
        let line = &lines[start..];
        if bytes == LONGEST_LINE && !line.ends_with(b"\n") {
            return Err(refused(Fault::NotText { offset: start }));
        }
        let is_data = !line.starts_with(b"#") && !line.iter().all(u8::is_ascii_whitespace);
        if is_data || bytes == 0 {
            let separator = [b';', b'\t', b','].into_iter().find(|s| line.contains(s));
            return Ok((lines, separator.unwrap_or(b' ')));
        }
    }
}

/// Reads a text table.
///
/// The header is optional: a first line of numbers is data, and then `--columns` names them.
pub(super) fn read_csv(
    mut reader: impl BufRead,
    file: &str,
    options: &ColumnOptions,
    kind: Option<ImportKind>,
    reduction: Reduction,
) -> Result<Table, Problems> {
    let (start, separator) = first_lines(&mut reader, file)?;
    let table = TextTable::open(file, Cursor::new(start).chain(reader), separator)?;
    let names: Vec<String> = table.header.iter().map(|cell| cell.full.clone()).collect();
    let own = (!table.is_headless).then_some(names.as_slice());
    let choice = name_columns(options, own, names.len())
        .and_then(|named| choose(named, options, kind, reduction.sampling_hz))
        .map_err(|fault| Problem::new(table.header_place(), fault))?;
    let mut problems = Problems::default();
    let mut gather = choice.gather(file, reduction);
    let wanted: Vec<_> = choice.taken().map(|t| (t.source, t.channel.label())).collect();
    table.numbers(&wanted, &mut problems, |numbers, line, problems| match numbers {
        Some(numbers) => gather.push(choice.converted(numbers.iter().copied()), line, problems),
        None => gather.leave_out(),
    })?;
    let parts = gather.finish(&mut problems);
    problems.into_result(parts.map(|parts| Table { parts, choice }))
}

#[cfg(test)]
#[path = "csv_tests.rs"]
mod tests;
