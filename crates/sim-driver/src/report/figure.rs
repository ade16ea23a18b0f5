//! The finding in one picture: the six hub loads before and after control, as SVG in both colour schemes.

use super::paper::{PaperNumbers, paper_numbers};
use crate::results::Figures;
use rotor_study::HubLoads;
use std::fmt::Write as _;

/// The picture that a report opens with, one panel a set of harmonics.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Finding {
    /// The panels.
    pub panels: Vec<FindingPanel>,
}

/// What control of one set of harmonics leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct FindingPanel {
    /// Set of harmonics, such as `3/rev`.
    pub title: String,
    /// Actuator, and what is left of J and the six loads, percent of those without control.
    pub left_percent: Vec<(String, [f64; 7])>,
    /// What the paper leaves, percent; its loads at 3/rev alone.
    pub paper_percent: [Option<f64>; 7],
}

/// Name of an actuator for people.
pub(crate) fn actuator_title(name: &str) -> &str {
    if name == "hysteretic" { "fed back" } else { name }
}

/// Most panels of a picture.
const MOST_PANELS: usize = 6;
/// Width of the picture and of what is left of the bars, px.
const WIDTH: f64 = 920.0;
const LEFT: f64 = 84.0;
/// Height of a panel and of its bars at 100 %, px.
const PANEL: f64 = 176.0;
const FULL: f64 = 88.0;
/// Height above the first panel, px.
const TOP: f64 = 64.0;
/// Tallest bar, percent.
const TALLEST: f64 = 150.0;

impl Finding {
    /// Of the figures of a result; `with_paper` where the paper's numbers may stand beside.
    pub fn new(figures: &Figures, with_paper: bool) -> Self {
        let mut panels: Vec<FindingPanel> = Vec::new();
        let before = figures.baseline.hub_nb_per_rev.amplitudes();
        for line in &figures.control {
            let after = line.hub_nb_per_rev.amplitudes();
            let mut left = [100.0 - line.reduction_percent; 7];
            for k in 0..6 {
                left[k + 1] = 100.0 * after[k] / before[k];
            }
            let title = format!("{}/rev", line.set_name());
            let bar = (actuator_title(&line.actuator).to_owned(), left);
            if let Some(panel) = panels.iter_mut().find(|panel| panel.title == title) {
                panel.left_percent.push(bar);
                continue;
            }
            let paper = paper_numbers(&line.harmonics).filter(|_| with_paper);
            panels.push(FindingPanel {
                title,
                left_percent: vec![bar],
                paper_percent: paper.as_ref().map_or([None; 7], paper_left),
            });
        }
        panels.truncate(MOST_PANELS);
        Self { panels }
    }

    /// Whether there is anything to draw: something is controlled, and there was something to reduce.
    pub fn is_drawn(&self) -> bool {
        let numbers = self.panels.iter().flat_map(|panel| &panel.left_percent);
        let mut numbers = numbers.flat_map(|(_, left)| left).peekable();
        numbers.peek().is_some() && numbers.all(|percent| percent.is_finite())
    }

    /// The picture as SVG text, readable on light and dark.
    pub fn svg(&self, title: &str) -> String {
        let mut names: Vec<&str> = Vec::new();
        for (name, _) in self.panels.iter().flat_map(|panel| &panel.left_percent) {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        let height = TOP + PANEL * self.panels.len() as f64 + 16.0;
        let mut svg = Svg::new(height);
        svg.text(
            (LEFT, 22.0),
            "title",
            "What control leaves of the vibration, percent of that without control",
        );
        svg.legend(&names, self.panels.iter().any(|panel| panel.paper_percent[0].is_some()));
        for (k, panel) in self.panels.iter().enumerate() {
            svg.panel(panel, &names, TOP + PANEL * k as f64);
        }
        svg.finish(title)
    }
}

/// What the paper leaves of J and of the loads, percent.
fn paper_left(paper: &PaperNumbers) -> [Option<f64>; 7] {
    let mut left = [None; 7];
    left[0] = Some(100.0 - paper.reduction_percent);
    if let Some(loads) = paper.loads_percent {
        for (left, percent) in left[1..].iter_mut().zip(loads) {
            *left = Some(100.0 - percent);
        }
    }
    left
}

/// Colours of text, lines and bars (Okabe and Ito's palette, apart for the colour-blind) on light and dark.
const STYLE: &str = "\
.hf text{fill:#22262b;font:13px system-ui,sans-serif}\
.hf .hf-title{font:600 16px system-ui,sans-serif}.hf .hf-soft{fill:#5b646e;font-size:12px}\
.hf line{stroke:#c3c9d0}.hf .hf-full{stroke:#5b646e;stroke-dasharray:4 3}.hf .hf-back{fill:#ffffff}\
.hf .hf-0{fill:#b4bac1}.hf .hf-1{fill:#0e86d4}.hf .hf-2{fill:#d55e00}.hf .hf-3{fill:#009e73}.hf .hf-4{fill:#cc79a7}\
.hf .hf-paper{fill:#ffffff;stroke:#22262b;stroke-width:1.5}\
@media (prefers-color-scheme:dark){.hf text{fill:#d8dde3}.hf .hf-soft{fill:#98a2ad}.hf line{stroke:#3a4148}\
.hf .hf-full{stroke:#98a2ad}.hf .hf-back{fill:#16191d}.hf .hf-0{fill:#5d656e}.hf .hf-paper{fill:#16191d;stroke:#d8dde3}}";

/// A picture that grows.
struct Svg {
    text: String,
    height: f64,
}

impl Svg {
    fn new(height: f64) -> Self {
        Self { text: String::new(), height }
    }

