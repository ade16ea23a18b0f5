//! The aerofoil tables a case names.

use super::AirfoilFile;
use crate::files::{self, Folder, RonIndex};
use crate::problem::{Fault, Problem, Problems};
use flap_aero::{AirfoilSpan, C81Airfoil};
use std::sync::Arc;

/// Reads the tables of a case; none for a case without.
///
/// # Errors
/// Every file that cannot be read or is no C81 table, with its line; stations out of range or order.
pub(super) fn read_airfoils(
    named: &[AirfoilFile],
    folder: &Folder,
    index: &RonIndex,
) -> Result<Option<Arc<AirfoilSpan>>, Problems> {
    let mut problems = Problems::default();
    let mut stations = Vec::with_capacity(named.len());
    let mut inboard = 0.0;
    // the first table may lie at the rotor centre, each further one beyond the one before
    for (i, airfoil) in named.iter().enumerate() {
        let (station, field) = (airfoil.station_r, format!("aerodynamics.airfoils[{i}].station_r"));
        let beyond = if i == 0 { station >= 0.0 } else { station > inboard };
        if beyond && station <= 1.0 {
            inboard = station;
        } else {
            let remedy = "list the tables from root to tip, each station once";
            let fault =
                Fault::OutOfRange { value: station, low: inboard, high: 1.0, unit: "R", remedy };
            problems.push(index.place(&field), fault);
        }
        match read_airfoil(airfoil, folder, index, i) {
            Ok(table) => stations.push((station, table)),
            Err(problem) => problems.append(problem.into()),
        }
    }
    let span = if named.is_empty() { None } else { AirfoilSpan::new(stations).ok().map(Arc::new) };
    problems.into_result(Some(span))
}

fn read_airfoil(
    airfoil: &AirfoilFile,
    folder: &Folder,
    index: &RonIndex,
    i: usize,
) -> Result<C81Airfoil, Problem> {
    let field = format!("aerodynamics.airfoils[{i}].table");
    if airfoil.table.trim().is_empty() {
        let of = "a C81 file, relative to the case file";
        return Err(Problem::new(index.place(&field), Fault::EmptyText { of }));
    }
    let (folder, file) = folder.airfoil(&airfoil.table);
    let missing = |folder: String| Fault::MissingFile { file: file.to_owned(), folder };
    if !folder.contains(file) {
        let shown = match folder.display("") {
            here if here.is_empty() => "this folder".to_owned(),
            folder => folder,
        };
        return Err(Problem::new(index.place(&field), missing(shown)));
    }
    files::read_airfoil(&folder.read(file)?)
}
