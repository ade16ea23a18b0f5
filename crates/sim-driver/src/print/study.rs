//! Sensitivities and robustness maps as CSV.

use rotor_study::{RobustnessLine, SensitivityLine};
use std::fmt::Write as _;

/// The rows as CSV text.
pub fn sensitivity_csv(harmonics: &[Vec<usize>], rows: &[SensitivityLine]) -> String {
    let sets = harmonics.iter().filter(|set| set.len() == 1);
    let names: Vec<String> =
        sets.map(|set| format!("reduction_{}_per_rev_percent", set[0])).collect();
    let mut text = format!("id,assumption,{},largest_change,compared_with\n", names.join(","));
    for row in rows {
        // an empty field has no answer
        let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.3}"));
        let numbers: Vec<String> =
            (0..names.len()).map(|k| number(row.reduction_percent.get(k).copied())).collect();
        let (numbers, change) = (numbers.join(","), number(row.largest_change));
        let _ = writeln!(
            text,
            "{},\"{}\",{numbers},{change},{}",
            row.id, row.assumption, row.compared_with
        );
    }
    text
}

/// The cells as CSV text.
pub fn robustness_csv(lines: &[RobustnessLine]) -> String {
    let mut text = String::from(
        "per_rev,controller,effort,noise_percent,t_gain,t_phase_deg,drift_percent,reduction_percent,best_percent,outcome,steps,halvings,measurements\n",
    );
    for line in lines {
        let c = &line.cell;
        let d = c.disturbance;
        // writing to a string cannot fail
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{:.3},{:.3},{},{},{},{}",
            c.harmonic,
            c.controller,
            c.effort,
            d.noise_percent,
            d.t_gain,
            d.t_phase_deg,
            d.drift_percent,
            line.reduction_percent,
            line.best_percent,
            c.outcome,
            c.steps,
            c.halvings,
            c.measurements
        );
    }
    text
}
