//! What a person reads: tables for the terminal, and HTML pages with pictures that load nothing.
//!
//! Floor 0: it is handed names and numbers and gives text back. It knows no case, no result and no file.
//!
//! | idea | module |
//! |---|---|
//! | lines and tables of a terminal, CSV | `text` |
//! | a heading with a table, for terminal and page | `section` |
//! | the page around a body, its charts | `page` |
//! | charts that many pages have | `charts` |
//! | pictures as SVG | [`pictures`] |

mod charts;
mod page;
pub mod pictures;
mod section;
mod text;

pub use charts::{
    COLOURS, DrawnCurve, NamedPoints, Place3, carpet_chart, chart_axis, chart_layout, chart_line,
    curve_chart, fronts_chart, map_chart, pair_chart, parallel_chart, trade_chart,
};
pub use maud::Markup;
pub use page::{Charts, MADE_HERE, body, folded, grid, heading, page, paragraphs, titled};
pub use section::Section;
pub use text::{Column, SCREEN, Sheet, counted, csv_of, table, table_of, unique, wrap};

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;
