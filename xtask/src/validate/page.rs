//! The validation page of the book: written, and compared with what it should say now.

use validation::{Criterion, Repeatability, Row, heading_of};

/// Share of a bound by which a figure may differ from machine to machine without the page being stale.
const MACHINE_SCATTER: f64 = 0.01;

/// Columns of the table.
const COLUMNS: usize = 8;

/// Column of the computed quantity.
const GOT: usize = 4;

/// Column of the verdict.
const PASS: usize = 6;

/// The verdict on a row that holds.
const YES: &str = "yes";

/// What a long row that was left out has in their place.
const LEFT_OUT: &str = "left out";

/// Titles of the columns.
pub(super) const TITLES: [&str; COLUMNS] =
    ["id", "quantity", "unit", "expected", "got", "bound", "pass", "source"];

const INTRODUCTION: &str = "\
# Validation

<!-- Written by `cargo xtask validate`; do not edit. -->

Every row compares a quantity with something that shares no code with it: exact theory, an
independent computation, published data. `got` is what this version computes; a row without `yes`
fails the command with exit code 3. The unit holds for the columns expected, got and bound.
";

/// The page for a set of rows in its order.
pub fn render(rows: &[Row]) -> String {
    let mut parts = vec![INTRODUCTION.to_owned()];
    let mut heading = "";
    for row in rows {
        let its = heading_of(&row.id).unwrap_or_default();
        if its != heading {
            heading = its;
            parts.push(format!("\n## {heading}\n\n| {} |\n", TITLES.join(" | ")));
            parts.push(format!("|{}\n", "---|".repeat(COLUMNS)));
        }
        parts.push(format!("| {} |\n", cells(row).join(" | ")));
    }
    // what a stored page says of a row that was left out is looked at in its line
    let passed = rows.iter().filter(|row| row.passes() || row.is_left_out).count();
    parts.push(format!("\n{passed} of {} checks passed.\n", rows.len()));
    parts.concat()
}

/// The lines of a stored page that do not say what the rows say now, each with what it should say.
///
/// Figures may differ by 1 % of their bound (rounding differs between machines), times by anything. Of a row that
/// was left out all but the figure is compared, and that it has passed.
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
    let Some(row) = rows.iter().find(|row| row.id == is[0]) else {
        return false;
    };
    let same_but = |own: &[usize]| (0..COLUMNS).all(|i| own.contains(&i) || was[i] == is[i]);
    if row.is_left_out {
        return same_but(&[GOT, PASS]) && was[PASS] == YES && was[GOT].parse::<f64>().is_ok();
    }
    let close = match (was[GOT].parse::<f64>(), is[GOT].parse::<f64>()) {
        (Ok(was), Ok(is)) => (was - is).abs() <= MACHINE_SCATTER * row.criterion.width(),
        _ => false,
    };
    same_but(&[GOT]) && (close || row.repeatability == Repeatability::MachineDependent)
}

/// The cells of the table, in the order of [`TITLES`].
pub(super) fn cells(row: &Row) -> [String; COLUMNS] {
    let [expected, bound] = shown(&row.criterion);
    let got = match (&row.got, row.criterion) {
        _ if row.is_left_out => LEFT_OUT.to_owned(),
        (Ok(value), Criterion::Near { within, .. }) => precise(*value, within),
        (Ok(value), _) => figure(*value),
        (Err(_), _) => "not computed".to_owned(),
    };
    let pass = if row.passes() {
        YES
    } else if row.is_left_out {
        LEFT_OUT
    } else {
        "**no**"
    }
    .to_owned();
    let [id, quantity, unit, source] =
        [&row.id, &row.quantity, &row.unit, &row.source].map(Clone::clone);
    [id, quantity, unit, expected, got, bound, pass, source]
}

/// Reference value and bound as the page shows them.
fn shown(criterion: &Criterion) -> [String; 2] {
    match *criterion {
        Criterion::Near { expected, within } => {
            [precise(expected, within), format!("± {}", figure(within))]
        }
        Criterion::AtMost(limit) => ["0".to_owned(), format!("≤ {}", figure(limit))],
        Criterion::AtLeast(limit) => ["–".to_owned(), format!("≥ {}", figure(limit))],
        Criterion::Between(low, high) => {
            ["–".to_owned(), format!("{} to {}", figure(low), figure(high))]
        }
    }
}

/// A number with three significant digits, without zeros that say nothing.
pub(crate) fn figure(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        let text = format!("{value:.2e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, ""));
        return format!("{}e{exponent}", without_zeros(digits)).trim_end_matches('e').to_owned();
    }
    fixed(value, 2 - exponent_of(size))
}

/// A number with one digit more than a tolerance has.
fn precise(value: f64, within: f64) -> String {
    fixed(value, 1 - exponent_of(within))
}

/// Power of ten of the leading digit.
fn exponent_of(size: f64) -> i32 {
    (-30..30).rev().find(|n| size >= 0.999_999 * 10_f64.powi(*n)).unwrap_or(-30)
}

fn fixed(value: f64, decimals: i32) -> String {
    let decimals = usize::try_from(decimals).unwrap_or(0);
    without_zeros(&format!("{value:.decimals$}")).to_owned()
}

fn without_zeros(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_short_and_readable() {
        for (value, text) in [
            (0.0, "0"),
            (15.934, "15.9"),
            (0.1, "0.1"),
            (0.004_627, "0.00463"),
            (-143.25, "-143"),
            (12_345.6, "12346"),
            (1000.0, "1000"),
            (4e-8, "4e-8"),
            (2.56e-9, "2.56e-9"),
            (2.5e-9, "2.5e-9"),
            (120.0, "120"),
            (2e6, "2e6"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(figure(value), text);
        }
        assert_eq!(precise(0.008_113_622_59, 1e-9), "0.0081136226");
        assert_eq!(precise(4.588_073, 4.6e-5), "4.588073");
        assert_eq!(precise(2.0, 0.5), "2");
    }
}
