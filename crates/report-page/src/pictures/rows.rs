//! Named rows of bars and marks over one axis.

use super::drawing::{Drawing, clipped};
use super::scale::{Scale, short};
use maud::{Markup, html};

/// Form of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MarkForm {
    /// A bar from the left end.
    #[default]
    Bar,
    /// A disc.
    Dot,
    /// An open circle.
    Ring,
    /// A stroke across the row.
    Tick,
}

/// A mark in a row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mark {
    /// Form.
    pub form: MarkForm,
    /// Colour, 0 to 4.
    pub colour: usize,
    /// Where it stands.
    pub value: f64,
    /// What it tells.
    pub told: String,
}

/// A named row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Row {
    /// Name.
    pub label: String,
    /// What stands at its right end.
    pub note: String,
    /// Whether its name is bold.
    pub is_strong: bool,
    /// Its marks.
    pub marks: Vec<Mark>,
}

/// Scale of the axis of rows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum RowScale {
    /// From 0 on.
    #[default]
    Linear,
    /// Logarithmic from a value above zero on; what is smaller stands at the left end, a mark of zero nowhere.
    LogFrom(f64),
}

/// Rows over one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rows {
    /// Title of the axis, with its unit.
    pub axis: String,
    /// Its scale.
    pub scale: RowScale,
    /// The rows from above.
    pub rows: Vec<Row>,
}

/// Width of the picture, of the names and of the notes, height of a row, px.
const WIDTH: f64 = 800.0;
const NAMES: f64 = 190.0;
const NOTES: f64 = 150.0;
const ROW: f64 = 20.0;
/// Characters of a name.
const NAME_LENGTH: usize = 30;

impl Rows {
    /// The rows as a figure.
    pub fn markup(&self) -> Markup {
        let values = self.rows.iter().flat_map(|row| &row.marks).map(|mark| mark.value);
        let most = values.filter(|v| v.is_finite()).fold(0.0, f64::max);
        let at = [NAMES, WIDTH - NOTES];
        // a value on the scale
        let scaled = |value: f64| match self.scale {
            RowScale::Linear => value.max(0.0),
            RowScale::LogFrom(least) => (value / least).max(1.0).log10(),
        };
        let high = if scaled(most) > 0.0 { 1.02 * scaled(most) } else { 1.0 };
        let scale = Scale { low: 0.0, high, at };
        let ticks: Vec<(f64, String)> = match self.scale {
            RowScale::Linear => scale.ticks().into_iter().map(|own| (own, short(own))).collect(),
            RowScale::LogFrom(least) => (0..12)
                .map(f64::from)
                .take_while(|decade| *decade <= high)
                .map(|decade| (decade, short(least * 10.0_f64.powf(decade))))
                .map(|(decade, text)| {
                    (decade, if decade > 0.0 { text } else { format!("\u{2264} {text}") })
                })
                .collect(),
        };
        let mut drawing = Drawing::default();
        let below = ROW * self.rows.len() as f64 + 4.0;
        for (tick, text) in ticks {
            let x = scale.place(tick);
            drawing.line([x, 0.0], [x, below], "rule");
            drawing.text([x, below + 13.0], "soft mid", &text);
        }
        for (r, row) in self.rows.iter().enumerate() {
            let y = ROW.mul_add(r as f64, 2.0);
            let class = if row.is_strong { "end strong" } else { "end" };
            drawing.text([NAMES - 6.0, y + 13.0], class, &clipped(&row.label, NAME_LENGTH));
            drawing.text([WIDTH - NOTES + 8.0, y + 13.0], "soft", &row.note);
            let is_drawn = |own: &&Mark| {
                let is_shown = self.scale == RowScale::Linear || own.form == MarkForm::Bar;
                own.value.is_finite() && (is_shown || own.value > 0.0)
            };
            for mark in row.marks.iter().filter(is_drawn) {
                mark.draw(&mut drawing, scale.place(scaled(mark.value)), y);
            }
        }
        drawing.text([f64::midpoint(at[0], at[1]), below + 28.0], "soft mid", &self.axis);
        html! { figure.rows { (drawing.markup([WIDTH, below + 34.0])) } }
    }
}

impl Mark {
    fn draw(&self, drawing: &mut Drawing, x: f64, y: f64) {
        let colour = self.colour.min(4);
        let middle = y + 0.5 * (ROW - 4.0);
        match self.form {
            MarkForm::Bar => {
                let (width, height) = ((x - NAMES).max(1.0), ROW - 6.0);
                let at = format_args!(
                    "x=\"{NAMES}\" y=\"{:.1}\" width=\"{width:.1}\" height=\"{height}\" class=\"k{colour}\"",
                    y + 1.0
                );
                drawing.element("rect", at, &self.told);
            }
            MarkForm::Tick => {
                let at = format_args!(
                    "x1=\"{x:.1}\" y1=\"{:.1}\" x2=\"{x:.1}\" y2=\"{:.1}\" class=\"l{colour}\"",
                    y - 1.0,
                    y + ROW - 3.0
                );
                drawing.element("line", at, &self.told);
            }
            form => {
                let class = if form == MarkForm::Dot { 'k' } else { 'l' };
                let at = format_args!(
                    "cx=\"{x:.1}\" cy=\"{middle:.1}\" r=\"4\" class=\"{class}{colour}\""
                );
                drawing.element("circle", at, &self.told);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_as_long_as_their_values() {
        let bar = |value: f64| Mark { value, told: format!("of {value}"), ..Mark::default() };
        let row = |value: f64| Row { label: "a".into(), marks: vec![bar(value)], ..Row::default() };
        let width = |rows: &Rows, value: f64| -> f64 {
            let text = rows.markup().into_string();
            let end = text.find(&format!("<title>of {value}</title>")).unwrap();
            let own = &text[text[..end].rfind("width=\"").unwrap() + 7..];
            own.split('"').next().unwrap().parse().unwrap()
        };
        let rows = vec![row(2.0), row(8.0), row(f64::INFINITY)];
        let mut all = Rows { rows, ..Rows::default() };
        assert!((4.0 * width(&all, 2.0) / width(&all, 8.0) - 1.0).abs() < 0.01);
        all.scale = RowScale::LogFrom(1.0);
        assert!((3.0 * width(&all, 2.0) / width(&all, 8.0) - 1.0).abs() < 0.01);
    }
}
