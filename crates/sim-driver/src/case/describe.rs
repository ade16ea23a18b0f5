//! The fields of a case in words: the tables of the page `docs/src/case-format.md`, and the commented case that
//! `hhc init` writes. Both walk over the sections, so that they say what the program reads.

use super::{ActuatorChoice, PAPER_CASE, shipped_case};
use crate::files::ron_text;
use crate::output::wrap;
use crate::problem::Problems;
use rotor_case::{
    ActuatorPath, ActuatorValues, AerodynamicsValues, AirfoilStation, BenchFolder, BladeTables,
    Case, ControlValues, DissimilarBlade, EffectivenessValues, FailedFlap, Field, FlapActuator,
    FlapValues, FlightValues, FreeWakeValues, HorizontalTailValues, InflowValues, LoadWeights,
    MeasuredFile, MeasuredFiles, MeasuredSection, ModeNumbers, PitchHarmonic,
    PrescribedCirculation, PrescribedTrim, PropulsiveTrim, Range, ResponseValues, RotorValues,
    Section, StructureValues, ThrustStep, ToleranceValues, UncertainField, Value, Visitor,
    WindTunnelTrim,
};
use serde::Serialize;
use std::fmt::Write as _;

/// Lines of the page around what is written here.
const BEGIN: &str = "<!-- Fields: written by `cargo xtask case-format`; do not edit. -->";
const END: &str = "<!-- End of the fields. -->";

/// Columns of a text line.
const WIDTH: usize = 100;

/// The page of the formats with its tables of case fields written anew; none if the page has no place for them.
pub fn case_format_page(page: &str) -> Option<String> {
    let (before, rest) = page.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{BEGIN}\n{}\n{END}{after}", tables()))
}

fn tables() -> String {
    [
        table::<Case>("case"),
        table::<RotorValues>("rotor"),
        table::<BladeTables>("rotor.tables"),
        table::<DissimilarBlade>("rotor.dissimilar_blades"),
        table::<PitchHarmonic>("rotor.root_pitch"),
        table::<FlapValues>("flaps"),
        table::<EffectivenessValues>("flaps: effectiveness"),
        table::<StructureValues>("structure"),
        table::<ModeNumbers>("structure.modes"),
        table::<AerodynamicsValues>("aerodynamics"),
        table::<AirfoilStation>("aerodynamics.airfoils"),
        table::<InflowValues>("inflow"),
        table::<FreeWakeValues>("inflow.model: FreeWake"),
        table::<PrescribedCirculation>("inflow.model: FreeWake, circulation: Prescribed"),
        table::<PropulsiveTrim>("trim: Propulsive"),
        table::<HorizontalTailValues>("trim: Propulsive, horizontal_tail"),
        table::<WindTunnelTrim>("trim: WindTunnel"),
        table::<PrescribedTrim>("trim: Prescribed"),
        table::<ActuatorValues>("actuator"),
        table::<BenchFolder>("actuator.model: Bench"),
        table::<ActuatorPath>("actuator.model: File"),
        table::<ControlValues>("control"),
        table::<LoadWeights>("control.load_weights"),
        table::<ResponseValues>("response"),
        table::<ToleranceValues>("tolerances"),
        table::<FlightValues>("flight"),
        table::<ThrustStep>("flight.thrust_step"),
        table::<FailedFlap>("flight.failed_flap"),
        table::<FlapActuator>("flight.flap_actuators"),
        table::<MeasuredFiles>("measured"),
        table::<MeasuredSection>("measured.airloads"),
        table::<MeasuredFile>("measured.tip, measured.vortex_centres"),
        table::<UncertainField>("uncertain"),
    ]
    .concat()
}

/// One section as a table: heading, what it is, a row per field.
fn table<T: Section>(heading: &str) -> String {
    let mut rows = Rows::default();
    T::default().each(&mut rows);
    let notes = if rows.notes.is_empty() { String::new() } else { format!("\n{}", rows.notes) };
    format!(
        "\n### `{heading}`\n\n{}\n\n| field | unit | range | default | meaning |\n|---|---|---|---|---|\n{}{notes}",
        sentences(T::ABOUT),
        rows.rows
    )
}

/// Longest row of a table, characters.
const LONGEST_ROW: usize = 300;

