//! Measured loops against the model.

use super::{LINE, MEASURED, MODEL, MOST_RUNS, POINTS, RUNS};
use crate::curves::CurveIdentification;
use crate::identification::{BenchIdentification, fits};
use preisach_dyn::forc::outputs;
use preisach_dyn::identify::{BenchRecord, Drive, RecordUse};
use report_page::pictures::{Look, Panel, PointForm, Series, legend, thinned};
use report_page::{Markup, counted, folded, grid, titled};
use std::ops::Range;

const TITLE: &str = "Loops, measured and simulated";
/// Steady cycles of a periodic run that are drawn, its last ones.
const CYCLES: f64 = 2.0;
/// Reversal curves that are drawn.
const CURVES: usize = 24;

/// A line of a name and a colour.
pub(super) fn line(name: &str, colour: usize) -> Look {
    Look { name: name.to_owned(), colour, form: PointForm::Line }
}

/// The samples of a run that are drawn: those judged, of a periodic run its last steady cycles.
fn drawn(record: &BenchRecord, drive: &Drive) -> Range<usize> {
    let judged = record.judged_samples();
    let Some(steady) = drive.steady_within(&judged, record.time_step_s) else { return judged };
    let first = record.time_step_s * steady.end as f64 - CYCLES / drive.base_hz;
    let is_early = |i: &usize| (*i as f64) * record.time_step_s < first;
    let start = steady.clone().take_while(is_early).count() + steady.start;
    start..steady.end
}

/// Loops of every run, the worst first, and the table of fits.
pub(super) fn section(
    found: &BenchIdentification,
    simulated: &[Vec<f64>],
    [input, output]: [&str; 2],
) -> Markup {
    let looks = [line("measured", MEASURED), line("simulated", MODEL)];
    let mut order: Vec<usize> = (0..found.fits.len()).collect();
    let error = |i: usize| found.fits[i].nrmse_percent;
    order.sort_by(|a, b| error(*b).total_cmp(&error(*a)));
    order.truncate(MOST_RUNS);
    let most = (POINTS / order.len().max(1)).clamp(LINE[0], LINE[1]);
    let panel = |&i: &usize| {
        let (record, fit) = (&found.records[i], &found.fits[i]);
        let samples = drawn(record, &found.identification.records[i].drive);
        let zero = found.identification.zero_deg;
        let series = |look: &Look, value: &dyn Fn(usize) -> f64| {
            let points: Vec<[f64; 2]> =
                samples.clone().map(|k| [record.voltage_volt[k], value(k)]).collect();
            Series { look: look.clone(), points: thinned(&points, most), told: Vec::new() }
        };
        let side = if fit.use_as == RecordUse::HeldOut { "held out" } else { "trained" };
        Panel {
            title: format!("{}, {side}", record.id),
            note: format!("NRMSE {:.2} %", fit.nrmse_percent),
            axes: [format!("input, {input}"), format!("output, {output}")],
            series: vec![
                series(&looks[0], &|k| record.output_deg[k] - zero),
                series(&looks[1], &|k| simulated[i][k]),
            ],
            ..Panel::default()
        }
        .markup()
    };
    let (first, rest) = order.split_at(order.len().min(RUNS));
    let mut parts = vec![legend(&looks), grid("grid", first.iter().map(panel))];
    if !rest.is_empty() {
        let title = format!("{} more", counted(rest.len(), "run"));
        parts.push(folded(&title, &grid("grid", rest.iter().map(panel))));
    }
    let unit = found.heading.channels.as_ref().map_or("V", |own| own.input.as_str());
    parts.push(folded("Every run in numbers", &fits(found.fits.iter(), unit).table()));
    let left_out = found.fits.len() - order.len();
    let more = match left_out {
        0 => String::new(),
        1 => " One run with a smaller error is in the table alone.".to_owned(),
        _ => format!(" {left_out} runs with smaller errors are in the table alone."),
    };
    let text = format!(
        "The runs that the model misses most come first. Of a periodic run the last two steady cycles are drawn, of others all that is judged.{more}"
    );
    titled("loops", TITLE, &text, &parts)
}

/// The family of reversal curves in one picture.
pub(super) fn of_curves(found: &CurveIdentification, [input, output]: [&str; 2]) -> Markup {
    let looks = [line("measured", MEASURED), line("simulated", MODEL)];
    let curves = &found.data().curves;
    let every = curves.len().div_ceil(CURVES).max(1);
    let most = POINTS / (10 * CURVES);
    let series: Vec<Series> = curves
        .iter()
        .step_by(every)
        .flat_map(|curve| {
            let simulated = outputs(found.model(), curve);
            [(&looks[0], &curve.output), (&looks[1], &simulated)].map(|(look, values)| {
                let pairs = curve.input.iter().zip(values);
                let points: Vec<[f64; 2]> = pairs.map(|(u, y)| [*u, *y]).collect();
                Series { look: look.clone(), points: thinned(&points, most), told: Vec::new() }
            })
        })
        .collect();
    let panel = Panel {
        title: format!("{} of {} curves", curves.len().div_ceil(every), curves.len()),
        axes: [format!("input, {input}"), format!("output, {output}")],
        series,
        ..Panel::default()
    };
    let text = "Every curve begins at its reversal, to which the input fell from saturation.";
    titled("loops", TITLE, text, &[legend(&looks), grid("grid wide", [panel.markup()])])
}
