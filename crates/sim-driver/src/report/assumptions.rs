//! What a case assumes, in words and as a table with units.

use crate::case::Case;
use serde_json::Value;

/// One thing that a case says.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumption {
    /// Part of the case, such as `rotor`.
    pub part: String,
    /// The quantity, in words.
    pub quantity: String,
    /// Its value.
    pub value: String,
    /// Its unit; empty without one.
    pub unit: &'static str,
}

/// Endings of the names of fields and the units they stand for, the longer ones first.
const UNITS: [(&str, &str); 13] = [
    ("_per_V2", "1/V^2"),
    ("_kg_m", "kg/m"),
    ("_m_s", "m/s"),
    ("_rpm", "rev/min"),
    ("_deg", "deg"),
    ("_hz", "Hz"),
    ("_volt", "V"),
    ("_V", "V"),
    ("_W", "W"),
    ("_watt", "W"),
    ("_percent", "%"),
    ("_m", "m"),
    ("_r", "R"),
];

/// Units of fields whose names end in none.
const NAMED_UNITS: [(&str, &str); 5] = [
    ("ei_flap", "m0 Omega^2 R^4"),
    ("ei_lag", "m0 Omega^2 R^4"),
    ("gj", "m0 Omega^2 R^4"),
    ("ea", "m0 Omega^2 R^2"),
    ("drag_area", "pi R^2"),
];

/// Models whose names are not words put together.
const NAMES: [(&str, &str); 15] = [
    ("HariharanLeishman", "form of Hariharan and Leishman"),
    ("Calibrated", "calibrated to indicial solutions"),
    ("QuasiSteady", "quasi-steady"),
    ("PittPeters", "dynamic inflow of Pitt and Peters"),
    ("Drees", "momentum theory with the gradients of Drees"),
    ("Uniform", "uniform, momentum theory"),
    ("FreeWake", "free wake, converged with the trim"),
    ("Vatistas", "core of Vatistas"),
    ("Full", "linear flap-lag-torsion couplings"),
    ("Moderate", "moderate deflections"),
    ("Bench", "identified from bench data"),
    ("LocalMach", "local Mach number"),
    ("FromActuator", "what the actuator reaches at full-scale voltage"),
    ("MeetStroke", "control weight tuned to the stroke"),
    ("Limits", "optimum within the limits"),
];

/// The name of a model in words: `FollowsTip` as `follows tip`.
fn words(name: &str) -> String {
    if let Some((_, words)) = NAMES.iter().find(|(own, _)| *own == name) {
        return (*words).to_owned();
    }
    let mut text = String::new();
    for c in name.chars() {
        if c.is_uppercase() && !text.is_empty() {
            text.push(' ');
        }
        text.extend(c.to_lowercase());
    }
    text.replace('_', " ")
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

/// Everything a case says.
pub(super) fn assumptions(case: &Case) -> Vec<Assumption> {
    let mut rows = Vec::new();
    if let Ok(Value::Object(parts)) = serde_json::to_value(case) {
        for (part, value) in &parts {
            match value {
                Value::Object(members) if !members.keys().any(|k| is_choice(k)) => {
                    for (name, value) in members {
                        push(&mut rows, part, name, value);
                    }
                }
                value if part != "title" => push(&mut rows, "case", part, value),
                _ => {}
            }
        }
    }
    rows
}

/// Whether the name of a member is that of a choice: `Propulsive`, not `radius_m`.
fn is_choice(name: &str) -> bool {
    name.starts_with(char::is_uppercase)
}

/// Adds a field; those of an object one by one.
fn push(rows: &mut Vec<Assumption>, part: &str, name: &str, value: &Value) {
    match value {
        Value::Object(members) => {
            // a choice with fields of its own
            if let Some((only, Value::Object(fields))) = members.iter().next()
                && members.len() == 1
                && is_choice(only)
            {
                rows.push(row(part, name, words(only)));
                let inner = format!("{part}: {}", spaced(name));
                for (name, value) in fields {
                    push(rows, &inner, name, value);
                }
                return;
            }
            let inner = format!("{part}: {}", spaced(name));
            for (name, value) in members {
                push(rows, &inner, name, value);
            }
        }
        Value::Array(items) if items.iter().any(Value::is_object) => {
            for (k, item) in items.iter().enumerate() {
                push(rows, part, &format!("{name} {}", k + 1), item);
            }
        }
        Value::Null => {
            let value = "chosen by the program".to_owned();
            rows.push(Assumption { unit: "", ..row(part, name, value) });
        }
        value => rows.push(row(part, name, plain(value, name))),
    }
}

fn row(part: &str, name: &str, value: String) -> Assumption {
    let named = NAMED_UNITS.iter().find(|(own, _)| *own == name);
    let ending = UNITS.iter().find(|(ending, _)| name.ends_with(ending));
    let (quantity, unit) = match (named, ending) {
        (Some((_, unit)), _) => (name, *unit),
        (None, Some((ending, unit))) => (name.strip_suffix(ending).unwrap_or(name), *unit),
        (None, None) => (name, ""),
    };
    Assumption { part: spaced(part), quantity: spaced(quantity), value, unit }
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
        let rows = assumptions(&file);
        let find = |quantity: &str| rows.iter().find(|row| row.quantity == quantity).unwrap();
        assert_eq!((find("twist").value.as_str(), find("twist").unit), ("-8.0", "deg"));
        assert_eq!(find("omega").unit, "rev/min");
        // its length stands beside the choice of how it travels
        assert!(rows.iter().any(|row| row.quantity == "near wake" && row.unit == "deg"));
        for row in &rows {
            let whole = format!("{} {} {}", row.part, row.quantity, row.value);
            assert!(!whole.contains(['{', '}', '[', '"']), "{whole}");
        }
    }
}
