//! C99: a header and a source.

use super::with;
use crate::constant::{Constant, Value, number, wrapped};
use crate::library::{Library, filled, prefixed};
use crate::plan::Plan;
use crate::stages::{Kind, List, Stage};

const HEADER: &str = include_str!("../../templates/c/main.h");
const SOURCE: &str = include_str!("../../templates/c/main.c");

/// Longest line of a list of numbers, characters.
const WIDTH: usize = 100;

pub(crate) fn files(plan: &Plan<'_>) -> Vec<(String, String)> {
    let library = Library::new(&[
        include_str!("../../templates/c/laws.c"),
        include_str!("../../templates/c/stages.c"),
    ]);
    let name = plan.name;
    vec![
        (format!("{name}.h"), header(plan, &library)),
        (format!("{name}.c"), source(plan, &library)),
    ]
}

fn header(plan: &Plan<'_>, library: &Library) -> String {
    let mut types = vec![lengths(plan)];
    types.push(format!("/* Memory of the law. */\n{}", library.piece(plan.law.memory)));
    for stage in plan.stages() {
        for (ending, what) in
            [("memory", "Memory of"), ("history", "What the inverse remembers of")]
        {
            let piece = library.piece(&format!("{}.{ending}", stage.kind.piece()));
            if !piece.is_empty() {
                types.push(of(stage, &format!("/* {what} {}. */\n{piece}", stage.place)));
            }
        }
    }
    types.retain(|text| !text.is_empty());
    let field = |kind: &str, name: &str| format!("    {{{{name}}}}_{kind} {name};");
    let remembering = || plan.stages().filter(|stage| stage.kind.remembers());
    let mut state = vec![field("law", "law")];
    state.extend(remembering().map(|stage| field(&stage.id, &stage.id)));
    let with_history = plan.stages().filter(|stage| stage.kind.has_history());
    let histories = with_history.map(|stage| field(&format!("{}_history", stage.id), &stage.id));
    let mut inverse_state: Vec<String> = histories.collect();
    inverse_state.extend(own_inverse(plan, library, "_state"));
    let about = prefixed(&plan.about(), " * ");
    let more = [
        ("about", about.as_str()),
        ("types", &types.join("\n\n")),
        ("state", &state.join("\n")),
        ("inverse_state", &inverse_state.join("\n")),
        ("time_step", &number(plan.time_step_s)),
        ("lowest", &number(plan.model.range_volt.lowest_volt())),
        ("highest", &number(plan.model.range_volt.highest_volt())),
    ];
    with(plan, HEADER, &more)
}

/// A piece of the inverse of a law whose rate has to be guessed.
fn own_inverse(plan: &Plan<'_>, library: &Library, ending: &str) -> Option<String> {
    let piece = || library.piece(&format!("prandtl.inverse{ending}")).to_owned();
    plan.law.guesses_rate.then(piece)
}

/// Lengths of lists, for the declarations.
fn lengths(plan: &Plan<'_>) -> String {
    let count = |prefix: &str, constant: &Constant| match constant.value {
        Value::Count(count) => {
            let name = format!("{prefix}{}", constant.name);
            Some(format!("enum {{ {{{{NAME}}}}_{name} = {count} }};   /* {} */", constant.meaning))
        }
        _ => None,
    };
    let mut lines: Vec<String> =
        plan.law.constants.iter().filter_map(|constant| count("", constant)).collect();
    for stage in plan.stages() {
        let prefix = format!("{}_", stage.id.to_uppercase());
        lines.extend(stage.constants.iter().filter_map(|constant| count(&prefix, constant)));
    }
    lines.join("\n")
}

fn source(plan: &Plan<'_>, library: &Library) -> String {
    let law = &plan.law;
    let equation = prefixed(law.equation, " *     ");
    let mut law_parts = vec![format!("/* {}:\n{equation} */", law.title)];
    law_parts.push(constants(&law.constants, ""));
    law_parts.push(library.pieces(law.functions.iter().copied()));
    // what the dynamic law has to come near to is another map than its output
    if law.memory != "dynamic.type" {
        law_parts.push(library.piece("law.probe").to_owned());
    }
    let law_text = law_parts.join("\n\n");
    let stages: String = plan.stages().map(|stage| stage_code(stage, library)).collect();
    let used = |constant: &&Constant| {
        [SOURCE, &law_text, &stages].iter().any(|text| text.contains(constant.name))
    };
    let common: Vec<Constant> = plan.common.iter().filter(used).cloned().collect();
    let glue = Glue { plan, library };
    let more = [
        ("common_constants", constants(&common, "")),
        ("law", law_text),
        ("stages", stages),
        ("amplifier_start", glue.forward(List::Amplifier, "start")),
        ("linkage_start", glue.forward(List::Linkage, "start")),
        ("amplifier_step", glue.forward(List::Amplifier, "step")),
        ("linkage_step", glue.forward(List::Linkage, "step")),
        ("inverse_start", glue.inverse_start()),
        ("inverse", glue.inverse()),
        ("follow", glue.follow()),
    ];
    let more: Vec<(&str, &str)> = more.iter().map(|(key, text)| (*key, text.as_str())).collect();
    with(plan, SOURCE, &more)
}

