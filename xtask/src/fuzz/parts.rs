//! The parts of an input by its form: items in brackets, rows and cells, fields of fixed width, words in binary.

use std::ops::Range;

use chacha20::ChaCha8Rng;
use rand::RngExt;

use super::bytes::{WORDS, number};

/// The items of a text in brackets: what stands between brackets and commas, at every depth, without blanks round it.
/// Quoted text is one piece.
pub(super) fn items(bytes: &[u8]) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut open = vec![0];
    let (mut quoted, mut escaped) = (false, false);
    for (at, byte) in bytes.iter().enumerate() {
        if quoted {
            quoted = *byte != b'"' || escaped;
            escaped = *byte == b'\\' && !escaped;
            continue;
        }
        match byte {
            b'"' => quoted = true,
            b'(' | b'[' | b'{' => open.push(at + 1),
            b',' | b')' | b']' | b'}' => {
                if let Some(start) = open.last_mut() {
                    found.push(*start..at);
                    *start = at + 1;
                }
                // the first start is that of the text itself
                if *byte != b',' && open.len() > 1 {
                    open.pop();
                }
            }
            _ => {}
        }
    }
    let trimmed = found.into_iter().filter_map(|range: Range<usize>| {
        let part = &bytes[range.clone()];
        let first = part.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let last = part.iter().rposition(|byte| !byte.is_ascii_whitespace())?;
        Some(range.start + first..range.start + last + 1)
    });
    trimmed.collect()
}

fn one_of<'a, T>(list: &'a [T], random: &mut ChaCha8Rng) -> Option<&'a T> {
    if list.is_empty() { None } else { list.get(random.random_range(0..list.len())) }
}

/// An item is left out, doubled, exchanged, wrapped, replaced by one of another input, or loses a letter of its name.
pub(super) fn of_nested(bytes: &mut Vec<u8>, other: &[u8], random: &mut ChaCha8Rng) {
    let own = items(bytes);
    let Some(item) = one_of(&own, random).cloned() else { return };
    let text = bytes[item.clone()].to_vec();
    let behind_name =
        text.iter().position(|byte| *byte == b':').map_or(item.start, |at| item.start + at + 1);
    match random.random_range(0..8_u32) {
        0 => drop(bytes.drain(item)),
        1 => drop(bytes.splice(item.end..item.end, [b", ".to_vec(), text].concat())),
        2 => {
            let Some(second) = one_of(&own, random).filter(|second| second.start >= item.end)
            else {
                return;
            };
            let later = bytes[second.clone()].to_vec();
            drop(bytes.splice(second.clone(), text));
            drop(bytes.splice(item, later));
        }
        3 => {
            let strange = items(other);
            let Some(strange) = one_of(&strange, random) else { return };
            drop(bytes.splice(item, other[strange.clone()].to_vec()));
        }
        4 => {
            let (open, close) =
                [("Some(", ")"), ("[", "]"), ("(", ")"), ("\"", "\"")][random.random_range(0..4)];
            drop(bytes.splice(item.end..item.end, close.bytes()));
            drop(bytes.splice(behind_name..behind_name, open.bytes()));
        }
        5 => {
            let word = WORDS[random.random_range(0..WORDS.len())];
            drop(bytes.splice(behind_name..item.end, word.bytes()));
        }
        6 if item.len() > 1 => drop(bytes.remove(item.start)),
        _ => number(bytes, item.start, random),
    }
}

/// Rows as ranges of bytes, each with its end of line.
fn rows(bytes: &[u8]) -> Vec<Range<usize>> {
    let mut start = 0;
    let mut found: Vec<Range<usize>> = Vec::new();
    for (at, byte) in bytes.iter().enumerate() {
        if *byte == b'\n' {
            found.push(start..at + 1);
            start = at + 1;
        }
    }
    if start < bytes.len() {
        found.push(start..bytes.len());
    }
    found
}

/// The separator that the first rows have most of.
fn separator(bytes: &[u8]) -> u8 {
    let start = &bytes[..bytes.len().min(400)];
    let count = |separator: &u8| start.split(|byte| byte == separator).count();
    b",;\t ".iter().copied().max_by_key(count).unwrap_or(b',')
}

/// A column is left out, doubled or moved to the front.
fn of_column(bytes: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let separator = separator(bytes);
    let column = random.random_range(0..6_usize);
    let how = random.random_range(0..3_u32);
    let mut out = Vec::with_capacity(bytes.len());
    for row in rows(bytes) {
        let mut cells: Vec<&[u8]> =
            bytes[row].trim_ascii_end().split(|byte| *byte == separator).collect();
        if column < cells.len() {
            match how {
                0 => drop(cells.remove(column)),
                1 => cells.insert(column, cells[column]),
                _ => cells.swap(0, column),
            }
        }
        out.extend(cells.join(&separator));
        out.push(b'\n');
    }
    out
}

