//! A stored result checked against itself: every figure computed again from what it holds raw.

use crate::SimError;
use crate::raw::Setting;
use crate::report::StudyReport;
use crate::results::{RunResult, StoredResult, json_key, key_of_version};
use crate::study::{PagePart, study_report};
use serde::Serialize;
use serde_json::Value;
use std::fmt;

/// What was computed again and how well it agrees.
#[derive(Debug, Clone, PartialEq)]
pub struct Recomputed {
    /// The result with its figures computed anew.
    pub stored: StoredResult<RunResult>,
    /// Reductions computed again: of controls, forecasts, sensitivities and robustness.
    pub reductions: usize,
    /// Numbers compared in all.
    pub numbers: usize,
    /// Largest difference of a reduction from the stored one, percentage points.
    pub largest_difference: f64,
}

/// Relative difference that the digits of a stored number, and another processor's, leave.
const ROUNDING: f64 = 1e-9;
/// The same of angles and percentages, which may be differences of large numbers.
const ROUNDING_OF_UNITS: f64 = 1e-9;
/// The same of residuals, which are differences of numbers of order 1.
const ROUNDING_OF_RESIDUALS: f64 = 1e-12;

/// Computes every figure of a stored result from the loads, controls, motions and T matrices in it and compares.
///
/// The weights follow from the case (given, or over the squared loads without control), the case from its key.
///
/// # Errors
/// [`SimError::NotReproduced`] for the first figure that does not follow, with its field.
pub fn recomputed(stored: StoredResult<RunResult>, file: &str) -> Result<Recomputed, SimError> {
    let version = stored.program.strip_prefix("hhc ").unwrap_or_default();
    let key = key_of_version(version, &stored.case, &stored.inputs)?;
    // what an older program canonised in its own way cannot be keyed again
    let of_version = version == crate::VERSION;
    if of_version && key != stored.key {
        let field = "key (of the case and its inputs)".to_owned();
        return Err(changed(file, field, stored.key, key));
    }
    let result = &stored.result;
    let setting = Setting::of_file(&stored.case, &result.baseline.hub_nb_per_rev)
        .map_err(|e| changed(file, "case.rotor".to_owned(), e.to_string(), String::new()))?;
    let anew = result.refigured(&setting);
    let numbers = compared_fields(result, &anew, (file, "result"))?;
    let found = json_key(result)?;
    let keyed = stored.result_key.as_ref();
    if keyed.map_or(of_version, |key| *key != found) {
        let field = "result_key (of what the figures are computed from)".to_owned();
        return Err(changed(file, field, keyed.cloned().unwrap_or_default(), found));
    }
    let mut largest_difference = 0.0_f64;
    for (then, now) in result.control.iter().zip(&anew.control) {
        let apart = (then.reduction_percent - now.reduction_percent).abs();
        largest_difference = largest_difference.max(apart);
    }
    let reductions = anew.control.len()
        + 3 * anew.forecasts.len()
        + anew.sensitivity.iter().map(|row| row.reduction_percent.len()).sum::<usize>()
        + 2 * anew.robustness.len();
    let stored = StoredResult { result: anew, ..stored };
    Ok(Recomputed { stored, reductions, numbers, largest_difference })
}

/// Names of the two files of a run that a report is made from.
pub const RESULT_FILE: &str = "result.json";
/// The numbers that a report shows.
pub const STUDY_FILE: &str = "study.json";

/// Checks a stored result and the report shown of it; the report as it follows from the result.
///
/// # Errors
/// [`SimError::NotReproduced`] for the first field that does not follow.
pub fn reproduced(
    shown: &StudyReport,
    stored: StoredResult<RunResult>,
) -> Result<(Recomputed, StudyReport), SimError> {
    let checked = recomputed(stored, RESULT_FILE)?;
    let page = PagePart::of(shown);
    let (key, found) = (checked.stored.page_key.clone().unwrap_or_default(), page.key()?);
    if key != found {
        let field = "title, setting, data_title, fits or loops".to_owned();
        return Err(changed(STUDY_FILE, field, format!("of key {found}"), format!("key {key}")));
    }
    let report = study_report(&checked.stored, page);
    compared_fields(shown, &report, (STUDY_FILE, "report"))?;
    Ok((checked, report))
}

