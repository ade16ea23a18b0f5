//! Reader of the reference tables, shared by the tests.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use num_complex::Complex64;
use std::collections::BTreeMap;

/// A table by column name; text columns (`mode`) are kept as text.
pub(crate) struct Table {
    rows: Vec<BTreeMap<String, String>>,
}

impl Table {
    /// Reads a table of `fixtures/reference/aero`.
    pub(crate) fn read(file: &str) -> Self {
        let path = format!("{}/../../fixtures/reference/aero/{file}", env!("CARGO_MANIFEST_DIR"));
        let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
        let rows: Vec<BTreeMap<String, String>> =
            reader.deserialize().map(|row| row.unwrap()).collect();
        assert!(!rows.is_empty(), "{path} is empty");
        Self { rows }
    }

    /// The rows.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(Row)
    }
}

/// One row of a table.
#[derive(Clone, Copy)]
pub(crate) struct Row<'a>(&'a BTreeMap<String, String>);

impl<'a> Row<'a> {
    /// A text.
    pub(crate) fn text(self, column: &str) -> &'a str {
        self.0.get(column).unwrap_or_else(|| panic!("no column {column}"))
    }

    /// A number.
    pub(crate) fn number(self, column: &str) -> f64 {
        self.text(column).parse().unwrap()
    }

    /// Whether a number is `value`, to the digits of a table.
    pub(crate) fn is(self, column: &str, value: f64) -> bool {
        (self.number(column) - value).abs() < 1e-9
    }

    /// The columns `{name}_re` and `{name}_im`.
    pub(crate) fn complex(self, name: &str) -> Complex64 {
        Complex64::new(self.number(&format!("{name}_re")), self.number(&format!("{name}_im")))
    }

    /// `[Cn, Cm, Ch]`.
    pub(crate) fn loads(self) -> [Complex64; 3] {
        let moment = if self.0.contains_key("cm25_re") { "cm25" } else { "cm" };
        [self.complex("cn"), self.complex(moment), self.complex("ch")]
    }
}
