//! The report of a study: charts and tables from what was computed.

use super::{RobustnessCell, Sensitivity, most_moved, paper};
use crate::SimError;
use crate::case::LoadedCase;
use crate::raw::SeriesLine;
use crate::report::{
    AzimuthChart, FlapTrace, LoadBars, LoopChart, ResultSection, StudyReport, bench_loops,
};
use crate::results::{ControlLine, RunResult, StoredResult, flap_name};
use crate::run::RunOutcome;
use crate::stored_actuator::StoredFit;
use rotor_base::uniform_azimuths_rad;
use serde::Serialize;
use std::fmt::Write as _;

/// Azimuths of the histories.
pub(super) const HISTORY_AZIMUTHS: usize = 120;

/// What a report shows that does not follow from the result: bench and setting.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct PagePart {
    /// Title of the page.
    pub title: String,
    /// What was run, a sentence each.
    pub setting: Vec<String>,
    /// Title of the bench data.
    pub data_title: String,
    /// Fit of every bench run.
    pub fits: Vec<StoredFit>,
    /// Measured and simulated loops.
    pub loops: Vec<LoopChart>,
}

impl PagePart {
    /// That of a stored report.
    pub fn of(report: &StudyReport) -> Self {
        Self {
            title: report.title.clone(),
            setting: report.setting.clone(),
            data_title: report.data_title.clone(),
            fits: report.fits.clone(),
            loops: report.loops.clone(),
        }
    }

    /// blake3 of all of it.
    ///
    /// # Errors
    /// [`SimError::NotWritten`] if JSON cannot express it.
    pub fn key(&self) -> Result<String, SimError> {
        let text = serde_json::to_string(self)
            .map_err(|e| SimError::NotWritten { path: "JSON".into(), reason: e.to_string() })?;
        Ok(blake3::hash(text.as_bytes()).to_hex().to_string())
    }
}

/// Bench and setting of a run.
///
/// # Errors
/// [`SimError::Actuator`] if a model cannot follow a bench record.
pub fn page_part(loaded: &LoadedCase, outcome: &RunOutcome) -> Result<PagePart, SimError> {
    let loops = match &outcome.actuators.bench {
        Some((data, found)) => bench_loops(data, found)?,
        None => vec![],
    };
    Ok(PagePart {
        title: loaded.case.title.clone(),
        setting: setting(loaded),
        data_title: outcome.actuators.data_title.clone(),
        fits: outcome.actuators.fits.clone(),
        loops,
    })
}

/// The report of a stored result: every figure of the control from the result alone.
pub fn study_report(stored: &StoredResult<RunResult>, page: PagePart) -> StudyReport {
    let result = &stored.result;
    let harmonics = &stored.case.control.harmonics;
    let at_paper = (stored.case.advance_ratio - paper::ADVANCE_RATIO).abs() < 1e-9;
    StudyReport {
        title: page.title,
        program: stored.program.clone(),
        key: stored.key.clone(),
        setting: page.setting,
        warnings: result.warnings.clone(),
        data_title: page.data_title,
        headline: if at_paper { paper::headline(result) } else { vec![] },
        trim: result.trim,
        mean_loads: result.mean_loads,
        residuals: result.residuals,
        stability: result.stability.clone(),
        fits: page.fits,
        loops: page.loops,
        azimuth: result.control.iter().map(azimuth_chart).collect(),
        loads: load_bars(result),
        sections: [
            (!result.sensitivity.is_empty())
                .then(|| sensitivity_section(harmonics, &result.sensitivity)),
            (!result.robustness.is_empty()).then(|| robustness_section(&result.robustness)),
        ]
        .into_iter()
        .flatten()
        .collect(),
    }
}

fn setting(loaded: &LoadedCase) -> Vec<String> {
    let case = &loaded.case;
    vec![
        format!(
            "{} blades, advance ratio {:.3}, {:?} couplings, modes {:?} (flap, lag, torsion).",
            case.blades, case.advance_ratio, case.blade.couplings, case.blade.modes
        ),
        format!("Sections: {}. Inflow: {:?}.", case.section_model().title(), case.inflow),
        format!(
            "One revolution of the rotor is {:.4} s of bench time ({} rev/s).",
            1.0 / case.actuator.bench_rev_hz,
            case.actuator.bench_rev_hz
        ),
        "While the harmonic control acts, pilot controls and attitude stay as trimmed; the inflow settles anew."
            .to_owned(),
    ]
}

/// `2/rev` or `2+3/rev`.
pub(super) fn set_name(harmonics: &[usize]) -> String {
    let all: Vec<String> = harmonics.iter().map(usize::to_string).collect();
    format!("{}/rev", all.join("+"))
}

fn azimuth_chart(line: &ControlLine) -> AzimuthChart {
    let azimuths = uniform_azimuths_rad(HISTORY_AZIMUTHS);
    let values = |series: &SeriesLine| azimuths.iter().map(|a| series.0.value(*a)).collect();
    let flaps = line.record.flaps.iter().enumerate();
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

fn load_bars(result: &RunResult) -> Vec<LoadBars> {
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

fn sensitivity_section(harmonics: &[Vec<usize>], rows: &[Sensitivity]) -> ResultSection {
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

fn robustness_section(cells: &[RobustnessCell]) -> ResultSection {
    let controllers = ["global", "local", "adaptive"];
    let rows = cells
        .chunks(controllers.len())
        .filter_map(|each| {
            let first = each.first()?;
            let d = first.disturbance;
            let head = [
                format!("{}/rev", first.harmonic),
                format!("{}", d.noise_percent),
                format!("{} / {} deg", d.t_gain, d.t_phase_deg),
                format!("{}", d.drift_percent),
            ];
            let ends = each.iter().map(|cell| {
                format!("{:.1} ({}, {})", cell.reduction_percent, cell.steps, cell.outcome)
            });
            Some(head.into_iter().chain(ends).collect())
        })
        .collect();
    let head = ["per rev", "noise %", "T0 error", "drift %"].map(str::to_owned);
    ResultSection {
        title: "What the controllers stand".to_owned(),
        text: "Fall of J in percent, with steps and end of the loop, which is that of the study (a weight tuned to the stroke goes with the constant T, limits with the others): noise of a load over the baseline, T0 wrong by gain and phase, loss of actuator gain per measurement. The loads counted are those without noise.".to_owned(),
        header: head.into_iter().chain(controllers.map(str::to_owned)).collect(),
        rows,
    }
}

/// Flap and voltage histories of every study as CSV text.
///
/// One row per azimuth (deg, psi = 0 aft) of the blade the flaps belong to; flap angle trailing edge down
/// positive.
pub fn histories_csv(lines: &[ControlLine]) -> String {
    let mut text = String::from("set,actuator,flap,azimuth_deg,voltage_V,flap_deg\n");
    for line in lines {
        let (set, actuator) = (set_name(&line.harmonics), &line.actuator);
        for (k, flap) in line.record.flaps.iter().enumerate() {
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
