//! The page around the charts.

use super::charts::{
    azimuth_chart, disk_chart, front_charts, load_chart, loop_chart, measured_chart,
};
use super::{StudyReport, assumptions, state_lines};
use crate::results::{BenchPart, by_set, curve_name, set_name};
use bench_study::stored::StoredFit;
use maud::{Markup, PreEscaped, html};
use preisach_dyn::identify::RecordUse;
use report_page::{Charts, Section, page};
use rotor_study::DiskLoads;
use study_text::{cost_sections, front_sections, robustness_pictures};

/// The report as one HTML text: charts, style and script inside, nothing loaded from anywhere.
pub fn report_html(report: &StudyReport<'_>) -> String {
    let StudyReport { stored, figures } = *report;
    let none = BenchPart::default();
    let bench = stored.bench.as_ref().unwrap_or(&none);
    let finding = report.finding();
    let before = figures.baseline.hub_nb_per_rev.amplitudes();
    let mut charts = Charts::default();
    let body = html! {
        header {
            h1 { (stored.case.title) }
            @if finding.is_drawn() {
                figure.finding { (PreEscaped(finding.svg(&stored.case.title))) }
            }
            p.lead { @for sentence in assumptions::setting(&stored.case) { (sentence) " " } }
            @if !bench.data_title.is_empty() { p { "Bench data: " strong { (bench.data_title) } } }
        }
        @if !figures.warnings.is_empty() {
            section.warnings {
                h2 { "Read first" }
                ul { @for warning in &figures.warnings { li { (warning) } } }
            }
        }
        @if let Some(section) = report.beside_paper() { (section) }
        section {
            h2 { "Trim and residuals" }
            @for (label, text) in state_lines(figures) { p { strong { (label) } " " (text) } }
            p { "All motions are in result.json." }
        }
        @for section in report.measured() { (section) }
        @if let Some(part) = &stored.result.measured {
            section {
                h2 { "Measured and computed curves" }
                div.grid {
                    @for of in &part.curves {
                        @let title = curve_name(of.curve.quantity, of.curve.station_r);
                        (charts.figure("chart", &title, &of.curve.source, &measured_chart(of)))
                    }
                }
            }
        }
        @if !figures.control.is_empty() {
            section {
                h2 { "Hub loads at the blade number per rev" }
                p { "Amplitudes in the fixed frame, forces over m0 Omega" sup { "2" } "R" sup { "2" }
                    ", moments over m0 Omega" sup { "2" } "R" sup { "3" }
                    ". The cost J is quadratic in the loads: half of every load is 75 % off J." }
                div.grid.wide {
                    @for (harmonics, lines) in by_set(&figures.control) {
                        @let title = format!("{}/rev", set_name(harmonics));
                        (charts.figure("chart", &title, "", &load_chart(&before, lines)))
                    }
                }
            }
            section {
                h2 { "Voltage and flap angle against azimuth" }
                p { "Azimuth 0 over the tail; flap angle positive trailing edge down." }
                div.grid {
                    @for record in &stored.result.control {
                        @let title = format!("{}/rev, {}", set_name(&record.head.harmonics), record.head.actuator);
                        (charts.figure("chart tall", &title, "", &azimuth_chart(record)))
                    }
                }
            }
        }
        @for section in cost_sections(&figures.costs) { (section) }
        @let fronts = front_charts(&figures.fronts);
        @if !fronts.is_empty() {
            section {
                h2 { "What a fall of J costs" }
                p { "Least J for a given cost, every actuator as its gain at full scale, rotor and blade linearised about "
                    "the trim. Each line ends at the least J; it begins at the least cost, or where J is that without control." }
                div.grid {
                    @for (title, chart) in &fronts { (charts.figure("chart", title, "", chart)) }
                }
            }
        }
        @for section in front_sections(&figures.fronts) { (section.folded()) }
        @if let Some(disk) = &stored.result.disk { (disk_maps(&mut charts, disk)) }
        @if !bench.loops.is_empty() {
            section {
                h2 { "Actuator on the bench: measured against simulated" }
                p { "Last steady cycle of each run. NRMSE: rms error over the standard deviation of "
                    "the measured output, whole record." }
                div.grid {
                    @for chart in &bench.loops {
                        @let title = format!("{} Hz, {:.0} V", short(chart.frequency_hz), chart.amplitude_volt);
                        @let side = if chart.trained { "trained" } else { "held out" };
                        @let note = format!("{}: {side}, NRMSE {:.1} %", chart.id, chart.nrmse_percent);
                        (charts.figure("chart", &title, &note, &loop_chart(chart)))
                    }
                }
            }
        }
        @if !bench.fits.is_empty() { (fits(&bench.fits)) }
        @for section in report.further() { (section) }
        @for part in robustness_pictures(&stored.result.robustness, &stored.result.margins) { (part) }
        (assumptions::assumptions(&stored.case))
        footer { p { (stored.program) ", result " code { (stored.key) } } }
    };
    page(&stored.case.title, &body, &charts)
}

fn fits(fits: &[StoredFit]) -> Section {
    let optional = |v: Option<f64>| v.map_or_else(|| "-".to_owned(), |v| format!("{v:+.2}"));
    let header = ["run", "side", "Hz", "V", "NRMSE %", "static only %", "amplitude %", "phase deg"];
    let rows = fits.iter().map(|f| {
        let side = if f.use_as == RecordUse::Train { "trained" } else { "held out" };
        vec![
            f.id.clone(),
            side.to_owned(),
            short(f.frequency_hz),
            format!("{:.0}", f.amplitude_volt),
            format!("{:.2}", f.nrmse_percent),
            format!("{:.1}", f.static_nrmse_percent),
            optional(f.amplitude_error_percent),
            optional(f.phase_error_deg),
        ]
    });
    Section {
        title: "Fit of the actuator model".to_owned(),
        text: String::new(),
        header: header.map(str::to_owned).to_vec(),
        rows: rows.collect(),
    }
}

/// Section lift and induced velocity over the disk.
fn disk_maps(charts: &mut Charts, disk: &DiskLoads) -> Markup {
    let maps = [
        ("Section lift C_n M^2", &disk.cn_m2, ""),
        ("Induced velocity, m/s", &disk.induced_m_s, " m/s"),
    ];
    html! {
        section {
            h2 { "Over the disk" }
            p { "Flaps at rest. Seen from above, flight up the page: azimuth 0 over the tail is below, 90 deg to "
                "the right. C_n M^2: force normal to the chord per length, up positive, over half of air density, chord "
                "and the square of the speed of sound. Induced velocity down positive." }
            div.grid.wide {
                @for (title, values, unit) in maps {
                    @let [low, high] = extremes(values);
                    @let note = format!("{low:.4} to {high:.4}{unit}");
                    (charts.figure("chart tall", title, &note, &disk_chart(disk, values, unit)))
                }
            }
        }
    }
}

/// Least and largest value.
fn extremes(values: &[f64]) -> [f64; 2] {
    values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)])
}

/// A frequency without needless digits.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
