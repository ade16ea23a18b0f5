//! The study's report: one HTML file with zoomable charts, no network, light and dark.

mod bench_loops;
mod charts;
mod data;
mod page;
#[cfg(test)]
mod tests;

pub use bench_loops::bench_loops;
pub use data::{
    AzimuthChart, FlapTrace, HeadlineRow, LoadBars, LoopChart, ResultSection, StudyReport,
};
pub use page::report_html;
