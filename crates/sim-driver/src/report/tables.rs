//! The tables of a report, and the histories as CSV.

use crate::results::{ControlRecord, flap_name, set_name};
use report_page::Section;
use rotor_base::uniform_azimuths_rad;
use rotor_study::{SensitivityLine, most_moved};
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
