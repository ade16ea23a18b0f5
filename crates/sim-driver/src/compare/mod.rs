//! `hhc compare`: two results of one number of blades, side by side.
//!
//! A difference is that of B less A; of a harmonic also as a vector, whose amplitude counts a change of phase.

mod page;

pub use page::compare_html;

use crate::SimError;
use crate::case::Case;
use crate::output::{Printable, Sheet};
use crate::problem::{Fault, Place, Problem};
use crate::report::Section;
use crate::results::{
    Figures, RESULT_FILE, StoredResult, curve_name, figures, same_station, set_name,
};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_study::{HubLoads, MeanLoads, WakeStatus, loads_cost};
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// A field that differs in the two cases.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FieldChange {
    /// Path of the field, `rotor.radius_m`.
    pub field: String,
    /// Its value in A; `left out` where it is.
    pub a: String,
    /// The same in B.
    pub b: String,
}

/// A number of both results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedNumber {
    /// What it is.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// In A.
    pub a: f64,
    /// In B.
    pub b: f64,
}

/// A harmonic of both results, `A cos(n psi - phase)`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedHarmonic {
    /// What it is of.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// Harmonic number.
    pub per_rev: usize,
    /// In A.
    pub a: Harmonic,
    /// In B.
    pub b: Harmonic,
}

impl ComparedHarmonic {
    /// The vector of B less that of A.
    pub fn difference(&self) -> Harmonic {
        let (a, b) = (self.a, self.b);
        Harmonic { cosine: b.cosine - a.cosine, sine: b.sine - a.sine }
    }
}

/// A curve of both results: an airload of a section or a motion of the tip, in the unit of its name.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedSeries {
    /// Quantity and place.
    pub name: String,
    /// Mean and harmonics in A.
    pub a: HarmonicSeries,
    /// The same in B.
    pub b: HarmonicSeries,
}

impl ComparedSeries {
    /// The harmonics that both hold.
    fn harmonics(&self) -> impl Iterator<Item = ComparedHarmonic> {
        let pairs = self.a.harmonics.iter().zip(&self.b.harmonics).enumerate();
        pairs.map(|(i, (a, b))| ComparedHarmonic {
            name: self.name.clone(),
            unit: "",
            per_rev: i + 1,
            a: *a,
            b: *b,
        })
    }
}

/// Two results side by side.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Names of both, where they come from.
    pub names: [String; 2],
    /// Titles of their cases.
    pub titles: [String; 2],
    /// What differs in the cases, the program and the files beside the case.
    pub fields: Vec<FieldChange>,
    /// Trim, thrust, power and J.
    pub numbers: Vec<ComparedNumber>,
    /// Hub loads without control at the blade number per rev.
    pub hub_loads: Vec<ComparedHarmonic>,
    /// Airloads and motion of the tip, where both hold them.
    pub curves: Vec<ComparedSeries>,
    /// What one of them alone holds, and what should be known of either.
    pub notes: Vec<String>,
}

/// Two stored results side by side, each behind its name.
///
/// # Errors
/// [`SimError::Data`] for another number of blades or a result without mean loads, and the errors of
/// [`StoredResult::setting`].
pub fn compare_results(
    [(name_a, a), (name_b, b)]: [(&str, &StoredResult); 2],
) -> Result<Comparison, SimError> {
    let [blades_a, blades_b] = [a, b].map(|stored| stored.case.rotor.blades);
    if blades_a != blades_b {
        let message = format!(
            "is {blades_b}, that of {name_a} is {blades_a}: loads at {blades_b}/rev are not those at {blades_a}/rev; compare rotors of the same number of blades"
        );
        let place = Place::file(name_b).field("case.rotor.blades");
        return Err(Problem::new(place, Fault::Other(message)).into());
    }
    let settings = [a.setting()?, b.setting()?];
    let found = [figures(&a.result, &settings[0]), figures(&b.result, &settings[1])];
    let means = [mean_loads(name_a, a, &found[0])?, mean_loads(name_b, b, &found[1])?];
    let mut notes = Vec::new();
    for (side, (name, stored)) in ["A", "B"].into_iter().zip([(name_a, a), (name_b, b)]) {
        if stored.result.wake.is_some_and(|wake| wake != WakeStatus::Converged) {
            notes.push(format!("{side} ({name}): the wake is not converged"));
        }
        if stored.result.curves.is_empty() {
            notes.push(format!(
                "{side} ({name}) holds no airloads: none are compared; run its case again to have them"
            ));
        }
    }
    let mut numbers = trim_numbers([a, b], means);
    let cost = |i: usize| loads_cost(&settings[i].load_weights(), &settings[i].baseline);
    numbers.push(number("J without control", "", [cost(0), cost(1)]));
    control_numbers(&found, &mut numbers, &mut notes);
    Ok(Comparison {
        names: [name_a, name_b].map(str::to_owned),
        titles: [a, b].map(|stored| stored.case.title.clone()),
        fields: changes(a, b)?,
        numbers,
        hub_loads: hub_loads([a, b]),
        curves: curves([a, b], &found, &mut notes),
        notes,
    })
}

