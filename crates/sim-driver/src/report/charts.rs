//! The charts, as plotly plots without colours of background and text: the page sets those.

use super::tables::HISTORY_AZIMUTHS;
use crate::results::{ControlLine, ControlRecord, LoopRecord, MeasuredLine, SeriesLine, flap_name};
use plotly::common::{Anchor, DashType, Line, Marker, Mode, Orientation, Title};
use plotly::layout::{
    AngularAxis, Axis, BarMode, LayoutPolar, Legend, Margin, PolarDirection, RadialAxis,
};
use plotly::{Bar, Layout, Plot, Scatter, Trace};
use rotor_base::uniform_azimuths_rad;
use rotor_study::{DiskLoads, HubLoads, MeasuredData};
use serde::Serialize;

/// Colours that stay apart from each other and readable on light and dark, also for the colour-blind
/// (Okabe and Ito's palette).
const MEASURED: &str = "#8c8c8c";
const MODEL: &str = "#0e86d4";
const STATIC: &str = "#d55e00";
const SERIES: [&str; 5] = ["#8c8c8c", "#0e86d4", "#d55e00", "#009e73", "#cc79a7"];

/// The legend stands below the axis title: the top is left to the zoom buttons.
fn layout() -> Layout {
    let legend =
        Legend::new().orientation(Orientation::Horizontal).x(0.0).y(-0.2).y_anchor(Anchor::Top);
    Layout::new().margin(Margin::new().left(56).right(16).top(28).bottom(84)).legend(legend)
}

fn axis(title: &str) -> Axis {
    Axis::new().title(Title::with_text(title)).auto_margin(true)
}

fn line(
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

/// Flap angle against voltage: measured, dynamic model, static model.
pub(super) fn loop_chart(chart: &LoopRecord) -> Plot {
    let mut plot = Plot::new();
    let u = &chart.voltage_volt;
    if !chart.static_deg.is_empty() {
        plot.add_trace(line(u, &chart.static_deg, "static model", STATIC, DashType::Dot));
    }
    plot.add_trace(line(u, &chart.measured_deg, "measured", MEASURED, DashType::Solid));
    plot.add_trace(line(u, &chart.simulated_deg, "dynamic model", MODEL, DashType::Dash));
    plot.set_layout(
        layout().x_axis(axis("voltage, V")).y_axis(axis("flap angle, deg").zero_line(false)),
    );
    plot
}

/// Voltage, bias included, above flap angle, trailing edge down positive, against azimuth.
pub(super) fn azimuth_chart(record: &ControlRecord) -> Plot {
    let mut plot = Plot::new();
    let azimuths = uniform_azimuths_rad(HISTORY_AZIMUTHS);
    let psi: Vec<f64> = azimuths.iter().map(|a| a.to_degrees()).collect();
    for (i, flap) in record.end.flaps.iter().enumerate() {
        let colour = SERIES[1 + i % (SERIES.len() - 1)];
        let trace = |series: &SeriesLine| {
            let values: Vec<f64> = azimuths.iter().map(|a| series.0.value(*a)).collect();
            line(&psi, &values, &flap_name(i), colour, DashType::Solid)
        };
        plot.add_trace(trace(&flap.voltage_volt));
        plot.add_trace(trace(&flap.flap_deg).y_axis("y2").show_legend(false));
    }
    let ticks: Vec<f64> = (0..=4).map(|i| 90.0 * f64::from(i)).collect();
    plot.set_layout(
        layout()
            .x_axis(axis("azimuth, deg").range(vec![0.0, 360.0]).tick_values(ticks).anchor("y2"))
            .y_axis(axis("voltage, V").domain(&[0.54, 1.0]))
            .y_axis2(axis("flap, deg").domain(&[0.0, 0.46]).anchor("x")),
    );
    plot
}

/// A curve to draw: its name, dots or line, azimuths in deg, values.
pub(crate) type DrawnCurve<'a> = (&'a str, Mode, Vec<f64>, Vec<f64>);

/// Curves against azimuth.
pub(crate) fn curve_chart(title: &str, curves: Vec<DrawnCurve<'_>>) -> Plot {
    let mut plot = Plot::new();
    for (i, (name, mode, psi_deg, values)) in curves.into_iter().enumerate() {
        let colour = SERIES[i % SERIES.len()];
        let trace = line(&psi_deg, &values, name, colour, DashType::Solid);
        plot.add_trace(trace.mode(mode).marker(Marker::new().color(colour)));
    }
    let ticks: Vec<f64> = (0..=4).map(|i| 90.0 * f64::from(i)).collect();
    let azimuth = axis("azimuth, deg").range(vec![0.0, 360.0]).tick_values(ticks);
    plot.set_layout(layout().x_axis(azimuth).y_axis(axis(title).zero_line(false)));
    plot
}

