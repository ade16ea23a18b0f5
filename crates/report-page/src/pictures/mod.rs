//! Pictures as SVG text inside a page: small, sharp, readable on light and dark, with a word behind every mark.
//!
//! Colours are numbers, 0 to 4 in the order of [`COLOURS`](crate::COLOURS). What a mark stands for is its `told`, shown
//! where a pointer rests on it. Values that are not finite are left out.

mod drawing;
mod heat;
mod interval;
mod panel;
mod rows;
mod scale;

pub use drawing::{Drawing, escaped};
pub use heat::HeatMap;
pub use interval::{Interval, intervals};
pub use panel::{Look, Panel, PointForm, Series, averaged, legend, thinned};
pub use rows::{Mark, MarkForm, Row, RowScale, Rows};
pub use scale::short;
