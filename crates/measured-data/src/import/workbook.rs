//! The largest sheet of an Excel workbook (`.xlsx`) as a table with tabs.
//!
//! Source: ECMA-376, Office Open XML; PKWARE, APPNOTE.TXT, the ZIP format.

use crate::problem::Fault;
use std::fmt::Write;
use std::io::Read;

/// What a ZIP archive begins with.
pub(super) const MAGIC: &[u8] = b"PK\x03\x04";
/// The end of its directory, an entry of it.
const END: &[u8] = b"PK\x05\x06";
const ENTRY: &[u8] = b"PK\x01\x02";
/// Most bytes of an unpacked part.
const MOST: u64 = 1 << 30;
/// Excel counts time in days.
const SECONDS_OF_A_DAY: f64 = 86_400.0;
/// Most columns of a sheet.
const MOST_COLUMNS: usize = 16_384;
/// Most rows of a sheet.
const MOST_ROWS: usize = 1_048_576;

fn refused(what: &str) -> Fault {
    Fault::Other(format!("{what}; open it and save the sheet of the record as CSV"))
}

fn word(bytes: &[u8], at: usize, count: usize) -> Option<usize> {
    let bytes = bytes.get(at..at + count)?;
    Some(bytes.iter().rev().fold(0, |all, byte| all << 8 | usize::from(*byte)))
}

/// A file of an archive.
struct Entry {
    name: String,
    method: usize,
    checksum: usize,
    packed_size: usize,
    place: usize,
}

/// The files of an archive.
fn entries(file: &[u8]) -> Option<Vec<Entry>> {
    let end = file.windows(4).rposition(|window| window == END)?;
    let (count, mut at) = (word(file, end + 10, 2)?, word(file, end + 16, 4)?);
    let mut found = Vec::new();
    for _ in 0..count {
        if file.get(at..at + 4)? != ENTRY {
            return None;
        }
        let length = word(file, at + 28, 2)?;
        let name = String::from_utf8_lossy(file.get(at + 46..at + 46 + length)?).into_owned();
        found.push(Entry {
            name,
            method: word(file, at + 10, 2)?,
            checksum: word(file, at + 16, 4)?,
            packed_size: word(file, at + 20, 4)?,
            place: word(file, at + 42, 4)?,
        });
        at += 46 + length + word(file, at + 30, 2)? + word(file, at + 32, 2)?;
    }
    Some(found)
}

/// The text of a file of an archive; none where it is damaged or beyond all bounds.
fn unpacked(file: &[u8], entry: &Entry) -> Option<String> {
    let at = entry.place;
    let begin = at + 30 + word(file, at + 26, 2)? + word(file, at + 28, 2)?;
    let packed = file.get(begin..begin.checked_add(entry.packed_size)?)?;
    let mut bytes = Vec::new();
    match entry.method {
        0 => bytes.extend(packed),
        8 => {
            let decoder = flate2::read::DeflateDecoder::new(packed);
            decoder.take(MOST + 1).read_to_end(&mut bytes).ok()?;
        }
        _ => return None,
    }
    let mut sum = flate2::Crc::new();
    sum.update(&bytes);
    let is_whole = bytes.len() as u64 <= MOST && sum.sum() as usize == entry.checksum;
    String::from_utf8(bytes).ok().filter(|_| is_whole)
}

/// Tags of XML with the text behind each: whether it ends, name, attributes, text.
fn tags(xml: &str) -> impl Iterator<Item = (bool, &str, &str, &str)> {
    xml.split('<').skip(1).filter_map(|piece| {
        let (tag, text) = piece.split_once('>')?;
        let (name, attributes) = tag.split_once(char::is_whitespace).unwrap_or((tag, ""));
        let bare = name.trim_matches('/');
        // without the prefix of its name space
        let bare = bare.rsplit_once(':').map_or(bare, |(_, bare)| bare);
        Some((name.starts_with('/'), bare, attributes, text))
    })
}

fn plain(text: &str) -> String {
    let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "");
    text.replace("&apos;", "'").replace("&amp;", "&").replace(['\t', '\n', '\r', '"'], " ")
}

fn attribute<'a>(attributes: &'a str, name: &str) -> Option<&'a str> {
    let mut words = attributes.split_whitespace();
    words.find_map(|word| word.strip_prefix(name)?.strip_prefix("=\"")?.split('"').next())
}

/// The texts that cells name by number.
fn shared(xml: &str) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for (is_end, name, _, text) in tags(xml) {
        match (name, all.last_mut()) {
            ("si", _) if !is_end => all.push(String::new()),
            ("t", Some(last)) if !is_end => last.push_str(&plain(text)),
            _ => {}
        }
    }
    all
}

/// The column of a reference such as `AB12`, from 0.
fn column(reference: &str) -> Option<usize> {
    let letters = reference.bytes().take_while(u8::is_ascii_uppercase);
    let number = letters.fold(0, |all, letter| 26 * all + usize::from(letter - b'A') + 1);
    number.checked_sub(1).filter(|column| *column < MOST_COLUMNS)
}

/// Whether each style of the cells shows a date or a time of day: built-in formats 14 to 22 and 45 to 47, and others with
/// the letters of dates outside of quotes.
fn dated(xml: &str) -> Vec<bool> {
    let mut own: Vec<(usize, bool)> = Vec::new();
    let mut styles = Vec::new();
    let mut is_of_cells = false;
    for (is_end, name, attributes, _) in tags(xml) {
        let number = |key| attribute(attributes, key).and_then(|id| id.parse::<usize>().ok());
        match name {
            "numFmt" => own.extend(number("numFmtId").map(|id| (id, is_date_format(attributes)))),
            "cellXfs" => is_of_cells = !is_end,
            "xf" if is_of_cells && !is_end => {
                let id = number("numFmtId").unwrap_or(0);
                let known = own.iter().find(|(other, _)| *other == id);
                styles.push(known.map_or(matches!(id, 14..=22 | 45..=47), |(_, date)| *date));
            }
            _ => {}
        }
    }
    styles
}

