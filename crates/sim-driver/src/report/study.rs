//! The report of a study: charts and tables from what was computed.

use super::assumptions::{assumptions, setting};
use super::{AzimuthChart, Finding, FlapTrace, LoadBars, ResultSection, StudyReport, paper};
use crate::results::{ControlRecord, Figures, SeriesLine, StoredResult, flap_name};
use rotor_base::uniform_azimuths_rad;
use rotor_study::{RobustnessLine, SensitivityLine, most_moved};
use std::fmt::Write as _;

/// Azimuths of the histories.
pub(super) const HISTORY_AZIMUTHS: usize = 120;

/// The report of a stored result and its figures.
pub fn study_report(stored: &StoredResult, figures: &Figures) -> StudyReport {
    let harmonics = &stored.case.control.harmonics;
    let at_paper = paper::is_paper(&stored.case);
    let bench = stored.bench.clone().unwrap_or_default();
    StudyReport {
        title: stored.case.title.clone(),
        program: stored.program.clone(),
        key: stored.key.clone(),
        setting: setting(&stored.case),
        assumptions: assumptions(&stored.case),
        finding: Finding::new(figures, at_paper),
        warnings: figures.warnings.clone(),
        data_title: bench.data_title,
        headline: if at_paper { paper::headline(figures) } else { vec![] },
        trim: figures.trim,
        mean_loads: figures.mean_loads,
        residuals: figures.residuals,
        stability: figures.stability.clone(),
        fits: bench.fits,
        loops: bench.loops,
        azimuth: stored.result.control.iter().map(azimuth_chart).collect(),
        loads: load_bars(figures),
        sections: [
            (!figures.sensitivity.is_empty())
                .then(|| sensitivity_section(harmonics, &figures.sensitivity)),
            (!figures.robustness.is_empty()).then(|| robustness_section(&figures.robustness)),
        ]
        .into_iter()
        .flatten()
        .collect(),
    }
}

/// `2/rev` or `2+3/rev`.
pub(super) fn set_name(harmonics: &[usize]) -> String {
    let all: Vec<String> = harmonics.iter().map(usize::to_string).collect();
    format!("{}/rev", all.join("+"))
}

fn azimuth_chart(line: &ControlRecord) -> AzimuthChart {
    let azimuths = uniform_azimuths_rad(HISTORY_AZIMUTHS);
    let values = |series: &SeriesLine| azimuths.iter().map(|a| series.0.value(*a)).collect();
    let flaps = line.end.flaps.iter().enumerate();
    AzimuthChart {
        title: format!("{}, {}", set_name(&line.harmonics), line.actuator),
        azimuth_deg: azimuths.iter().map(|a| a.to_degrees()).collect(),
        flaps: flaps
            .map(|(k, flap)| FlapTrace {
                name: flap_name(k),
                voltage_volt: values(&flap.voltage_volt),
                flap_deg: values(&flap.flap_deg),
            })
            .collect(),
    }
}

fn load_bars(result: &Figures) -> Vec<LoadBars> {
    let before = result.baseline.hub_nb_per_rev.amplitudes();
    let mut bars: Vec<LoadBars> = Vec::new();
    for line in &result.control {
        let title = set_name(&line.harmonics);
        let after =
            (line.actuator.clone(), line.hub_nb_per_rev.amplitudes(), line.reduction_percent);
        match bars.iter_mut().find(|b| b.title == title) {
            Some(bar) => bar.after.push(after),
            None => bars.push(LoadBars { title, before, after: vec![after] }),
        }
    }
    bars
}

fn sensitivity_section(harmonics: &[Vec<usize>], rows: &[SensitivityLine]) -> ResultSection {
    let sets: Vec<String> = harmonics
        .iter()
        .filter(|set| set.len() == 1)
        .map(|set| format!("{} J %", set_name(set)))
        .collect();
    let count = sets.len();
    let number =
        |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.1}"));
    let mut text = "Reduction of J with one assumption changed at a time, the one that moves a reduction most first; ideal actuator, held to the stroke of the identified one.".to_owned();
    for (set, (row, by)) in sets.iter().zip(most_moved(rows)) {
        let _ = write!(text, " {set} moves most, by {by:+.1} points, with {}.", row.assumption);
    }
    for row in rows {
        if let Some(why) = &row.failure {
            let _ = write!(text, " No answer with {}: {why}.", row.assumption);
        }
    }
    ResultSection {
        title: "What the paper leaves open".to_owned(),
        text,
        header: ["id", "assumption"]
            .map(str::to_owned)
            .into_iter()
            .chain(sets)
            .chain(["largest change", "from"].map(str::to_owned))
            .collect(),
        rows: rows
            .iter()
            .map(|row| {
                [row.id.clone(), row.assumption.clone()]
                    .into_iter()
                    .chain((0..count).map(|k| number(row.reduction_percent.get(k).copied())))
                    .chain([number(row.largest_change), row.compared_with.clone()])
                    .collect()
            })
            .collect(),
    }
}

fn robustness_section(lines: &[RobustnessLine]) -> ResultSection {
    let controllers = ["global", "local", "adaptive"];
    let rows = lines
        .chunks(controllers.len())
        .filter_map(|each| {
            let first = &each.first()?.cell;
            let d = first.disturbance;
            let head = [
                format!("{}/rev", first.harmonic),
                format!("{}", d.noise_percent),
                format!("{} / {} deg", d.t_gain, d.t_phase_deg),
                format!("{}", d.drift_percent),
            ];
            let ends = each.iter().map(|line| {
                format!(
                    "{:.1} ({}, {})",
                    line.reduction_percent, line.cell.steps, line.cell.outcome
                )
            });
            Some(head.into_iter().chain(ends).collect())
        })
        .collect();
    let head = ["per rev", "noise %", "T0 error", "drift %"].map(str::to_owned);
    ResultSection {
        title: "Control under noise, a wrong T and drift".to_owned(),
        text: "Fall of J in percent, with steps and end of the loop, which is that of the study (a weight tuned to the stroke goes with the constant T, limits with the others): noise of a load over the baseline, T0 wrong by gain and phase, loss of actuator gain per measurement. The loads counted are those without noise.".to_owned(),
        header: head.into_iter().chain(controllers.map(str::to_owned)).collect(),
        rows,
    }
}

/// Flap and voltage histories of every study as CSV text.
///
/// One row per azimuth (deg, psi = 0 aft) of the blade the flaps belong to; flap angle trailing edge down
/// positive.
pub fn histories_csv(lines: &[ControlRecord]) -> String {
    let mut text = String::from("set,actuator,flap,azimuth_deg,voltage_V,flap_deg\n");
    for line in lines {
        let (set, actuator) = (set_name(&line.harmonics), &line.actuator);
        for (k, flap) in line.end.flaps.iter().enumerate() {
            for azimuth in uniform_azimuths_rad(HISTORY_AZIMUTHS) {
                let row = format!(
                    "{set},{actuator},{},{},{:e},{:e}\n",
                    flap_name(k),
                    azimuth.to_degrees(),
                    flap.voltage_volt.0.value(azimuth),
                    flap.flap_deg.0.value(azimuth)
                );
                text.push_str(&row);
            }
        }
    }
    text
}
