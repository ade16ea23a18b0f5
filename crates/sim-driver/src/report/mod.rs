//! The study's report: one HTML file with zoomable charts, no network, light and dark; its tables on the terminal.

mod assumptions;
mod charts;
mod figure;
mod measured;
mod page;
mod paper;
mod state;
mod tables;
#[cfg(test)]
mod tests;

pub use figure::Finding;
pub(crate) use figure::actuator_title;
pub use measured::measured_csv;
pub use page::report_html;
pub(crate) use paper::{is_paper, paper_numbers};
pub use report_page::Section;
pub(crate) use state::{residuals_text, state_lines, vibration_text, wake_note};
pub use tables::{histories_csv, sensitivity_csv};

use crate::results::{Figures, RunResult, StoredResult};
use bench_study::identification::fit_table;
use study_text::robustness_sections;

/// A stored result with its figures, as it is shown.
#[derive(Debug, Clone, Copy)]
pub struct StudyReport<'a> {
    /// The result with its case.
    pub stored: &'a StoredResult,
    /// Its figures.
    pub figures: &'a Figures,
}

impl<'a> StudyReport<'a> {
    /// The six loads before and after, one panel a set of harmonics.
    pub fn finding(&self) -> Finding {
        Finding::new(self.figures, is_paper(&self.stored.case))
    }

    /// Our numbers beside the paper's, where a case is flown as the paper's.
    pub fn beside_paper(&self) -> Option<Section> {
        is_paper(&self.stored.case).then(|| paper::beside_paper(self.figures)).flatten()
    }

    /// Measured against computed, where something was measured.
    pub fn measured(&self) -> Vec<Section> {
        measured::sections(self.figures)
    }

    /// Sensitivities and robustness, where they were computed.
    pub fn further(&self) -> impl Iterator<Item = Section> + use<'a> {
        let Self { stored, figures } = *self;
        let sensitivity = (!figures.sensitivity.is_empty())
            .then(|| tables::sensitivity(&stored.case.control.harmonics, &figures.sensitivity));
        let RunResult { robustness, margins, .. } = &stored.result;
        sensitivity.into_iter().chain(robustness_sections(robustness, margins))
    }

    /// The bench fits, the comparison with the paper and the further tables, for the terminal.
    pub fn text(&self) -> String {
        let fitted = self.stored.bench.as_ref().filter(|bench| !bench.fits.is_empty());
        let fits = fitted.map_or_else(String::new, |bench| {
            format!("\nActuator: {}\n{}", bench.data_title, fit_table(bench.fits.iter(), "V"))
        });
        let sections = self.beside_paper().into_iter().chain(self.measured()).chain(self.further());
        fits + &sections.map(|section| section.to_string()).collect::<String>()
    }
}
