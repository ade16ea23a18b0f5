//! The validation of the whole: every check against theory and published data, one page in the book.
//!
//! Each crate's checks stand in one module here, beside the references they are measured against in
//! `fixtures/reference`. A check is more than a test: it prints how far the bound is.

mod check;
mod error;
mod page;
mod reference;

mod actuator;
mod actuator_data;
mod actuator_stages;
mod blade;
mod blade_loads;
mod control;
mod discovery;
mod hinge;
mod hover_torque;
mod inflow;
mod joints;
mod moderate;
mod moderate_blades;
mod rotor;
mod rotor_details;
mod section;
mod section_beyond;
mod section_compressible;
mod study;
mod study_work;
mod time_elements;
mod trim_reference;
mod trimmed;
mod wake;
mod wake_flight;
mod wake_hover;
mod wake_measured;
mod wake_trim;

pub use check::{Area, Check, Criterion, Repeatability, Row};
pub use error::CheckError;
pub use page::{render, stale_lines};

use crate::XtaskError;

/// All areas, in the order of the page.
pub const AREAS: &[Area] = &[
    blade::AREA,
    moderate::AREA,
    time_elements::AREA,
    section::AREA,
    section_compressible::AREA,
    section_beyond::AREA,
    inflow::AREA,
    wake::AREA,
    wake_hover::AREA,
    wake_flight::AREA,
    wake_measured::AREA,
    wake_trim::AREA,
    rotor::AREA,
    rotor_details::AREA,
    blade_loads::AREA,
    joints::AREA,
    hover_torque::AREA,
    trimmed::AREA,
    actuator::AREA,
    actuator_stages::AREA,
    actuator_data::AREA,
    control::AREA,
    discovery::AREA,
    study::AREA,
];

/// Ids of all checks, in the order of the page.
pub fn ids() -> Vec<&'static str> {
    AREAS.iter().flat_map(|area| area.checks).map(|check| check.id).collect()
}

/// Does all checks whose id or area contains `filter` (all, if it is empty), one after the other: what
/// can run in parallel is inside of them.
///
/// # Errors
/// [`XtaskError::NoSuchCheck`] if there is none. A check that cannot be computed is a row that fails.
pub fn run(filter: &str) -> Result<Vec<Row>, XtaskError> {
    let wanted: Vec<(&'static str, Check)> = AREAS
        .iter()
        .flat_map(|area| area.checks.iter().map(|check| (area.heading, *check)))
        .filter(|(heading, check)| check.id.contains(filter) || heading.contains(filter))
        .collect();
    if wanted.is_empty() {
        let areas: Vec<&str> = AREAS.iter().map(|area| area.heading).collect();
        return Err(XtaskError::NoSuchCheck { text: filter.to_owned(), areas: areas.join(", ") });
    }
    Ok(wanted.into_iter().map(|(heading, check)| Row::of(heading, check)).collect())
}

/// The rows as a table for the terminal, with the reason of each check that could not be computed.
pub fn text(rows: &[Row]) -> String {
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::ASCII_BORDERS_ONLY_CONDENSED);
    table.set_header(["id", "quantity", "unit", "expected", "got", "bound", "pass"]);
    let mut failures = Vec::new();
    for row in rows {
        table.add_row(row.cells().into_iter().take(7).map(|cell| cell.replace('*', "")));
        if let Err(error) = &row.got {
            failures.push(format!("{}: {error}\n", row.check.id));
        }
    }
    let passed = rows.iter().filter(|row| row.passes()).count();
    format!("{table}\n{}{passed} of {} checks passed\n", failures.concat(), rows.len())
}
