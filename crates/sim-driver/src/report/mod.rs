//! The study's report: one HTML file with zoomable charts, no network, light and dark.

mod charts;
mod data;
mod page;

pub use data::{
    AzimuthChart, FlapTrace, HeadlineRow, LoadBars, LoopChart, ResultSection, StudyReport,
};
pub use page::report_html;
