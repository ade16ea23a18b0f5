//! The finding in one picture: the six hub loads before and after control, as SVG in both colour schemes.

use super::paper::{PaperNumbers, paper_numbers};
use crate::output::unique;
use crate::results::{ControlLine, Figures, by_set, set_name};
use report_page::pictures::{Drawing, escaped};
use rotor_study::HubLoads;

/// The picture that a report opens with, one panel a set of harmonics.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Finding {
    panels: Vec<Panel>,
}

/// What control of one set of harmonics leaves.
#[derive(Debug, Clone, PartialEq)]
struct Panel {
    /// Set of harmonics, such as `3/rev`.
    title: String,
    /// Actuator, and what is left of J and the six loads, percent of those without control.
    left_percent: Vec<(String, Vec<f64>)>,
    /// What the paper leaves of J and, at 3/rev alone, of the loads, percent.
    paper_percent: Vec<f64>,
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
        let before = figures.baseline.hub_nb_per_rev.amplitudes();
        let left = |line: &ControlLine| {
            let after = line.head.hub_nb_per_rev.amplitudes();
            let loads = after.iter().zip(before).map(|(after, before)| 100.0 * after / before);
            let left = std::iter::once(100.0 - line.reduction_percent).chain(loads);
            (actuator_title(&line.head.actuator).to_owned(), left.collect())
        };
        let panels = by_set(&figures.control).take(MOST_PANELS).map(|(harmonics, lines)| {
            let paper = paper_numbers(harmonics).filter(|_| with_paper);
            Panel {
                title: format!("{}/rev", set_name(harmonics)),
                left_percent: lines.iter().map(left).collect(),
                paper_percent: paper.map(paper_left).unwrap_or_default(),
            }
        });
        Self { panels: panels.collect() }
    }

    /// Whether there is anything to draw: something is controlled, and there was something to reduce.
    pub fn is_drawn(&self) -> bool {
        let numbers = self.panels.iter().flat_map(|panel| &panel.left_percent);
        let mut numbers = numbers.flat_map(|(_, left)| left).peekable();
        numbers.peek().is_some() && numbers.all(|percent| percent.is_finite())
    }

    /// The picture as SVG text, readable on light and dark.
    pub fn svg(&self, title: &str) -> String {
        let bars = self.panels.iter().flat_map(|panel| &panel.left_percent);
        let names = unique(bars.map(|(name, _)| name.as_str()));
        let height = TOP + PANEL * self.panels.len() as f64 + 16.0;
        let mut svg = Svg::default();
        let heading = "What control leaves of the vibration, percent of that without control";
        svg.text(LEFT, 22.0, "title", heading);
        svg.legend(&names, self.panels.iter().any(|panel| !panel.paper_percent.is_empty()));
        for (k, panel) in self.panels.iter().enumerate() {
            svg.panel(panel, &names, TOP + PANEL * k as f64);
        }
        let (title, content) = (escaped(title), svg.drawing.text);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" class=\"hf\" role=\"img\" \
             aria-label=\"Hub loads before and after control\">\n\
             <!-- Made by the program: `hhc` writes it as figure.svg into the folder of its results and opens report.html \
             with it; `hhc report DIR` makes it again. -->\n\
             <title>{title}</title>\n<style>\n{STYLE}</style>\n\
             <rect width=\"{WIDTH}\" height=\"{height}\" class=\"hf-back\"/>\n{content}</svg>\n"
        )
    }
}

/// What the paper leaves of J and of the loads, percent.
fn paper_left(paper: PaperNumbers) -> Vec<f64> {
    let loads = paper.loads_percent.into_iter().flatten();
    std::iter::once(paper.reduction_percent).chain(loads).map(|percent| 100.0 - percent).collect()
}

/// Colours of text, lines and bars (Okabe and Ito's palette, apart for the colour-blind) on light and dark.
const STYLE: &str = include_str!("figure.css");

/// The picture as it grows.
#[derive(Default)]
struct Svg {
    drawing: Drawing,
}

