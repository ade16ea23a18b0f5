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
mod write;

use super::columns::ColumnOptions;
use super::gather::Reduction;
use super::{ImportKind, Table};
use crate::problem::{Place, Problem, Problems};

pub(super) use value::byte_order;
pub use value::{MatValue, Variables, read_variables};
pub use write::mat_file;

/// Reads a record out of a MAT file; also what was taken, in words.
pub(super) fn read_mat(
    bytes: &[u8],
    file: &str,
    (options, variable): (&ColumnOptions, Option<&str>),
    kind: Option<ImportKind>,
    reduction: Reduction,
) -> Result<(Table, String), Problems> {
    let refused = |fault| Problem::new(Place::file(file), fault);
    let variables = value::read_variables(bytes).map_err(refused)?;
    let found = select::select(&variables, variable).map_err(refused)?;
    drop(variables);
    found.table(file, options, kind, reduction)
}
