//! Charts that many pages have, as plotly plots without colours of background and text: the page sets those.

use plotly::common::{
    Anchor, ColorScale, ColorScalePalette, DashType, HoverInfo, Line, Marker, Mode,
};
use plotly::common::{Orientation, Position, Title};
use plotly::layout::{Axis, BarMode, Legend, Margin};
use plotly::{Bar, Contour, Layout, Plot, Scatter, Trace};
use serde::Serialize;

/// Colours that stay apart from each other and readable on light and dark, also for the colour-blind
/// (Okabe and Ito's palette).
pub const COLOURS: [&str; 5] = ["#8c8c8c", "#0e86d4", "#d55e00", "#009e73", "#cc79a7"];

/// The layout of a chart. The legend stands below the axis title: the top is left to the zoom buttons.
pub fn chart_layout() -> Layout {
    let legend =
        Legend::new().orientation(Orientation::Horizontal).x(0.0).y(-0.2).y_anchor(Anchor::Top);
    Layout::new().margin(Margin::new().left(56).right(16).top(28).bottom(84)).legend(legend)
}

/// An axis with its title.
pub fn chart_axis(title: &str) -> Axis {
    Axis::new().title(Title::with_text(title)).auto_margin(true)
}

/// A line through points.
pub fn chart_line(
    x: &[f64],
    y: &[f64],
    name: &str,
    colour: &'static str,
    dash: DashType,
) -> Box<Scatter<f64, f64>> {
    Scatter::new(x.to_vec(), y.to_vec())
        .name(name)
        .mode(Mode::Lines)
        .line(Line::new().color(colour).width(2.0).dash(dash))
}

/// A curve to draw: its name, dots or line, azimuths in deg, values.
pub type DrawnCurve<'a> = (&'a str, Mode, Vec<f64>, Vec<f64>);

/// Curves against azimuth.
pub fn curve_chart(title: &str, curves: Vec<DrawnCurve<'_>>) -> Plot {
    let mut plot = Plot::new();
    for (i, (name, mode, psi_deg, values)) in curves.into_iter().enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        let trace = chart_line(&psi_deg, &values, name, colour, DashType::Solid);
        plot.add_trace(trace.mode(mode).marker(Marker::new().color(colour)));
    }
    let ticks: Vec<f64> = (0..=4).map(|i| 90.0 * f64::from(i)).collect();
    let azimuth = chart_axis("azimuth, deg").range(vec![0.0, 360.0]).tick_values(ticks);
    plot.set_layout(chart_layout().x_axis(azimuth).y_axis(chart_axis(title).zero_line(false)));
    plot
}

/// Named values of two results as grouped bars.
pub fn pair_chart(title: &str, heads: &[String], sides: [(&str, Vec<f64>); 2]) -> Plot {
    let mut plot = Plot::new();
    for (i, (name, values)) in sides.into_iter().enumerate() {
        let bars = Bar::new(heads.to_vec(), values).name(name);
        plot.add_trace(bars.marker(Marker::new().color(COLOURS[i])));
    }
    plot.set_layout(
        chart_layout().bar_mode(BarMode::Group).x_axis(chart_axis("")).y_axis(chart_axis(title)),
    );
    plot
}

/// A value at a place of a plane: `[x, y, value]`.
pub type Place3 = [f64; 3];

/// Values on a whole grid: steps of both axes, and a row of values for each step of the second.
struct Grid {
    xs: Vec<f64>,
    ys: Vec<f64>,
    rows: Vec<Vec<f64>>,
}

impl Grid {
    /// The grid that the places are, each step of one axis with each of the other and once; none if they are no such grid.
    fn of(places: &[Place3]) -> Option<Self> {
        let steps = |i: usize| -> Vec<f64> {
            let mut values: Vec<f64> = places.iter().map(|place| place[i]).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        };
        let (xs, ys) = (steps(0), steps(1));
        let at = |x: f64, y: f64| {
            let same = |place: &&Place3| place[..2] == [x, y];
            places.iter().find(same).map(|place| place[2])
        };
        if xs.len() < 2 || ys.len() < 2 || xs.len() * ys.len() != places.len() {
            return None;
        }
        let row = |&y: &f64| xs.iter().map(|&x| at(x, y)).collect::<Option<Vec<f64>>>();
        let rows = ys.iter().map(row).collect::<Option<Vec<Vec<f64>>>>()?;
        Some(Self { xs, ys, rows })
    }
}

