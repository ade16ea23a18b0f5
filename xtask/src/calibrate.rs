//! `cargo xtask calibrate`: poles and gains of the calibrated section model, from exact theory to its table.

use std::path::Path;

use exact_section::ExactError;
use exact_section::calibration::{Calibration, calibrate};

use crate::{XtaskError, files};

/// The file the calibration is stored in, from the root.
pub const TABLE: &str = "crates/flap-aero/src/attached/calibrated/table.in";

/// Numbers of a table that differ by more than this are different: the fit is iterative, and
/// logarithms are not the same to the last bit on every machine.
const SAME: f64 = 1e-5;

/// Fits the model anew and writes its table.
///
/// # Errors
/// [`XtaskError::Exact`] if the exact theory fails, [`XtaskError::Write`] if the file cannot be
/// written.
pub fn write(root: &Path) -> Result<Calibration, XtaskError> {
    let calibration = calibrate()?;
    files::write_atomically(&root.join(TABLE), &calibration.source())?;
    Ok(calibration)
}

/// Fits the model anew and compares with the stored table: the lines that differ.
///
/// # Errors
/// As [`write()`], and [`XtaskError::Read`] if there is no table.
pub fn check(root: &Path) -> Result<Vec<String>, XtaskError> {
    let stored = files::read(&root.join(TABLE))?;
    Ok(differences(&stored, &calibrate()?.source()))
}

/// Lines of two tables that differ by more than rounding.
fn differences(stored: &str, fitted: &str) -> Vec<String> {
    let count = stored.lines().count().max(fitted.lines().count());
    let line = |text: &str, i: usize| text.lines().nth(i).unwrap_or_default().to_owned();
    (0..count)
        .map(|i| (i + 1, line(stored, i), line(fitted, i)))
        .filter(|(_, a, b)| !same(a, b))
        .map(|(number, a, b)| {
            format!("{TABLE}:{number}: stored `{}`, fitted `{}`", a.trim(), b.trim())
        })
        .collect()
}

/// Whether two lines have the same words, and numbers near one another.
fn same(a: &str, b: &str) -> bool {
    let words = |line: &str| -> Vec<String> {
        line.split([',', '[', ']', ' ']).filter(|w| !w.is_empty()).map(str::to_owned).collect()
    };
    let (a, b) = (words(a), words(b));
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) => (x - y).abs() <= SAME,
            _ => a == b,
        })
}

impl From<ExactError> for XtaskError {
    fn from(source: ExactError) -> Self {
        Self::Exact { source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stored_table_is_what_the_fit_gives() {
        let found = check(&crate::workspace::root()).unwrap();
        assert!(found.is_empty(), "{}", found.join("\n"));
    }

    #[test]
    fn rounding_is_no_difference_and_anything_else_is() {
        let stored = "a [1.0, 2.0],\nb [3.0],";
        assert!(differences(stored, "a [1.000001, 2.0],\nb [3.0],").is_empty());
        assert_eq!(differences(stored, "a [1.001, 2.0],\nb [3.0],").len(), 1);
        assert_eq!(differences(stored, "a [1.0, 2.0],\nc [3.0],").len(), 1);
        assert_eq!(differences(stored, "a [1.0, 2.0],").len(), 1);
    }
}