/// Whether the format code among some attributes is one of dates.
fn is_date_format(attributes: &str) -> bool {
    let code = attributes.split_once("formatCode=\"").and_then(|(_, rest)| rest.split_once('"'));
    let code = code.map_or("", |(code, _)| code).replace("&quot;", "\"");
    let (mut in_quotes, mut is_literal) = (false, false);
    code.chars().any(|c| {
        let was_literal = std::mem::replace(&mut is_literal, c == '\\');
        in_quotes ^= c == '"';
        !in_quotes && !was_literal && matches!(c, 'h' | 's' | 'y' | 'd')
    })
}

/// The rows of a sheet, their cells separated by tabs; dates and times of day in s. None beyond all bounds.
fn rows(xml: &str, shared: &[String], dated: &[bool]) -> Option<String> {
    let mut table = String::new();
    let mut cells: Vec<String> = Vec::new();
    let (mut kind, mut is_date) = ("", false);
    let mut last_row = 0;
    for (is_end, name, attributes, text) in tags(xml) {
        match name {
            "row" if is_end => {
                let _ = writeln!(table, "{}", cells.join("\t"));
                if table.len() as u64 > MOST {
                    return None;
                }
            }
            _ if is_end => {}
            "row" => {
                cells.clear();
                let number = attribute(attributes, "r").and_then(|r| r.parse::<usize>().ok());
                let number = number.filter(|r| *r <= MOST_ROWS).unwrap_or(last_row + 1);
                // blank rows are not stored
                let blank = if last_row > 0 { number.saturating_sub(last_row + 1) } else { 0 };
                table.push_str(&"\t\n".repeat(blank));
                last_row = number;
                // a row of a height alone, which has no end of its own
                if attributes.ends_with('/') {
                    table.push_str("\t\n");
                }
            }
            "c" => {
                kind = attribute(attributes, "t").unwrap_or("n");
                let style = attribute(attributes, "s").and_then(|s| s.parse::<usize>().ok());
                is_date = style.and_then(|style| dated.get(style)).copied().unwrap_or(false);
                let at = attribute(attributes, "r").and_then(column).unwrap_or(cells.len());
                cells.resize(at.max(cells.len()), String::new());
                cells.push(String::new());
            }
            "v" | "t" => {
                let number = || shared.get(text.parse::<usize>().ok()?).cloned();
                let text = match text.parse::<f64>() {
                    _ if kind == "s" => number().unwrap_or_default(),
                    Ok(days) if kind == "n" && is_date => (SECONDS_OF_A_DAY * days).to_string(),
                    _ => plain(text),
                };
                if let Some(last) = cells.last_mut() {
                    last.push_str(&text);
                }
            }
            _ => {}
        }
    }
    Some(table)
}

/// Reads the largest sheet.
///
/// # Errors
/// An archive that holds no sheet, or is damaged.
pub(super) fn read_sheet(file: &[u8]) -> Result<String, Fault> {
    let damaged = || refused("is a damaged archive");
    let entries = entries(file).ok_or_else(damaged)?;
    let sheets = entries.iter().filter(|entry| entry.name.starts_with("xl/worksheets/sheet"));
    let largest = sheets.max_by_key(|entry| entry.packed_size);
    let largest = largest.ok_or_else(|| refused("is an archive without a sheet of Excel"))?;
    let part = |name: &str| {
        let entry = entries.iter().find(|entry| entry.name == name);
        entry.map_or(Ok(String::new()), |entry| unpacked(file, entry).ok_or_else(damaged))
    };
    let (texts, styles) = (part("xl/sharedStrings.xml")?, part("xl/styles.xml")?);
    let sheet = unpacked(file, largest).ok_or_else(damaged)?;
    rows(&sheet, &shared(&texts), &dated(&styles))
        .ok_or_else(|| refused("holds a sheet of more than a gigabyte"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_times_of_day_are_seconds() {
        let styles = "<numFmts><numFmt numFmtId=\"164\" formatCode=\"hh:mm:ss.000\"/>\
            <numFmt numFmtId=\"165\" formatCode=\"0.00&quot; s&quot;\"/></numFmts>\
            <cellStyleXfs><xf numFmtId=\"14\"/></cellStyleXfs>\
            <cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"164\"/><xf numFmtId=\"165\"/><xf numFmtId=\"22\"/></cellXfs>";
        assert_eq!(dated(styles), [false, true, false, true]);
        let sheet = "<row r=\"1\"><c s=\"1\"><v>0.5</v></c><c s=\"2\"><v>0.5</v></c><c><v>7</v></c>\
            <c t=\"s\" s=\"1\"><v>0</v></c></row>";
        let texts = shared("<sst><si><t>a &amp; b</t></si></sst>");
        assert_eq!(rows(sheet, &texts, &dated(styles)).unwrap(), "43200\t0.5\t7\ta & b\n");
        // rows that hold nothing are not stored, and none the less there
        let row = |number: usize| format!("<row r=\"{number}\"><c><v>1</v></c></row>");
        let sheet = [3, 4, 7].map(row).concat();
        assert_eq!(rows(&sheet, &[], &[]).unwrap(), "1\n1\n\t\n\t\n1\n");
        // nor those that only have a height
        let tall = "<row r=\"5\" ht=\"20\" customHeight=\"1\"/>".to_owned();
        let sheet = [row(3), row(4), tall, row(7)].concat();
        assert_eq!(rows(&sheet, &[], &[]).unwrap(), "1\n1\n\t\n\t\n1\n");
    }
}
