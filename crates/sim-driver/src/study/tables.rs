//! The report of a study: charts and tables from what was computed.

use super::{ControlStudy, RobustnessCell, Sensitivity, paper};
use crate::SimError;
use crate::case::LoadedCase;
use crate::report::{AzimuthChart, FlapTrace, LoadBars, ResultSection, StudyReport, bench_loops};
use crate::results::{RunResult, StoredResult, flap_name};
use crate::run::RunOutcome;
use rotor_base::uniform_azimuths_rad;
use std::fmt::Write as _;

/// Azimuths of the histories.
pub(super) const HISTORY_AZIMUTHS: usize = 120;

/// The report of a run: sensitivity and robustness are empty where none were asked for.
///
/// # Errors
/// [`SimError::Actuator`] if a model cannot follow a bench record.
pub fn study_report(
    loaded: &LoadedCase,
    outcome: &RunOutcome,
    stored: &StoredResult<RunResult>,
    (sensitivity, robustness): (&[Sensitivity], &[RobustnessCell]),
) -> Result<StudyReport, SimError> {
    let result = &outcome.result;
    let loops = match &outcome.actuators.bench {
        Some((data, found)) => bench_loops(data, found)?,
        None => vec![],
    };
    Ok(StudyReport {
        title: loaded.case.title.clone(),
        program: stored.program.clone(),
        key: stored.key.clone(),
        setting: setting(loaded),
        warnings: result.warnings.clone(),
        data_title: outcome.actuators.data_title.clone(),
        headline: if at_paper_condition(loaded) { paper::headline(result) } else { vec![] },
        trim: result.trim,
        residuals: result.residuals,
        stability: result.stability.clone(),
        fits: outcome.actuators.fits.clone(),
        loops,
        azimuth: outcome.studies.iter().map(azimuth_chart).collect(),
        loads: load_bars(result),
        sections: [
            (!sensitivity.is_empty()).then(|| sensitivity_section(loaded, sensitivity)),
            (!robustness.is_empty()).then(|| robustness_section(robustness)),
        ]
        .into_iter()
        .flatten()
        .collect(),
    })
}

/// Whether the case flies at the one advance ratio the paper reports.
fn at_paper_condition(loaded: &LoadedCase) -> bool {
    (loaded.case.advance_ratio - paper::ADVANCE_RATIO).abs() < 1e-9
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

fn azimuth_chart(study: &ControlStudy) -> AzimuthChart {
    let azimuths = uniform_azimuths_rad(HISTORY_AZIMUTHS);
    AzimuthChart {
        title: format!("{}, {}", set_name(&study.harmonics), study.actuator.name()),
        azimuth_deg: azimuths.iter().map(|a| a.to_degrees()).collect(),
        flaps: study
            .state
            .flaps
            .iter()
            .enumerate()
            .map(|(k, motion)| FlapTrace {
                name: flap_name(k),
                voltage_volt: azimuths.iter().map(|a| motion.voltage_volt.value(*a)).collect(),
                flap_deg: azimuths.iter().map(|a| motion.flap_deg.value(*a)).collect(),
            })
            .collect(),
    }
}

fn load_bars(result: &RunResult) -> Vec<LoadBars> {
    let before = result.baseline.hub_4_per_rev.amplitudes();
    let mut bars: Vec<LoadBars> = Vec::new();
    for line in &result.control {
        let title = set_name(&line.harmonics);
        let after =
            (line.actuator.clone(), line.hub_4_per_rev.amplitudes(), line.reduction_percent);
        match bars.iter_mut().find(|b| b.title == title) {
            Some(bar) => bar.after.push(after),
            None => bars.push(LoadBars { title, before, after: vec![after] }),
        }
    }
    bars
}

fn sensitivity_section(loaded: &LoadedCase, rows: &[Sensitivity]) -> ResultSection {
    let sets = loaded.case.control.harmonics.iter().filter(|set| set.len() == 1);
    let sets = sets.map(|set| format!("{} J %", set_name(set)));
    let number = |value: f64| if value.is_nan() { "-".to_owned() } else { format!("{value:.1}") };
    let mut text = "Reduction of J with one assumption changed at a time, the one that moves a reduction most first; ideal actuator, held to the stroke of the identified one.".to_owned();
    for row in rows {
        if let Some(why) = &row.failure {
            let _ = write!(text, " No answer with {}: {why}.", row.assumption);
        }
    }
    ResultSection {
        title: "What the paper leaves open".to_owned(),
        text,
        header: std::iter::once("assumption".to_owned())
            .chain(sets)
            .chain(std::iter::once("largest change".to_owned()))
            .collect(),
        rows: rows
            .iter()
            .map(|row| {
                std::iter::once(row.assumption.clone())
                    .chain(row.reduction_percent.iter().map(|r| number(*r)))
                    .chain(std::iter::once(number(row.largest_change)))
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
        text: "Fall of J in percent, with steps and end of the loop, on the identified actuators and the linearised rotor: noise of a load over the baseline, T0 wrong by gain and phase, loss of actuator gain per measurement. The loads counted are those without noise.".to_owned(),
        header: head.into_iter().chain(controllers.map(str::to_owned)).collect(),
        rows,
    }
}

/// Flap and voltage histories of every study as CSV text.
///
/// One row per azimuth (deg, psi = 0 aft) of the blade the flaps belong to; flap angle trailing edge down
/// positive.
pub fn histories_csv(studies: &[ControlStudy]) -> String {
    let mut text = String::from("set,actuator,flap,azimuth_deg,voltage_V,flap_deg\n");
    for study in studies {
        let (set, actuator) = (set_name(&study.harmonics), study.actuator.name());
        for (k, motion) in study.state.flaps.iter().enumerate() {
            for azimuth in uniform_azimuths_rad(HISTORY_AZIMUTHS) {
                let row = format!(
                    "{set},{actuator},{},{},{:e},{:e}\n",
                    flap_name(k),
                    azimuth.to_degrees(),
                    motion.voltage_volt.value(azimuth),
                    motion.flap_deg.value(azimuth)
                );
                text.push_str(&row);
            }
        }
    }
    text
}
