//! Points and lines over two axes.

use super::drawing::Drawing;
use super::scale::{Scale, short};
use maud::{Markup, html};

/// Form of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PointForm {
    /// Full discs.
    #[default]
    Dots,
    /// Open circles.
    Rings,
    /// Crosses.
    Crosses,
    /// A line through all of them.
    Line,
    /// A thin line from the first to the second, from the third to the fourth and so on.
    Links,
}

/// How points look, and what they are.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Look {
    /// Name in the legend.
    pub name: String,
    /// Colour, 0 to 4.
    pub colour: usize,
    /// Form.
    pub form: PointForm,
}

/// Points of one look.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Their look.
    pub look: Look,
    /// The points, x and y.
    pub points: Vec<[f64; 2]>,
    /// What each of them tells; fewer where the others tell nothing.
    pub told: Vec<String>,
}

/// A plot of points and lines.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// A note below it.
    pub note: String,
    /// Titles of the axes, with units.
    pub axes: [String; 2],
    /// Whether both axes have one scale, as in a plane of cosine and sine.
    pub is_equal: bool,
    /// Whether x and y have a logarithmic scale; points that are not above zero there are left out.
    pub is_log: [bool; 2],
    /// What is drawn, the first below.
    pub series: Vec<Series>,
}

/// Width and height of a panel, px; of one with equal axes the height is larger.
const WIDTH: f64 = 340.0;
const HEIGHT: f64 = 220.0;
const EQUAL_HEIGHT: f64 = 300.0;
/// Borders left, right, top and bottom, px.
const BORDERS: [f64; 4] = [54.0, 8.0, 6.0, 34.0];
/// Size of a mark, px.
const SIZE: f64 = 3.2;

impl Panel {
    /// The panel as a figure.
    pub fn markup(&self) -> Markup {
        let height = if self.is_equal { EQUAL_HEIGHT } else { HEIGHT };
        let [left, right, top, bottom] = BORDERS;
        let series: Vec<Series> = self.series.iter().map(|own| own.scaled(self.is_log)).collect();
        let points = || series.iter().flat_map(|own| &own.points);
        let mut x = Scale::of(points().map(|own| own[0]), [left, WIDTH - right]);
        let mut y = Scale::of(points().map(|own| own[1]), [height - bottom, top]);
        if self.is_equal {
            let unit = x.unit().min(y.unit());
            (x, y) = (x.wider(x.unit() / unit), y.wider(y.unit() / unit));
        }
        let mut drawing = Drawing::default();
        self.frame(&mut drawing, x, y);
        for series in &series {
            series.draw(&mut drawing, x, y);
        }
        html! {
            figure {
                figcaption {
                    strong { (self.title) }
                    @if !self.note.is_empty() { br; span.note { (self.note) } }
                }
                (drawing.markup([WIDTH, height]))
            }
        }
    }

    fn frame(&self, drawing: &mut Drawing, x: Scale, y: Scale) {
        let ([left, right], [below, above]) = (x.at, y.at);
        let class = |value: f64| if value == 0.0 { "zero" } else { "rule" };
        for (at, value) in x.named_ticks(self.is_log[0]) {
            drawing.line([at, below], [at, above], class(value));
            drawing.text([at, below + 13.0], "soft mid", &short(value));
        }
        for (at, value) in y.named_ticks(self.is_log[1]) {
            drawing.line([left, at], [right, at], class(value));
            drawing.text([left - 4.0, at + 3.5], "soft end", &short(value));
        }
        let middle = f64::midpoint(left, right);
        drawing.text([middle, below + 28.0], "soft mid", &self.axes[0]);
        let middle = f64::midpoint(below, above);
        drawing.turned_text([11.0, middle], "soft mid", &self.axes[1]);
    }
}

impl Series {
    /// It with the logarithms of its points where an axis is logarithmic.
    fn scaled(&self, is_log: [bool; 2]) -> Self {
        let of = |value: f64, is_log: bool| if is_log { value.log10() } else { value };
        let points = self.points.iter().map(|own| [of(own[0], is_log[0]), of(own[1], is_log[1])]);
        Self { points: points.collect(), ..self.clone() }
    }

    fn draw(&self, drawing: &mut Drawing, x: Scale, y: Scale) {
        let is_finite = |own: &[f64; 2]| own.iter().all(|value| value.is_finite());
        let place = |own: &[f64; 2]| [x.place(own[0]), y.place(own[1])];
        let colour = self.look.colour.min(4);
        match self.look.form {
            PointForm::Line => {
                let each = self.points.iter().filter(|own| is_finite(own)).map(place);
                let path: Vec<String> = each.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
                let at = format_args!("points=\"{}\" class=\"l{colour}\"", path.join(" "));
                drawing.element("polyline", at, &self.look.name);
            }
            PointForm::Links => {
                for pair in self.points.chunks_exact(2).filter(|own| own.iter().all(is_finite)) {
                    drawing.line(place(&pair[0]), place(&pair[1]), "link");
                }
            }
            form => {
                for (k, own) in self.points.iter().enumerate().filter(|own| is_finite(own.1)) {
                    let told = self.told.get(k).map_or("", String::as_str);
                    mark(drawing, (form, colour), place(own), told);
                }
            }
        }
    }
}

