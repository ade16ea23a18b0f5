//! The page of two results side by side.

use super::Comparison;
use maud::html;
use plotly::common::Mode;
use report_page::{Charts, curve_chart, page, pair_chart};
use rotor_base::{HarmonicSeries, uniform_azimuths_rad};
use rotor_study::CURVE_AZIMUTHS;

/// Two results on one page: what differs, the numbers, hub loads and curves of both drawn.
pub fn compare_html(of: &Comparison) -> String {
    let mut charts = Charts::default();
    let azimuths = uniform_azimuths_rad(CURVE_AZIMUTHS);
    let drawn = |name, series: &HarmonicSeries| {
        let values = azimuths.iter().map(|psi| series.value(*psi)).collect();
        (name, Mode::Lines, azimuths.iter().map(|psi| psi.to_degrees()).collect(), values)
    };
    let [title_a, title_b] = &of.titles;
    let title = format!("{title_a} beside {title_b}");
    let body = html! {
        header {
            h1 { (title) }
            @for (side, name) in ["A", "B"].iter().zip(&of.names) { p { strong { (side) } " " (name) } }
        }
        @if !of.notes.is_empty() {
            section.warnings {
                h2 { "Read first" }
                ul { @for note in &of.notes { li { (note) } } }
            }
        }
        (of.fields_section(usize::MAX))
        (of.hub_section())
        section {
            div.grid {
                @for unit in ["N", "N m"] {
                    @let loads: Vec<_> = of.hub_loads.iter().filter(|load| load.unit == unit).collect();
                    @let heads: Vec<String> = loads.iter().map(|load| load.name.clone()).collect();
                    @let a = loads.iter().map(|load| load.a.amplitude()).collect();
                    @let b = loads.iter().map(|load| load.b.amplitude()).collect();
                    @let plot = pair_chart(&format!("amplitude, {unit}"), &heads, [("A", a), ("B", b)]);
                    (charts.figure("chart", &format!("Hub loads, {unit}"), "", &plot))
                }
            }
        }
        (of.numbers_section())
        @if !of.curves.is_empty() {
            section {
                h2 { "Curves" }
                p { "Mean and harmonics up to the last that both hold." }
                div.grid {
                    @for curve in &of.curves {
                        @let plot = curve_chart("", vec![drawn("A", &curve.a), drawn("B", &curve.b)]);
                        (charts.figure("chart", &curve.name, "", &plot))
                    }
                }
            }
            (of.curves_section())
        }
    };
    page(&title, &body, &charts)
}
