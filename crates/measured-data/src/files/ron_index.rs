//! Where every field of a RON text stands.
//!
//! The RON reader knows the place of what it cannot read; this index knows the place of everything
//! it could read, so that a value out of range is reported with its line as well.

use crate::problem::Place;
use std::ops::Range;

/// A field or list element of a RON text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Entry {
    /// Path from the root: `rotor.radius_m`, `flaps[1].start_r`. The name of an enum variant or
    /// struct adds nothing to a path.
    pub(crate) path: String,
    /// Byte at which the key begins, or the value if there is no key.
    pub(crate) start: usize,
    /// Bytes of the value, an enum's name included.
    pub(crate) value: Range<usize>,
}

/// The places of all fields of one RON text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RonIndex {
    file: String,
    text: String,
    entries: Vec<Entry>,
}

impl RonIndex {
    /// Indexes a text; of a malformed one, whatever comes before the flaw.
    pub fn new(file: &str, text: &str) -> Self {
        let mut scanner = Scanner { bytes: text.as_bytes(), at: 0, entries: Vec::new(), depth: 0 };
        scanner.skip_blank();
        scanner.value("");
        Self { file: file.to_owned(), text: text.to_owned(), entries: scanner.entries }
    }

    fn entry(&self, path: &str) -> Option<&Entry> {
        self.entries.iter().find(|e| e.path == path)
    }

    /// The name of the file.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The place of a field; of a field the text leaves out, the nearest section around it.
    pub fn place(&self, path: &str) -> Place {
        let mut sections =
            std::iter::successors(Some(path), |path| Some(&path[..path.rfind(['.', '['])?]));
        let place = match sections.find_map(|path| self.entry(path)) {
            Some(entry) => self.place_of_byte(entry.start),
            None => Place::file(&self.file),
        };
        place.field(path)
    }

    /// Line of a field, from 1, if the text has it.
    pub fn line(&self, path: &str) -> Option<usize> {
        self.place_of_byte(self.entry(path)?.start).line
    }

    /// The text of a field's value.
    pub fn value_text(&self, path: &str) -> Option<&str> {
        self.entry(path).map(|e| self.text(&e.value))
    }

    /// Whether the text has a field.
    pub fn contains(&self, path: &str) -> bool {
        self.entry(path).is_some()
    }

    /// The text with another value of a field. A field that the text leaves out is written into the nearest group
    /// around it; whether it belongs there, the reader of the text says. None where there is no such group.
    pub fn with_value(&self, path: &str, value: &str) -> Option<String> {
        if let Some(entry) = self.entry(path) {
            let (before, after) = (&self.text[..entry.value.start], &self.text[entry.value.end..]);
            return Some(format!("{before}{value}{after}"));
        }
        let (group, name) = path.rsplit_once('.').unwrap_or(("", path));
        // an element cannot be added in the middle of a list
        if name.is_empty() || name.contains(['[', ']']) {
            return None;
        }
        let inside = if group.is_empty() {
            self.entries.iter().map(|entry| entry.start).min()?
        } else if let Some(entry) = self.entry(group) {
            entry.value.start + self.text(&entry.value).find('(')? + 1
        } else {
            return self.with_value(group, &format!("({name}: {value})"));
        };
        let (before, after) = (self.text.get(..inside)?, self.text.get(inside..)?);
        Some(format!("{before}{name}: {value}, {after}"))
    }

    /// The text without a field; none if it has no such field.
    pub fn without(&self, path: &str) -> Option<String> {
        let entry = self.entry(path)?;
        let (before, after) = (self.text.get(..entry.start)?, self.text.get(entry.value.end..)?);
        let after = after.trim_start();
        Some(format!("{before}{}", after.strip_prefix(',').unwrap_or(after)))
    }

    /// Gives a field, and all inside it, another path.
    pub fn rename(&mut self, before: &str, now: &str) {
        for entry in &mut self.entries {
            if let Some(rest) = entry.path.strip_prefix(before)
                && (rest.is_empty() || rest.starts_with(['.', '[']))
            {
                entry.path = format!("{now}{rest}");
            }
        }
    }

    /// The place of a byte.
    pub(crate) fn place_of_byte(&self, byte: usize) -> Place {
        let before = &self.text.as_bytes()[..byte];
        let lines = before.split(|b| *b == b'\n');
        let last = lines.clone().next_back().unwrap_or_default();
        let column = String::from_utf8_lossy(last).chars().count() + 1;
        Place::at(&self.file, lines.count(), column)
    }

    /// The byte of a line and column, both from 1.
    pub(crate) fn byte(&self, line: usize, column: usize) -> usize {
        let lines_before = self.text.split_inclusive('\n').take(line.saturating_sub(1));
        let start = lines_before.map(str::len).sum();
        let into = self.text[start..].char_indices().nth(column.saturating_sub(1));
        into.map_or(self.text.len(), |(i, _)| start + i)
    }