fn mean_loads<'a>(
    name: &str,
    stored: &StoredResult,
    figures: &'a Figures,
) -> Result<&'a MeanLoads, SimError> {
    figures.mean_loads.as_ref().ok_or_else(|| {
        let message = format!(
            "is missing: {} did not store thrust and power; run the case again: hhc run CASE --out DIR",
            stored.program
        );
        let place = Place::file(format!("{name}/{RESULT_FILE}")).field("result.mean_loads");
        Problem::new(place, Fault::Other(message)).into()
    })
}

fn number(name: impl Into<String>, unit: &'static str, [a, b]: [f64; 2]) -> ComparedNumber {
    ComparedNumber { name: name.into(), unit, a, b }
}

/// Controls, attitude, thrust and power.
fn trim_numbers(stored: [&StoredResult; 2], means: [&MeanLoads; 2]) -> Vec<ComparedNumber> {
    let trims = stored.map(|stored| stored.result.trim);
    vec![
        number("theta0", "deg", trims.map(|t| t.theta0_deg)),
        number("theta1c", "deg", trims.map(|t| t.theta1c_deg)),
        number("theta1s", "deg", trims.map(|t| t.theta1s_deg)),
        number("shaft tilt", "deg", trims.map(|t| t.alpha_s_deg)),
        number("bank", "deg", trims.map(|t| t.phi_s_deg)),
        number("mean induced inflow", "Omega R", trims.map(|t| t.induced_inflow)),
        number("C_T/sigma", "", trims.map(|t| t.ct_sigma)),
        number("mean vertical force", "N", means.map(|m| m.hub_force_newton[2])),
        number("shaft power", "W", means.map(|m| m.shaft_power_watt)),
    ]
}

/// J after every control that both have.
fn control_numbers(
    found: &[Figures; 2],
    numbers: &mut Vec<ComparedNumber>,
    notes: &mut Vec<String>,
) {
    let name = |harmonics: &[usize], actuator: &str| {
        format!("J, flaps at {}/rev, {actuator}", set_name(harmonics))
    };
    let lists = [0, 1].map(|i| {
        let lines = found[i].control.iter();
        lines.map(|l| (name(&l.head.harmonics, &l.head.actuator), l.j_after)).collect::<Vec<_>>()
    });
    let of = |list: &[(String, f64)], name: &str| {
        list.iter().find(|(own, _)| own == name).map(|(_, j)| *j)
    };
    for (name, a) in &lists[0] {
        match of(&lists[1], name) {
            Some(b) => numbers.push(number(name, "", [*a, b])),
            None => notes.push(format!("{name}: in A alone")),
        }
    }
    let alone = lists[1].iter().filter(|(name, _)| of(&lists[0], name).is_none());
    notes.extend(alone.map(|(name, _)| format!("{name}: in B alone")));
}

/// The six loads at the blade number per rev, each in the units of its own rotor.
fn hub_loads(stored: [&StoredResult; 2]) -> Vec<ComparedHarmonic> {
    let per_rev = stored[0].case.rotor.blades;
    let sides = stored.map(|stored| {
        let scales = stored.case.scales();
        let parts = stored.result.baseline.hub_nb_per_rev.parts();
        (parts, scales.force_newton(), scales.moment_newton_metre())
    });
    let each = HubLoads::NAMES.iter().enumerate().map(|(k, name)| {
        let [a, b] = sides.map(|(parts, force_newton, moment_newton_metre)| {
            let scale = if k < 3 { force_newton } else { moment_newton_metre };
            Harmonic { cosine: scale * parts[2 * k], sine: scale * parts[2 * k + 1] }
        });
        let unit = if k < 3 { "N" } else { "N m" };
        ComparedHarmonic { name: name.to_uppercase(), unit, per_rev, a, b }
    });
    each.collect()
}