/// Values over two axes: contours where they stand on a whole grid, each place once, else points in the colour of their
/// value.
pub fn map_chart([x_title, y_title]: [&str; 2], places: &[Place3]) -> Plot {
    let column = |i: usize| -> Vec<f64> { places.iter().map(|place| place[i]).collect() };
    let mut plot = Plot::new();
    let scale = || ColorScale::Palette(ColorScalePalette::Viridis);
    if let Some(Grid { xs, ys, rows }) = Grid::of(places) {
        plot.add_trace(Contour::new(xs, ys, rows).color_scale(scale()));
    } else {
        let marker = Marker::new().size(9).color_array(column(2)).color_scale(scale());
        let points = Scatter::new(column(0), column(1)).mode(Mode::Markers);
        plot.add_trace(points.marker(marker.show_scale(true)));
    }
    plot.set_layout(chart_layout().x_axis(chart_axis(x_title)).y_axis(chart_axis(y_title)));
    plot
}

/// Way to the right of a carpet over its second axis, over that of the first: the lines cross, and hide each other nowhere.
const SLANT: f64 = 0.4;
/// Lines of a carpet of one kind that have their value beside them, at most.
const LABELS: usize = 8;

/// A carpet: a value upwards, a line for each step of the first axis and one for each step of the second. Both axes go to the
/// right, the second by less. None where the places are no whole grid.
pub fn carpet_chart([x_title, y_title, title]: [&str; 3], places: &[Place3]) -> Option<Plot> {
    let Grid { xs, ys, rows } = Grid::of(places)?;
    let share = |steps: &[f64], i: usize| {
        let (first, last) = (steps[0], steps[steps.len() - 1]);
        (steps[i] - first) / (last - first)
    };
    let place = |i: usize, j: usize| (share(&xs, i) + SLANT * share(&ys, j), rows[j][i]);
    let mut plot = Plot::new();
    let mut draw =
        |points: Vec<(usize, usize)>, (name, value): (&str, f64), k: usize, of: usize, colour| {
            let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|&(i, j)| place(i, j)).unzip();
            let mut label = vec![String::new(); points.len()];
            if let Some(end) = label.last_mut().filter(|_| k.is_multiple_of(of.div_ceil(LABELS))) {
                *end = four_digits(value);
            }
            let said = points.iter().zip(&y).map(|(&(i, j), value)| {
                let [x, y, value] = [xs[i], ys[j], *value].map(four_digits);
                format!("{x_title} {x}<br>{y_title} {y}<br>{value}")
            });
            let line = chart_line(&x, &y, name, colour, DashType::Solid).mode(Mode::LinesText);
            let line = line.text_array(label).text_position(Position::TopRight);
            let line = line.hover_text_array(said.collect::<Vec<String>>());
            plot.add_trace(line.hover_info(HoverInfo::Text).legend_group(name).show_legend(k == 0));
        };
    let (m, n) = (xs.len(), ys.len());
    for (i, &x) in xs.iter().enumerate() {
        draw((0..n).map(|j| (i, j)).collect(), (x_title, x), i, m, COLOURS[1]);
    }
    for (j, &y) in ys.iter().enumerate() {
        draw((0..m).map(|i| (i, j)).collect(), (y_title, y), j, n, COLOURS[2]);
    }
    let across = chart_axis("").show_tick_labels(false).show_grid(false).zero_line(false);
    plot.set_layout(chart_layout().x_axis(across).y_axis(chart_axis(title).zero_line(false)));
    Some(plot)
}

/// A number for a label: four digits.
fn four_digits(value: f64) -> String {
    let rounded = format!("{value:.3e}").parse().unwrap_or(value);
    format!("{rounded}")
}

/// Points over two axes, with the line through some of them that no other point beats.
pub fn trade_chart([x_title, y_title]: [&str; 2], points: &[[f64; 2]], front: &[[f64; 2]]) -> Plot {
    let [x, y] = [0, 1].map(|i| points.iter().map(|point| point[i]).collect::<Vec<f64>>());
    let [front_x, front_y] = [0, 1].map(|i| front.iter().map(|p| p[i]).collect::<Vec<f64>>());
    let mut plot = Plot::new();
    let dots = Scatter::new(x, y).name("cases").mode(Mode::Markers);
    plot.add_trace(dots.marker(Marker::new().color(COLOURS[0])));
    let line = chart_line(&front_x, &front_y, "front", COLOURS[2], DashType::Solid);
    plot.add_trace(line.mode(Mode::LinesMarkers));
    plot.set_layout(chart_layout().x_axis(chart_axis(x_title)).y_axis(chart_axis(y_title)));
    plot
}

/// A line through points with its name.
pub type NamedPoints = (String, Vec<[f64; 2]>);