/// Compares what a file holds with what was computed again; the count of numbers.
///
/// # Errors
/// [`SimError::NotReproduced`] for the first field that differs.
pub fn compared_fields<T: Serialize>(
    stored: &T,
    anew: &T,
    (file, root): (&str, &str),
) -> Result<usize, SimError> {
    let value = |of: &T| {
        serde_json::to_value(of)
            .map_err(|e| SimError::NotWritten { path: "JSON".into(), reason: e.to_string() })
    };
    let mut numbers = 0;
    same(&value(stored)?, &value(anew)?, root.to_owned(), &mut numbers)
        .map_err(|(field, stored, anew)| changed(file, field, stored, anew))?;
    Ok(numbers)
}

/// Compares a table as text, line by line.
///
/// # Errors
/// [`SimError::NotReproduced`] for the first cell that differs.
pub fn compared_table(stored: &str, anew: &str, file: &str) -> Result<(), SimError> {
    let header = cells_of(anew.lines().next().unwrap_or_default());
    let (mut then, mut now) = (stored.lines(), anew.lines());
    let mut line = 0;
    loop {
        line += 1;
        let (then, now) = match (then.next(), now.next()) {
            (None, None) => return Ok(()),
            (then, now) => (then.unwrap_or_default(), now.unwrap_or_default()),
        };
        if then == now {
            continue;
        }
        let (stored, anew) = (cells_of(then), cells_of(now));
        let mut cells = stored.into_iter().zip(anew).zip(&header);
        let first = cells.find(|((a, b), _)| a != b);
        let name = first.map_or("", |(_, name)| *name);
        let (a, b) = first.map_or((then, now), |(pair, _)| pair);
        return Err(changed(file, format!("line {line} {name}"), a.to_owned(), b.to_owned()));
    }
}

/// The cells of a line: commas between quotation marks part nothing.
fn cells_of(line: &str) -> Vec<&str> {
    let mut is_quoted = false;
    line.split(|c: char| {
        is_quoted ^= c == '"';
        c == ',' && !is_quoted
    })
    .collect()
}

/// A field that does not follow.
pub fn changed(file: &str, field: String, stored: String, recomputed: String) -> SimError {
    SimError::NotReproduced { file: file.to_owned(), field, stored, recomputed }
}

type Apart = (String, String, String);

/// Walks two trees side by side.
fn same(a: &Value, b: &Value, at: String, numbers: &mut usize) -> Result<(), Apart> {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
            for name in names {
                let none = Value::Null;
                let (a, b) = (a.get(name).unwrap_or(&none), b.get(name).unwrap_or(&none));
                same(a, b, format!("{at}.{name}"), numbers)?;
            }
            Ok(())
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (k, (a, b)) in a.iter().zip(b).enumerate() {
                same(a, b, format!("{at}[{k}]"), numbers)?;
            }
            Ok(())
        }
        (Value::Number(x), Value::Number(y)) => {
            *numbers += 1;
            let (x, y) = (x.as_f64().unwrap_or(f64::NAN), y.as_f64().unwrap_or(f64::NAN));
            let field = at.rsplit('.').next().unwrap_or_default();
            let of_units = field.contains("_deg")
                || field.contains("percent")
                || (field.ends_with("_V") && !field.contains("per_V"));
            let floor = match field {
                "kkt_residual" => ROUNDING_OF_RESIDUALS,
                _ if of_units => ROUNDING_OF_UNITS,
                _ => 0.0,
            };
            let room = (ROUNDING * x.abs().max(y.abs())).max(floor);
            if (x - y).abs() <= room { Ok(()) } else { Err((at, a.to_string(), b.to_string())) }
        }
        _ if a == b => Ok(()),
        _ => Err((at, short(a), short(b))),
    }
}

/// A value without its depths.
fn short(value: &Value) -> String {
    match value {
        Value::Array(items) => format!("{} entries", items.len()),
        Value::Object(_) => "an object".to_owned(),
        other => other.to_string(),
    }
}

impl fmt::Display for Recomputed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} reductions computed again from the stored loads, controls and T matrices, largest difference {:.1e} points; {} numbers agree",
            self.reductions, self.largest_difference, self.numbers
        )
    }
}

#[cfg(test)]
#[path = "recompute_tests.rs"]
mod tests;
