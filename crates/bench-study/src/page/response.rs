//! Gain and phase over frequency.

use super::{NORMAL_95, RESPONSE};
use crate::identification::{IdentifyResult, section as table_of};
use crate::stored::{HarmonicResponse, StoredFit};
use measured_data::significant;
use report_page::pictures::{Look, Panel, PointForm, Series, legend, short};
use report_page::{Markup, folded, grid, titled};

/// Frequencies, and amplitudes, that differ by less than this share are one.
const SAME: f64 = 0.05;
/// Colours of the amplitudes, the largest first.
const COLOURS: [usize; 5] = [1, 2, 3, 4, 0];

/// The periodic runs with their responses, the largest amplitude first.
fn periodic(result: &IdentifyResult) -> Vec<(&StoredFit, HarmonicResponse, [f64; 2])> {
    let all = result.runs.iter();
    let mut runs: Vec<_> =
        all.filter_map(|run| Some((run, run.response?, run.model_response()?))).collect();
    runs.sort_by(|a, b| {
        let by_amplitude = b.0.amplitude_volt.total_cmp(&a.0.amplitude_volt);
        by_amplitude.then(a.0.frequency_hz.total_cmp(&b.0.frequency_hz))
    });
    runs
}

/// The number of different values.
fn different(mut values: Vec<f64>) -> usize {
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| *b <= *a * (1.0 + SAME));
    values.len()
}

/// Gain and lag of the runs that repeat, each amplitude with its colour, and the model's.
pub(super) fn section(result: &IdentifyResult, [input, output]: [&str; 2]) -> Markup {
    let runs = periodic(result);
    if runs.is_empty() {
        let text = "No run is periodic. Record sines, several cycles each, at three frequencies or more in the range of use.";
        return titled("response", RESPONSE, text, &[]);
    }
    let mut text = "Output over input at the strongest harmonic of each command, over the steady cycles judged. Upright lines: 95 % intervals for white noise of the size that repeated cycles show.".to_owned();
    if runs.iter().any(|own| own.1.std_deviation.is_none()) {
        text += " A run without one has no cycle that repeats: record three cycles or more.";
    }
    let frequencies = different(runs.iter().map(|own| own.0.frequency_hz).collect());
    if frequencies < 2 {
        text += " All runs have one frequency: record sines at two more, so that the lag shows how it depends on the rate.";
    }
    let groups: Vec<&[_]> =
        runs.chunk_by(|a, b| b.0.amplitude_volt >= a.0.amplitude_volt * (1.0 - SAME)).collect();
    let name = |group: &[(&StoredFit, HarmonicResponse, [f64; 2])]| {
        format!("{} {input}", significant(group[0].0.amplitude_volt, 3))
    };
    let look =
        |name: &str, colour: usize, form: PointForm| Look { name: name.to_owned(), colour, form };
    let colour = |group: usize| COLOURS[group % COLOURS.len()];
    let panel = |which: usize, title: &str, unit: &str| {
        let mut series = Vec::new();
        for (k, group) in groups.iter().enumerate() {
            let of = |own: &HarmonicResponse| [own.gain, own.lag_deg][which];
            let ends = group.iter().filter_map(|(run, own, _)| {
                let half = NORMAL_95 * own.std_deviation?[which];
                Some([-half, half].map(|end| [run.frequency_hz, of(own) + end]))
            });
            let told = group.iter().map(|(run, own, model)| {
                format!("{}: {} {unit}, model {}", run.id, short(of(own)), short(model[which]))
            });
            series.push(Series {
                look: look("", colour(k), PointForm::Links),
                points: ends.flatten().collect(),
                told: Vec::new(),
            });
            series.push(Series {
                look: look("", colour(k), PointForm::Line),
                points: group
                    .iter()
                    .map(|(run, _, model)| [run.frequency_hz, model[which]])
                    .collect(),
                told: Vec::new(),
            });
            series.push(Series {
                look: look("", colour(k), PointForm::Dots),
                points: group.iter().map(|(run, own, _)| [run.frequency_hz, of(own)]).collect(),
                told: told.collect(),
            });
        }
        Panel {
            title: title.to_owned(),
            axes: ["frequency, Hz".to_owned(), format!("{title}, {unit}")],
            is_log: [frequencies > 1, false],
            series,
            ..Panel::default()
        }
        .markup()
    };
    let mut looks: Vec<Look> = groups
        .iter()
        .enumerate()
        .map(|(k, group)| look(&name(group), colour(k), PointForm::Dots))
        .collect();
    looks.push(look("model", colour(0), PointForm::Line));
    let panels = [panel(0, "gain", &format!("{output}/{input}")), panel(1, "lag", "deg")];
    let numbers = folded("In numbers", &numbers(&runs, [input, output]));
    titled("response", RESPONSE, &text, &[legend(&looks), grid("grid wide", panels), numbers])
}

/// The same as a table.
fn numbers(
    runs: &[(&StoredFit, HarmonicResponse, [f64; 2])],
    [input, output]: [&str; 2],
) -> Markup {
    let four = |value: f64| significant(value, 4).to_string();
    let rows = runs.iter().map(|(run, own, model)| {
        let [gain_half, lag_half] = match own.std_deviation {
            Some(own) => own.map(|std| format!("{}", significant(NORMAL_95 * std, 2))),
            None => ["-".to_owned(), "-".to_owned()],
        };
        let (hz, amplitude) =
            (significant(run.frequency_hz, 3), significant(run.amplitude_volt, 3));
        vec![
            run.id.clone(),
            hz.to_string(),
            amplitude.to_string(),
            four(own.gain),
            gain_half,
            four(model[0]),
            four(own.lag_deg),
            lag_half,
            four(model[1]),
        ]
    });
    let gain = format!("gain, {output}/{input}");
    let header = ["run", "Hz", input, &gain, "+-", "model", "lag, deg", "+-", "model"];
    table_of(&header, rows).table()
}