/// Rows of a table, and below it what is too long for them; sections inside have tables of their own.
#[derive(Default)]
struct Rows {
    rows: String,
    notes: String,
}

impl Visitor for Rows {
    fn field<T: Value>(&mut self, field: &Field, value: &T) {
        let unit = field.unit;
        let (range, default) = (range_of::<T>(field), default_of(field, value));
        let (key, meaning) = (field.key, sentences(field.meaning));
        let row =
            |meaning: &str| format!("| `{key}` | {unit} | {range} | {default} | {meaning} |\n");
        let whole = row(&meaning);
        match meaning.split_once(". ") {
            Some((first, rest)) if whole.chars().count() > LONGEST_ROW => {
                self.rows.push_str(&row(&format!("{first}; see below.")));
                for line in wrap(&format!("- `{key}`: {rest}"), WIDTH) {
                    self.notes.push_str(&line);
                    self.notes.push('\n');
                }
            }
            _ => self.rows.push_str(&whole),
        }
    }

    fn section<T: Section>(&mut self, _: &str, _: &T) {}

    fn item<T: Section>(&mut self, _: usize, _: &T) {}
}

/// The lines of a documentation comment as one text.
fn sentences(lines: &[&str]) -> String {
    lines.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ")
}

/// What a value must be, in words.
fn range_of<T: Value>(field: &Field) -> String {
    let choices: Vec<String> = T::choices().iter().map(|name| format!("`{name}`")).collect();
    let range = match field.range {
        Range::Any => String::new(),
        Range::Within(low, high) => format!("{} to {}", short(low), short(high)),
        Range::UpTo(_) => "above 0".to_owned(),
        Range::Count(low, high) => format!("{low} to {high}"),
        Range::Rule(rule) => rule.to_owned(),
    };
    together([choices.join(", "), range])
}

/// The parts there are, with semicolons between them.
fn together([first, second]: [String; 2]) -> String {
    let separator = if first.is_empty() || second.is_empty() { "" } else { "; " };
    format!("{first}{separator}{second}")
}

/// A number as a person writes it.
fn short(value: f64) -> String {
    let size = value.abs();
    let plain = value == 0.0 || (1e-3..1e5).contains(&size);
    if plain { value.to_string() } else { format!("{value:e}") }
}

/// The default of a field.
fn default_of<T: Value>(field: &Field, value: &T) -> String {
    let mut inside = Inside(None);
    value.inside(&mut inside);
    match inside.0.as_deref() {
        Some("") => "see below".to_owned(),
        Some(choice) => format!("`{choice}(...)`"),
        None if matches!(field.range, Range::Rule(rule) if rule.ends_with("required")) => {
            "required".to_owned()
        }
        None => match one_line(value).as_str() {
            "" | "[]" | "None" | "\"\"" => "none".to_owned(),
            text => format!("`{text}`"),
        },
    }
}

/// The name of the choice whose fields a value has, empty where it belongs to none; nothing for a plain value.
struct Inside(Option<String>);

impl Visitor for Inside {
    fn field<T: Value>(&mut self, _: &Field, _: &T) {}

    fn section<T: Section>(&mut self, choice: &str, _: &T) {
        self.0 = Some(choice.to_owned());
    }

    fn item<T: Section>(&mut self, _: usize, _: &T) {
        self.0 = Some(String::new());
    }
}

/// A value as RON on one line; empty if RON cannot express it, which it can of every value of a case.
fn one_line<T: Serialize>(value: &T) -> String {
    let text = ron_text(value).unwrap_or_default();
    let lines: Vec<&str> = text.lines().skip(1).map(str::trim).collect();
    let text = lines.join(" ").replace("( ", "(").replace("[ ", "[");
    let text = text.replace(", )", ")").replace(",)", ")").replace(", ]", "]").replace(",]", "]");
    match text.trim().parse::<f64>() {
        Ok(number) => short(number),
        Err(_) => text.trim().to_owned(),
    }
}

/// The paper's case with every field and its meaning, as a case to start from; its bench data are found from any
/// folder.
///
/// # Errors
/// That the shipped case cannot be read.
pub fn starting_case() -> Result<String, Problems> {
    let mut case = shipped_case(PAPER_CASE)?.case;
    case.actuator.model = ActuatorChoice::Bench(BenchFolder::default());
    case.flight = Some(FlightValues::default());
    let mut text = Starting { text: HEADER.to_owned(), indent: 0, is_commented: true };
    text.body("(", &case, ")\n");
    Ok(text.text)
}

