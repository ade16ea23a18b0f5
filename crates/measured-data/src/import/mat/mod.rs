//! MAT files of level 5 (MATLAB 5 to 7, `save -v7`): numeric arrays, structures, cells, characters,
//! compressed or not, in either byte order; matrices of level 4. Nothing in them can make the reader panic: every size is
//! checked against the bytes that are there.
//!
//! Source: The `MathWorks`, MAT-File Format, level 5.

mod bytes;
#[cfg(feature = "hdf5")]
mod hdf5;
mod level4;
mod select;
#[cfg(test)]
mod tests;
mod value;
mod write;

use super::columns::ColumnOptions;
use super::gather::Reduction;
use super::{Reading, Table};
use crate::problem::{Fault, Place, Problem, Problems};

use bytes::Bytes;
pub use value::{MatValue, Variables};
pub use write::mat_file;

/// Whether a MAT file is little-endian, by its first bytes; none if it is no MAT file. `named_mat`: the
/// file's name ends in `.mat`, without which level 4, which has no signature, is not looked for.
///
/// # Errors
/// What to do with an HDF5 file, MATLAB's format 7.3.
pub(super) fn byte_order(start: &[u8], named_mat: bool) -> Option<Result<bool, Fault>> {
    if is_hdf5(start) {
        // it finds its byte order itself
        let is_read = cfg!(feature = "hdf5");
        return Some(is_read.then_some(true).ok_or_else(|| Fault::Other(NO_HDF5.to_owned())));
    }
    if let Some(is_little) = value::level_5(start) {
        return Some(Ok(is_little));
    }
    level4::byte_order(start).filter(|_| named_mat).map(Ok)
}

/// Whether a file is HDF5, of MATLAB's format 7.3 or any other.
fn is_hdf5(start: &[u8]) -> bool {
    const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
    let is_at = |at: usize| start.get(at..).is_some_and(|rest| rest.starts_with(SIGNATURE));
    // behind a block of the user: 512, 1024, 2048 ... bytes
    let mut blocks = std::iter::successors(Some(512), |at| Some(2 * at));
    is_at(0)
        || start.starts_with(b"MATLAB 7.3")
        || blocks.by_ref().take_while(|at| *at < start.len()).any(is_at)
}

/// What to do with HDF5 where it is not read.
const NO_HDF5: &str = "is an HDF5 file (MATLAB's format 7.3), which is not read; in MATLAB: load it and save('file.mat', '-v7', 'your_variable')";

/// Reads every variable of a MAT file of level 4 or 5, or of HDF5 where it is read.
///
/// # Errors
/// What is damaged, with the byte offset; a file of no such format.
pub fn read_variables(file: &[u8]) -> Result<Variables, Fault> {
    let unknown = || {
        let at = Bytes::new(&[], 124.min(file.len()), true, false);
        Err(at.fault("the header names no byte order: it is no MAT file of level 4 or 5"))
    };
    let is_little = byte_order(file, true).unwrap_or_else(unknown)?;
    #[cfg(feature = "hdf5")]
    if is_hdf5(file) {
        return hdf5::variables(file);
    }
    match value::level_5(file) {
        Some(_) => value::variables(file, is_little),
        None => level4::variables(file, is_little),
    }
}

/// Reads a record out of a MAT file; also what was taken, in words.
pub(super) fn read_mat(
    bytes: &[u8],
    file: &str,
    (options, variable): (&ColumnOptions, Option<&str>),
    into: Reading,
    reduction: Reduction,
) -> Result<(Table, String), Problems> {
    let refused = |fault| Problem::new(Place::file(file), fault);
    let variables = read_variables(bytes).map_err(refused)?;
    let found = select::select(&variables, variable).map_err(refused)?;
    drop(variables);
    found.table(file, options, into, reduction)
}
