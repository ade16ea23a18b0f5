//! The study's report: one HTML file with zoomable charts, no network, light and dark.

mod assumptions;
mod charts;
mod data;
mod figure;
mod page;
mod paper;
mod study;
#[cfg(test)]
mod tests;

pub use assumptions::Assumption;
pub use data::{AzimuthChart, FlapTrace, HeadlineRow, LoadBars, ResultSection, StudyReport};
pub(crate) use figure::actuator_title;
pub use figure::{Finding, FindingPanel};
pub use page::report_html;
pub(crate) use paper::{is_paper, paper_numbers};
pub use study::{histories_csv, study_report};
