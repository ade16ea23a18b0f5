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
/// Most columns of a sheet.
const MOST_COLUMNS: usize = 16_384;

fn refused(what: &str) -> Fault {
    Fault::Other(format!("{what}; open it and save the sheet of the record as CSV"))
}

fn word(bytes: &[u8], at: usize, count: usize) -> Option<usize> {
    let bytes = bytes.get(at..at + count)?;
    Some(bytes.iter().rev().fold(0, |all, byte| all << 8 | usize::from(*byte)))
}

/// Name, method, packed size and place of each file of an archive.
fn entries(file: &[u8]) -> Option<Vec<(String, usize, usize, usize)>> {
    let end = file.windows(4).rposition(|window| window == END)?;
    let (count, mut at) = (word(file, end + 10, 2)?, word(file, end + 16, 4)?);
    let mut found = Vec::new();
    for _ in 0..count {
        if file.get(at..at + 4)? != ENTRY {
            return None;
        }
        let length = word(file, at + 28, 2)?;
        let name = String::from_utf8_lossy(file.get(at + 46..at + 46 + length)?).into_owned();
        found.push((
            name,
            word(file, at + 10, 2)?,
            word(file, at + 20, 4)?,
            word(file, at + 42, 4)?,
        ));
        at += 46 + length + word(file, at + 30, 2)? + word(file, at + 32, 2)?;
    }
    Some(found)
}

/// The text of a file of an archive.
fn unpacked(file: &[u8], (_, method, size, at): &(String, usize, usize, usize)) -> Option<String> {
    let begin = at + 30 + word(file, at + 26, 2)? + word(file, at + 28, 2)?;
    let packed = file.get(begin..begin + size)?;
    let mut text = String::new();
    match method {
        0 => text.push_str(std::str::from_utf8(packed).ok()?),
        8 => {
            let decoder = flate2::read::DeflateDecoder::new(packed);
            decoder.take(MOST).read_to_string(&mut text).ok()?;
        }
        _ => return None,
    }
    Some(text)
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

/// The rows of a sheet, their cells separated by tabs.
fn rows(xml: &str, shared: &[String]) -> String {
    let mut table = String::new();
    let mut cells: Vec<String> = Vec::new();
    let mut kind = "";
    for (is_end, name, attributes, text) in tags(xml) {
        match name {
            "row" if is_end => {
                let _ = writeln!(table, "{}", cells.join("\t"));
            }
            _ if is_end => {}
            "row" => cells.clear(),
            "c" => {
                kind = attribute(attributes, "t").unwrap_or("n");
                let at = attribute(attributes, "r").and_then(column).unwrap_or(cells.len());
                cells.resize(at.max(cells.len()), String::new());
                cells.push(String::new());
            }
            "v" | "t" => {
                let number = || shared.get(text.parse::<usize>().ok()?).cloned();
                let text = if kind == "s" { number().unwrap_or_default() } else { plain(text) };
                if let Some(last) = cells.last_mut() {
                    last.push_str(&text);
                }
            }
            _ => {}
        }
    }
    table
}

/// Reads the largest sheet; also its name in the archive.
///
/// # Errors
/// An archive that holds no sheet, or is damaged.
pub(super) fn read_sheet(file: &[u8]) -> Result<String, Fault> {
    let damaged = || refused("is a damaged archive");
    let entries = entries(file).ok_or_else(damaged)?;
    let sheets = entries.iter().filter(|entry| entry.0.starts_with("xl/worksheets/sheet"));
    let largest = sheets.max_by_key(|entry| entry.2);
    let largest = largest.ok_or_else(|| refused("is an archive without a sheet of Excel"))?;
    let texts = entries.iter().find(|entry| entry.0 == "xl/sharedStrings.xml");
    let texts = texts.map(|entry| unpacked(file, entry).ok_or_else(damaged)).transpose()?;
    let texts = shared(&texts.unwrap_or_default());
    Ok(rows(&unpacked(file, largest).ok_or_else(damaged)?, &texts))
}
