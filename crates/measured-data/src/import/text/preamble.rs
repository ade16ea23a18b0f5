//! What stands above the numbers of a table: units of its columns, and the stated sampling.

use super::numbers::number;
use super::row::Row;
use crate::tables::{Dimension, Unit};

/// Words for the time between two samples, letters and digits alone.
const STEP: [&str; 18] = [
    "deltax",
    "deltat",
    "dt",
    "sampleinterval",
    "samplinginterval",
    "sampletime",
    "samplingtime",
    "sampleperiod",
    "samplingperiod",
    "scaninterval",
    "timeinterval",
    "xinc",
    "xincr",
    "xincrement",
    "increment",
    "tinc",
    "abtastintervall",
    "abtastzeit",
];
/// Words for the samples in a second.
const RATE: [&str; 10] = [
    "samplerate",
    "samplingrate",
    "samplefrequency",
    "samplingfrequency",
    "scanrate",
    "acquisitionrate",
    "fs",
    "abtastrate",
    "messrate",
    "abtastfrequenz",
];
/// Words for the units of the channels.
const UNITS: [&str; 10] = [
    "unit",
    "units",
    "yunit",
    "yunits",
    "vunit",
    "vunits",
    "yunitlabel",
    "verticalunits",
    "einheit",
    "einheiten",
];
/// Words for the unit of the time.
const TIME_UNIT: [&str; 6] =
    ["xunit", "xunits", "hunit", "hunits", "xunitlabel", "horizontalunits"];

/// A word as it is looked up: letters and digits alone, in lower case, without what stands in brackets.
pub(super) fn word(text: &str) -> String {
    let text = text.split(['(', '[']).next().unwrap_or_default();
    text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

pub(super) fn is_key(text: &str) -> bool {
    let word = word(text);
    let is = |words: &[&str]| words.contains(&word.as_str());
    is(&STEP) || is(&RATE) || is(&UNITS) || is(&TIME_UNIT)
}

pub(super) fn is_unit_key(text: &str) -> bool {
    UNITS.contains(&word(text).as_str())
}

/// The unit that a cell names, alone, in brackets or as `in V`.
pub(super) fn unit_of(text: &str) -> Option<Unit> {
    let text = text.trim().trim_matches(['(', ')', '[', ']']).trim();
    if text == "1" {
        return None;
    }
    Unit::find(text.strip_prefix("in ").unwrap_or(text).trim())
}

/// What the lines above the numbers state.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Preamble {
    /// Time between two samples, s.
    pub(super) step_s: Option<f64>,
    /// Unit of the time.
    pub(super) time_unit: Option<String>,
    /// Units of the channels, or one for all.
    pub(super) units: Vec<String>,
    /// Names of the columns, from words such as `NAME0`.
    pub(super) names: Vec<String>,
    /// Whether columns `X_Value` of a `LabVIEW` measurement hold the times, s: they say more than its one step.
    pub(super) has_times: bool,
}

impl Preamble {
    /// Reads `word: value`, `word = value` and a word beside its values; also the cells of `header` beyond the `width` of the
    /// table, a row of words and one of their values.
    pub(super) fn read(above: &[Row], decimal: char, header: [&[String]; 2], width: usize) -> Self {
        let mut found = Self::default();
        for row in above {
            let cells = row.filled();
            if let Some((key, value)) = row.text.split_once('=').filter(|_| row.is_comment) {
                found.take(key, &[value.trim().to_owned()], decimal);
                continue;
            }
            if let Some((key, value)) = row.text.split_once(':').filter(|_| row.is_comment)
                && is_key(key)
            {
                found.take(key, &[value.trim().to_owned()], decimal);
                continue;
            }
            for (i, cell) in cells.iter().enumerate() {
                match cell.split_once(['=', ':']) {
                    Some((key, value)) if !value.trim().is_empty() => {
                        let behind = cells.get(i + 1).filter(|next| parts_number(value, next));
                        let values = std::iter::once(value).chain(behind.map(String::as_str));
                        let values: Vec<String> = values.map(str::to_owned).collect();
                        found.take(key, &values, decimal);
                    }
                    _ if i == 0 => found.take(cell, &cells[1..], decimal),
                    _ => {}
                }
            }
        }
        let [words, values] = header.map(|cells| cells.get(width..).unwrap_or_default());
        for (key, value) in words.iter().zip(values) {
            found.take(key, std::slice::from_ref(value), decimal);
        }
        found
    }

    fn take(&mut self, key: &str, values: &[String], decimal: char) {
        let is = |words: &[&str]| words.contains(&word(key).as_str());
        let is_name =
            word(key).strip_prefix("name").is_some_and(|number| number.parse::<u8>().is_ok());
        let quantity = || {
            let at = values.iter().position(|v| !v.is_empty())?;
            // a comma of thousands has parted the number
            let is_parted = values.get(at + 1).is_some_and(|next| parts_number(&values[at], next));
            quantity(&values[at], key, decimal).filter(|_| !is_parted)
        };
        let positive = |value: f64| Some(value).filter(|v| *v > 0.0 && v.is_finite());
        if is(&["xcolumns"]) {
            self.has_times |=
                values.iter().any(|own| matches!(word(own).as_str(), "one" | "multi"));
        } else if is_name {
            self.names.extend(values.first().cloned());
        } else if is(&STEP) && self.step_s.is_none() {
            self.step_s = quantity().and_then(|q| positive(q.step_s(false)));
        } else if is(&RATE) && self.step_s.is_none() {
            self.step_s = quantity().and_then(|q| positive(q.step_s(true)));
        } else if is(&TIME_UNIT) && self.time_unit.is_none() {
            let unit = values.iter().find_map(|value| unit_of(value));
            let unit = unit.filter(|unit| unit.dimension == Dimension::Time);
            self.time_unit = unit.map(|unit| unit.symbol.to_owned());
        } else if is(&UNITS) && self.units.is_empty() {
            let known = values.iter().filter(|v| !v.is_empty()).map(|v| unit_of(v));
            let known = known.map(|unit| Some(unit?.symbol.to_owned()));
            self.units = known.collect::<Option<Vec<_>>>().unwrap_or_default();
        }
    }

