//! Rows of the validation page, written by the tests that check them.
//!
//! A test states its rows as a table of [`Check`]s and calls [`hold`], which computes each quantity and
//! fails where a bound is not kept. Where [`ROWS_FOLDER`] names a folder, every row is also written there
//! as `<id>.ron`, for `cargo xtask validate` to make the page of. Which rows there are, and their order,
//! stands in [`AREAS`]. The longest rows are computed by `cargo xtask validate` alone ([`Check::long`]).
//!
//! ```no_run
//! use validation::row;
//!
//! validation::hold(&[
//!     row("V-ACT-01", "wiping-out: output with and without a past", "deg")
//!         .against("definition")
//!         .at_most(1e-12, || Ok(3e-16)),
//! ]);
//! ```

#![expect(
    clippy::disallowed_methods,
    reason = "reads reference tables and writes rows where the environment asks for them"
)]

mod areas;
mod check;
mod table;

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{LazyLock, OnceLock};

pub use areas::{AREAS, Area, heading_of, ids};
pub use check::{Check, Criterion, Draft, Measure, Repeatability, Row, row};
pub use table::{Table, TableError, TableRow, crosscheck, crosscheck_rows};

/// Environment variable: the folder that rows are written to.
pub const ROWS_FOLDER: &str = "VALIDATION_ROWS";

/// Environment variable: only rows with this text in id or heading are computed.
pub const FILTER: &str = "VALIDATION_FILTER";

/// Environment variable: where it is set, long checks are computed too ([`Check::long`]).
pub const LONG: &str = "VALIDATION_LONG";

/// Why a quantity could not be computed.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Computes every check and writes its row where [`ROWS_FOLDER`] asks for it.
///
/// # Panics
/// If a quantity cannot be computed or does not keep its bound, with all such rows; if a row is in no
/// [`Area`] or cannot be written.
pub fn hold(checks: &[Check]) {
    let filter = std::env::var(FILTER).unwrap_or_default();
    let folder = std::env::var_os(ROWS_FOLDER).map(PathBuf::from);
    let with_long = std::env::var_os(LONG).is_some();
    hold_in(&Wanted { folder: folder.as_deref(), filter: &filter, with_long }, checks);
}

/// What the environment asks for.
#[derive(Debug, Clone, Copy)]
struct Wanted<'a> {
    /// Where the rows are written.
    folder: Option<&'a Path>,
    /// Text of id or heading.
    filter: &'a str,
    /// Whether long checks are computed.
    with_long: bool,
}

/// [`hold`] of what is wanted. As many checks as there are cores are computed at once.
fn hold_in(wanted: &Wanted, checks: &[Check]) {
    let Wanted { folder, filter, with_long } = *wanted;
    let chosen: Vec<&Check> = checks
        .iter()
        .filter(|check| {
            let Some(heading) = heading_of(check.id) else {
                panic!("{} is in no area: add it to AREAS of the package `validation`", check.id)
            };
            check.id.contains(filter) || heading.contains(filter)
        })
        .collect();
    let next = AtomicUsize::new(0);
    let rows: Vec<OnceLock<Row>> = chosen.iter().map(|_| OnceLock::new()).collect();
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                loop {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let (Some(check), Some(done)) = (chosen.get(place), rows.get(place)) else {
                        break;
                    };
                    let is_computed = with_long || !check.is_long;
                    let row = if is_computed { Row::of(check) } else { Row::left_out(check) };
                    if let Some(folder) = folder
                        && let Err(error) = row.write(folder)
                    {
                        let to = folder.display();
                        panic!("the row of {} cannot be written to {to}: {error}", row.id);
                    }
                    done.get_or_init(|| row);
                }
            });
        }
    });
    let failed: Vec<String> = rows
        .iter()
        .filter_map(OnceLock::get)
        .filter(|row| !row.passes() && !row.is_left_out)
        .map(|row| format!("{}, {}: {:?}, {:?}", row.id, row.quantity, row.got, row.criterion))
        .collect();
    assert!(failed.is_empty(), "{} rows do not hold:\n{}", failed.len(), failed.join("\n"));
}

/// The root folder of the workspace.
pub fn root() -> PathBuf {
    let member = Path::new(env!("CARGO_MANIFEST_DIR"));
    member.ancestors().nth(2).unwrap_or(member).to_path_buf()
}

/// What several rows share, computed once.
///
/// # Errors
/// The failure of the computation.
pub fn shared<T>(lazy: &'static LazyLock<Result<T, Failure>>) -> Result<&'static T, Failure> {
    lazy.as_ref().map_err(|error| error.to_string().into())
}

/// Fewer values were found than a row needs.
pub fn too_few(what: &str, found: usize, needed: usize) -> Failure {
    format!("only {found} values of {what} were compared, {needed} are needed").into()
}

/// The largest of at least `needed` values; a NaN is the largest of all.
///
/// # Errors
/// The first value that could not be computed, or [`too_few`].
pub fn worst(
    what: &str,
    needed: usize,
    values: impl IntoIterator<Item = Result<f64, Failure>>,
) -> Result<f64, Failure> {
    let (mut largest, mut found) = (0.0_f64, 0);
    for value in values {
        let value = value?;
        if value.is_nan() {
            return Ok(value);
        }
        largest = largest.max(value);
        found += 1;
    }
    if found < needed { Err(too_few(what, found, needed)) } else { Ok(largest) }
}
