//! Charts that many pages have, as plotly plots without colours of background and text: the page sets those.

use plotly::common::{Anchor, DashType, Line, Marker, Mode, Orientation, Title};
use plotly::layout::{Axis, BarMode, Legend, Margin};
use plotly::{Bar, Layout, Plot, Scatter};

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
