//! The validation page of the book: written, and compared with what it should say now.

use super::check::{COLUMNS, GOT, Repeatability, Row, TITLES};

/// Share of a bound by which a figure may differ from machine to machine without the page being stale.
const MACHINE_SCATTER: f64 = 0.01;

const INTRODUCTION: &str = "\
# Validation

<!-- Written by `cargo xtask validate`; do not edit. -->

Every row compares a quantity with something that shares no code with it: exact theory, an
independent computation, published data. `got` is what this version computes; a row without `yes`
fails the command with exit code 3. The unit holds for the columns expected, got and bound.
";

/// The page for a set of rows, which are grouped by area already.
pub fn render(rows: &[Row]) -> String {
    let mut parts = vec![INTRODUCTION.to_owned()];
    let mut heading = "";
    for row in rows {
        if row.heading != heading {
            heading = row.heading;
            parts.push(format!("\n## {heading}\n\n| {} |\n", TITLES.join(" | ")));
            parts.push(format!("|{}\n", "---|".repeat(COLUMNS)));
        }
        parts.push(format!("| {} |\n", row.cells().join(" | ")));
    }
    let passed = rows.iter().filter(|row| row.passes()).count();
    parts.push(format!("\n{passed} of {} checks passed.\n", rows.len()));
    parts.concat()
}

/// The lines of a stored page that do not say what the rows say now, each with what it should say.
///
/// Figures may differ by 1 % of their bound (rounding differs between machines), times by anything.
pub fn stale_lines(stored: &str, rows: &[Row]) -> Vec<String> {
    let fresh = render(rows);
    let (old, new): (Vec<&str>, Vec<&str>) = (stored.lines().collect(), fresh.lines().collect());
    let mut stale = Vec::new();
    for index in 0..old.len().max(new.len()) {
        let (was, is) = (old.get(index).copied(), new.get(index).copied());
        let same = match (was, is) {
            (Some(was), Some(is)) => was == is || same_row(was, is, rows),
            _ => false,
        };
        if !same {
            let is = is.unwrap_or("nothing");
            stale.push(format!(
                "line {}: stored `{}`, now `{is}`",
                index + 1,
                was.unwrap_or("nothing")
            ));
        }
    }
    stale
}

/// Whether two table lines differ in the computed figure alone, and in that by little.
fn same_row(was: &str, is: &str, rows: &[Row]) -> bool {
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let (was, is) = (cells(was), cells(is));
    if was.len() != COLUMNS || is.len() != COLUMNS {
        return false;
    }
    let Some(row) = rows.iter().find(|row| row.check.id == is[0]) else {
        return false;
    };
    let others = (0..COLUMNS).filter(|i| *i != GOT).all(|i| was[i] == is[i]);
    let close = match (was[GOT].parse::<f64>(), is[GOT].parse::<f64>()) {
        (Ok(was), Ok(is)) => (was - is).abs() <= MACHINE_SCATTER * row.check.criterion.width(),
        _ => false,
    };
    others && (close || row.check.repeatability == Repeatability::MachineDependent)
}
