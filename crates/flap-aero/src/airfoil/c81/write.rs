//! A C81 file's text from an aerofoil.

use super::C81Airfoil;
use crate::AeroError;
use std::fmt::Write;

/// Columns of a number.
pub(super) const WIDTH: usize = 7;
/// Values on a line.
pub(super) const PER_LINE: usize = 9;
/// Columns of the name.
pub(super) const NAME: usize = 30;
/// Largest count two columns hold.
const LARGEST_COUNT: usize = 99;

/// The shortest spelling of a number, if seven columns hold it.
fn spelled(value: f64) -> Option<String> {
    // a minus zero is a zero
    let value = if value == 0.0 { 0.0 } else { value };
    let mut plain = format!("{value}");
    if !plain.contains('.') {
        plain.push('.');
    }
    let bare = plain.replacen("0.", ".", usize::from(value.abs() < 1.0 && plain.len() > 2));
    let short = if value == 0.0 { "0.".to_owned() } else { bare };
    [short, format!("{value:E}")].into_iter().find(|text| text.len() <= WIDTH)
}

/// The nearest number that seven columns hold.
fn rounded_number(value: f64) -> f64 {
    (0..=6)
        .rev()
        .filter_map(|decimals| format!("{value:.decimals$}").parse::<f64>().ok())
        .chain((0..=3).rev().filter_map(|digits| format!("{value:.digits$E}").parse().ok()))
        .filter(|near: &f64| spelled(*near).is_some())
        .min_by(|a, b| (a - value).abs().total_cmp(&(b - value).abs()))
        .unwrap_or(0.0)
}

pub(super) fn rounded(airfoil: &C81Airfoil) -> C81Airfoil {
    C81Airfoil {
        name: name(&airfoil.name).trim_end().to_owned(),
        lift: airfoil.lift.mapped(rounded_number),
        drag: airfoil.drag.mapped(rounded_number),
        moment: airfoil.moment.mapped(rounded_number),
    }
}

/// A name on one line of 30 characters.
fn name(text: &str) -> String {
    let kept: String =
        text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(NAME).collect();
    let kept = kept.trim_end();
    format!("{kept}{}", " ".repeat(NAME - kept.chars().count()))
}

pub(super) fn airfoil(airfoil: &C81Airfoil) -> Result<String, AeroError> {
    let mut text = name(&airfoil.name);
    if text.trim_end() != airfoil.name {
        return Err(AeroError::C81NotWritable {
            what: "the name: at most 30 characters, on one line",
        });
    }
    let tables = [&airfoil.lift, &airfoil.drag, &airfoil.moment];
    for table in tables {
        for count in [table.machs().len(), table.incidences_deg().len()] {
            if count > LARGEST_COUNT {
                let what = "a table of more than 99 Mach numbers or incidences";
                return Err(AeroError::C81NotWritable { what });
            }
            // writing to a string does not fail
            let _ = write!(text, "{count:2}");
        }
    }
    text.push('\n');
    for table in tables {
        line(&mut text, None, table.machs())?;
        for (i, incidence) in table.incidences_deg().iter().enumerate() {
            line(&mut text, Some(*incidence), table.row(i))?;
        }
    }
    Ok(text)
}

/// A row with its continuation lines.
fn line(text: &mut String, first: Option<f64>, values: &[f64]) -> Result<(), AeroError> {
    let field = |value: f64| {
        spelled(value)
            .map(|number| format!("{number:>WIDTH$}"))
            .ok_or(AeroError::C81NotWritable { what: "a number that seven columns do not hold" })
    };
    for (n, chunk) in values.chunks(PER_LINE).enumerate() {
        match first.filter(|_| n == 0) {
            Some(value) => text.push_str(&field(value)?),
            None => text.push_str(&" ".repeat(WIDTH)),
        }
        for value in chunk {
            text.push_str(&field(*value)?);
        }
        text.push('\n');
    }
    Ok(())
}
