//! `hhc section`: responses of a section with a trailing-edge flap, printed; the responses are of `section-study`.

pub use section_study::{
    LoopQuestion, PolarQuestion, SectionChoice, SectionResult, SectionTable, loop_history, polar,
    section_response, transient_history,
};

use crate::SimError;
use crate::files::{Folder, Source, airfoil_text, read_airfoil};
use crate::output::{Printable, table};
use flap_aero::C81Airfoil;
use std::path::{Path, PathBuf};

/// A C81 table: a file, or a shipped one by its name `shipped:...`.
///
/// # Errors
/// [`SimError::Data`] if it cannot be read or is none.
pub fn airfoil_table(path: &Path) -> Result<C81Airfoil, SimError> {
    let source = match path.to_str() {
        Some(name) if name.starts_with("shipped:") => {
            airfoil_text(&Folder::Disk(PathBuf::new()), name)?
        }
        _ => Source::read(path)?,
    };
    Ok(read_airfoil(&source)?)
}

impl Printable for SectionResult {
    fn text(&self) -> String {
        let rows = [
            ("Cn, normal force", self.cn),
            ("Cm, about c/4", self.cm),
            ("Ch, about the hinge", self.ch),
        ];
        let loads = table(
            &["per radian (plunge: per h_dot/U)", "real", "imaginary", "amplitude", "lag, deg"],
            rows.map(|(name, [re, im])| {
                // 0 less the part: no lag of -0 or -180 deg where there is none
                let lag = (0.0 - im).atan2(re).to_degrees();
                let numbers = [re, im, re.hypot(im)].map(|number| format!("{number:.6}"));
                std::iter::once(name.to_owned())
                    .chain(numbers)
                    .chain([format!("{lag:.2}")])
                    .collect()
            }),
        );
        format!("Model: {}\n{}{loads}", self.model, notes(&self.remarks))
    }
}

fn notes(remarks: &[String]) -> String {
    remarks.iter().flat_map(|remark| ["Note: ", remark.as_str(), "\n"]).collect()
}

/// Rows a person is shown; a file or JSON has all of them.
const SHOWN: usize = 40;

impl Printable for SectionTable {
    fn text(&self) -> String {
        let every = self.rows.len().div_ceil(SHOWN).max(1);
        let rows = self.rows.iter().step_by(every);
        let cells = rows.map(|row| row.iter().map(|value| format!("{value:.6}")).collect());
        let notes = notes(&self.remarks);
        format!("{}\n{notes}{}", self.title, table(&self.columns, cells))
    }
}
