//! Bytes, words and numbers: changes that know nothing of the form of an input.

use chacha20::ChaCha8Rng;
use rand::RngExt;

/// What an input is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// Lists and fields in brackets: RON, JSON.
    Nested,
    /// Rows and cells.
    Table,
    /// Numbers of fixed width.
    Fixed,
    /// Counts, offsets and numbers in binary.
    Binary,
    /// A ZIP file of XML texts.
    Zip,
    /// A MAT file, whose elements are compressed.
    Mat,
    /// A table compressed by gzip.
    Gzip,
}

/// Words that readers stumble over; the first nine stand for numbers.
pub(super) const WORDS: [&str; 26] = [
    "-1",
    "0",
    "1e308",
    "1e-320",
    "NaN",
    "inf",
    "-inf",
    "18446744073709551616",
    "4294967295",
    "(",
    ")",
    "[",
    "]",
    "()",
    "[]",
    "\"",
    ",",
    ",,",
    ":",
    "\n",
    "\r",
    "None",
    "Some(",
    "r#\"",
    "/*",
    "\u{feff}",
];

/// A change that knows nothing of the form.
pub(super) fn of_bytes(bytes: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    let at = random.random_range(0..=bytes.len());
    let end = (at + random.random_range(1..=24_usize)).min(bytes.len());
    match random.random_range(0..7_u32) {
        0 if at < bytes.len() => bytes[at] ^= 1 << random.random_range(0..8_u32),
        1 if at < bytes.len() => bytes[at] = random.random(),
        2 => drop(bytes.drain(at..end)),
        3 => {
            let part = bytes[at..end].to_vec();
            let to = random.random_range(0..=bytes.len());
            drop(bytes.splice(to..to, part));
        }
        4 => bytes.truncate(at),
        5 => {
            let word = WORDS[random.random_range(0..WORDS.len())];
            drop(bytes.splice(at..at, word.bytes()));
        }
        _ => number(bytes, at, random),
    }
}

/// Puts another number in the place of the next one: a word, or the number itself moved, grown or with the other sign.
pub(super) fn number(bytes: &mut Vec<u8>, from: usize, random: &mut ChaCha8Rng) {
    let Some(start) = bytes[from..].iter().position(u8::is_ascii_digit).map(|i| from + i) else {
        return;
    };
    let is_number = |byte: &u8| byte.is_ascii_digit() || b".-+eE".contains(byte);
    let end = bytes[start..].iter().position(|b| !is_number(b)).map_or(bytes.len(), |i| start + i);
    let old = String::from_utf8_lossy(&bytes[start..end]).parse::<f64>().ok();
    let new = match (random.random_range(0..6_u32), old) {
        (0, Some(old)) => (old + 1.0).to_string(),
        (1, Some(old)) => (-old).to_string(),
        (2, Some(old)) => format!("{:e}", old * 10_f64.powi(random.random_range(-12..13))),
        _ => WORDS[random.random_range(0..9)].to_owned(),
    };
    drop(bytes.splice(start..end, new.into_bytes()));
}
