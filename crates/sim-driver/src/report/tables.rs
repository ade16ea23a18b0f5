//! The tables of a report, and the histories as CSV.

use crate::results::{ControlRecord, RunResult, flap_name, set_name};
use report_page::Section;
use rotor_base::uniform_azimuths_rad;
use rotor_study::{RobustnessCell, SensitivityLine, most_moved};
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
const CONTROLLERS: [&str; 3] = ["fixed T", "adaptive", "adaptive, told"];

/// How wrong T may be, and `J / J0` under every disturbance, a column for each controller; none without flights.
pub(super) fn robustness(result: &RunResult) -> Vec<Section> {
    // cells of an older version hold no flights
    let cells: Vec<_> = result.robustness.iter().filter(|cell| cell.cycles > 0).collect();
    if cells.is_empty() {
        return Vec::new();
    }
    let rows = cells.chunks(CONTROLLERS.len()).map(|each| {
        let (harmonic, d) = (each[0].harmonic, each[0].disturbance);
        let flap = d.t_flap.map_or_else(String::new, |flap| format!(", {}", flap_name(flap)));
        let mut row = vec![
            format!("{harmonic}/rev"),
            d.noise_percent.to_string(),
            format!("{} / {} deg{flap}", d.t_gain, d.t_phase_deg),
            d.drift_percent.to_string(),
        ];
        row.extend(each.iter().map(|cell| cell.summary()));
        row
    });
    let head = ["per rev", "noise %", "T error", "drift %"].into_iter().chain(CONTROLLERS);
    let flights = Section {
        title: "Flights under noise, a wrong T and drift".to_owned(),
        text: format!(
            "J/J0 over the last cycles of {} (of {} draws with noise: mean, best and worst; seeds alike for all controllers), then its largest on the way, loads without noise. Fixed number of cycles, no line search, half a step a cycle. Noise of a load over the baseline, T wrong by gain and phase, loss of actuator gain per cycle. The rotor is linearised about its trim, the actuators are as identified.",
            cells[0].cycles,
            cells.iter().map(|cell| cell.draws).max().unwrap_or_default()
        ),
        header: head.map(str::to_owned).collect(),
        rows: rows.collect(),
    };
    let header = [
        "per rev",
        "condition",
        "diverges at, deg",
        "diverges at gain",
        "J above J0 at, deg",
        "one flap alone, deg",
    ];
    let margins = Section {
        title: "How wrong T may be".to_owned(),
        text: "Least phase error of T common to all flaps, and gain of the rotor over it, at which a loop without limits diverges (radius of (C.14) with half a step a cycle); then the least phase error from which J rises above J0 on the way, of all flaps and of one alone, root to tip.".to_owned(),
        header: header.map(str::to_owned).to_vec(),
        rows: result.margins.iter().map(|line| line.cells().to_vec()).collect(),
    };
    vec![margins, flights]
}

/// The cells of the robustness maps as CSV text.
pub fn robustness_csv(cells: &[RobustnessCell]) -> String {
    let header = RobustnessCell::default().fields().map(|(name, _)| name).join(",");
    let rows = cells.iter().map(|cell| cell.fields().map(|(_, value)| value).join(",") + "\n");
    header + "\n" + &rows.collect::<String>()
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
