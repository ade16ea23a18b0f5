//! The page around the charts.

use super::charts::{azimuth_chart, load_chart, loop_chart};
use super::{HeadlineRow, StudyReport};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use plotly::Plot;
use rotor_study::MeanLoads;

/// The report as one HTML text: charts, style and script inside, nothing loaded from anywhere.
pub fn report_html(report: &StudyReport) -> String {
    let mut charts = Charts::default();
    let body = html! {
        header {
            h1 { (report.title) }
            @if report.finding.is_drawn() {
                figure.finding { (PreEscaped(report.finding.svg(&report.title))) }
            }
            p.lead { @for sentence in &report.setting { (sentence) " " } }
            @if !report.data_title.is_empty() { p { "Bench data: " strong { (report.data_title) } } }
        }
        @if !report.warnings.is_empty() {
            section.warnings {
                h2 { "Read first" }
                ul { @for warning in &report.warnings { li { (warning) } } }
            }
        }
        (headline(&report.headline))
        (state(report))
        @if !report.loads.is_empty() {
            section {
                h2 { "Hub loads at the blade number per rev" }
                p { "Amplitudes in the fixed frame, forces over m0 Omega" sup { "2" } "R" sup { "2" }
                    ", moments over m0 Omega" sup { "2" } "R" sup { "3" }
                    ". The cost J is quadratic in the loads: half of every load is 75 % off J." }
                div.grid.wide {
                    @for bars in &report.loads { (charts.figure(&bars.title, "", &load_chart(bars))) }
                }
            }
        }
        @if !report.azimuth.is_empty() {
            section {
                h2 { "Voltage and flap angle against azimuth" }
                p { "Azimuth 0 over the tail; flap angle positive trailing edge down." }
                div.grid {
                    @for chart in &report.azimuth {
                        (charts.tall_figure(&chart.title, &azimuth_chart(chart)))
                    }
                }
            }
        }
        @if !report.loops.is_empty() {
            section {
                h2 { "Actuator on the bench: measured against simulated" }
                p { "Last steady cycle of each run. NRMSE: rms error over the standard deviation of "
                    "the measured output, whole record." }
                div.grid {
                    @for chart in &report.loops {
                        @let title = format!("{} Hz, {:.0} V", short(chart.frequency_hz), chart.amplitude_volt);
                        @let side = if chart.trained { "trained" } else { "held out" };
                        @let note = format!("{}: {side}, NRMSE {:.1} %", chart.id, chart.nrmse_percent);
                        (charts.figure(&title, &note, &loop_chart(chart)))
                    }
                }
            }
        }
        (fits(report))
        @for section in &report.sections {
            section {
                h2 { (section.title) }
                @if !section.text.is_empty() { p { (section.text) } }
                (table(&section.header, &section.rows))
            }
        }
        (assumed(report))
        footer { p { (report.program) ", result " code { (report.key) } } }
    };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (report.title) }
                style { (PreEscaped(STYLE)) }
                (PreEscaped(plotly_script()))
            }
            body {
                main { (body) }
                script { (PreEscaped(charts.script())) }
            }
        }
    };
    page.into_string()
}

fn headline(rows: &[HeadlineRow]) -> Markup {
    let names: Vec<&String> =
        rows.first().map(|r| r.ours.iter().map(|(n, _)| n).collect()).unwrap_or_default();
    html! {
        @if !rows.is_empty() {
            section {
                h2 { "Beside the paper" }
                div.scroll { table {
                    thead { tr { th { "quantity" } th { "paper" } @for name in &names { th { (name) } } } }
                    tbody { @for row in rows { tr {
                        th { (row.quantity) } td { (row.paper) }
                        @for (_, value) in &row.ours { td { (value) } }
                    } } }
                } }
            }
        }
    }
}