/// The words of a stage filled into a text.
fn of(stage: &Stage, text: &str) -> String {
    let upper = stage.id.to_uppercase();
    filled(text, &[("id", &stage.id), ("ID", &upper), ("unit", stage.list.unit())])
}

fn stage_code(stage: &Stage, library: &Library) -> String {
    let dashes = "-".repeat(94_usize.saturating_sub(stage.place.len()));
    let kind = stage.kind;
    let equation = prefixed(kind.equation(), " *     ");
    let names = ["forward", "inverse"].map(|ending| format!("{}.{ending}", kind.piece()));
    let functions = library.pieces(names.iter().map(String::as_str));
    let numbers = constants(&stage.constants, &format!("{}_", stage.id.to_uppercase()));
    of(
        stage,
        &format!(
            "/* {dashes} {} */\n\n/* {}:\n{equation} */\n\n{numbers}\n\n{functions}\n\n",
            stage.place,
            kind.title(),
        ),
    )
}

/// Definitions of numbers, lengths left out.
fn constants(constants: &[Constant], prefix: &str) -> String {
    let lines = constants.iter().filter_map(|constant| {
        let name = format!("{prefix}{}", constant.name);
        let comment = constant.comment();
        Some(match &constant.value {
            Value::Count(_) => return None,
            Value::Scalar(value) => {
                format!("static const double {name} = {};   /* {comment} */", number(*value))
            }
            Value::List(values) => {
                let list = wrapped(values, WIDTH, "    ", "");
                let length = values.len();
                format!(
                    "/* {comment} */\nstatic const double {name}[{length}] = {{\n    {list}\n}};"
                )
            }
            Value::Triangle(rows) => {
                let row = |row: &Vec<f64>| format!("    {{{}}},", wrapped(row, WIDTH, "     ", ""));
                let text: Vec<String> = rows.iter().map(row).collect();
                let (count, length) = (rows.len(), rows.len() + 2);
                format!(
                    "/* {comment} */\nstatic const double {name}[{count}][{length}] = {{\n{}\n}};",
                    text.join("\n")
                )
            }
        })
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// The lines that lead a signal through the stages.
struct Glue<'a> {
    plan: &'a Plan<'a>,
    library: &'a Library,
}

impl Glue<'_> {
    /// From stage to stage in the order of the chain.
    fn forward(&self, list: List, what: &str) -> String {
        let x = signal(list);
        let lines = self.plan.list(list).iter().map(|stage| {
            let id = &stage.id;
            if stage.kind.remembers() {
                format!("    {x} = {id}_{what}(&s->{id}, {x});")
            } else {
                format!("    {x} = {id}_step({x});")
            }
        });
        lines.collect::<Vec<_>>().join("\n")
    }

    fn inverse_start(&self) -> String {
        let with_history = self.plan.stages().filter(|stage| stage.kind.has_history());
        let mut lines: Vec<String> = with_history
            .map(|stage| of(stage, "    {{id}}_history_start(&s->{{id}}, &s->model.{{id}});"))
            .collect();
        lines.extend(own_inverse(self.plan, self.library, "_start"));
        lines.join("\n")
    }

    /// From the last stage back to the command.
    fn inverse(&self) -> String {
        let step = |stage: &Stage| {
            let x = signal(stage.list);
            let arguments = match stage.kind {
                Kind::Delay => return None,
                Kind::Lags => "&s->model.{{id}}, &s->{{id}}, {{x}}",
                Kind::Resonance => "&s->{{id}}, {{x}}",
                Kind::CurrentLimit => "&s->model.{{id}}, {{x}}, &reached",
                Kind::Saturation => "{{x}}, &reached",
                Kind::Load => "{{x}}",
                Kind::Accommodation | Kind::Backlash | Kind::Friction => "&s->model.{{id}}, {{x}}",
            };
            let line = format!("        {{{{x}}}} = {{{{id}}}}_inverse({arguments});");
            Some(of(stage, &filled(&line, &[("x", x)])))
        };
        let mut lines: Vec<String> = self.plan.linkage.iter().rev().filter_map(step).collect();
        lines.push(own_inverse(self.plan, self.library, "").unwrap_or_else(|| {
            "        volt = law_inverse(&s->model.law, s->model.law_volt, deg, &s->deg_per_volt,\n                           &reached);"
                .to_owned()
        }));
        lines.extend(self.plan.amplifier.iter().rev().filter_map(step));
        lines.join("\n")
    }

    /// What the inverse remembers goes along with what really came.
    fn follow(&self) -> String {
        let lags = self.plan.stages().filter(|stage| stage.kind == Kind::Lags);
        let lines = lags.map(|stage| of(stage, "    {{id}}_follow(&s->{{id}}, &s->model.{{id}});"));
        lines.collect::<Vec<_>>().join("\n")
    }
}

/// Name of the signal in the stages of a list.
fn signal(list: List) -> &'static str {
    match list {
        List::Amplifier => "volt",
        List::Linkage => "deg",
    }
}