    /// The text of a range of bytes.
    pub(crate) fn text(&self, bytes: &Range<usize>) -> &str {
        self.text.get(bytes.clone()).unwrap_or_default()
    }

    /// The innermost entry around a range of bytes.
    pub(crate) fn innermost(&self, bytes: &Range<usize>) -> Option<&Entry> {
        self.entries
            .iter()
            .filter(|e| e.start <= bytes.start && bytes.end <= e.value.end)
            .min_by_key(|e| e.value.end - e.start)
    }
}

/// Deepest nesting followed; no file of this program comes near.
const DEEPEST: usize = 100;

struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    entries: Vec<Entry>,
    depth: usize,
}

impl Scanner<'_> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Skips blanks, comments and `#![enable(...)]`.
    fn skip_blank(&mut self) {
        loop {
            let rest = self.bytes.get(self.at..).unwrap_or_default();
            match rest {
                [b' ' | b'\t' | b'\r' | b'\n', ..] => self.at += 1,
                [b'/', b'/', ..] | [b'#', ..] => {
                    self.at += rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
                }
                [b'/', b'*', ..] => self.skip_block_comment(),
                _ => return,
            }
        }
    }

    /// Block comments of RON nest.
    fn skip_block_comment(&mut self) {
        let mut depth = 0;
        while self.at < self.bytes.len() {
            match &self.bytes[self.at..] {
                [b'/', b'*', ..] => (depth, self.at) = (depth + 1, self.at + 2),
                [b'*', b'/', ..] => {
                    (depth, self.at) = (depth - 1, self.at + 2);
                    if depth == 0 {
                        return;
                    }
                }
                _ => self.at += 1,
            }
        }
    }

    /// Walks one value whose path is `path`; leaves `at` behind it.
    fn value(&mut self, path: &str) {
        if self.depth > DEEPEST {
            self.at = self.bytes.len();
            return;
        }
        self.depth += 1;
        match self.peek() {
            Some(b'(') => self.items(path, b')'),
            Some(b'[') => self.items(path, b']'),
            Some(b'{') => self.items(path, b'}'),
            Some(quote @ (b'"' | b'\'')) => self.quoted(quote),
            Some(_) => {
                self.word();
                let end = self.at;
                self.skip_blank();
                if self.peek() == Some(b'(') {
                    self.items(path, b')');
                } else {
                    self.at = end;
                }
            }
            None => {}
        }
        self.depth -= 1;
    }

    /// A number, an identifier or a raw string.
    fn word(&mut self) {
        let start = self.at;
        while let Some(b) = self.peek() {
            match b {
                b'"' => return self.raw_string(start),
                b'#' if self.bytes[start] == b'r' => self.at += 1,
                b if b.is_ascii_alphanumeric() || b"_.+-".contains(&b) || b >= 0x80 => self.at += 1,
                _ => break,
            }
        }
        // whatever this is, step over it
        if self.at == start {
            self.at += 1;
        }
    }

    /// A string or character between quotes.
    fn quoted(&mut self, quote: u8) {
        self.at += 1;
        while let Some(b) = self.peek() {
            self.at += 1;
            match b {
                // one byte on, never past the end
                b'\\' => self.at = (self.at + 1).min(self.bytes.len()),
                b if b == quote => return,
                _ => {}
            }
        }
    }

    fn raw_string(&mut self, start: usize) {
        let hashes = self.bytes[start..self.at].split(|&b| b == b'#').count() - 1;
        self.at += 1;
        let mut end = vec![b'"'];
        end.extend(std::iter::repeat_n(b'#', hashes));
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let length = rest.windows(end.len()).position(|w| w == end);
        self.at += length.map_or(rest.len(), |l| l + end.len());
    }

    /// The items between a bracket and `close`, each `key: value` or `value`.
    fn items(&mut self, path: &str, close: u8) {
        self.at += 1;
        let mut index = 0;
        loop {
            self.skip_blank();
            match self.peek() {
                Some(b) if b == close => {
                    self.at += 1;
                    return;
                }
                Some(b',') => {
                    self.at += 1;
                    continue;
                }
                None | Some(b')' | b']' | b'}') => return,
                Some(_) => {}
            }
            let start = self.at;
            let path = match self.key() {
                Some(key) if path.is_empty() => key,
                Some(key) => format!("{path}.{key}"),
                None => format!("{path}[{index}]"),
            };
            let value_start = self.at;
            let slot = self.entries.len();
            self.entries.push(Entry { path: path.clone(), start, value: value_start..value_start });
            self.value(&path);
            self.entries[slot].value = value_start..self.at;
            index += 1;
        }
    }

    /// The key of `key: value` if one stands here; `at` is then at the value.
    fn key(&mut self) -> Option<String> {
        let start = self.at;
        let key = match self.peek()? {
            b'"' => {
                self.quoted(b'"');
                self.bytes.get(start + 1..self.at.saturating_sub(1))
            }
            b if b.is_ascii_alphabetic() || b == b'_' => {
                self.word();
                self.bytes.get(start..self.at)
            }
            _ => None,
        };
        let key = key.map(|k| String::from_utf8_lossy(k).into_owned());
        self.skip_blank();
        if key.is_some() && self.peek() == Some(b':') {
            self.at += 1;
            self.skip_blank();
            return key;
        }
        self.at = start;
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "#![enable(implicit_some)]\n// a comment with rotor: (radius_m: 1)\n(\n    title: \"a (tricky: \\\" one\",\n    rotor: ( // here\n        radius_m: -4.94, /* and: /* nested */ */ blades: 4,\n    ),\n    flaps: [(start_r: 0.7), (start_r: 0.8, end_r: 0.85)],\n    trim: Propulsive(ct_sigma: 0.07), raw: r#\"x: \"y\"\"#,\n    range_V: (-20, 150), map: {\"µ\": 1, 2: 3},\n)\n";

    #[test]
    fn a_value_is_replaced_or_added_where_its_group_is() {
        let text = "#![enable(implicit_some)]\n(a: 1, b: Kind(c: [2, 3]), d: \"x\", e: ())";
        let set = |path: &str, value: &str| RonIndex::new("f", text).with_value(path, value);
        assert_eq!(set("a", "(7)").unwrap(), text.replace("a: 1", "a: (7)"));
        assert_eq!(set("b.c[1]", "4").unwrap(), text.replace('3', "4"));
        assert_eq!(set("b.n", "4").unwrap(), text.replace("Kind(", "Kind(n: 4, "));
        assert_eq!(set("e.n.m", "4").unwrap(), text.replace("e: (", "e: (n: (m: 4), "));
        assert_eq!(set("n", "4").unwrap(), text.replace("(a", "(n: 4, a"));
        for path in ["b.c[2]", "a.n", "", "b."] {
            assert_eq!(set(path, "4"), None, "{path}");
        }
    }

    #[test]
    fn a_field_goes_with_its_comma() {
        let without = |text: &str, path| RonIndex::new("a", text).without(path);
        let text = "(a: 1, b: (c: [2, 3], d: 4), e: 5)";
        assert_eq!(without(text, "b.c").as_deref(), Some("(a: 1, b: ( d: 4), e: 5)"));
        assert_eq!(without(text, "b").as_deref(), Some("(a: 1,  e: 5)"));
        assert_eq!(without(text, "e").as_deref(), Some("(a: 1, b: (c: [2, 3], d: 4), )"));
        assert_eq!(without(text, "f"), None);
    }

    #[test]
    fn every_field_has_its_line_and_column() {
        let index = RonIndex::new("case.ron", TEXT);
        let at = |path: &str| {
            let p = index.place(path);
            (p.line.unwrap(), p.column.unwrap())
        };
        assert_eq!(at("title"), (4, 5));
        assert_eq!(at("rotor.radius_m"), (6, 9));
        assert_eq!(at("rotor.blades"), (6, 50));
        assert_eq!(at("flaps[1].end_r"), (8, 44));
        assert_eq!(at("trim.ct_sigma"), (9, 22));
        assert_eq!(at("range_V[1]"), (10, 20));
        assert_eq!(at("map.µ"), (10, 32));
        assert_eq!(index.line("rotor.chord_r"), None);
        // a field left out is reported at its section, or at the file
        assert_eq!(at("rotor.chord_r"), (5, 5));
        assert_eq!(index.place("inflow").line, None);
    }

    #[test]
    fn malformed_text_is_indexed_up_to_the_flaw() {
        for cut in 0..TEXT.len() {
            let Some(text) = TEXT.get(..cut) else {
                continue;
            };
            let index = RonIndex::new("x", text);
            assert!(index.entries.len() <= 24);
        }
        assert!(RonIndex::new("x", "((((a: ]").contains("[0][0][0].a"));
        let deep = "(".repeat(5000);
        RonIndex::new("x", &deep);
    }

    #[test]
    fn bytes_and_places_are_inverse() {
        let index = RonIndex::new("case.ron", TEXT);
        for (byte, _) in TEXT.char_indices() {
            let place = index.place_of_byte(byte);
            assert_eq!(index.byte(place.line.unwrap(), place.column.unwrap()), byte);
        }
    }
}
