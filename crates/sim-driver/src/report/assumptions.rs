//! What a case assumes, in words and as a table with units.

use crate::case::Case;
use crate::choices::spelt;
use report_page::Section;
use rotor_case::{Field, Section as CaseSection, Value as FieldValue, Visitor};
use serde_json::Value;

/// Endings of the names of fields that say the unit.
const ENDINGS: [&str; 13] = [
    "_per_V2", "_kg_m", "_m_s", "_rpm", "_deg", "_hz", "_volt", "_V", "_W", "_watt", "_percent",
    "_m", "_r",
];

/// Models whose names are not words put together.
const NAMES: [(&str, &str); 16] = [
    ("HariharanLeishman", "form of Hariharan and Leishman"),
    ("Calibrated", "calibrated to indicial solutions"),
    ("QuasiSteady", "quasi-steady"),
    ("PittPeters", "dynamic inflow of Pitt and Peters"),
    ("Drees", "momentum theory with the gradients of Drees"),
    ("Uniform", "uniform, momentum theory"),
    ("FreeWake", "free wake, converged with the trim"),
    ("Vatistas", "core of Vatistas"),
    ("Linear", "linear, flap and lag apart"),
    ("Full", "second-order flap-lag-torsion couplings"),
    ("Moderate", "moderate deflections"),
    ("Bench", "identified from bench data"),
    ("LocalMach", "local Mach number"),
    ("FromActuator", "what the actuator reaches at full-scale voltage"),
    ("MeetStroke", "control weight tuned to the stroke"),
    ("Limits", "optimum within the limits"),
];

/// The name of a model in words: `FollowsTip` as `follows tip`.
fn words(name: &str) -> String {
    let known = NAMES.iter().find(|(own, _)| *own == name);
    known.map_or_else(|| spaced(&spelt(name, ' ')), |(_, words)| (*words).to_owned())
}

/// The choice that a field of a case makes, in words.
fn choice(value: &Value) -> String {
    match value {
        Value::String(name) => words(name),
        Value::Object(members) => members.keys().next().map_or_else(String::new, |k| words(k)),
        other => other.to_string(),
    }
}

/// What was run, a sentence each.
pub(super) fn setting(case: &Case) -> Vec<String> {
    let tree = serde_json::to_value(case).unwrap_or_default();
    let at = |pointer: &str| tree.pointer(pointer).map_or_else(String::new, choice);
    let modes = &case.structure.modes;
    vec![
        format!("Rotor: {} blades at an advance ratio of {:.3}.", case.rotor.blades, case.advance_ratio),
        format!(
            "Blades: {}; {} flap, {} lag and {} torsion modes.",
            at("/structure/couplings"),
            modes.flap,
            modes.lag,
            modes.torsion
        ),
        format!("Sections: {}. Inflow: {}.", at("/aerodynamics/model"), at("/inflow/model")),
        format!("Actuator: {}. Trim: {}.", at("/actuator/model"), at("/trim")),
        format!(
            "One revolution of the rotor is {:.4} s of bench time ({} rev/s).",
            1.0 / case.actuator.bench_rev_hz,
            case.actuator.bench_rev_hz
        ),
        "While the harmonic control acts, pilot controls and attitude stay as trimmed; the inflow follows the moved \
         loading."
            .to_owned(),
    ]
}

/// Everything a case says, with units.
pub(super) fn assumptions(case: &Case) -> Section {
    let mut walk = Walk::default();
    case.each(&mut walk);
    Section {
        title: "Assumptions".to_owned(),
        text: "R is the radius of the rotor, m0 the mass per length of its blade, Omega its speed."
            .to_owned(),
        header: ["part of the case", "quantity", "value", "unit"].map(str::to_owned).to_vec(),
        rows: walk.rows,
    }
}

/// A walk over the fields of a case.
#[derive(Default)]
struct Walk {
    /// Names from the root of the case to where the walk is.
    path: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Walk {
    /// Adds the value of the field that the walk is at.
    fn row(&mut self, value: String, unit: &str) {
        let Some((name, outer)) = self.path.split_last() else { return };
        let part = if outer.is_empty() { "case".to_owned() } else { outer.join(": ") };
        let bare = ENDINGS.iter().find_map(|ending| name.strip_suffix(ending));
        let quantity = bare.filter(|_| !unit.is_empty()).unwrap_or(name);
        self.rows.push(vec![spaced(&part), spaced(quantity), value, unit.to_owned()]);
    }
}

impl Visitor for Walk {
    fn field<T: FieldValue>(&mut self, field: &Field, value: &T) {
        self.path.push(field.key.to_owned());
        if !value.inside(self) && field.key != "title" {
            let text = match serde_json::to_value(value).unwrap_or_default() {
                Value::Null => "chosen by the program".to_owned(),
                value => plain(&value, field.key),
            };
            self.row(text, field.unit);
        }
        self.path.pop();
    }

    fn section<T: CaseSection>(&mut self, choice: &str, section: &T) {
        if !choice.is_empty() {
            self.row(words(choice), "");
        }
        section.each(self);
    }

    fn item<T: CaseSection>(&mut self, index: usize, section: &T) {
        self.path.push((index + 1).to_string());
        section.each(self);
        self.path.pop();
    }
}

fn spaced(name: &str) -> String {
    name.replace('_', " ")
}

/// A value without quotes and brackets; names of models in words, titles and paths as they are.
fn plain(value: &Value, name: &str) -> String {
    match value {
        Value::String(text) if name == "dataset" || name == "path" || name == "table" => {
            text.clone()
        }
        Value::String(text) => words(text),
        Value::Object(members) => {
            let each = members.iter().map(|(key, value)| match value {
                Value::Object(_) if key.starts_with(char::is_uppercase) => {
                    format!("{} {}", words(key), plain(value, name))
                }
                value => format!("{} {}", spaced(key), plain(value, name)),
            });
            each.collect::<Vec<_>>().join(", ")
        }
        Value::Array(items) => {
            let all: Vec<String> = items.iter().map(|item| plain(item, name)).collect();
            let separator = if items.iter().any(Value::is_array) { "; " } else { ", " };
            all.join(separator)
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{FreeWakeValues, InflowChoice, PAPER_CASE, shipped_case};

    #[test]
    fn a_case_is_told_in_words_and_units() {
        let mut file = shipped_case(PAPER_CASE).unwrap().case;
        file.inflow.model = InflowChoice::FreeWake(FreeWakeValues::default());
        let text = setting(&file).join(" ");
        assert!(text.contains("free wake") && text.contains("Hariharan and Leishman"), "{text}");
        let rows = assumptions(&file).rows;
        let find = |quantity: &str| rows.iter().find(|row| row[1] == quantity).unwrap();
        assert_eq!(find("twist")[2..], ["-8.0", "deg"]);
        assert_eq!(find("omega")[3], "rpm");
        // its length stands beside the choice of how it travels
        assert!(rows.iter().any(|row| row[1] == "near wake" && row[3] == "deg"));
        for row in &rows {
            let whole = row[..3].join(" ");
            assert!(!whole.contains(['{', '}', '[', '"']), "{whole}");
        }
    }
}