/// Computed curves of one quantity and place in both, then the measured ones.
fn curves(
    stored: [&StoredResult; 2],
    found: &[Figures; 2],
    notes: &mut Vec<String>,
) -> Vec<ComparedSeries> {
    let [a, b] = stored.map(|stored| &stored.result.curves);
    let mut pairs = Vec::new();
    for own in a {
        let name = curve_name(own.quantity, own.station_r);
        let is_same = |other: &&crate::results::CurveLine| {
            other.quantity == own.quantity && same_station(other.station_r, own.station_r)
        };
        match b.iter().find(is_same) {
            Some(other) => {
                let (a, b) = (own.series.0.clone(), other.series.0.clone());
                pairs.push(ComparedSeries { name, a, b });
            }
            None if !b.is_empty() => notes.push(format!("{name}: in A alone")),
            None => {}
        }
    }
    for own in &found[0].measured {
        let other = found[1].measured.iter().find(|other| {
            other.quantity == own.quantity && same_station(other.station_r, own.station_r)
        });
        if let Some(other) = other {
            let name = format!("measured {}", curve_name(own.quantity, own.station_r));
            let (a, b) = (own.measured.clone(), other.measured.clone());
            pairs.push(ComparedSeries { name, a, b });
        }
    }
    pairs
}

/// Every field with another value in the two cases, then program and input files.
fn changes(a: &StoredResult, b: &StoredResult) -> Result<Vec<FieldChange>, SimError> {
    let [of_a, of_b] = [fields_of(&a.case)?, fields_of(&b.case)?];
    let names: BTreeSet<&String> = of_a.keys().chain(of_b.keys()).collect();
    let value = |of: &BTreeMap<String, String>, field: &str| {
        of.get(field).cloned().unwrap_or_else(|| "left out".to_owned())
    };
    let mut changes: Vec<FieldChange> = names
        .into_iter()
        .map(|name| FieldChange {
            field: name.clone(),
            a: value(&of_a, name),
            b: value(&of_b, name),
        })
        .collect();
    let change = |field: &str, a: &str, b: &str| FieldChange {
        field: field.to_owned(),
        a: a.to_owned(),
        b: b.to_owned(),
    };
    let short = |stored: &StoredResult| {
        let each = stored.inputs.iter().map(|hash| hash.chars().take(8).collect::<String>());
        each.collect::<Vec<_>>().join(" ")
    };
    changes.push(change("(program)", &a.program, &b.program));
    changes.push(change("(input files, hashes)", &short(a), &short(b)));
    // the titles stand above
    changes.retain(|change| change.a != change.b && change.field != "title");
    Ok(changes)
}

/// Path and value of every field of a case.
fn fields_of(case: &Case) -> Result<BTreeMap<String, String>, SimError> {
    let value = serde_json::to_value(case).map_err(|e| SimError::not_written("case", &e))?;
    let mut fields = BTreeMap::new();
    flatten("", &value, &mut fields);
    Ok(fields)
}

/// Adds the fields of a value; the name of a choice is the value of its own field, not part of a path.
fn flatten(path: &str, value: &Value, fields: &mut BTreeMap<String, String>) {
    match value {
        Value::Object(members) => {
            for (key, inner) in members {
                if key.starts_with(char::is_uppercase) {
                    fields.insert(path.to_owned(), key.clone());
                    flatten(path, inner, fields);
                } else {
                    let dot = if path.is_empty() { "" } else { "." };
                    flatten(&format!("{path}{dot}{key}"), inner, fields);
                }
            }
        }
        Value::Array(items) if items.iter().any(|item| item.is_object() || item.is_array()) => {
            for (i, item) in items.iter().enumerate() {
                flatten(&format!("{path}[{i}]"), item, fields);
            }
        }
        Value::String(text) => {
            fields.insert(path.to_owned(), text.clone());
        }
        other => {
            fields.insert(path.to_owned(), other.to_string());
        }
    }
}

