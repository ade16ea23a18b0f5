//! The tables of a report, and the histories as CSV.

use crate::output::csv_of;
use crate::results::{ControlRecord, flap_name, set_name};
use report_page::Section;
use rotor_base::uniform_azimuths_rad;
use rotor_study::{RobustnessLine, SensitivityLine, most_moved};
use std::fmt::Write as _;

/// Azimuths of the histories.
pub(super) const HISTORY_AZIMUTHS: usize = 120;

/// Sets of a single harmonic, which the sensitivities are about.
fn single(harmonics: &[Vec<usize>]) -> impl Iterator<Item = String> {
    harmonics.iter().filter(|set| set.len() == 1).map(|set| set_name(set))
}

/// A row of the sensitivities: id, assumption, reductions, largest change, the row compared with.
fn sensitivity_row(
    row: &SensitivityLine,
    sets: usize,
    number: impl Fn(Option<f64>) -> String,
) -> Vec<String> {
    let mut cells = vec![row.id.clone(), row.assumption.clone()];
    cells.extend((0..sets).map(|k| number(row.reduction_percent.get(k).copied())));
    cells.extend([number(row.largest_change), row.compared_with.clone()]);
    cells
}

/// The reductions with one assumption changed at a time.
pub(super) fn sensitivity(harmonics: &[Vec<usize>], rows: &[SensitivityLine]) -> Section {
    let sets: Vec<String> = single(harmonics).map(|set| format!("{set}/rev J %")).collect();
    let mut text = "Reduction of J with one assumption changed at a time, the one that moves a reduction most first; ideal actuator, held to the stroke of the identified one.".to_owned();
    for (set, (row, by)) in sets.iter().zip(most_moved(rows)) {
        let _ = write!(text, " {set} moves most, by {by:+.1} points, with {}.", row.assumption);
    }
    for row in rows {
        if let Some(why) = &row.failure {
            let _ = write!(text, " No answer with {}: {why}.", row.assumption);
        }
    }
    let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.1}"));
    let mut header = vec!["id".to_owned(), "assumption".to_owned()];
    header.extend(sets.iter().cloned());
    header.extend(["largest change", "from"].map(str::to_owned));
    Section {
        title: "What the paper leaves open".to_owned(),
        text,
        header,
        rows: rows.iter().map(|row| sensitivity_row(row, sets.len(), number)).collect(),
    }
}

/// The same as CSV text; an empty field has no answer.
pub fn sensitivity_csv(harmonics: &[Vec<usize>], rows: &[SensitivityLine]) -> String {
    let names: Vec<String> =
        single(harmonics).map(|set| format!("reduction_{set}_per_rev_percent")).collect();
    let mut text = format!("id,assumption,{},largest_change,compared_with\n", names.join(","));
    let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.3}"));
    for row in rows {
        let mut cells = sensitivity_row(row, names.len(), number);
        cells[1] = format!("\"{}\"", row.assumption);
        text += &(cells.join(",") + "\n");
    }
    text
}

/// Controllers of the robustness maps, in the order of their cells.
const CONTROLLERS: [&str; 3] = ["global", "local", "adaptive"];

/// The ends of the loops under every disturbance, a column for each controller.
pub(super) fn robustness(lines: &[RobustnessLine]) -> Section {
    let rows = lines.chunks(CONTROLLERS.len()).map(|each| {
        let (harmonic, d) = (each[0].cell.harmonic, each[0].cell.disturbance);
        let mut cells = vec![
            format!("{harmonic}/rev"),
            d.noise_percent.to_string(),
            format!("{} / {} deg", d.t_gain, d.t_phase_deg),
            d.drift_percent.to_string(),
        ];
        cells.extend(each.iter().map(|RobustnessLine { cell, reduction_percent, .. }| {
            format!("{reduction_percent:.1} ({}, {})", cell.steps, cell.status)
        }));
        cells
    });
    let head = ["per rev", "noise %", "T0 error", "drift %"].into_iter().chain(CONTROLLERS);
    Section {
        title: "Control under noise, a wrong T and drift".to_owned(),
        text: "Fall of J in percent, with steps and end of the loop, which is that of the study (a weight tuned to the stroke goes with the constant T, limits with the others): noise of a load over the baseline, T0 wrong by gain and phase, loss of actuator gain per measurement. The loads counted are those without noise.".to_owned(),
        header: head.map(str::to_owned).collect(),
        rows: rows.collect(),
    }
}

/// The cells of the robustness maps as CSV text.
pub fn robustness_csv(lines: &[RobustnessLine]) -> String {
    csv_of(
        lines,
        &[
            ("per_rev", &|l| l.cell.harmonic.to_string()),
            ("controller", &|l| l.cell.controller.clone()),
            ("effort", &|l| l.cell.effort.clone()),
            ("noise_percent", &|l| l.cell.disturbance.noise_percent.to_string()),
            ("t_gain", &|l| l.cell.disturbance.t_gain.to_string()),
            ("t_phase_deg", &|l| l.cell.disturbance.t_phase_deg.to_string()),
            ("drift_percent", &|l| l.cell.disturbance.drift_percent.to_string()),
            ("reduction_percent", &|l| format!("{:.3}", l.reduction_percent)),
            ("best_percent", &|l| format!("{:.3}", l.best_percent)),
            ("status", &|l| l.cell.status.clone()),
            ("steps", &|l| l.cell.steps.to_string()),
            ("backtracks", &|l| l.cell.backtracks.to_string()),
            ("measurements", &|l| l.cell.measurements.to_string()),
        ],
    )
}

/// Flap and voltage histories of every study as CSV text.
///
/// One row per azimuth (deg, psi = 0 aft) of the blade the flaps belong to; flap angle trailing edge down
/// positive.
pub fn histories_csv(lines: &[ControlRecord]) -> String {
    let mut text = String::from("set,actuator,flap,azimuth_deg,voltage_V,flap_deg\n");
    for line in lines {
        let (set, actuator) = (set_name(&line.head.harmonics), &line.head.actuator);
        for (k, flap) in line.end.flaps.iter().enumerate() {
            for azimuth in uniform_azimuths_rad(HISTORY_AZIMUTHS) {
                let row = format!(
                    "{set}/rev,{actuator},{},{},{:e},{:e}\n",
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
