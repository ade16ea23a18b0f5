//! Collects every value of a case that is out of range, with the path of its field.

use crate::field::{Field, Section, Value, Visitor};
use crate::{Case, CaseFault, CaseFaults, FieldFault};

/// Walks over a case, checks values against their ranges, and collects what fails.
pub(super) struct Checker {
    /// Root of the blade, R: where tables along the span begin.
    root_r: f64,
    path: Vec<String>,
    faults: Vec<FieldFault>,
}

impl Visitor for Checker {
    fn field<T: Value>(&mut self, field: &Field, value: &T) {
        self.path.push(field.key.to_owned());
        let path = self.path.join(".");
        self.found(&path, value.fault(field));
        if let Some(table) = value.table() {
            self.table(&path, field, table);
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

impl Checker {
    /// The faults of the values alone, apart from the rules between them.
    pub(super) fn of_values(case: &Case) -> Self {
        let root_r = case.rotor.root_offset_r;
        let mut check = Self { root_r, path: Vec::new(), faults: Vec::new() };
        case.each(&mut check);
        check
    }

    /// Takes note of what is wrong with a value, if anything is.
    pub(super) fn found(&mut self, field: &str, fault: Option<CaseFault>) {
        self.faults.extend(fault.map(|fault| FieldFault { field: field.to_owned(), fault }));
    }

    /// A value that no rotor or no model can have: why, and what to do.
    pub(super) fn refuse(&mut self, field: &str, message: impl Into<String>) {
        self.found(field, Some(CaseFault::Refused { message: message.into() }));
    }

    /// A rule between fields, or one of a list or a pair, that is broken.
    pub(super) fn broken(&mut self, field: &str, message: impl Into<String>) {
        self.found(field, Some(CaseFault::Rule { message: message.into() }));
    }

    /// A number from `low` to `high`, both included; NaN is outside.
    pub(super) fn within(
        &mut self,
        field: &str,
        value: f64,
        range: (f64, f64),
        unit: &'static str,
        remedy: &'static str,
    ) {
        self.found(field, CaseFault::of_number(value, range, unit, remedy));
    }

    /// A count from `low` to `high`.
    pub(super) fn count(
        &mut self,
        field: &str,
        value: usize,
        range: (usize, usize),
        remedy: &'static str,
    ) {
        self.found(field, CaseFault::of_count(value, range, remedy));
    }

    /// Stations that grow, cover the blade and hold values that a blade can have.
    fn table(&mut self, path: &str, field: &Field, table: &[(f64, f64)]) {
        let (root, mut before) = (self.root_r, 0.0);
        for (i, &(station, value)) in table.iter().enumerate() {
            let at = format!("{path}[{i}]");
            if let Some(first) = table[..i].iter().position(|(s, _)| (s - station).abs() < 1e-12) {
                let message = format!(
                    "the station {station} R is given twice, as number {} and number {} of the list; give each once, a jump as two stations a little apart, such as {station} and {}",
                    first + 1,
                    i + 1,
                    station + 1e-3
                );
                self.refuse(&at, message);
            } else {
                let remedy = "list the stations from root to tip, each once";
                self.within(&at, station, (before, 1.0), "R", remedy);
            }
            before = station;
            self.found(&at, value.fault(field));
        }
        let (Some(first), Some(last)) = (table.first(), table.last()) else { return };
        if first.0 > root + 1e-9 || last.0 < 1.0 - 1e-9 || table.len() < 2 {
            let message = format!(
                "the table reaches from {} R to {} R, the blade from {root} R to 1 R; give a value at both ends",
                first.0, last.0
            );
            self.refuse(path, message);
        }
    }

    pub(super) fn finish(self) -> Result<(), CaseFaults> {
        if self.faults.is_empty() { Ok(()) } else { Err(CaseFaults(self.faults)) }
    }
}