/// Rows, cells and columns are left out, doubled and exchanged; units, separators, ends of lines and encoding are others.
pub(super) fn of_table(bytes: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    let own = rows(bytes);
    let Some(row) = one_of(&own, random).cloned() else { return };
    let replaced = |bytes: &[u8], from: u8, to: u8| -> Vec<u8> {
        bytes.iter().map(|byte| if *byte == from { to } else { *byte }).collect()
    };
    match random.random_range(0..13_u32) {
        0 => drop(bytes.drain(row)),
        1 => {
            let text = bytes[row.clone()].to_vec();
            drop(bytes.splice(row.end..row.end, text));
        }
        2 => {
            let Some(second) = one_of(&own, random).filter(|second| second.start >= row.end) else {
                return;
            };
            let (first, later) = (bytes[row.clone()].to_vec(), bytes[second.clone()].to_vec());
            drop(bytes.splice(second.clone(), first));
            drop(bytes.splice(row, later));
        }
        3 | 4 => *bytes = of_column(bytes, random),
        5 => {
            let to = b",;\t |"[random.random_range(0..5)];
            *bytes = replaced(bytes, separator(bytes), to);
        }
        6 => *bytes = replaced(bytes, b'.', b','),
        7 => {
            // a unit of the header
            let units = ["_V", "_mV", "_um", "_mm", "_s", "_ms", "_N", "_deg", " [V]", " (um)", ""];
            let head = own.first().cloned().unwrap_or(0..0);
            let at = bytes[head.clone()]
                .iter()
                .rposition(|byte| *byte == b'_')
                .map(|at| head.start + at);
            let Some(at) = at else { return };
            let end = (at + random.random_range(1..5_usize)).min(head.end);
            drop(bytes.splice(at..end, units[random.random_range(0..units.len())].bytes()));
        }
        8 => {
            let text = String::from_utf8_lossy(bytes).into_owned();
            let is_big = random.random::<bool>();
            let mark: u16 = 0xfeff;
            let units = std::iter::once(mark).chain(text.encode_utf16());
            *bytes = units
                .flat_map(|unit| if is_big { unit.to_be_bytes() } else { unit.to_le_bytes() })
                .collect();
        }
        9 => {
            let text = String::from_utf8_lossy(bytes)
                .replace('\n', ["\r\n", "\r", "\n\n"][random.random_range(0..3)]);
            *bytes = text.into_bytes();
        }
        10 => {
            let word = WORDS[random.random_range(0..WORDS.len())];
            let cell = bytes[row.clone()].iter().position(|byte| *byte == separator(bytes));
            let end = cell.map_or(row.end, |at| row.start + at);
            drop(bytes.splice(row.start..end, word.bytes()));
        }
        _ => number(bytes, row.start, random),
    }
}

/// Rows are left out, doubled or shifted by a blank; fields of seven letters become words or blanks.
pub(super) fn of_fixed(bytes: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    let own = rows(bytes);
    let Some(row) = one_of(&own, random).cloned() else { return };
    let field = row.start + 7 * random.random_range(0..11_usize);
    let end = (field + 7).min(row.end.saturating_sub(1));
    match random.random_range(0..6_u32) {
        0 => drop(bytes.drain(row)),
        1 => {
            let text = bytes[row.clone()].to_vec();
            drop(bytes.splice(row.end..row.end, text));
        }
        2 => bytes.insert(row.start, b' '),
        3 if field < end => bytes[field..end].fill(b' '),
        4 if field < end => {
            let word = format!("{:>7}", WORDS[random.random_range(0..9)]);
            drop(bytes.splice(field..end, word.into_bytes().into_iter().take(7)));
        }
        _ => number(bytes, row.start, random),
    }
}

/// A count or an offset of four or eight bytes becomes an extreme or its neighbour, a number becomes no number; blocks are left
/// out or doubled.
pub(super) fn of_binary(bytes: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    let width = if random.random::<bool>() { 4 } else { 8 };
    if bytes.len() < 2 * width {
        return;
    }
    let at = random.random_range(0..bytes.len() - width) / 4 * 4;
    let field = at..at + width;
    match random.random_range(0..6_u32) {
        0 | 1 => {
            let extremes = [0, 1, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, u64::MAX, 1 << 40];
            let value = extremes[random.random_range(0..extremes.len())];
            let little = value.to_le_bytes();
            let big = value.to_be_bytes();
            let bytes_of = if random.random_range(0..4_u32) > 0 {
                &little[..width]
            } else {
                &big[8 - width..]
            };
            bytes[field].copy_from_slice(bytes_of);
        }
        2 => {
            let moved = bytes[at].wrapping_add([1, 255, 8, 128][random.random_range(0..4)]);
            bytes[at] = moved;
        }
        3 if width == 8 => {
            let value = [f64::NAN, f64::INFINITY, -1e308, 5e-324][random.random_range(0..4)];
            bytes[field].copy_from_slice(&value.to_le_bytes());
        }
        4 => {
            let end = (at + 8 * random.random_range(1..32_usize)).min(bytes.len());
            drop(bytes.drain(at..end));
        }
        _ => {
            let end = (at + 8 * random.random_range(1..32_usize)).min(bytes.len());
            let part = bytes[at..end].to_vec();
            drop(bytes.splice(at..at, part));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_stand_between_brackets_and_commas() {
        let text = b"(a: 1, b: [2, \"x, (\\\"\"], c: Some((d: 3)))";
        let found: Vec<String> = items(text)
            .into_iter()
            .map(|range| String::from_utf8_lossy(&text[range]).into_owned())
            .collect();
        assert_eq!(
            found,
            [
                "a: 1",
                "2",
                "\"x, (\\\"\"",
                "b: [2, \"x, (\\\"\"]",
                "d: 3",
                "(d: 3)",
                "c: Some((d: 3))"
            ]
        );
        assert!(items(b"").is_empty() && items(b")))").is_empty());
    }

    #[test]
    fn rows_and_separators_are_found() {
        assert_eq!(rows(b"a\nbc\nd"), [0..2, 2..5, 5..6]);
        assert!(rows(b"").is_empty());
        assert_eq!([separator(b"a;b;c,d"), separator(b"a\tb\tc d")], [b';', b'\t']);
    }
}
