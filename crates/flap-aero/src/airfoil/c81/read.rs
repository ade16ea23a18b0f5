//! An aerofoil from a C81 file's text.

use super::table::ascending;
use super::write::{NAME, PER_LINE, WIDTH};
use super::{C81Airfoil, C81Table};
use crate::AeroError;

/// Lines with their numbers, blank ones left out.
struct Lines<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    /// Line last handed out, from 1.
    line: usize,
}

impl<'a> Lines<'a> {
    fn next_filled(&mut self) -> Option<&'a str> {
        for (index, line) in self.lines.by_ref() {
            self.line = index + 1;
            if !line.trim().is_empty() {
                return Some(line);
            }
        }
        None
    }

    fn fault(&self, column: usize, expected: impl Into<String>) -> AeroError {
        AeroError::C81Text { line: self.line, column, expected: expected.into() }
    }
}

pub(super) fn airfoil(text: &str) -> Result<C81Airfoil, AeroError> {
    let mut lines = Lines { lines: text.lines().enumerate(), line: 1 };
    let expected =
        "a first line with name (30 columns) and six counts (2 columns each), no lines before it";
    let head = lines.next_filled().ok_or_else(|| lines.fault(1, expected))?;
    let (name, counts) = header(head).ok_or_else(|| lines.fault(NAME + 1, expected))?;
    let [ml, al, md, ad, mm, am] = counts;
    let lift = table(&mut lines, "lift", ml, al)?;
    let drag = table(&mut lines, "drag", md, ad)?;
    let moment = table(&mut lines, "moment", mm, am)?;
    nothing_follows(&mut lines)?;
    Ok(C81Airfoil { name, lift, drag, moment })
}

/// That no row is left over: remarks may follow the tables, numbers are a table the counts cut off.
fn nothing_follows(lines: &mut Lines<'_>) -> Result<(), AeroError> {
    let is_row = |line: &str| {
        let mut words = line.split_whitespace();
        words.all(|word| parsed(word).is_some())
            || by_columns(line, true, line.trim_end().chars().count().div_ceil(WIDTH) - 1).is_ok()
    };
    while let Some(line) = lines.next_filled() {
        if is_row(line) {
            let expected = "the end of the tables; the counts of the first line are too small";
            return Err(lines.fault(1, expected));
        }
    }
    Ok(())
}

/// Name and counts of the first line: by columns, or else the last six words.
fn header(line: &str) -> Option<(String, [usize; 6])> {
    let count = |text: &str| text.trim().parse().ok().filter(|n| (1..=99).contains(n));
    let characters: Vec<char> = line.chars().collect();
    let by_columns = || -> Option<Vec<usize>> {
        let (fields, rest) = characters.get(NAME..)?.split_at_checked(12)?;
        let fields = fields.chunks(2).map(|field| count(&String::from_iter(field)));
        rest.iter().all(|c| c.is_whitespace()).then(|| fields.collect())?
    };
    if let Some(counts) = by_columns() {
        let name = String::from_iter(&characters[..NAME]);
        return Some((name.trim_end().to_owned(), counts.try_into().ok()?));
    }
    let words: Vec<&str> = line.split_whitespace().collect();
    let (name, counts) = words.split_at_checked(words.len().checked_sub(6)?)?;
    let counts: Option<Vec<usize>> = counts.iter().map(|word| count(word)).collect();
    Some((name.join(" "), counts?.try_into().ok()?))
}

