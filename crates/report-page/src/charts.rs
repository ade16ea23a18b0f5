//! Charts that many pages have, as plotly plots without colours of background and text: the page sets those.

use plotly::common::{Anchor, ColorScale, ColorScalePalette, DashType, Line, Marker, Mode};
use plotly::common::{Orientation, Title};
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

/// Values over two axes: contours where they stand on a whole grid, each place once, else points in the colour of their
/// value.
pub fn map_chart([x_title, y_title]: [&str; 2], places: &[Place3]) -> Plot {
    let column = |i: usize| -> Vec<f64> { places.iter().map(|place| place[i]).collect() };
    let steps = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    };
    let (xs, ys) = (steps(column(0)), steps(column(1)));
    let at = |x: f64, y: f64| {
        let same = |place: &&Place3| place[..2] == [x, y];
        places.iter().find(same).map(|place| place[2])
    };
    let rows: Option<Vec<Vec<f64>>> =
        ys.iter().map(|&y| xs.iter().map(|&x| at(x, y)).collect()).collect();
    let is_grid = xs.len() > 1 && ys.len() > 1 && xs.len() * ys.len() == places.len();
    let mut plot = Plot::new();
    let scale = || ColorScale::Palette(ColorScalePalette::Viridis);
    if let Some(rows) = rows.filter(|_| is_grid) {
        plot.add_trace(Contour::new(xs, ys, rows).color_scale(scale()));
    } else {
        let marker = Marker::new().size(9).color_array(column(2)).color_scale(scale());
        let points = Scatter::new(column(0), column(1)).mode(Mode::Markers);
        plot.add_trace(points.marker(marker.show_scale(true)));
    }
    plot.set_layout(chart_layout().x_axis(chart_axis(x_title)).y_axis(chart_axis(y_title)));
    plot
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
        let parallel =
            parallel_chart(vec![("a".into(), vec![1.0, 2.0]), ("b".into(), vec![3.0, 4.0])]);
        let text = parallel.to_json();
        assert!(text.contains("parcoords") && text.contains("\"color\":[3.0,4.0]"), "{text}");
    }
}
