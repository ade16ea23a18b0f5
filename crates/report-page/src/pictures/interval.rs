//! Values with their intervals, each on an axis of its own.

use super::drawing::{Drawing, clipped};
use super::scale::{Scale, resolved, short};
use maud::{Markup, html};

/// A value with its interval.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Interval {
    /// Name, with its unit.
    pub label: String,
    /// The value.
    pub value: f64,
    /// Its interval, low end first.
    pub ends: [f64; 2],
    /// A value to compare it with, and what that is called.
    pub beside: Option<(f64, String)>,
    /// Colour, 0 to 4.
    pub colour: usize,
}

/// Width of the picture, of the names and of the numbers, height of a row, px.
const WIDTH: f64 = 760.0;
const NAMES: f64 = 240.0;
const NUMBERS: f64 = 190.0;
const ROW: f64 = 30.0;
/// Characters of a name.
const NAME_LENGTH: usize = 40;

/// Intervals, one below the other.
pub fn intervals(all: &[Interval]) -> Markup {
    let mut drawing = Drawing::default();
    for (k, own) in all.iter().enumerate() {
        let y = ROW * k as f64;
        drawing.text([NAMES - 8.0, y + 15.0], "end", &clipped(&own.label, NAME_LENGTH));
        let [low, high] = own.ends;
        let [value, from, to] = [own.value, low, high].map(|v| resolved(v, high - low));
        let numbers = format!("{value} ({from} to {to})");
        drawing.text([WIDTH - NUMBERS + 10.0, y + 15.0], "", &numbers);
        let beside = own.beside.as_ref().map(|beside| beside.0);
        let values = own.ends.into_iter().chain([own.value]).chain(beside);
        let scale = Scale::of(values, [NAMES, WIDTH - NUMBERS]);
        drawing.line([NAMES, y + 11.0], [WIDTH - NUMBERS, y + 11.0], "rule");
        if let Some((value, name)) = &own.beside {
            let x = scale.place(*value);
            drawing.line([x, y + 3.0], [x, y + 19.0], "zero");
            let class = if x > f64::midpoint(NAMES, WIDTH - NUMBERS) { "soft end" } else { "soft" };
            drawing.text([x, y + 28.0], class, &format!("{name} {}", short(*value)));
        }
        let colour = own.colour.min(4);
        if [low, high, own.value].iter().all(|value| value.is_finite()) {
            let [low, high] = [low, high].map(|end| scale.place(end));
            let told = format!("{}: {numbers}", own.label);
            let width = (high - low).max(1.0);
            let at = format_args!(
                "x=\"{low:.1}\" y=\"{:.1}\" width=\"{width:.1}\" height=\"6\" fill-opacity=\"0.5\" class=\"k{colour}\"",
                y + 8.0
            );
            drawing.element("rect", at, &told);
            let at = format_args!(
                "cx=\"{:.1}\" cy=\"{:.1}\" r=\"4.5\" class=\"k{colour}\"",
                scale.place(own.value),
                y + 11.0
            );
            drawing.element("circle", at, &told);
        }
    }
    html! { figure.rows { (drawing.markup([WIDTH, ROW * all.len() as f64 + 4.0])) } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_shows_its_ends_and_what_it_is_compared_with() {
        let own = Interval {
            label: "lift".into(),
            value: 0.8,
            ends: [0.7, 0.9],
            beside: Some((1.0, "as simulated".into())),
            colour: 1,
        };
        let text = intervals(&[own]).into_string();
        assert!(
            text.contains("lift: 0.80 (0.70 to 0.90)") && text.contains("as simulated 1"),
            "{text}"
        );
    }
}
