//! The FORC diagram.

use crate::diagram::DiagramPoint;
use crate::reversals::{FEWEST, ForcDiagram};
use report_page::pictures::{HeatMap, short};
use report_page::{Markup, counted, grid, titled};

const TITLE: &str = "FORC diagram";
/// Cells of the picture on a side at most.
const CELLS: usize = 48;

/// What is said of records without reversal curves.
pub(super) fn none_held() -> String {
    format!(
        "The data hold no first-order reversal curves. Record a run that falls from the upper end of the range to a turning point and rises back to the end. Do so {FEWEST} times at least, each time to another turning point, slowly."
    )
}

/// The diagrams as maps over half-width and centre of the relays; what is said where there are none.
pub(super) fn section(diagrams: &[ForcDiagram], none: &str, units: [&str; 2]) -> Markup {
    if diagrams.is_empty() {
        return titled("forc", TITLE, none, &[]);
    }
    let text = "Second mixed derivative of the reversal curves, with no model in it: density of relays over their half-width and their centre. Orange: above zero, blue: below. Points at small half-widths and of the outermost curves are left out: their window is not complete.";
    let figures = diagrams.iter().map(|own| picture(own, units));
    titled("forc", TITLE, text, &[grid("grid wide", figures)])
}

/// Means of the points in square cells.
fn picture(own: &ForcDiagram, [input, output]: [&str; 2]) -> Markup {
    let all = |of: fn(&DiagramPoint) -> f64| {
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        own.points.iter().map(of).fold(ends, |own, v| [own[0].min(v), own[1].max(v)])
    };
    let [mut widths, centres] = [all(|point| point.half_width), all(|point| point.centre)];
    widths[0] = 0.0;
    let longest = (widths[1] - widths[0]).max(centres[1] - centres[0]);
    let cells = (own.points.len() as f64).sqrt().min(CELLS as f64);
    let side = (longest / cells).max(f64::MIN_POSITIVE);
    // the cell a value lies in, found by counting: a float is no index
    let place =
        |value: f64, low: f64| (1..CELLS).take_while(|k| low + side * *k as f64 <= value).count();
    let size = |own: [f64; 2]| place(own[1], own[0]) + 1;
    let (columns, rows) = (size(widths), size(centres));
    let mut sums = vec![vec![(0.0, 0_u32); columns]; rows];
    for point in &own.points {
        let (x, y) = (place(point.half_width, widths[0]), place(point.centre, centres[0]));
        let sum = &mut sums[rows - 1 - y][x];
        *sum = (sum.0 + point.density, sum.1 + 1);
    }
    let mean = |sum: &(f64, u32)| (sum.1 > 0).then(|| sum.0 / f64::from(sum.1));
    // a row ends at its last cell with a point
    let ended = |row: &Vec<(f64, u32)>| {
        let end = row.iter().rposition(|sum| sum.1 > 0).map_or(0, |last| last + 1);
        row[..end].iter().map(mean).collect()
    };
    let values: Vec<Vec<Option<f64>>> = sums.iter().map(ended).collect();
    let limit = values.iter().flatten().flatten().fold(0.0, |most: f64, v| most.max(v.abs()));
    let middle = |low: f64| move |k: usize| short(low + (k as f64 + 0.5) * side);
    let name = middle(centres[0]);
    HeatMap {
        title: own.id.clone(),
        note: format!(
            "{}, smoothing factor {}; up: centre, across: half-width, {input}; full colour {} {output}/{input}\u{b2}",
            counted(own.curves, "curve"),
            own.smoothing,
            short(limit)
        ),
        rows: (0..rows).rev().map(name).collect(),
        columns: (0..columns.max(rows)).map(middle(widths[0])).collect(),
        values,
        limit: if limit > 0.0 { limit } else { 1.0 },
        is_square: true,
        ..HeatMap::default()
    }
    .markup()
}
