//! Aerofoil tables from C81 files.

use super::shipped::{SHIPPED_AIRFOILS, shipped};
use super::{Folder, Source};
use crate::problem::{Fault, Place, Problem};
use flap_aero::{AeroError, C81Airfoil};

/// An aerofoil from the text of a C81 file.
///
/// # Errors
/// [`Fault::Refused`] with the line and column of the first thing that is not understood.
pub fn read_airfoil(source: &Source) -> Result<C81Airfoil, Problem> {
    C81Airfoil::read(&source.text).map_err(|error| {
        let (place, message) = match error {
            AeroError::C81Text { line, column, expected } => (
                Place::at(&source.name, line, column),
                format!("expected {expected}, as in a C81 table"),
            ),
            other => (Place::file(&source.name), other.to_string()),
        };
        Problem::new(place, Fault::Refused { message })
    })
}

/// The folder and name of an aerofoil table: `shipped:NAME` is one shipped inside the program, any
/// other name a file of `folder`.
pub fn airfoil_place<'a>(folder: &Folder, name: &'a str) -> (Folder, &'a str) {
    match name.strip_prefix("shipped:") {
        Some(name) => (shipped(SHIPPED_AIRFOILS), name),
        None => (folder.clone(), name),
    }
}

/// The text of an aerofoil file; `shipped:NAME` is one shipped inside the program, any other name a file
/// of the folder.
///
/// # Errors
/// [`Fault::Unreadable`], [`Fault::NotText`] or [`Fault::NotShipped`].
pub fn airfoil_text(folder: &Folder, name: &str) -> Result<Source, Problem> {
    let (folder, name) = airfoil_place(folder, name);
    folder.read(name)
}
