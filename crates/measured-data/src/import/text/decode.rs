//! Text of any usual encoding as UTF-8 lines.

use crate::problem::Fault;
use std::io::{BufRead, Cursor, Read};

/// Longest line taken for text, bytes.
const LONGEST_LINE: usize = 1 << 20;
/// Words for no number that begin as comments do.
const NO_NUMBER: [&[u8]; 12] = [
    b"#N/A", b"#NV", b"#NUM!", b"#VALUE!", b"#WERT!", b"#DIV/0!", b"#REF!", b"#BEZUG!", b"#NAME?",
    b"#NULL!", b"#ZAHL!", b"####",
];
/// Windows-1252 from 0x80 to 0x9f; what it leaves free stays a control character.
const WINDOWS: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}',
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// The byte order of UTF-16 text, by its mark or by the zeros of its first characters: `true` is little-endian.
pub(in crate::import) fn utf16(start: &[u8]) -> Option<bool> {
    match start {
        [0xff, 0xfe, ..] => return Some(true),
        [0xfe, 0xff, ..] => return Some(false),
        _ => {}
    }
    let (pairs, _) = start.as_chunks::<2>();
    let plain = |b: u8| b >= 0x20 || b.is_ascii_whitespace();
    let all = |low: usize| {
        pairs.len() > 7 && pairs.iter().all(|pair| pair[1 - low] == 0 && plain(pair[low]))
    };
    if all(0) { Some(true) } else { all(1).then_some(false) }
}

/// UTF-16 bytes as UTF-8; what is no character becomes the replacement character.
pub(in crate::import) fn from_utf16(bytes: &[u8], is_little: bool) -> String {
    let (pairs, _) = bytes.as_chunks::<2>();
    let word = |pair: &[u8; 2]| {
        if is_little { u16::from_le_bytes(*pair) } else { u16::from_be_bytes(*pair) }
    };
    let units = pairs.iter().map(word);
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

/// Lines as UTF-8 that end in `\n`: a line that is no UTF-8 is Windows-1252, of which Latin-1 is a part.
pub(super) struct Lines<R> {
    inner: R,
    /// The byte that ends a line: `\r` of old Macintosh files.
    end: u8,
    line: Cursor<Vec<u8>>,
    is_first: bool,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(mut inner: R) -> std::io::Result<Self> {
        let start = inner.fill_buf()?;
        let end = if start.contains(&b'\r') && !start.contains(&b'\n') { b'\r' } else { b'\n' };
        Ok(Self { inner, end, line: Cursor::default(), is_first: true })
    }

    fn next_line(&mut self) -> std::io::Result<Vec<u8>> {
        let mut line = Vec::new();
        let most = LONGEST_LINE as u64;
        self.inner.by_ref().take(most).read_until(self.end, &mut line)?;
        if line.len() == LONGEST_LINE && line.last() != Some(&self.end) {
            let kind = std::io::ErrorKind::InvalidData;
            return Err(std::io::Error::new(kind, "a line of more than 1 MiB is no text"));
        }
        if std::mem::take(&mut self.is_first) && line.starts_with("\u{feff}".as_bytes()) {
            line.drain(..3);
        }
        // what a spreadsheet writes for no number is no comment
        if NO_NUMBER.iter().any(|word| line.starts_with(word)) {
            line.insert(0, b' ');
        }
        // the end that DOS writes, and the zeros of a block that was not filled
        while line.last().is_some_and(|byte| matches!(byte, 0 | 0x1a)) {
            line.pop();
        }
        if let (b'\r', Some(last)) = (self.end, line.last_mut())
            && *last == b'\r'
        {
            *last = b'\n';
        }
        Ok(match String::from_utf8(line) {
            Ok(text) => text.into_bytes(),
            Err(e) => e.into_bytes().into_iter().map(windows).collect::<String>().into_bytes(),
        })
    }
}

fn windows(byte: u8) -> char {
    match byte {
        0x80..=0x9f => WINDOWS[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

impl<R: BufRead> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.fill_buf()?.read(buffer)?;
        self.consume(count);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Lines<R> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        if self.line.fill_buf()?.is_empty() {
            self.line = Cursor::new(self.next_line()?);
        }
        self.line.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.line.consume(count);
    }
}

/// Whether bytes can be text: no control characters but blanks.
pub(in crate::import) fn is_text(start: &[u8]) -> bool {
    start.iter().all(|b| *b >= 0x20 || matches!(b, b'\t' | b'\n' | b'\r' | 0x0c))
}

/// What to do with a file of a known kind that is not read; none where it may be read.
pub(in crate::import) fn foreign(start: &[u8]) -> Option<Fault> {
    let starts = |magic: &[u8]| start.starts_with(magic);
    let message = if start.is_empty() {
        "is empty: the recorder wrote nothing, or the copy failed; export or copy it again"
    } else if starts(b"\x93NUMPY") {
        "is an array of NumPy, which is not read; in Python: numpy.savetxt('file.csv', numpy.load(FILE), delimiter=','), then --columns time_s,command_V,displacement_um"
    } else if starts(b"\xd0\xcf\x11\xe0") {
        "is a workbook of old Excel (.xls), which is not read; open it and save the sheet as CSV or .xlsx"
    } else {
        match start.iter().find(|b| !b.is_ascii_whitespace()) {
            Some(b'{' | b'[') => {
                "is JSON, which is not read; in Python: pandas.read_json(FILE).to_csv('file.csv', index=False)"
            }
            Some(b'<') => "is a page or XML, no table; export the record as CSV",
            _ => return None,
        }
    };
    Some(Fault::Other(message.to_owned()))
}