impl Svg {
    fn text(&mut self, x: f64, y: f64, class: &str, words: &str) {
        self.drawing.text([x, y], &format!("hf-{class}"), words);
    }

    fn bar(&mut self, x: f64, y: f64, size: [f64; 2], colour: usize) {
        self.drawing.bar([x, y], size, &format!("hf-{}", colour.min(4)));
    }

    /// The mark of the paper's number.
    fn diamond(&mut self, x: f64, y: f64) {
        let path = format_args!("d=\"M{x:.1} {:.1}l5 5l-5 5l-5 -5z\" class=\"hf-paper\"", y - 5.0);
        self.drawing.element("path", path, "");
    }

    fn legend(&mut self, names: &[&str], with_paper: bool) {
        let mut x = LEFT;
        for (k, name) in std::iter::once(&"without control").chain(names).enumerate() {
            self.bar(x, 35.0, [12.0; 2], k);
            self.text(x + 17.0, 46.0, "soft", name);
            x += 34.0 + 7.0 * name.len() as f64;
        }
        if with_paper {
            self.diamond(x + 6.0, 41.0);
            self.text(x + 17.0, 46.0, "soft", "paper (fed back)");
        }
    }

    fn panel(&mut self, panel: &Panel, names: &[&str], top: f64) {
        let ground = top + PANEL - 40.0;
        let height = |percent: f64| FULL * percent.clamp(0.0, TALLEST) / 100.0;
        self.text(8.0, ground - FULL / 2.0, "soft", "flaps at");
        let class = if panel.title.len() > 8 { "soft" } else { "title" };
        self.text(8.0, ground - FULL / 2.0 + 18.0, class, &panel.title);
        let group = (WIDTH - LEFT - 16.0) / 7.0;
        let start = LEFT + 8.0;
        for (percent, class) in [(0.0, ""), (50.0, ""), (100.0, "hf-full")] {
            let y = ground - height(percent);
            self.drawing.line([start, y], [WIDTH - 8.0, y], class);
        }
        let labels = std::iter::once("J").chain(HubLoads::NAMES);
        let width = (group - 18.0) / (names.len() + 1) as f64;
        for (k, label) in labels.enumerate() {
            let x = start + group * k as f64 + 6.0;
            self.bar(x, ground - height(100.0), [width - 2.0, height(100.0)], 0);
            for (name, left) in &panel.left_percent {
                let place = names.iter().position(|own| own == name).unwrap_or_default();
                let (x, tall) = (x + width * (place + 1) as f64, height(left[k]));
                self.bar(x, ground - tall, [width - 2.0, tall], place + 1);
                let (middle, above) = (x + width / 2.0 - 1.0, ground - tall - 4.0);
                self.text(middle, above, "soft hf-centred", &format!("{:.0}", left[k]));
            }
            if let Some(&percent) = panel.paper_percent.get(k) {
                // over the bar of the feedback, which is what the paper's number is of
                let place = names.iter().position(|name| *name == "fed back").unwrap_or_default();
                self.diamond(x + width * (place as f64 + 1.5) - 1.0, ground - height(percent));
            }
            let (middle, below) = (x + (group - 18.0) / 2.0, ground + 17.0);
            self.text(middle, below, "soft hf-centred", &label.to_uppercase());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding() -> Finding {
        let left = vec![75.0, 108.0, 102.0, 61.0, 103.0, 110.0, 97.0];
        let all = ["ideal", "ignored", "fed back"].map(|name| (name.to_owned(), left.clone()));
        let paper_percent = paper_numbers(&[3]).map(paper_left).unwrap();
        let panel = Panel { title: "3/rev".into(), left_percent: all.to_vec(), paper_percent };
        Finding { panels: vec![panel] }
    }

    #[test]
    fn the_picture_shows_every_load_before_and_after_and_the_paper() {
        let svg = finding().svg("a </title> case");
        assert!(svg.starts_with("<svg") && svg.contains("prefers-color-scheme: dark"), "{svg}");
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
