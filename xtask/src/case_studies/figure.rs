//! Charts of the case studies, as SVG that a light and a dark page can show.

use std::fmt::Write as _;

/// How the points of a series are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    /// Open diamonds: measured.
    Diamonds,
    /// Filled dots: simulated.
    Dots,
    /// A line from point to point.
    Line,
}

/// Points of one kind.
#[derive(Debug, Clone)]
pub(super) struct Series {
    /// What they are, in the legend.
    pub(super) name: &'static str,
    /// Number of its colour.
    pub(super) colour: usize,
    pub(super) mark: Mark,
    pub(super) points: Vec<[f64; 2]>,
}

/// An axis from end to end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    pub(super) label: &'static str,
    pub(super) ends: [f64; 2],
    /// From mark to mark.
    pub(super) step: f64,
}

/// One field of a figure.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    pub(super) title: String,
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) series: Vec<Series>,
}

const WIDTH: f64 = 270.0;
const HEIGHT: f64 = 230.0;
const LEFT: f64 = 56.0;
const TOP: f64 = 70.0;
const APART: f64 = 66.0;
/// Height of a row of panels with its labels.
const ROW: f64 = HEIGHT + 76.0;
/// Most panels side by side.
const ACROSS: usize = 4;

const STYLE: &str = "\
<style>
.cs text { fill: #22262b; font: 12px system-ui, sans-serif }
.cs .cs-title { font: 600 15px system-ui, sans-serif }
.cs .cs-soft { fill: #5b646e }
.cs .cs-mid { text-anchor: middle }
.cs .cs-end { text-anchor: end }
.cs .cs-grid { stroke: #dfe3e7 }
.cs .cs-back { fill: #ffffff }
.cs .cs-line { fill: none; stroke-width: 2 }
.cs .cs-0 { stroke: #22262b; fill: #ffffff; stroke-width: 1.5 }
.cs .cs-1 { stroke: #d55e00; fill: #d55e00 }
.cs .cs-2 { stroke: #0e86d4; fill: #0e86d4 }
.cs .cs-3 { stroke: #009e73; fill: #009e73 }
@media (prefers-color-scheme: dark) {
  .cs text { fill: #d8dde3 }
  .cs .cs-soft { fill: #98a2ad }
  .cs .cs-grid { stroke: #3a4148 }
  .cs .cs-back { fill: #16191d }
  .cs .cs-0 { stroke: #d8dde3; fill: #16191d }
}
</style>
";

impl Axis {
    fn share(&self, value: f64) -> f64 {
        (value - self.ends[0]) / (self.ends[1] - self.ends[0])
    }

    fn marks(&self) -> Vec<f64> {
        let mut all = Vec::new();
        let mut next = self.ends[0];
        while next <= self.ends[1] + 1e-9 * self.step {
            all.push(next);
            next += self.step;
        }
        all
    }

    /// A mark with as many decimals as the step has.
    fn text(&self, value: f64) -> String {
        let decimals = if self.step.fract() == 0.0 {
            0
        } else if self.step >= 0.1 {
            1
        } else if self.step >= 0.01 {
            2
        } else {
            3
        };
        let text = format!("{value:.decimals$}");
        if text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.')) {
            return text.trim_start_matches('-').to_owned();
        }
        text
    }
}

impl Panel {
    fn place(&self, [left, top]: [f64; 2], [x, y]: [f64; 2]) -> [f64; 2] {
        [left + WIDTH * self.x.share(x), top + HEIGHT * (1.0 - self.y.share(y))]
    }

    fn draw(&self, corner: [f64; 2], text: &mut String) {
        let [left, top] = corner;
        let (right, bottom) = (left + WIDTH, top + HEIGHT);
        let _ =
            writeln!(text, "<text x=\"{left:.1}\" y=\"{:.1}\">{}</text>", top - 10.0, self.title);
        for value in self.x.marks() {
            let [x, _] = self.place(corner, [value, self.y.ends[0]]);
            let _ = writeln!(
                text,
                "<line x1=\"{x:.1}\" y1=\"{top:.1}\" x2=\"{x:.1}\" y2=\"{bottom:.1}\" class=\"cs-grid\"/>\n<text x=\"{x:.1}\" y=\"{:.1}\" class=\"cs-soft cs-mid\">{}</text>",
                bottom + 16.0,
                self.x.text(value)
            );
        }
        for value in self.y.marks() {
            let [_, y] = self.place(corner, [self.x.ends[0], value]);
            let _ = writeln!(
                text,
                "<line x1=\"{left:.1}\" y1=\"{y:.1}\" x2=\"{right:.1}\" y2=\"{y:.1}\" class=\"cs-grid\"/>\n<text x=\"{:.1}\" y=\"{:.1}\" class=\"cs-soft cs-end\">{}</text>",
                left - 6.0,
                y + 4.0,
                self.y.text(value)
            );
        }
        let middle = 0.5 * (left + right);
        let _ = writeln!(
            text,
            "<text x=\"{middle:.1}\" y=\"{:.1}\" class=\"cs-soft cs-mid\">{}</text>",
            bottom + 34.0,
            self.x.label
        );
        let (x, y) = (left - 44.0, top + 0.5 * HEIGHT);
        let _ = writeln!(
            text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"cs-soft cs-mid\" transform=\"rotate(-90 {x:.1} {y:.1})\">{}</text>",
            self.y.label
        );
        for own in &self.series {
            own.draw(
                &own.points.iter().map(|at| self.place(corner, *at)).collect::<Vec<_>>(),
                text,
            );
        }
    }
}

impl Series {
    fn draw(&self, places: &[[f64; 2]], text: &mut String) {
        let class = self.colour;
        if self.mark == Mark::Line {
            let path: Vec<String> = places.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            let _ = writeln!(
                text,
                "<polyline points=\"{}\" class=\"cs-{class} cs-line\" style=\"fill: none\"/>",
                path.join(" ")
            );
            return;
        }
        for [x, y] in places {
            let _ = match self.mark {
                Mark::Diamonds => writeln!(
                    text,
                    "<path d=\"M{x:.1} {:.1}l5 5l-5 5l-5 -5z\" class=\"cs-{class}\"/>",
                    y - 5.0
                ),
                _ => {
                    writeln!(
                        text,
                        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" class=\"cs-{class}\"/>"
                    )
                }
            };
        }
    }
}

/// A figure: its title, the panels side by side in rows, the legend of the first.
pub(super) fn drawn(title: &str, panels: &[Panel]) -> String {
    let across = panels.len().min(ACROSS) as f64;
    let rows = panels.len().div_ceil(ACROSS) as f64;
    let width = LEFT + across * WIDTH + (across - 1.0) * APART + 16.0;
    let height = TOP + (rows - 1.0) * ROW + HEIGHT + 46.0;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" class=\"cs\" role=\"img\" aria-label=\"{title}\">\n<!-- Made by `cargo xtask case-studies`; do not edit. -->\n<title>{title}</title>\n{STYLE}<rect width=\"{width:.0}\" height=\"{height:.0}\" class=\"cs-back\"/>\n<text x=\"8\" y=\"20\" class=\"cs-title\">{title}</text>\n"
    );
    let mut x = 14.0;
    let mut named = Vec::new();
    for own in panels.first().map(|own| &own.series[..]).unwrap_or_default() {
        if named.contains(&own.name) {
            continue;
        }
        named.push(own.name);
        own.draw(
            &[[x - 4.0, 38.0], [x + 8.0, 38.0]][..if own.mark == Mark::Line { 2 } else { 1 }],
            &mut text,
        );
        let _ = writeln!(
            text,
            "<text x=\"{:.1}\" y=\"42\" class=\"cs-soft\">{}</text>",
            x + 12.0,
            own.name
        );
        x += 38.0 + 6.8 * own.name.len() as f64;
    }
    for (number, own) in panels.iter().enumerate() {
        let (column, row) = ((number % ACROSS) as f64, (number / ACROSS) as f64);
        own.draw([LEFT + column * (WIDTH + APART), TOP + row * ROW], &mut text);
    }
    text + "</svg>\n"
}