/// Measured values as dots, measured harmonics as a line, and the computed curve.
pub(super) fn measured_chart(of: &MeasuredLine) -> Plot {
    let (psi_deg, values) = of.curve.measured.points();
    let mode = match &of.curve.measured {
        MeasuredData::Samples { .. } => Mode::Markers,
        MeasuredData::Harmonics(_) => Mode::Lines,
    };
    let azimuths = uniform_azimuths_rad(of.computed.len());
    let computed_deg = azimuths.iter().map(|psi| psi.to_degrees()).collect();
    let computed = ("computed", Mode::Lines, computed_deg, of.computed.clone());
    curve_chart(of.curve.quantity.name(), vec![("measured", mode, psi_deg, values), computed])
}

/// Named values of two results as grouped bars.
pub(crate) fn pair_chart(title: &str, heads: &[String], sides: [(&str, Vec<f64>); 2]) -> Plot {
    let mut plot = Plot::new();
    for (i, (name, values)) in sides.into_iter().enumerate() {
        let bars = Bar::new(heads.to_vec(), values).name(name);
        plot.add_trace(bars.marker(Marker::new().color(SERIES[i])));
    }
    plot.set_layout(layout().bar_mode(BarMode::Group).x_axis(axis("")).y_axis(axis(title)));
    plot
}

/// The six loads as grouped bars: without control, and with each actuator for one set of harmonics.
pub(super) fn load_chart(before: &[f64; 6], lines: &[ControlLine]) -> Plot {
    let names: Vec<String> = HubLoads::NAMES.iter().map(|n| n.to_uppercase()).collect();
    let mut plot = Plot::new();
    let after = lines.iter().map(|line| {
        let name = format!("{} (J {:+.0} %)", line.head.actuator, -line.reduction_percent);
        (name, line.head.hub_nb_per_rev.amplitudes())
    });
    let series = std::iter::once(("without control".to_owned(), *before)).chain(after);
    for (i, (name, loads)) in series.enumerate() {
        let hover: Vec<String> = loads
            .iter()
            .zip(before)
            .map(|(after, before)| format!("{:+.0} % of the load", 100.0 * (after / before - 1.0)))
            .collect();
        let scaled: Vec<f64> = loads.iter().map(|v| 1e4 * v).collect();
        plot.add_trace(
            Bar::new(names.clone(), scaled)
                .name(name)
                .hover_text_array(hover)
                .marker(Marker::new().color(SERIES[i % SERIES.len()])),
        );
    }
    plot.set_layout(
        layout().bar_mode(BarMode::Group).x_axis(axis("")).y_axis(axis("amplitude, 1e-4")),
    );
    plot
}

/// Sectors of a disk with a colour for a value each: plotly's `barpolar`, which its crate does not have.
#[derive(Debug, Clone, Serialize)]
struct DiskTrace {
    r#type: &'static str,
    /// Inner radius and depth of a sector.
    base: Vec<f64>,
    r: Vec<f64>,
    /// Azimuth of its middle and its angle, deg.
    theta: Vec<f64>,
    width: Vec<f64>,
    /// Radius of its middle.
    customdata: Vec<f64>,
    marker: DiskColours,
    hovertemplate: String,
}

#[derive(Debug, Clone, Serialize)]
struct DiskColours {
    color: Vec<f64>,
    colorscale: &'static str,
    showscale: bool,
}

impl Trace for DiskTrace {
    fn to_json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// A value over the disk, seen from above with the flight up the page: azimuth 0 below, 90 deg to the right.
pub(super) fn disk_chart(disk: &DiskLoads, values: &[f64], unit: &str) -> Plot {
    let (panels, stations) = (disk.panels(), disk.stations_r());
    let step_deg = 360.0 / disk.azimuths() as f64;
    let of_panel = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        (0..values.len()).map(|at| value(at % panels)).collect()
    };
    let mut plot = Plot::new();
    plot.add_trace(Box::new(DiskTrace {
        r#type: "barpolar",
        base: of_panel(&|k| disk.edges_r[k]),
        r: of_panel(&|k| disk.edges_r[k + 1] - disk.edges_r[k]),
        theta: (0..values.len()).map(|at| (at / panels) as f64 * step_deg).collect(),
        width: vec![step_deg; values.len()],
        customdata: of_panel(&|k| stations[k]),
        marker: DiskColours { color: values.to_vec(), colorscale: "Viridis", showscale: true },
        hovertemplate: format!(
            "azimuth %{{theta}} deg, %{{customdata:.3f}} R<br>%{{marker.color:.4g}}{unit}<extra></extra>"
        ),
    }));
    let angle = AngularAxis::new().direction(PolarDirection::Counterclockwise).rotation(270.0);
    let radius = RadialAxis::new().range([0.0, 1.0].map(Into::into));
    let polar =
        LayoutPolar::new().bg_color("rgba(0,0,0,0)").angular_axis(angle).radial_axis(radius);
    plot.set_layout(layout().polar(polar));
    plot
}
