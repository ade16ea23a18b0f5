//! Collects every value of a case that is out of range, with its place.

use crate::files::RonIndex;
use crate::problem::{Fault, Problems};

/// Checks values against ranges and collects what fails.
pub(super) struct Checker<'a> {
    index: &'a RonIndex,
    problems: Problems,
}

/// A number with its field, unit and remedy.
#[derive(Clone, Copy)]
pub(super) struct Number<'a> {
    pub(super) field: &'a str,
    pub(super) value: f64,
    pub(super) unit: &'static str,
    pub(super) remedy: &'static str,
}

impl<'a> Checker<'a> {
    pub(super) fn new(index: &'a RonIndex) -> Self {
        Self { index, problems: Problems::default() }
    }

    pub(super) fn fault(&mut self, field: &str, fault: Fault) {
        self.problems.push(self.index.place(field), fault);
    }

    /// Line of a field, 0 if the text leaves it out.
    pub(super) fn line(&self, field: &str) -> usize {
        self.index.line(field).unwrap_or_default()
    }

    /// A number from `low` to `high`, both included; NaN is outside.
    pub(super) fn within(&mut self, number: Number<'_>, low: f64, high: f64) {
        let Number { field, value, unit, remedy } = number;
        if !(value >= low && value <= high) {
            self.fault(field, Fault::OutOfRange { value, low, high, unit, remedy });
        }
    }

    /// A positive finite number.
    pub(super) fn positive(&mut self, number: Number<'_>) {
        let Number { field, value, unit, remedy } = number;
        if !(value > 0.0 && value.is_finite()) {
            self.fault(field, Fault::NotPositive { value, unit, remedy });
        }
    }

    /// A number no larger than `most`; what is no number is for [`Self::positive`] to refuse.
    pub(super) fn no_more(&mut self, number: Number<'_>, most: f64) {
        let Number { field, value, unit, remedy } = number;
        if value.is_finite() && value > most {
            self.fault(field, Fault::Beyond { value, most, unit, remedy });
        }
    }

    /// A count from `low` to `high`.
    pub(super) fn count(
        &mut self,
        field: &str,
        value: usize,
        range: (usize, usize),
        remedy: &'static str,
    ) {
        let (low, high) = range;
        if !(low..=high).contains(&value) {
            self.fault(field, Fault::CountOutOfRange { value, low, high, remedy });
        }
    }

    pub(super) fn finish(self) -> Problems {
        self.problems
    }
}