/// The table of this name.
fn table(
    lines: &mut Lines<'_>,
    name: &str,
    machs: usize,
    incidences: usize,
) -> Result<C81Table, AeroError> {
    let (line, _, mach_numbers) = row(lines, name, false, machs)?;
    let fault = |line, expected| AeroError::C81Text { line, column: 1, expected };
    if mach_numbers[0] < 0.0 {
        return Err(fault(line, format!("Mach numbers of the {name} table of 0 or more")));
    }
    if ascending("Mach numbers", &mach_numbers).is_err() {
        let expected = format!("Mach numbers of the {name} table that ascend; sort its columns");
        return Err(fault(line, expected));
    }
    let mut angles: Vec<f64> = Vec::with_capacity(incidences);
    let mut values = Vec::with_capacity(machs * incidences);
    for _ in 0..incidences {
        let (line, angle, row) = row(lines, name, true, machs)?;
        if angles.last().zip(angle).is_some_and(|(before, now)| now <= *before) {
            let place = format!("an incidence above the one before it in the {name} table");
            return Err(fault(line, format!("{place}; sort its rows")));
        }
        angles.extend(angle);
        values.extend(row);
    }
    C81Table::new(mach_numbers, angles, values)
}

/// One row: the line it begins on, its incidence, if it has one, and `count` values, over as many lines as these need.
fn row(
    lines: &mut Lines<'_>,
    table: &str,
    has_incidence: bool,
    count: usize,
) -> Result<(usize, Option<f64>, Vec<f64>), AeroError> {
    let mut begin = None;
    let mut incidence = None;
    let mut values: Vec<f64> = Vec::with_capacity(count);
    let mut first = has_incidence;
    while values.len() < count {
        let wanted = (count - values.len()).min(PER_LINE);
        let line = lines.next_filled().ok_or_else(|| {
            let remedy = "complete it, or correct the counts of the first line";
            lines.fault(1, format!("more of the {table} table; the file ends inside it: {remedy}"))
        })?;
        let _ = begin.get_or_insert(lines.line);
        let mut numbers = match by_columns(line, first, wanted) {
            Ok(numbers) => numbers,
            Err(column) => {
                by_words(line, usize::from(first) + count - values.len()).ok_or_else(|| {
                    let how = "in fields of seven columns, or apart by blanks";
                    let count = "as many as the first line counts";
                    lines.fault(column, format!("numbers of the {table} table {how}, {count}"))
                })?
            }
        };
        if first {
            incidence = Some(numbers.remove(0));
            first = false;
        }
        values.extend(numbers);
    }
    Ok((begin.unwrap_or(lines.line), incidence, values))
}

/// The numbers of a line cut by columns; the column of the first field that is none.
fn by_columns(line: &str, has_incidence: bool, wanted: usize) -> Result<Vec<f64>, usize> {
    let characters: Vec<char> = line.trim_end().chars().collect();
    let field = |n: usize| -> Option<String> {
        let end = characters.len().min((n + 1) * WIDTH);
        characters.get(n * WIDTH..end).map(|field| field.iter().collect())
    };
    let number = |n: usize| -> Result<f64, usize> {
        field(n).and_then(|text| parsed(text.trim())).ok_or(n * WIDTH + 1)
    };
    let mut numbers = Vec::with_capacity(wanted + 1);
    if has_incidence {
        numbers.push(number(0)?);
    } else if field(0).is_some_and(|text| !text.trim().is_empty()) {
        return Err(1);
    }
    for n in 1..=wanted {
        numbers.push(number(n)?);
    }
    if characters.len() > (wanted + 1) * WIDTH {
        return Err((wanted + 1) * WIDTH + 1);
    }
    Ok(numbers)
}

/// The numbers of a line apart by blanks: at most as many as are still wanted, at least two.
fn by_words(line: &str, wanted: usize) -> Option<Vec<f64>> {
    let numbers: Option<Vec<f64>> = line.split_whitespace().map(parsed).collect();
    numbers.filter(|numbers| (1..=wanted).contains(&numbers.len()))
}

/// A finite number as Fortran writes it: `.5`, `5.`, `1.2D-3` and `1.2E-3`.
fn parsed(text: &str) -> Option<f64> {
    let plain = text.chars().all(|c| c.is_ascii_digit() || "+-.eEdD".contains(c));
    if !plain {
        return None;
    }
    text.replace(['d', 'D'], "E").parse().ok().filter(|value: &f64| value.is_finite())
}
