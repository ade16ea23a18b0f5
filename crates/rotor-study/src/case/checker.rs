//! Collects every value of a case that is out of range, with the path of its field.

use super::field::{Field, Section, Value, Visitor};
use super::{CaseFault, CaseFaults, FieldFault};

/// Walks over a case, checks values against their ranges, and collects what fails.
#[derive(Default)]
pub(super) struct Checker {
    path: Vec<String>,
    faults: Vec<FieldFault>,
}

impl Visitor for Checker {
    fn field<T: Value>(&mut self, field: &Field, value: &T) {
        self.path.push(field.key.to_owned());
        if let Some(fault) = value.fault(field) {
            let field = self.path.join(".");
            self.faults.push(FieldFault { field, fault });
        }
        value.inside(self);
        self.path.pop();
    }

    fn section<T: Section>(&mut self, _: &str, section: &T) {
        section.each(self);
    }

    fn item<T: Section>(&mut self, index: usize, section: &T) {
        let list = self.path.pop().unwrap_or_default();
        self.path.push(format!("{list}[{index}]"));
        section.each(self);
        self.path.pop();
        self.path.push(list);
    }
}

/// A number with its field, unit and remedy.
#[derive(Clone, Copy)]
pub(super) struct Number<'a> {
    pub(super) field: &'a str,
    pub(super) value: f64,
    pub(super) unit: &'static str,
    pub(super) remedy: &'static str,
}

/// A number with its field, unit and remedy.
pub(super) fn number<'a>(
    field: &'a str,
    value: f64,
    unit: &'static str,
    remedy: &'static str,
) -> Number<'a> {
    Number { field, value, unit, remedy }
}

impl Checker {
    pub(super) fn fault(&mut self, field: &str, fault: CaseFault) {
        self.faults.push(FieldFault { field: field.to_owned(), fault });
    }

    /// A value that no rotor or no model can have: why, and what to do.
    pub(super) fn refuse(&mut self, field: &str, message: impl Into<String>) {
        self.fault(field, CaseFault::Refused { message: message.into() });
    }

    /// Two fields that do not go together.
    pub(super) fn conflict(&mut self, field: &str, rule: &'static str) {
        self.fault(field, CaseFault::Conflict { rule });
    }

    /// A number from `low` to `high`, both included; NaN is outside.
    pub(super) fn within(&mut self, number: Number<'_>, low: f64, high: f64) {
        let Number { field, value, unit, remedy } = number;
        if !(value >= low && value <= high) {
            self.fault(field, CaseFault::OutOfRange { value, low, high, unit, remedy });
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
            self.fault(field, CaseFault::CountOutOfRange { value, low, high, remedy });
        }
    }

    pub(super) fn finish(self) -> Result<(), CaseFaults> {
        if self.faults.is_empty() { Ok(()) } else { Err(CaseFaults(self.faults)) }
    }
}
