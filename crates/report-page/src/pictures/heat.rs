//! A map of signed values.

use super::drawing::{Drawing, clipped};
use super::scale::short;
use maud::{Markup, html};

/// Signed values by row and column: above zero orange, below zero blue, the fuller the larger.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HeatMap {
    /// Title.
    pub title: String,
    /// A note below it.
    pub note: String,
    /// Names of the rows.
    pub rows: Vec<String>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Values by row and column; none where nothing was measured.
    pub values: Vec<Vec<Option<f64>>>,
    /// Size of a value that has the full colour, above zero.
    pub limit: f64,
    /// Unit behind a value.
    pub unit: &'static str,
    /// Whether cells are as high as they are wide: a map of a plane.
    pub is_square: bool,
}

/// Width of a map and of the names of its rows at most, height of a row, px.
const WIDTH: f64 = 400.0;
const NAMES: f64 = 140.0;
const ROW: f64 = 18.0;
/// Width of a cell from which on its value is written in it, px.
const WRITTEN: f64 = 30.0;
/// Most columns; more are put together, the largest value of each group shown.
const MOST_COLUMNS: usize = 90;
/// Characters of a name of a row, and width of one of a column, px.
const NAME_LENGTH: usize = 20;
const LABEL: f64 = 44.0;
/// Height of a name of a row, px.
const NAME_HEIGHT: f64 = 12.0;

impl HeatMap {
    /// The map as a figure.
    pub fn markup(&self) -> Markup {
        let group = self.columns.len().div_ceil(MOST_COLUMNS).max(1);
        let count = self.columns.len().div_ceil(group).max(1);
        let longest = self.rows.iter().map(|own| own.chars().count()).max().unwrap_or(0);
        let left = (6.6 * longest.min(NAME_LENGTH) as f64 + 8.0).min(NAMES);
        let width = (WIDTH - left - 4.0) / count as f64;
        let row = if self.is_square { width } else { ROW };
        let mut drawing = Drawing::default();
        // names of rows where there is room for them
        let mut free = f64::NEG_INFINITY;
        for (r, (name, values)) in self.rows.iter().zip(&self.values).enumerate() {
            let y = row * r as f64;
            let base = y + 0.5 * row + 4.0;
            if base - free >= NAME_HEIGHT {
                drawing.text([left - 4.0, base], "end", &clipped(name, NAME_LENGTH));
                free = base;
            }
            for (k, part) in values.chunks(group).enumerate() {
                let corner = [left + width * k as f64, y];
                self.cell(&mut drawing, (name, group * k, part), (corner, [width, row - 1.0]));
            }
        }
        let below = row * self.rows.len() as f64 + 12.0;
        // names of columns where there is room for them
        let mut free = left;
        for (k, name) in self.columns.iter().step_by(group).enumerate() {
            let middle = width.mul_add(k as f64 + 0.5, left);
            let name = clipped(name, 12);
            let half = (3.1 * name.chars().count() as f64).max(0.3 * LABEL);
            if middle - half >= free - 2.0 && middle + half <= WIDTH + 4.0 {
                drawing.text([middle, below], "soft mid", &name);
                free = middle + half + 6.0;
            }
        }
        html! {
            figure {
                figcaption {
                    strong { (self.title) }
                    @if !self.note.is_empty() { br; span.note { (self.note) } }
                }
                (drawing.markup([WIDTH, below + 6.0]))
            }
        }
    }

    /// A cell of the largest of some values, the first of which is of column `of`; left upper corner, width and height.
    fn cell(
        &self,
        drawing: &mut Drawing,
        (row, of, values): (&str, usize, &[Option<f64>]),
        ([x, y], [width, height]): ([f64; 2], [f64; 2]),
    ) {
        let each = values.iter().enumerate().filter_map(|(k, own)| Some((k, (*own)?)));
        let each = each.filter(|own| own.1.is_finite());
        let largest = each.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let Some((k, value)) = largest else {
            drawing.bar([x, y], [width, height], "cell");
            return;
        };
        let class = if value < 0.0 { "below" } else { "above" };
        let full = (value.abs() / self.limit).min(1.0);
        let told = format!("{}, {row}: {}{}", self.columns[of + k], short(value), self.unit);
        let at = format_args!(
            "x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" class=\"{class}\" fill-opacity=\"{full:.2}\""
        );
        drawing.element("rect", at, &told);
        if width >= WRITTEN && !self.is_square {
            // no minus before what rounds to zero
            let text = format!("{:.1}", if value.abs() < 0.05 { 0.0 } else { value });
            drawing.text([x + 0.5 * width, y + 12.5], "mid", &text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_a_cell_of_its_sign_and_size() {
        let map = HeatMap {
            rows: vec!["fx".into(), "fz".into()],
            columns: vec!["a<b".into(), "c".into()],
            values: vec![vec![Some(-2.0), None], vec![Some(8.0), Some(f64::NAN)]],
            limit: 4.0,
            unit: " sd",
            ..HeatMap::default()
        };
        let text = map.markup().into_string();
        assert!(
            text.contains("class=\"below\" fill-opacity=\"0.50\"><title>a&lt;b, fx: -2 sd</title>")
        );
        assert!(
            text.contains("class=\"above\" fill-opacity=\"1.00\"><title>a&lt;b, fz: 8 sd</title>")
        );
        assert_eq!(text.matches("class=\"cell\"").count(), 2, "{text}");
    }

    #[test]
    fn many_columns_are_put_together_by_their_largest_value() {
        let values = (0..1000).map(|i| Some(if i == 123 { -7.0 } else { 0.1 })).collect();
        let columns = (0..1000).map(|i| format!("p{i}")).collect();
        let rows = vec!["fx".to_owned()];
        let map = HeatMap { rows, columns, values: vec![values], limit: 5.0, ..HeatMap::default() };
        let text = map.markup().into_string();
        assert!(text.matches("<rect").count() <= MOST_COLUMNS, "{text}");
        assert!(text.contains("<title>p123, fx: -7</title>"), "{text}");
    }
}
