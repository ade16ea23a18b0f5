//! Columns of a source that was read whole.

use super::columns::{ColumnOptions, choose, name_columns};
use super::gather::Reduction;
use super::{Reading, Table};
use crate::problem::{Place, Problem, Problems};

/// The columns of a record: names where the file gives them, and the numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WholeColumns {
    /// Names of the columns, if they have some.
    pub(super) names: Option<Vec<String>>,
    /// The columns, all of one length.
    pub(super) columns: Vec<Vec<f64>>,
    /// Time between two samples that the file states, s; taken where no column is the time.
    pub(super) step_s: Option<f64>,
    /// What was taken, in words.
    pub(super) taken: String,
}

impl WholeColumns {
    /// The record of the columns that are chosen; also what was taken, in words.
    pub(super) fn table(
        self,
        file: &str,
        options: &ColumnOptions,
        into: Reading,
        reduction: Reduction,
    ) -> Result<(Table, String), Problems> {
        let refused = |fault| Problem::new(Place::file(file), fault);
        let stated_hz = self.step_s.map(|step_s| 1.0 / step_s);
        let reduction = Reduction { sampling_hz: reduction.sampling_hz.or(stated_hz), ..reduction };
        let choice = name_columns(options, self.names.as_deref(), self.columns.len())
            .and_then(|named| choose(named, options, into, reduction.sampling_hz))
            .map_err(refused)?;
        let mut problems = Problems::default();
        let mut gather = choice.gather(file, reduction);
        for i in 0..self.columns.first().map_or(0, Vec::len) {
            let numbers = choice.taken().map(|taken| self.columns[taken.source][i]);
            let row = choice.converted(numbers).collect();
            gather.push_or_miss(row, i + 1, &mut problems);
        }
        let parts = gather.finish(&mut problems);
        let table = parts.map(|parts| (Table { parts, choice }, self.taken));
        problems.into_result(table)
    }
}
