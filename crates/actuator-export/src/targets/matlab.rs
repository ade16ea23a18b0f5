//! MATLAB: a handle class in one file.

use super::with;
use crate::constant::{Constant, Value, number, wrapped};
use crate::library::{Library, prefixed};
use crate::plan::Plan;
use crate::stages::{Kind, List, Stage};
use std::collections::BTreeSet;

const CLASS: &str = include_str!("../../templates/matlab/main.m");

/// Longest line of a list of numbers, characters.
const WIDTH: usize = 96;

pub(crate) fn files(plan: &Plan<'_>) -> Vec<(String, String)> {
    let library = Library::new(&[
        include_str!("../../templates/matlab/laws.m"),
        include_str!("../../templates/matlab/stages.m"),
    ]);
    let law = &plan.law;
    let more = [
        ("about", prefixed(&plan.about(), "    % ")),
        ("constants", numbers(plan)),
        ("law_title", law.title.to_owned()),
        ("law_equation", prefixed(law.equation, "%   ")),
        ("law", library.pieces(law.functions.iter().copied())),
        ("stages", stage_functions(plan, &library)),
        ("amplifier_start", forward(plan, List::Amplifier, "start")),
        ("linkage_start", forward(plan, List::Linkage, "start")),
        ("amplifier_step", forward(plan, List::Amplifier, "step")),
        ("linkage_step", forward(plan, List::Linkage, "step")),
        ("inverse_start", inverse_start(plan, &library)),
        ("inverse", inverse(plan, &library)),
        ("follow", follow(plan)),
    ];
    let more: Vec<(&str, &str)> = more.iter().map(|(key, text)| (*key, text.as_str())).collect();
    vec![(format!("{}.m", plan.name), with(plan, CLASS, &more))]
}

/// The functions of every kind of stage in use, once.
fn stage_functions(plan: &Plan<'_>, library: &Library) -> String {
    let kinds: BTreeSet<Kind> = plan.stages().map(|stage| stage.kind).collect();
    let text = |kind: &Kind| {
        let piece = kind.piece();
        let dashes = "-".repeat(98_usize.saturating_sub(kind.title().len()));
        let equation = prefixed(kind.equation(), "%   ");
        let functions = library.piece(&format!("{piece}.functions"));
        format!("\n% {dashes} {}\n%\n{equation}\n\n{functions}\n", kind.title())
    };
    kinds.iter().map(text).collect()
}

/// The struct of all numbers; those of a stage in a struct of its own.
fn numbers(plan: &Plan<'_>) -> String {
    let mut lines: Vec<String> = Vec::new();
    for constant in plan.common.iter().chain(&plan.law.constants) {
        lines.push(assignment(&format!("p.{}", constant.name), constant));
    }
    for stage in plan.stages() {
        let id = &stage.id;
        lines.push(format!("    % {}", stage.place));
        lines.push(format!("    p.{id}.time_step_s = p.TIME_STEP_S;"));
        // lists know their lengths
        let listed = |constant: &&Constant| {
            stage.kind != Kind::Lags || !matches!(constant.value, Value::Count(_))
        };
        for constant in stage.constants.iter().filter(listed) {
            let field = format!("p.{id}.{}", constant.name.to_lowercase());
            lines.push(assignment(&field, constant));
        }
    }
    lines.join("\n")
}

fn assignment(field: &str, constant: &Constant) -> String {
    let comment = constant.comment();
    let indent = " ".repeat(8);
    match &constant.value {
        Value::Count(count) => format!("    {field} = {count};    % {comment}"),
        Value::Scalar(value) => format!("    {field} = {};    % {comment}", number(*value)),
        Value::List(values) => {
            let list = wrapped(values, WIDTH, &indent, " ...");
            format!("    % {comment}\n    {field} = [ ...\n{indent}{list}];")
        }
        Value::Triangle(rows) => {
            // a full matrix, filled up with zeros
            let row = |row: &Vec<f64>| {
                let mut row = row.clone();
                row.resize(rows.len() + 2, 0.0);
                format!("{indent}{}", wrapped(&row, WIDTH, &indent, " ..."))
            };
            let rows: Vec<String> = rows.iter().map(row).collect();
            format!("    % {comment}\n    {field} = [ ...\n{}];", rows.join("; ...\n"))
        }
    }
}

fn signal(list: List) -> &'static str {
    match list {
        List::Amplifier => "volt",
        List::Linkage => "deg",
    }
}

/// From stage to stage in the order of the chain.
fn forward(plan: &Plan<'_>, list: List, what: &str) -> String {
    let line = |stage: &Stage| {
        let (x, id, kind) = (signal(list), &stage.id, stage.kind.piece());
        let memory = if what == "step" { format!("m.{id}, ") } else { String::new() };
        format!("    [{x}, m.{id}] = {kind}_{what}(p.{id}, {memory}{x});")
    };
    plan.list(list).iter().map(line).collect::<Vec<_>>().join("\n")
}

fn inverse_start(plan: &Plan<'_>, library: &Library) -> String {
    let line = |stage: &Stage| {
        let (id, kind) = (&stage.id, stage.kind.piece());
        if stage.kind.has_history() {
            format!("    r.{id} = {kind}_history(p.{id}, r.model.{id});")
        } else {
            format!("    r.{id} = [];")
        }
    };
    let mut lines: Vec<String> = plan.stages().map(line).collect();
    if plan.law.guesses_rate {
        lines.push(library.piece("prandtl.inverse_start").to_owned());
    }
    lines.join("\n")
}

/// From the last stage back to the command.
fn inverse(plan: &Plan<'_>, library: &Library) -> String {
    let step = |stage: &Stage| {
        let (x, id, kind) = (signal(stage.list), &stage.id, stage.kind.piece());
        let arguments = format!("p.{id}, r.model.{id}, r.{id}, {x}");
        match stage.kind {
            Kind::Delay => None,
            Kind::Saturation | Kind::CurrentLimit => Some(format!(
                "        [{x}, r.{id}, within] = {kind}_inverse({arguments});\n        \
                 reached = reached && within;"
            )),
            _ => Some(format!("        [{x}, r.{id}] = {kind}_inverse({arguments});")),
        }
    };
    let mut lines: Vec<String> = plan.linkage.iter().rev().filter_map(step).collect();
    lines.push(if plan.law.guesses_rate {
        library.piece("prandtl.inverse").to_owned()
    } else {
        "        [volt, reached] = law_inverse(p, r.model.law, r.model.law_volt, deg);".to_owned()
    });
    lines.extend(plan.amplifier.iter().rev().filter_map(step));
    lines.join("\n")
}

/// What the inverse remembers goes along with what really came.
fn follow(plan: &Plan<'_>) -> String {
    let lags = plan.stages().filter(|stage| stage.kind == Kind::Lags);
    let line = |stage: &Stage| {
        let id = &stage.id;
        format!("    r.{id} = lags_follow(p.{id}, r.model.{id}, r.{id});")
    };
    lags.map(line).collect::<Vec<_>>().join("\n")
}
