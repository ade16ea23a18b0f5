//! MAT files of level 5 (MATLAB 5 to 7, `save -v7`): numeric arrays, structures, cells, characters,
//! compressed or not, in either byte order. Nothing in them can make the reader panic: every size is
//! checked against the bytes that are there.
//!
//! Source: The `MathWorks`, MAT-File Format, level 5.

mod bytes;
mod select;
#[cfg(test)]
mod tests;
mod value;

use super::columns::{Shape, choose, name_columns};
use super::gather::{Gather, Reduction};
use super::{ColumnOptions, Table};
use crate::problem::{Fault, Place, Problem, Problems, RecordFault};

pub(super) use value::{MatLevel, mat_level};

/// Reads a record out of a MAT file; also what was taken, in words.
pub(super) fn read_mat(
    bytes: &[u8],
    file: &str,
    (options, variable): (&ColumnOptions, Option<&str>),
    shape: Option<Shape>,
    reduction: Reduction,
) -> Result<(Table, String), Problems> {
    let refused = |fault: RecordFault| Problem::new(Place::file(file), fault.into());
    let variables = value::read_variables(bytes).map_err(refused)?;
    let found = select::select(&variables, variable).map_err(refused)?;
    drop(variables);
    let choice = name_columns(options, found.names.as_deref(), found.columns.len())
        .and_then(|named| choose(named, options, shape, reduction.sampling_hz))
        .map_err(refused)?;
    let mut problems = Problems::default();
    let length = found.columns.first().map_or(0, Vec::len);
    for taken in choice.time.iter().chain(&choice.columns) {
        let column = &found.columns[taken.source];
        let place = || Place::file(file).field(taken.channel.label());
        if let Some((i, value)) = column.iter().enumerate().find(|(_, v)| !v.is_finite()) {
            let place = Place { line: Some(i + 1), ..place() };
            problems.push(place, Fault::NotFinite { value: *value });
        }
    }
    if !problems.is_empty() {
        return problems.into_result(None);
    }
    let mut gather = Gather::new(file, choice.labels(), reduction);
    let step_s = reduction.sampling_hz.map_or(0.0, |hz| 1.0 / hz);
    let mut row = vec![0.0; found.columns.len()];
    let mut taken = Vec::new();
    for i in 0..length {
        for (value, column) in row.iter_mut().zip(&found.columns) {
            *value = column[i];
        }
        choice.take(&row, step_s, i, &mut taken);
        gather.push(&taken, i + 1, &mut problems);
    }
    let gathered = gather.finish(&mut problems);
    let table = gathered.map(|gathered| (Table { gathered, choice }, found.taken));
    problems.into_result(table)
}