const HEADER: &str = "\
#![enable(implicit_some, unwrap_variant_newtypes)]
// A case to start from: the paper's rotor at advance ratio 0.30. A field that is left out has its default.
// Behind a meaning in brackets: unit; range or choices.
// Conventions: azimuth 0 over the tail, counter-clockwise seen from above; hub axes X aft, Y starboard,
// Z up; theta = theta0 + theta1c cos psi + theta1s sin psi; flap angle trailing edge down positive;
// a harmonic is A cos(n psi - phase).
";

/// Writes a case with a comment at every field.
struct Starting {
    text: String,
    indent: usize,
    is_commented: bool,
}

impl Starting {
    fn line(&mut self, line: &str) {
        self.text.push_str(&"    ".repeat(self.indent));
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn body<T: Section>(&mut self, open: &str, section: &T, close: &str) {
        self.text.push_str(open);
        self.text.push('\n');
        self.indent += 1;
        section.each(self);
        self.indent -= 1;
        self.text.push_str(&"    ".repeat(self.indent));
        self.text.push_str(close);
    }

    /// The meaning of a field, in lines of the usual width.
    fn comment<T: Value>(&mut self, field: &Field) {
        let terms = together([field.unit.to_owned(), range_of::<T>(field).replace('`', "")]);
        let mut meaning = sentences(field.meaning).replace('`', "");
        if !terms.is_empty() {
            meaning = format!("{} [{}]", meaning.trim_end_matches('.'), terms);
        }
        let width = WIDTH - 4 * self.indent - 3;
        for line in wrap(&meaning, width) {
            self.line(&format!("// {line}"));
        }
    }
}

impl Visitor for Starting {
    fn field<T: Value>(&mut self, field: &Field, value: &T) {
        if self.is_commented {
            self.comment::<T>(field);
        }
        let before = self.text.len();
        let _ = write!(self.text, "{}{}: ", "    ".repeat(self.indent), field.key);
        let key_end = self.text.len();
        value.inside(self);
        if self.text.len() > key_end {
            // a list of sections has opened its bracket with its first item
            if self.text.ends_with("),\n") {
                self.line("],");
            } else {
                self.text.push_str(",\n");
            }
            return;
        }
        self.text.truncate(before);
        let text = one_line(value);
        let is_left_out = matches!(text.as_str(), "[]" | "None");
        let mark = if is_left_out { "// " } else { "" };
        self.line(&format!("{mark}{}: {text},", field.key));
    }

    fn section<T: Section>(&mut self, choice: &str, section: &T) {
        self.body(&format!("{choice}("), section, ")");
    }

    fn item<T: Section>(&mut self, index: usize, section: &T) {
        if index == 0 {
            self.text.push_str("[\n");
        }
        let before = self.is_commented;
        self.is_commented &= index == 0;
        self.indent += 1;
        let open = format!("{}(", "    ".repeat(self.indent));
        self.body(&open, section, "),\n");
        self.indent -= 1;
        self.is_commented = before;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::read_case;
    use crate::files::{Folder, Source};

    #[test]
    fn the_page_of_the_fields_is_what_the_sections_say() {
        // the book is no part of the package
        let book = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/src/case-format.md");
        let page = Source::read(std::path::Path::new(book)).unwrap().text;
        let fresh = case_format_page(&page).unwrap();
        assert!(fresh == page, "docs/src/case-format.md is stale: run `cargo xtask case-format`");
    }

    #[test]
    fn the_case_to_start_from_is_the_papers_with_every_field() {
        let text = starting_case().unwrap();
        let source = Source { name: "case.ron".into(), text: text.clone() };
        let read = read_case(&source, &Folder::Disk("no/such/folder".into())).unwrap();
        let mut paper = shipped_case(PAPER_CASE).unwrap().case;
        paper.actuator.model = ActuatorChoice::Bench(BenchFolder::default());
        paper.flight = Some(FlightValues::default());
        assert_eq!(read.case, paper);
        for key in
            ["horizontal_tail", "gyration_fraction", "twist_angle", "power_limit_W", "range_V"]
        {
            assert!(text.contains(&format!("{key}: ")), "{key}\n{text}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
    }
}
