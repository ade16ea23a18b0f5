//! The validation of the whole: every check against theory and published data, one page in the book.
//!
//! The checks are tests of the crates they check, named `validation`; each leaves a row in a folder
//! ([`validation::ROWS_FOLDER`]). Here the tests are run, the rows collected, and the page made of them.

mod page;

use std::path::{Path, PathBuf};
use std::process::Command;

use validation::{AREAS, FILTER, LONG, ROWS_FOLDER, Row, heading_of, ids};

use crate::{XtaskError, files};

pub(crate) use page::figure;
pub use page::{render, stale_lines};

/// Where the rows of a run are put, from the root.
pub const ROWS: &str = "target/validation";

/// Runs the tests that write rows, those whose id or heading contains `filter` (all, if it is empty).
/// What they wrote before is removed first; a row that does not hold is left to [`collect`].
///
/// # Errors
/// [`XtaskError::NoSuchCheck`] if no row matches, [`XtaskError::Start`] if cargo cannot be run.
pub fn run_tests(root: &Path, filter: &str, profile: &str) -> Result<PathBuf, XtaskError> {
    if wanted(filter).next().is_none() {
        let areas: Vec<&str> = AREAS.iter().map(|area| area.heading).collect();
        return Err(XtaskError::NoSuchCheck { text: filter.to_owned(), areas: areas.join(", ") });
    }
    let folder = root.join(ROWS);
    files::remove_folder(&folder)?;
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    Command::new(&cargo)
        .args(["test", "--workspace", "--locked", "--quiet", "--no-fail-fast"])
        .args(["--profile", profile, "--test", "validation"])
        .env(ROWS_FOLDER, &folder)
        .env(FILTER, filter)
        .env(LONG, "1")
        .current_dir(root)
        .status()
        .map_err(|source| XtaskError::Start {
            program: cargo.to_string_lossy().into_owned(),
            source,
        })?;
    Ok(folder)
}

/// Ids of the rows whose id or heading contains `filter`, in the order of the page.
fn wanted(filter: &str) -> impl Iterator<Item = &'static str> {
    ids().filter(move |id| {
        id.contains(filter) || heading_of(id).is_some_and(|heading| heading.contains(filter))
    })
}

/// Rows found, and ids of those that are missing.
#[derive(Debug)]
pub struct Collected {
    /// The rows, in the order of the page.
    pub rows: Vec<Row>,
    /// Rows that no test has written.
    pub missing: Vec<&'static str>,
}

impl Collected {
    /// Whether every row is there, and every one that was computed holds.
    pub fn passes(&self) -> bool {
        self.missing.is_empty() && self.rows.iter().all(|row| row.passes() || row.is_left_out)
    }

    /// How many rows were left out, being long.
    pub fn left_out(&self) -> usize {
        self.rows.iter().filter(|row| row.is_left_out).count()
    }
}

/// The rows of a folder whose id or heading contains `filter`.
///
/// # Errors
/// [`XtaskError::Row`] if a file is no row.
pub fn collect(folder: &Path, filter: &str) -> Result<Collected, XtaskError> {
    let mut collected = Collected { rows: Vec::new(), missing: Vec::new() };
    for id in wanted(filter) {
        match Row::read(folder, id) {
            Ok(Some(row)) => collected.rows.push(row),
            Ok(None) => collected.missing.push(id),
            Err(error) => {
                let (folder, said) = (folder.to_path_buf(), error.to_string());
                return Err(XtaskError::Row { id, folder, said });
            }
        }
    }
    Ok(collected)
}

/// The rows as a table for the terminal, with the time of each, and what is wrong with those that fail.
pub fn text(collected: &Collected) -> String {
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::ASCII_BORDERS_ONLY_CONDENSED);
    table.set_header(page::TITLES.into_iter().take(7).chain(["s"]));
    let mut failures = Vec::new();
    for row in &collected.rows {
        let cells = page::cells(row).into_iter().take(7).map(|cell| cell.replace('*', ""));
        table.add_row(cells.chain([format!("{:.1}", row.seconds)]));
        if let Err(error) = &row.got
            && !row.is_left_out
        {
            failures.push(format!("{}: {error}\n", row.id));
        }
    }
    failures.extend(collected.missing.iter().map(|id| format!("{id}: no test has written it\n")));
    let passed = collected.rows.iter().filter(|row| row.passes()).count();
    let all = collected.rows.len() + collected.missing.len();
    let left = match collected.left_out() {
        0 => String::new(),
        left => format!(", {left} were left to `cargo xtask validate`"),
    };
    format!("{table}\n{}{passed} of {all} checks passed{left}\n", failures.concat())
}