/// A number in six digits.
fn six(value: f64) -> String {
    let plain = value == 0.0 || (1e-3..1e6).contains(&value.abs());
    if plain { format!("{value:.6}") } else { format!("{value:.5e}") }
}

fn section(title: &str, text: &str, header: &[&str], rows: Vec<Vec<String>>) -> Section {
    let header = header.iter().map(|head| (*head).to_owned()).collect();
    Section { title: title.to_owned(), text: text.to_owned(), header, rows }
}

/// The cells of a harmonic: name, unit, number, both with their phases, difference of amplitudes, vector.
fn harmonic_cells(of: &ComparedHarmonic) -> Vec<String> {
    let vector = of.difference();
    let mut cells = vec![of.name.clone(), of.unit.to_owned(), of.per_rev.to_string()];
    for harmonic in [of.a, of.b] {
        cells.extend([six(harmonic.amplitude()), format!("{:.1}", harmonic.phase_deg())]);
    }
    cells.push(six(of.b.amplitude() - of.a.amplitude()));
    cells.extend([six(vector.amplitude()), format!("{:.1}", vector.phase_deg())]);
    cells
}

/// Heads of [`harmonic_cells`].
const HARMONIC_HEADS: [&str; 10] =
    ["of", "unit", "per rev", "A", "phase", "B", "phase", "B - A", "vector", "phase"];

impl Comparison {
    /// What differs in the cases, values no longer than so many characters.
    pub(crate) fn fields_section(&self, most: usize) -> Section {
        let value = |text: &str| {
            if text.chars().count() <= most {
                return text.to_owned();
            }
            text.chars().take(most.saturating_sub(3)).collect::<String>() + "..."
        };
        let rows = self.fields.iter().map(|c| vec![c.field.clone(), value(&c.a), value(&c.b)]);
        let text = if self.fields.is_empty() { "Nothing." } else { "" };
        section("What differs in the cases", text, &["field", "A", "B"], rows.collect())
    }

    /// Trim, thrust, power and J.
    pub(crate) fn numbers_section(&self) -> Section {
        let rows = self.numbers.iter().cloned();
        let rows = rows.map(|ComparedNumber { name, unit, a, b }| {
            vec![name, unit.to_owned(), six(a), six(b), six(b - a)]
        });
        let header = ["of", "unit", "A", "B", "B - A"];
        section("Trim, thrust, power and J", "", &header, rows.collect())
    }

    /// Hub loads.
    pub(crate) fn hub_section(&self) -> Section {
        let text = "Fixed frame, without control; A cos(n psi - phase), deg. vector: of the difference of the two harmonics.";
        let rows = self.hub_loads.iter().map(harmonic_cells).collect();
        section("Hub loads at the blade number per rev", text, &HARMONIC_HEADS, rows)
    }

    /// Airloads and motion of the tip.
    pub(crate) fn curves_section(&self) -> Section {
        let rows = self.curves.iter().flat_map(|of| {
            let (a, b) = (of.a.mean, of.b.mean);
            let mut mean = vec![String::new(); HARMONIC_HEADS.len()];
            for (i, cell) in [(2, "mean".to_owned()), (3, six(a)), (5, six(b)), (7, six(b - a))] {
                mean[i] = cell;
            }
            mean[0].clone_from(&of.name);
            std::iter::once(mean).chain(of.harmonics().map(|of| harmonic_cells(&of)))
        });
        section("Airloads and motion of the tip", "", &HARMONIC_HEADS, rows.collect())
    }

