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
fn word(text: &str) -> String {
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
            for (i, cell) in cells.iter().enumerate() {
                match cell.split_once(['=', ':']) {
                    Some((key, value)) if !value.trim().is_empty() => {
                        found.take(key, &[value.to_owned()], decimal);
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
        let quantity = || quantity(values.iter().find(|v| !v.is_empty())?, key, decimal);
        if is_name {
            self.names.extend(values.first().cloned());
        } else if is(&STEP) && self.step_s.is_none() {
            self.step_s = quantity().filter(|step| *step > 0.0 && step.is_finite());
        } else if is(&RATE) && self.step_s.is_none() {
            self.step_s = quantity().map(|hz| 1.0 / hz).filter(|s| *s > 0.0 && s.is_finite());
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

/// A time or a rate in s or Hz: the number with the unit behind it, or with that in the brackets of its word.
fn quantity(text: &str, key: &str, decimal: char) -> Option<f64> {
    let text = text.rsplit(':').next().unwrap_or(text).trim();
    let ends = (1..=text.len().min(40)).rev().filter(|end| text.is_char_boundary(*end));
    let (value, unit) = ends.map(|end| text.split_at(end)).find_map(|(value, unit)| {
        let value = number(value.trim(), decimal).or_else(|| number(value.trim(), '.'))?;
        value.is_finite().then_some((value, unit.trim()))
    })?;
    let in_key = || Some(key.split_once(['(', '['])?.1.trim_end_matches([')', ']']).trim());
    let unit = if unit.is_empty() { in_key().unwrap_or_default() } else { unit };
    let unit = unit.split([',', ' ']).next().unwrap_or_default();
    let factor = match unit.to_lowercase().as_str() {
        "" | "hz" | "s/s" | "sa/s" | "1/s" | "sps" => 1.0,
        "khz" | "ks/s" | "ksa/s" => 1e3,
        "mhz" | "ms/s" | "msa/s" => 1e6,
        _ => Unit::find(unit).filter(|own| own.dimension == Dimension::Time)?.to_si,
    };
    Some(value * factor)
}