    fn push(&mut self, element: std::fmt::Arguments<'_>) {
        // writing to a string cannot fail
        let _ = writeln!(self.text, "{element}");
    }

    fn text(&mut self, (x, y): (f64, f64), class: &str, words: &str) {
        self.push(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"hf-{class}\">{}</text>",
            escaped(words)
        ));
    }

    fn centred(&mut self, x: f64, y: f64, words: &str) {
        self.push(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" class=\"hf-soft\">{}</text>",
            escaped(words)
        ));
    }

    fn bar(&mut self, x: f64, y: f64, (width, height): (f64, f64), colour: usize) {
        self.push(format_args!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" class=\"hf-{}\"/>",
            colour.min(4)
        ));
    }

    /// The mark of the paper's number.
    fn diamond(&mut self, x: f64, y: f64) {
        self.push(format_args!(
            "<path d=\"M{x:.1} {:.1}l5 5l-5 5l-5 -5z\" class=\"hf-paper\"/>",
            y - 5.0
        ));
    }

    fn legend(&mut self, names: &[&str], with_paper: bool) {
        let mut x = LEFT;
        for (k, name) in std::iter::once(&"without control").chain(names).enumerate() {
            self.bar(x, 35.0, (12.0, 12.0), k);
            self.text((x + 17.0, 46.0), "soft", name);
            x += 34.0 + 7.0 * name.len() as f64;
        }
        if with_paper {
            self.diamond(x + 6.0, 41.0);
            self.text((x + 17.0, 46.0), "soft", "paper (fed back)");
        }
    }

    fn panel(&mut self, panel: &FindingPanel, names: &[&str], top: f64) {
        let ground = top + PANEL - 40.0;
        let height = |percent: f64| FULL * percent.clamp(0.0, TALLEST) / 100.0;
        self.text((8.0, ground - FULL / 2.0), "soft", "flaps at");
        let class = if panel.title.len() > 8 { "soft" } else { "title" };
        self.text((8.0, ground - FULL / 2.0 + 18.0), class, &panel.title);
        let group = (WIDTH - LEFT - 16.0) / 7.0;
        let start = LEFT + 8.0;
        for (percent, class) in [(0.0, ""), (50.0, ""), (100.0, " class=\"hf-full\"")] {
            let y = ground - height(percent);
            self.push(format_args!(
                "<line x1=\"{start:.1}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{y:.1}\"{class}/>",
                WIDTH - 8.0
            ));
        }
        let labels = std::iter::once("J").chain(HubLoads::NAMES);
        let width = (group - 18.0) / (names.len() + 1) as f64;
        for (k, label) in labels.enumerate() {
            let x = start + group * k as f64 + 6.0;
            self.bar(x, ground - height(100.0), (width - 2.0, height(100.0)), 0);
            for (name, left) in &panel.left_percent {
                let place = names.iter().position(|own| own == name).unwrap_or_default();
                let (x, tall) = (x + width * (place + 1) as f64, height(left[k]));
                self.bar(x, ground - tall, (width - 2.0, tall), place + 1);
                self.centred(
                    x + width / 2.0 - 1.0,
                    ground - tall - 4.0,
                    &format!("{:.0}", left[k]),
                );
            }
            if let Some(percent) = panel.paper_percent[k] {
                // over the bar of the feedback, which is what the paper's number is of
                let place = names.iter().position(|name| *name == "fed back").unwrap_or_default();
                self.diamond(x + width * (place as f64 + 1.5) - 1.0, ground - height(percent));
            }
            self.centred(x + (group - 18.0) / 2.0, ground + 17.0, &label.to_uppercase());
        }
    }

    fn finish(self, title: &str) -> String {
        let Self { text, height } = self;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" class=\"hf\" role=\"img\" \
             aria-label=\"Hub loads before and after control\">\n\
             <!-- Made by the program: `hhc` writes it as figure.svg into the folder of its results and opens report.html \
             with it; `hhc report DIR` makes it again. -->\n\
             <title>{}</title>\n<style>{STYLE}</style>\n\
             <rect width=\"{WIDTH}\" height=\"{height}\" class=\"hf-back\"/>\n{text}</svg>\n",
            escaped(title)
        )
    }
}

/// Text that cannot end the element it stands in.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding() -> Finding {
        let left = [75.0, 108.0, 102.0, 61.0, 103.0, 110.0, 97.0];
        let all = ["ideal", "ignored", "fed back"].map(|name| (name.to_owned(), left));
        let paper_percent = paper_numbers(&[3]).as_ref().map_or([None; 7], paper_left);
        let panel =
            FindingPanel { title: "3/rev".into(), left_percent: all.to_vec(), paper_percent };
        Finding { panels: vec![panel] }
    }

    #[test]
    fn the_picture_shows_every_load_before_and_after_and_the_paper() {
        let svg = finding().svg("a </title> case");
        assert!(svg.starts_with("<svg") && svg.contains("prefers-color-scheme:dark"), "{svg}");
        for word in ["J</text>", "FX", "MZ", "without control", "fed back", "a &lt;/title&gt; case"]
        {
            assert!(svg.contains(word), "{word}");
        }
        // seven groups of four bars, their legend, seven numbers of the paper and its legend
        assert_eq!(svg.matches("<rect").count(), 1 + 7 * 4 + 4);
        assert_eq!(svg.matches("<path").count(), 7 + 1);
    }

    #[test]
    fn loads_that_are_none_are_no_picture() {
        let mut none = finding();
        assert!(none.is_drawn());
        none.panels[0].left_percent[0].1[2] = f64::NAN;
        assert!(!none.is_drawn() && !Finding::default().is_drawn());
    }
}
