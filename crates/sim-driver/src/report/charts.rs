//! The charts, as plotly plots without colours of background and text: the page sets those.

use super::tables::HISTORY_AZIMUTHS;
use crate::results::{
    ControlLine, ControlRecord, LoopRecord, MeasuredLine, SeriesLine, flap_name, set_name,
};
use plotly::common::{DashType, Marker, Mode};
use plotly::layout::{AngularAxis, BarMode, LayoutPolar, PolarDirection, RadialAxis};
use plotly::{Bar, Plot, Trace};
use report_page::{
    COLOURS, NamedPoints, chart_axis, chart_layout, chart_line, curve_chart, fronts_chart,
};
use rotor_base::uniform_azimuths_rad;
use rotor_study::{DiskLoads, FrontAgainst, FrontLine, HubLoads, MeasuredData};
use serde::Serialize;
use study_text::front_axis;

/// Flap angle against voltage: measured, dynamic model, static model.
pub(super) fn loop_chart(chart: &LoopRecord) -> Plot {
    let mut plot = Plot::new();
    let u = &chart.voltage_volt;
    if !chart.static_deg.is_empty() {
        plot.add_trace(chart_line(u, &chart.static_deg, "static model", COLOURS[2], DashType::Dot));
    }
    plot.add_trace(chart_line(u, &chart.measured_deg, "measured", COLOURS[0], DashType::Solid));
    plot.add_trace(chart_line(
        u,
        &chart.simulated_deg,
        "dynamic model",
        COLOURS[1],
        DashType::Dash,
    ));
    plot.set_layout(
        chart_layout()
            .x_axis(chart_axis("voltage, V"))
            .y_axis(chart_axis("flap angle, deg").zero_line(false)),
    );
    plot
}

/// Voltage, bias included, above flap angle, trailing edge down positive, against azimuth.
pub(super) fn azimuth_chart(record: &ControlRecord) -> Plot {
    let mut plot = Plot::new();
    let azimuths = uniform_azimuths_rad(HISTORY_AZIMUTHS);
    let psi: Vec<f64> = azimuths.iter().map(|a| a.to_degrees()).collect();
    for (i, flap) in record.end.flaps.iter().enumerate() {
        let colour = COLOURS[1 + i % (COLOURS.len() - 1)];
        let trace = |series: &SeriesLine| {
            let values: Vec<f64> = azimuths.iter().map(|a| series.0.value(*a)).collect();
            chart_line(&psi, &values, &flap_name(i), colour, DashType::Solid)
        };
        plot.add_trace(trace(&flap.voltage_volt));
        plot.add_trace(trace(&flap.flap_deg).y_axis("y2").show_legend(false));
    }
    let ticks: Vec<f64> = (0..=4).map(|i| 90.0 * f64::from(i)).collect();
    plot.set_layout(
        chart_layout()
            .x_axis(
                chart_axis("azimuth, deg").range(vec![0.0, 360.0]).tick_values(ticks).anchor("y2"),
            )
            .y_axis(chart_axis("voltage, V").domain(&[0.54, 1.0]))
            .y_axis2(chart_axis("flap, deg").domain(&[0.0, 0.46]).anchor("x")),
    );
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
                .marker(Marker::new().color(COLOURS[i % COLOURS.len()])),
        );
    }
    plot.set_layout(
        chart_layout()
            .bar_mode(BarMode::Group)
            .x_axis(chart_axis(""))
            .y_axis(chart_axis("amplitude, 1e-4")),
    );
    plot
}

/// `J / J0` against each cost: a line for every set of harmonics; none of a cost without a front.
pub(super) fn front_charts(fronts: &[FrontLine]) -> Vec<(String, Plot)> {
    let of = |against: FrontAgainst| {
        let lines =
            fronts.iter().filter(|line| line.against == against && line.useful().count() > 0);
        let curves: Vec<NamedPoints> = lines
            .map(|line| {
                let points = line.useful().map(|state| [state.second, state.cost_ratio]);
                (format!("{}/rev", set_name(&line.harmonics)), points.collect())
            })
            .collect();
        let title = format!("J against {}", against.name());
        let chart = || fronts_chart([&front_axis(against), "J/J0"], &curves);
        (!curves.is_empty()).then(|| (title, chart()))
    };
    FrontAgainst::ALL.into_iter().filter_map(of).collect()
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
    plot.set_layout(chart_layout().polar(polar));
    plot
}
