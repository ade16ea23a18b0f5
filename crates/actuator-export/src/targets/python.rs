//! Python: a module with a class.

use super::with;
use crate::constant::{Constant, Value, number, wrapped};
use crate::library::{Library, filled, prefixed};
use crate::plan::Plan;
use crate::stages::{Kind, List, Stage};
use std::collections::BTreeSet;

const MODULE: &str = include_str!("../../templates/python/main.py");

/// Longest line of a list of numbers, characters.
const WIDTH: usize = 100;

pub(crate) fn files(plan: &Plan<'_>) -> Vec<(String, String)> {
    let library = Library::new(&[
        include_str!("../../templates/python/laws.py"),
        include_str!("../../templates/python/stages.py"),
    ]);
    let law = &plan.law;
    let inverse = if law.guesses_rate { "prandtl.inverse" } else { "inverse" };
    let methods = library.pieces(law.functions.iter().copied().chain([inverse]));
    let equation = prefixed(law.equation, "    ");
    let words = [("methods", methods.as_str()), ("equation", &equation)];
    let law_text = filled(library.piece("law"), &words);
    let mut numbers = vec![definitions(&plan.common)];
    numbers.push(definitions(&law.constants));
    let about = prefixed(&plan.about(), "");
    let more = [
        ("about", about.as_str()),
        ("constants", &numbers.join("\n\n")),
        ("law", &law_text),
        ("stages", &stage_classes(plan, &library)),
        ("amplifier", &constructors(plan, List::Amplifier)),
        ("linkage", &constructors(plan, List::Linkage)),
    ];
    vec![(format!("{}.py", plan.name), with(plan, MODULE, &more))]
}

/// The class of every kind of stage in use, once.
fn stage_classes(plan: &Plan<'_>, library: &Library) -> String {
    let kinds: BTreeSet<Kind> = plan.stages().map(|stage| stage.kind).collect();
    if kinds.is_empty() {
        return String::new();
    }
    let classes = kinds.iter().map(|kind| library.piece(&format!("{}.class", kind.piece())));
    let mut classes: Vec<&str> = std::iter::once(library.piece("stage")).chain(classes).collect();
    classes.push("");
    classes.join("\n\n\n")
}

/// The stages of a list with their numbers.
fn constructors(plan: &Plan<'_>, list: List) -> String {
    let stages: Vec<String> = plan.list(list).iter().map(constructor).collect();
    if stages.is_empty() { String::new() } else { format!("\n{}\n        ", stages.join("\n")) }
}

fn constructor(stage: &Stage) -> String {
    let class = match stage.kind {
        Kind::Lags => "_Lags",
        Kind::Delay => "_Delay",
        Kind::Saturation => "_Saturation",
        Kind::CurrentLimit => "_CurrentLimit",
        Kind::Accommodation => "_Accommodation",
        Kind::Resonance => "_Resonance",
        Kind::Backlash => "_Backlash",
        Kind::Friction => "_Friction",
        Kind::Load => "_Load",
    };
    let mut lines = vec![format!("            # {}", stage.place), format!("            {class}(")];
    for constant in &stage.constants {
        let value = match &constant.value {
            // lists know their lengths
            Value::Count(_) if stage.kind == Kind::Lags => continue,
            Value::Triangle(_) => continue,
            Value::Count(count) => count.to_string(),
            Value::Scalar(value) => number(*value),
            Value::List(values) => {
                let indent = " ".repeat(20);
                let list = wrapped(values, WIDTH, &indent, "");
                format!("[\n{indent}{list},\n                ]")
            }
        };
        lines.push(format!("                # {}", constant.comment()));
        lines.push(format!("                {}={value},", constant.name.to_lowercase()));
    }
    lines.push("            ),".to_owned());
    lines.join("\n")
}

fn definitions(constants: &[Constant]) -> String {
    let line = |constant: &Constant| {
        let (name, comment) = (constant.name, constant.comment());
        match &constant.value {
            Value::Count(count) => format!("{name} = {count}  # {comment}"),
            Value::Scalar(value) => format!("{name} = {}  # {comment}", number(*value)),
            Value::List(values) => {
                format!("# {comment}\n{name} = [\n    {},\n]", wrapped(values, WIDTH, "    ", ""))
            }
            Value::Triangle(rows) => {
                let row = |row: &Vec<f64>| format!("    [{}],", wrapped(row, WIDTH, "     ", ""));
                let rows: Vec<String> = rows.iter().map(row).collect();
                format!("# {comment}\n{name} = [\n{}\n]", rows.join("\n"))
            }
        }
    };
    constants.iter().map(line).collect::<Vec<_>>().join("\n")
}
