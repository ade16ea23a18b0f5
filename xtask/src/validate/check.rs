//! A check: a quantity with an independent reference and a bound, and what became of it.

use super::CheckError;

/// How far a quantity may be from its reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Criterion {
    /// Near a reference value.
    Near {
        /// The reference value.
        expected: f64,
        /// Largest distance, in the unit of the quantity.
        within: f64,
    },
    /// Not above a limit: errors and residuals.
    AtMost(f64),
    /// Not below a limit: what must be visibly wrong without the effect.
    AtLeast(f64),
    /// In an interval: orders of convergence.
    Between(f64, f64),
}

impl Criterion {
    /// Whether a value passes; a NaN does not.
    pub fn admits(&self, got: f64) -> bool {
        match *self {
            Self::Near { expected, within } => (got - expected).abs() <= within,
            Self::AtMost(limit) => got <= limit,
            Self::AtLeast(limit) => got >= limit,
            Self::Between(low, high) => (low..=high).contains(&got),
        }
    }

    /// The width against which changes from machine to machine are judged.
    pub fn width(&self) -> f64 {
        match *self {
            Self::Near { within, .. } => within,
            Self::AtMost(limit) | Self::AtLeast(limit) => limit.abs(),
            Self::Between(low, high) => 0.5 * (high - low),
        }
    }

    /// Reference value and bound as the page shows them.
    pub(super) fn shown(&self) -> [String; 2] {
        match *self {
            Self::Near { expected, within } => {
                [precise(expected, within), format!("± {}", figure(within))]
            }
            Self::AtMost(limit) => ["0".to_owned(), format!("≤ {}", figure(limit))],
            Self::AtLeast(limit) => ["–".to_owned(), format!("≥ {}", figure(limit))],
            Self::Between(low, high) => {
                ["–".to_owned(), format!("{} to {}", figure(low), figure(high))]
            }
        }
    }
}

/// Whether a figure is the same on every machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Repeatability {
    /// Up to rounding.
    Everywhere,
    /// A time: shown, judged, and never a reason to call the page stale.
    MachineDependent,
}

/// A quantity with its reference, its bound and the way to compute it.
#[derive(Debug, Clone, Copy)]
pub struct Check {
    /// Id, `V-AREA-NN`; never used again for another check.
    pub id: &'static str,
    /// What is measured.
    pub quantity: &'static str,
    /// Unit of value and bound.
    pub unit: &'static str,
    /// Where the reference is from.
    pub source: &'static str,
    /// The bound.
    pub criterion: Criterion,
    /// Whether the figure is the same everywhere.
    pub repeatability: Repeatability,
    /// Computes the quantity.
    pub measure: fn() -> Result<f64, CheckError>,
}

impl Check {
    /// A figure that is shown, not asked for: the check is that it stays what was computed when it was written down.
    pub(super) const fn shown(
        id: &'static str,
        quantity: &'static str,
        [unit, source]: [&'static str; 2],
        [written, within]: [f64; 2],
        measure: fn() -> Result<f64, CheckError>,
    ) -> Self {
        Self {
            id,
            quantity,
            unit,
            source,
            criterion: Criterion::Near { expected: written, within },
            repeatability: Repeatability::MachineDependent,
            measure,
        }
    }
}

/// A check that is the same on every machine: id, quantity, unit, reference and bound, way to compute it.
pub(super) const fn everywhere(
    id: &'static str,
    quantity: &'static str,
    unit: &'static str,
    (source, criterion): (&'static str, Criterion),
    measure: fn() -> Result<f64, CheckError>,
) -> Check {
    let repeatability = Repeatability::Everywhere;
    Check { id, quantity, unit, source, criterion, repeatability, measure }
}

/// The checks of one crate.
#[derive(Debug, Clone, Copy)]
pub struct Area {
    /// Heading on the page.
    pub heading: &'static str,
    /// The checks, in the order of the page.
    pub checks: &'static [Check],
}

/// A check that has been done.
#[derive(Debug)]
pub struct Row {
    /// Heading of its area.
    pub heading: &'static str,
    /// The check.
    pub check: Check,
    /// The quantity as computed.
    pub got: Result<f64, CheckError>,
}

impl Row {
    /// Does a check.
    pub fn of(heading: &'static str, check: Check) -> Self {
        Self { heading, got: (check.measure)(), check }
    }

    /// Whether the quantity was computed and keeps its bound.
    pub fn passes(&self) -> bool {
        self.got.as_ref().is_ok_and(|got| self.check.criterion.admits(*got))
    }

    /// The cells of the table: id, quantity, unit, expected, got, bound, pass, source.
    pub(super) fn cells(&self) -> [String; COLUMNS] {
        let [expected, bound] = self.check.criterion.shown();
        let got = match &self.got {
            Ok(value) => match self.check.criterion {
                Criterion::Near { within, .. } => precise(*value, within),
                _ => figure(*value),
            },
            Err(_) => "not computed".to_owned(),
        };
        [
            self.check.id.to_owned(),
            self.check.quantity.to_owned(),
            self.check.unit.to_owned(),
            expected,
            got,
            bound,
            if self.passes() { "yes" } else { "**no**" }.to_owned(),
            self.check.source.to_owned(),
        ]
    }
}

/// Columns of the table.
pub(super) const COLUMNS: usize = 8;

/// Column of the computed quantity.
pub(super) const GOT: usize = 4;

/// Titles of the columns.
pub(super) const TITLES: [&str; COLUMNS] =
    ["id", "quantity", "unit", "expected", "got", "bound", "pass", "source"];

/// A number with three significant digits, without zeros that say nothing.
pub(super) fn figure(value: f64) -> String {
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

    #[test]
    fn bounds_hold_on_their_side_and_refuse_what_is_no_number() {
        let criteria = [
            (Criterion::Near { expected: 2.0, within: 0.5 }, 2.5, 1.4),
            (Criterion::AtMost(1.0), -3.0, 1.1),
            (Criterion::AtLeast(1.0), 3.0, 0.9),
            (Criterion::Between(15.0, 17.0), 16.0, 17.1),
        ];
        for (criterion, good, bad) in criteria {
            assert!(criterion.admits(good) && !criterion.admits(bad), "{criterion:?}");
            assert!(!criterion.admits(f64::NAN), "{criterion:?}");
            assert!(criterion.width() > 0.0);
        }
    }
}