    /// The unit of a channel among some.
    pub(super) fn unit(&self, place: usize, channels: usize) -> Option<String> {
        match &self.units[..] {
            [one] => Some(one.clone()),
            all if all.len() == channels => all.get(place).cloned(),
            _ => None,
        }
    }
}

/// Whether a cell goes on with the number of the one before: `1` and `000 Hz`, but not twice the same number.
fn parts_number(value: &str, next: &str) -> bool {
    let (value, next) = (value.trim(), next.trim());
    let digits = next.bytes().take_while(u8::is_ascii_digit).count();
    let leads = (1..=3).contains(&value.len()) && value.bytes().all(|b| b.is_ascii_digit());
    leads && digits == 3 && value != next
}

/// A time, s, or a rate, Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quantity {
    Time(f64),
    Rate(f64),
    /// No unit stands beside it.
    Bare(f64),
}

impl Quantity {
    /// The step that it is, s: its unit says so, or else its word, which is that of a rate or not.
    fn step_s(self, word_is_rate: bool) -> f64 {
        match self {
            Self::Time(s) => s,
            Self::Rate(hz) => 1.0 / hz,
            Self::Bare(value) if word_is_rate => 1.0 / value,
            Self::Bare(value) => value,
        }
    }
}

/// The number with the unit behind it, or with that in the brackets of its word; none where digits are left behind it.
fn quantity(text: &str, key: &str, decimal: char) -> Option<Quantity> {
    let text = text.rsplit(':').next().unwrap_or(text).trim();
    let ends = (1..=text.len().min(40)).rev().filter(|end| text.is_char_boundary(*end));
    let (value, unit) = ends.map(|end| text.split_at(end)).find_map(|(value, unit)| {
        let value = number(value.trim(), decimal).or_else(|| number(value.trim(), '.'))?;
        value.is_finite().then_some((value, unit.trim()))
    })?;
    let in_key = || Some(key.split_once(['(', '['])?.1.trim_end_matches([')', ']']).trim());
    if unit.starts_with(|c: char| c.is_ascii_digit() || matches!(c, ',' | '.' | '\'')) {
        return None;
    }
    let unit = if unit.is_empty() { in_key().unwrap_or_default() } else { unit };
    let unit = unit.split([',', ' ']).next().unwrap_or_default();
    Some(match unit.to_lowercase().as_str() {
        "" => Quantity::Bare(value),
        "hz" | "s/s" | "sa/s" | "1/s" | "sps" => Quantity::Rate(value),
        "khz" | "ks/s" | "ksa/s" => Quantity::Rate(1e3 * value),
        "mhz" | "ms/s" | "msa/s" => Quantity::Rate(1e6 * value),
        _ => {
            let unit = Unit::find(unit).filter(|own| own.dimension == Dimension::Time)?;
            Quantity::Time(value * unit.to_si)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_rates_are_what_their_units_say() {
        for (text, key, decimal, expected) in [
            ("200 Hz", "Sample rate", '.', Some(Quantity::Rate(200.0))),
            ("10 ms", "Sample rate", '.', Some(Quantity::Time(0.01))),
            ("51.2 kHz", "Rate", '.', Some(Quantity::Rate(51_200.0))),
            ("0,005", "Delta_X", ',', Some(Quantity::Bare(0.005))),
            ("5", "Interval (ms)", '.', Some(Quantity::Time(0.005))),
            // a separator of thousands, or decimals of three digits
            ("1,000 Hz", "Sample rate", '.', None),
            ("10,000", "Sample rate", '.', None),
            ("51.200 Hz", "Sample rate", ',', Some(Quantity::Rate(51.2))),
        ] {
            let found = quantity(text, key, decimal);
            let close = |a: Quantity, b: Quantity| match (a, b) {
                (Quantity::Time(a), Quantity::Time(b))
                | (Quantity::Rate(a), Quantity::Rate(b))
                | (Quantity::Bare(a), Quantity::Bare(b)) => (a - b).abs() < 1e-9 * b,
                _ => false,
            };
            let same = match (found, expected) {
                (Some(a), Some(b)) => close(a, b),
                (a, b) => a == b,
            };
            assert!(same, "{text}: {found:?}");
        }
        assert!((Quantity::Time(0.01).step_s(true) - 0.01).abs() < 1e-12);
        assert!((Quantity::Rate(200.0).step_s(false) - 0.005).abs() < 1e-12);
        assert!((Quantity::Bare(200.0).step_s(true) - 0.005).abs() < 1e-12);
    }

    #[test]
    fn a_rate_that_a_comma_has_parted_is_no_rate() {
        let row = |cells: &[&str]| {
            let mut found = Preamble::default();
            let cells: Vec<String> = cells.iter().map(|cell| (*cell).to_owned()).collect();
            found.take(&cells[0], &cells[1..], '.');
            found.step_s
        };
        assert_eq!(row(&["Sample rate", "1", "000 Hz"]), None);
        assert!(row(&["Sample rate", "100", "100"]).is_some_and(|s| (s - 0.01).abs() < 1e-12));
    }
}
