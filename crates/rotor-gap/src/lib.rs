//! Rotors as data that discovery works on: points of test, causes, diagnosis.
//!
//! Floor 6: it is handed a case and what was measured, and gives findings back. It knows no file and no terminal.
//!
//! | kind of data | module |
//! |---|---|
//! | hub loads, controls, airloads of a sweep | [`rotor`] |
//! | frequencies of a blade | [`blade`] |
//! | loads of an oscillating section | [`section`] |
//! | anyone's simulator as tables | [`TableData`] |

pub mod blade;
mod diagnosis;
mod error;
mod properties;
pub mod rotor;
pub mod section;
mod table;

use measured_data::problem::{Fault, Problems};
use measured_data::{DatasetKind, SweepData};

pub use diagnosis::{CaseDiagnosis, CaseQuestion};
pub use error::RotorGapError;
pub use rotor::{
    Aside, Column, FlapDriveModel, LIBRARY, Load, LoadPath, PartOf, Reading, RotorCause,
    RotorDiagnosis, RotorModel, RotorQuestion, Setting, Sweep, SweepChannel, SweepPoint,
    USUAL_UNCERTAIN, WonBack, alternatives, diagnose, predict, stated, usual_uncertain,
};
pub use table::{TableData, read_table};

/// Checks the columns of points of any kind.
///
/// # Errors
/// Every name, word and cell that says nothing, at its place.
pub fn check_columns(data: &SweepData) -> Result<(), Problems> {
    let table = &data.points.table;
    let of_kind = match data.kind {
        DatasetKind::BladeFrequencies => blade::Frequencies::of(&data.points).map(drop),
        DatasetKind::SectionLoops => section::SectionLoads::of(&data.points).map(drop),
        _ => return rotor::check_columns(&data.points),
    };
    of_kind.map_err(|error| {
        let name = if let RotorGapError::Column { name, .. } = &error { name } else { "" };
        let mut problems = Problems::default();
        problems.push(table.column_place(name), Fault::Refused { message: error.to_string() });
        problems
    })
}