    /// Every number as CSV text, every digit kept; an empty field has no value.
    pub fn csv(&self) -> String {
        let mut text = String::from(
            "name,unit,per_rev,a,a_phase_deg,b,b_phase_deg,difference,vector_amplitude,vector_phase_deg\n",
        );
        let quoted = |name: &str| format!("\"{name}\"");
        let mut plain = |name: &str, unit: &str, per_rev: &str, [a, b]: [f64; 2]| {
            // writing to a string cannot fail
            let (name, apart) = (quoted(name), b - a);
            let _ = writeln!(text, "{name},{unit},{per_rev},{a:e},,{b:e},,{apart:e},,");
        };
        for of in &self.numbers {
            plain(&of.name, of.unit, "", [of.a, of.b]);
        }
        for of in &self.curves {
            plain(&format!("mean of {}", of.name), "", "0", [of.a.mean, of.b.mean]);
        }
        let rows = self.hub_loads.iter().cloned();
        for of in rows.chain(self.curves.iter().flat_map(ComparedSeries::harmonics)) {
            let vector = of.difference();
            let cells = [
                of.a.amplitude(),
                of.a.phase_deg(),
                of.b.amplitude(),
                of.b.phase_deg(),
                of.b.amplitude() - of.a.amplitude(),
                vector.amplitude(),
                vector.phase_deg(),
            ];
            let cells = cells.map(|cell| format!("{cell:e}")).join(",");
            let _ = writeln!(text, "{},{},{},{cells}", quoted(&of.name), of.unit, of.per_rev);
        }
        text
    }

    /// Everything but the curves; they follow where they are asked for.
    fn sheet(&self, curves: Option<Section>) -> Sheet {
        let mut sheet = Sheet::default();
        for (side, (name, title)) in ["A", "B"].iter().zip(self.names.iter().zip(&self.titles)) {
            sheet.line(format_args!("{side}  {title} ({name})"));
        }
        let first =
            [self.fields_section(LONGEST_VALUE), self.hub_section(), self.numbers_section()];
        for section in first.into_iter().chain(curves) {
            sheet.block(&section.to_string());
        }
        for note in &self.notes {
            sheet.paragraphs(&format!("\nnote: {note}"));
        }
        sheet
    }
}

/// Longest value of a field that the terminal shows, characters.
const LONGEST_VALUE: usize = 28;

impl Printable for Comparison {
    fn text(&self) -> String {
        let mut sheet = self.sheet(None);
        sheet.line("\nAirloads and motion of the tip by harmonic: --details, or --out DIR");
        sheet.finish()
    }

    fn details(&self) -> String {
        self.sheet(Some(self.curves_section())).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{PAPER_CASE, shipped_case};
    use crate::results::{MeanHubLoads, RunResult};

    fn stored(change: impl Fn(&mut Case), mean_loads: Option<MeanHubLoads>) -> StoredResult {
        let mut case = shipped_case(PAPER_CASE).unwrap().case;
        change(&mut case);
        let result = RunResult { mean_loads, ..RunResult::default() };
        StoredResult::new(&case, vec![], None, result).unwrap()
    }

    #[test]
    fn a_result_without_mean_loads_is_named_with_its_remedy() {
        let with = stored(|_| (), Some(MeanHubLoads::default()));
        let without = stored(|_| (), None);
        let error = compare_results([("a", &with), ("b", &without)]).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let text = error.to_string();
        assert!(text.starts_with("b/result.json: result.mean_loads: is missing"), "{text}");
        assert!(text.contains("hhc run CASE"), "{text}");
    }

    /// The name of a choice is the value of its field, as a case file has it; forces are in the units of each rotor.
    #[test]
    fn fields_have_the_paths_of_a_case_file_and_loads_their_own_units() {
        let mean = Some(MeanHubLoads { hub: [0.0, 0.0, 0.07, 0.0, 0.0, 0.0] });
        let a = stored(|_| (), mean);
        let b = stored(
            |case| {
                case.rotor.mass_kg_m *= 2.0;
                case.inflow.model = crate::case::InflowChoice::Uniform;
                case.flaps[1].end_r = 0.9;
            },
            mean,
        );
        let found = compare_results([("a", &a), ("b", &b)]).unwrap();
        let fields: Vec<&str> = found.fields.iter().map(|change| change.field.as_str()).collect();
        assert_eq!(fields, ["flaps[1].end_r", "inflow.model", "rotor.mass_kg_m"]);
        assert_eq!((&*found.fields[1].a, &*found.fields[1].b), ("Drees", "Uniform"));
        let force = found.numbers.iter().find(|of| of.name == "mean vertical force").unwrap();
        assert!((force.b / force.a - 2.0).abs() < 1e-12, "{force:?}");
    }
}