fn state(report: &StudyReport) -> Markup {
    let (t, r) = (&report.trim, &report.residuals);
    let angles = [
        ("theta0, deg", t.theta0_deg),
        ("theta1c, deg", t.theta1c_deg),
        ("theta1s, deg", t.theta1s_deg),
        ("shaft tilt, deg", t.alpha_s_deg),
        ("bank, deg", t.phi_s_deg),
    ];
    let residuals = [("trim", r.trim), ("periodicity", r.periodicity), ("inflow", r.inflow)];
    html! {
        section {
            h2 { "Trim and residuals" }
            div.scroll { table {
                thead { tr {
                    @for (name, _) in &angles { th { (name) } }
                    @for (name, _) in &residuals { th { (name) " residual" } }
                } }
                tbody { tr {
                    @for (_, value) in &angles { td { (format!("{value:.3}")) } }
                    @for (_, value) in &residuals { td { (format!("{value:.1e}")) } }
                } }
            } }
            @if let Some([loads, shaft]) = report.mean_loads.as_ref().map(MeanLoads::text) {
                p { "Mean loads on the hub " (loads) "; " (shaft) "." }
            }
            @if let Some(stability) = report.stability.text() {
                p { "Trimmed blade " (stability) ". All motions are in result.json." }
            }
        }
    }
}

/// Everything the case says, with units.
fn assumed(report: &StudyReport) -> Markup {
    let header = ["part of the case", "quantity", "value", "unit"].map(str::to_owned);
    let rows: Vec<Vec<String>> = report
        .assumptions
        .iter()
        .map(|a| vec![a.part.clone(), a.quantity.clone(), a.value.clone(), a.unit.to_owned()])
        .collect();
    html! {
        @if !rows.is_empty() {
            section {
                h2 { "Assumptions" }
                p { "R is the radius of the rotor, m0 the mass per length of its blade, Omega its speed." }
                (table(&header, &rows))
            }
        }
    }
}

fn fits(report: &StudyReport) -> Markup {
    let optional = |v: Option<f64>| v.map_or_else(|| "-".to_owned(), |v| format!("{v:+.2}"));
    let header = ["run", "side", "Hz", "V", "NRMSE %", "static only %", "amplitude %", "phase deg"];
    let rows: Vec<Vec<String>> = report
        .fits
        .iter()
        .map(|f| {
            let side = match f.use_as {
                crate::stored_actuator::FitUse::Trained => "trained",
                crate::stored_actuator::FitUse::HeldOut => "held out",
            };
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
        })
        .collect();
    html! {
        @if !rows.is_empty() {
            section {
                h2 { "Fit of the actuator model" }
                (table(&header.map(str::to_owned), &rows))
            }
        }
    }
}

fn table(header: &[String], rows: &[Vec<String>]) -> Markup {
    html! {
        div.scroll { table {
            thead { tr { @for head in header { th { (head) } } } }
            tbody { @for row in rows { tr {
                @for (i, cell) in row.iter().enumerate() {
                    @if i == 0 { th { (cell) } } @else { td { (cell) } }
                }
            } } }
        } }
    }
}

/// A frequency without needless digits.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The charts of a page: boxes in the text, their data in one script at its end.
#[derive(Default)]
struct Charts {
    json: Vec<String>,
}

impl Charts {
    fn figure(&mut self, title: &str, note: &str, plot: &Plot) -> Markup {
        self.boxed(title, note, plot, "chart")
    }

    fn tall_figure(&mut self, title: &str, plot: &Plot) -> Markup {
        self.boxed(title, "", plot, "chart tall")
    }

    fn boxed(&mut self, title: &str, note: &str, plot: &Plot, class: &str) -> Markup {
        let id = format!("chart-{}", self.json.len());
        // a title in the data must not end the script it stands in
        self.json.push(plot.to_json().replace("</", "<\\/"));
        html! {
            figure {
                figcaption { strong { (title) } @if !note.is_empty() { br; span.note { (note) } } }
                div class=(class) id=(id) {}
            }
        }
    }

    fn script(&self) -> String {
        format!("const charts = [{}];\n{SCRIPT}", self.json.join(",\n"))
    }
}

/// The plotting library alone, of the scripts plotly brings.
fn plotly_script() -> String {
    let sources = Plot::offline_js_sources();
    let end = sources.find("</script>").map_or(sources.len(), |i| i + "</script>".len());
    sources[..end].to_owned()
}

/// Draws the charts in the colours of the reader's theme, again when it changes.
const SCRIPT: &str = include_str!("report.js");
/// The style of the page.
const STYLE: &str = include_str!("report.css");