/// Lines through points over two axes, such as fronts of two costs side by side.
pub fn fronts_chart([x_title, y_title]: [&str; 2], lines: &[NamedPoints]) -> Plot {
    let mut plot = Plot::new();
    for (i, (name, points)) in lines.iter().enumerate() {
        let [x, y] = [0, 1].map(|k| points.iter().map(|point| point[k]).collect::<Vec<f64>>());
        let line = chart_line(&x, &y, name, COLOURS[(i + 1) % COLOURS.len()], DashType::Solid);
        plot.add_trace(line.mode(Mode::LinesMarkers));
    }
    plot.set_layout(chart_layout().x_axis(chart_axis(x_title)).y_axis(chart_axis(y_title)));
    plot
}

/// A trace of parallel coordinates.
#[derive(Clone, Serialize)]
struct Parallel {
    r#type: &'static str,
    line: ParallelLine,
    dimensions: Vec<Dimension>,
}

#[derive(Clone, Serialize)]
struct ParallelLine {
    color: Vec<f64>,
    colorscale: &'static str,
}

#[derive(Clone, Serialize)]
struct Dimension {
    label: String,
    values: Vec<f64>,
}

impl Trace for Parallel {
    fn to_json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Parallel coordinates: an upright axis for each named column, a line for each case, coloured by the last column.
pub fn parallel_chart(columns: Vec<(String, Vec<f64>)>) -> Plot {
    let color = columns.last().map(|(_, values)| values.clone()).unwrap_or_default();
    let dimensions = columns.into_iter().map(|(label, values)| Dimension { label, values });
    let line = ParallelLine { color, colorscale: "Viridis" };
    let mut plot = Plot::new();
    plot.add_trace(Box::new(Parallel {
        r#type: "parcoords",
        line,
        dimensions: dimensions.collect(),
    }));
    plot.set_layout(chart_layout().margin(Margin::new().left(64).right(64).top(64).bottom(24)));
    plot
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A whole grid has contours; with a place missing, or twice, it has points.
    #[test]
    fn a_whole_grid_has_contours() {
        let grid = [[0.0, 0.0, 1.0], [1.0, 0.0, 2.0], [0.0, 5.0, 3.0], [1.0, 5.0, 4.0]];
        let json = |places: &[Place3]| map_chart(["x", "y"], places).to_json();
        assert!(json(&grid).contains("\"z\":[[1.0,2.0],[3.0,4.0]]"), "{}", json(&grid));
        assert!(!json(&grid[..3]).contains("contour"));
        assert!(!json(&[grid[0], grid[1], grid[2], grid[2]]).contains("contour"));
        assert!(carpet_chart(["x", "y", "z"], &grid[..3]).is_none());
        let parallel =
            parallel_chart(vec![("a".into(), vec![1.0, 2.0]), ("b".into(), vec![3.0, 4.0])]);
        let text = parallel.to_json();
        assert!(text.contains("parcoords") && text.contains("\"color\":[3.0,4.0]"), "{text}");
    }
    /// On a plane every line of a carpet is straight, the crossings are the places, and each line is drawn once.
    #[test]
    fn a_carpet_has_a_line_for_each_step() {
        let plane = |x: f64, y: f64| [x, y, 3.0 * x - y];
        let places: Vec<Place3> =
            (0..12).map(|k| plane(0.2 + 0.1 * f64::from(k % 4), f64::from(k / 4))).collect();
        let plot = carpet_chart(["mu", "gj", "J"], &places).unwrap();
        let json: serde_json::Value = serde_json::from_str(&plot.to_json()).unwrap();
        let lines = json["data"].as_array().unwrap();
        assert_eq!(lines.len(), 4 + 3);
        let numbers = |line: &serde_json::Value, key: &str| -> Vec<f64> {
            line[key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
        };
        for (k, line) in lines.iter().enumerate() {
            let (x, y) = (numbers(line, "x"), numbers(line, "y"));
            assert_eq!(x.len(), if k < 4 { 3 } else { 4 });
            let slope = |i: usize| (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
            assert!((1..x.len() - 1).all(|i| (slope(i) - slope(0)).abs() < 1e-9), "{line}");
            assert!(x.is_sorted(), "both axes go to the right");
        }
        // the second line of the first axis meets the third of the second where both have the place
        let (first, second) = (&lines[1], &lines[4 + 2]);
        for key in ["x", "y"] {
            assert!((numbers(first, key)[2] - numbers(second, key)[1]).abs() < 1e-12, "{key}");
        }
        assert!((numbers(first, "y")[2] - (3.0 * 0.3 - 2.0)).abs() < 1e-12);
        assert_eq!(second["text"][3], "2");
    }
}
