//! `hhc section`: responses of a section with a trailing-edge flap, printed; the responses are of `section-study`.

mod polar;

pub use polar::{PolarQuestion, polar};
pub use section_study::{
    LoopQuestion, SectionChoice, SectionResult, SectionTable, loop_history, section_response,
    transient_history,
};

use crate::output::{Printable, table};

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