/// A mark of a form and a colour at a place, px.
fn mark(drawing: &mut Drawing, (form, colour): (PointForm, usize), [x, y]: [f64; 2], told: &str) {
    match form {
        PointForm::Crosses => {
            let (size, twice) = (SIZE, 2.0 * SIZE);
            let path = format_args!(
                "d=\"M{:.1} {:.1}l{twice} {twice}m0 -{twice}l-{twice} {twice}\" class=\"l{colour}\"",
                x - size,
                y - size
            );
            drawing.element("path", path, told);
        }
        PointForm::Rings => {
            let at = format_args!("cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{SIZE}\" class=\"l{colour}\"");
            drawing.element("circle", at, told);
        }
        _ => {
            let at = format_args!("cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{SIZE}\" class=\"k{colour}\"");
            drawing.element("circle", at, told);
        }
    }
}

/// What the colours and forms of a group of panels mean.
pub fn legend(looks: &[Look]) -> Markup {
    let sample = |look: &Look| {
        let mut drawing = Drawing::default();
        let colour = look.colour.min(4);
        match look.form {
            PointForm::Line => drawing.line([0.0, 6.0], [22.0, 6.0], &format!("l{colour}")),
            PointForm::Links => drawing.line([0.0, 6.0], [22.0, 6.0], "link"),
            form => mark(&mut drawing, (form, colour), [11.0, 6.0], ""),
        }
        drawing.markup([22.0, 12.0])
    };
    html! { p.legend { @for look in looks { (sample(look)) (look.name) } } }
}

/// A line of many points as one of fewer that shows the same extremes: of each part the lowest and the highest, in their
/// order.
pub fn thinned(points: &[[f64; 2]], most: usize) -> Vec<[f64; 2]> {
    if points.len() <= most {
        return points.to_vec();
    }
    let length = (2 * points.len()).div_ceil(most.max(2));
    let extremes = |part: &[[f64; 2]]| {
        let by_height = |a: &(usize, &[f64; 2]), b: &(usize, &[f64; 2])| a.1[1].total_cmp(&b.1[1]);
        let low = part.iter().enumerate().min_by(by_height);
        let high = part.iter().enumerate().max_by(by_height);
        let mut both: Vec<(usize, &[f64; 2])> = low.into_iter().chain(high).collect();
        both.sort_by_key(|own| own.0);
        both.dedup_by_key(|own| own.0);
        both.into_iter().map(|own| *own.1).collect::<Vec<_>>()
    };
    points.chunks(length).flat_map(extremes).collect()
}

/// A line of many points as one of fewer: the means of consecutive ones, for lines that noise would hide.
pub fn averaged(points: &[[f64; 2]], most: usize) -> Vec<[f64; 2]> {
    let length = points.len().div_ceil(most.max(1)).max(1);
    let mean = |part: &[[f64; 2]], axis: usize| {
        part.iter().map(|own| own[axis]).sum::<f64>() / part.len() as f64
    };
    points.chunks(length).map(|part| [mean(part, 0), mean(part, 1)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_has_one_scale_and_escapes_what_it_tells() {
        let series = Series {
            points: vec![[0.0, 0.0], [10.0, 1.0], [f64::NAN, 1.0]],
            told: vec!["point <1>".to_owned()],
            ..Series::default()
        };
        let panel = Panel { is_equal: true, series: vec![series], ..Panel::default() };
        let text = panel.markup().into_string();
        let places: Vec<f64> = text
            .split("cx=\"")
            .skip(1)
            .flat_map(|own| own.split('"').step_by(2).take(2))
            .map(|own| own.parse().unwrap())
            .collect();
        let [x0, y0, x1, y1] = places[..] else { panic!("{text}") };
        assert!(((x1 - x0) / 10.0 + (y1 - y0)).abs() < 0.1, "{places:?}");
        assert!(text.contains("<title>point &lt;1&gt;</title>"), "{text}");
    }

    #[test]
    fn decades_are_alike_on_a_logarithmic_axis() {
        let series =
            Series { points: [0.1, 1.0, 10.0, 0.0].map(|v| [v, v]).into(), ..Series::default() };
        let panel = Panel { is_log: [true, false], series: vec![series], ..Panel::default() };
        let text = panel.markup().into_string();
        let places: Vec<f64> = text
            .split("cx=\"")
            .skip(1)
            .map(|own| own.split('"').next().unwrap().parse().unwrap())
            .collect();
        let [a, b, c] = places[..] else { panic!("{text}") };
        assert!(((b - a) - (c - b)).abs() < 0.2, "{places:?}");
        assert!(text.contains(">0.1<") && text.contains(">10<"), "{text}");
    }

    #[test]
    fn a_thinned_line_keeps_its_extremes() {
        let wave = |i: u32| [f64::from(i), if i == 777 { 9.0 } else { f64::from(i % 3) }];
        let points: Vec<[f64; 2]> = (0..3000).map(wave).collect();
        let few = thinned(&points, 100);
        assert!(few.len() <= 100 && few.contains(&[777.0, 9.0]), "{}", few.len());
        assert!(few.windows(2).all(|own| own[0][0] < own[1][0]));
        assert_eq!(thinned(&points[..50], 100), points[..50]);
        let means = averaged(&points, 1000);
        assert_eq!((means.len(), means[1]), (1000, [4.0, 1.0]));
    }
}
