//! The aerofoil tables a case names.

use super::AirfoilStation;
use crate::files::{self, Folder, RonIndex, missing_file};
use crate::problem::{Problem, Problems};
use flap_aero::{AirfoilSpan, C81Airfoil};
use std::sync::Arc;

/// Reads the tables of a case; none for a case without.
///
/// # Errors
/// Every file that cannot be read or is no C81 table, with its line.
pub(super) fn read_airfoils(
    named: &[AirfoilStation],
    folder: &Folder,
    index: &RonIndex,
) -> Result<Option<Arc<AirfoilSpan>>, Problems> {
    let mut problems = Problems::default();
    let mut stations = Vec::with_capacity(named.len());
    // a name that is left out is a fault of the values
    let named = named.iter().enumerate().filter(|(_, airfoil)| !airfoil.table.trim().is_empty());
    for (i, airfoil) in named {
        match read_airfoil(airfoil, folder, index, i) {
            Ok(table) => stations.push((airfoil.station_r, table)),
            Err(problem) => problems.append(problem.into()),
        }
    }
    let span = (!stations.is_empty()).then(|| AirfoilSpan::new(stations).ok().map(Arc::new));
    problems.into_result(Some(span.flatten()))
}

fn read_airfoil(
    airfoil: &AirfoilStation,
    folder: &Folder,
    index: &RonIndex,
    i: usize,
) -> Result<C81Airfoil, Problem> {
    let field = format!("aerodynamics.airfoils[{i}].table");
    let (folder, file) = files::airfoil_place(folder, &airfoil.table);
    if !folder.contains(file) {
        return Err(Problem::new(index.place(&field), missing_file(&folder, file)));
    }
    files::read_airfoil(&folder.read(file)?)
}
