//! The cases of a sweep with their keys.

use crate::sample::{Value, samples};
use crate::store::case_key;
use crate::{ReadCase, Runner, SweepError, SweepFile};
use measured_data::RonIndex;
use measured_data::problem::{Fault, Place, Problem, Problems};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// The cases of a sweep, in the order of its table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    /// Fields of the axes.
    pub fields: Vec<String>,
    /// Their units, empty for a pure number or a word.
    pub units: Vec<String>,
    /// The cases.
    pub cases: Vec<PlannedCase>,
    /// The base case, canonical.
    #[serde(skip)]
    base: String,
}

/// A case of a plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct PlannedCase {
    /// blake3 of the canonical case, the version of the model and the files that the case names.
    pub key: String,
    /// Its value on each axis, RON.
    pub values: Vec<String>,
    /// Why it cannot be run, though each of its values can: values that do not go together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
}

impl Plan {
    /// The text of a case: the base with the values of the axes.
    ///
    /// # Errors
    /// The axis that is no field of the case, counted from 0.
    pub(crate) fn text<R: Runner>(&self, values: &[String], runner: &R) -> Result<String, usize> {
        varied(&self.base, self.fields.iter().zip(values), runner)
    }

    /// Names of the axes, with units.
    pub fn axis_names(&self) -> Vec<String> {
        self.fields.iter().zip(&self.units).map(|(field, unit)| with_unit(field, unit)).collect()
    }

    /// The cases of different keys, in order.
    pub fn distinct(&self) -> Vec<&PlannedCase> {
        let mut keys = BTreeSet::new();
        self.cases.iter().filter(|case| keys.insert(&case.key)).collect()
    }
}

fn varied<'a, R: Runner>(
    base: &str,
    values: impl Iterator<Item = (&'a String, &'a String)>,
    runner: &R,
) -> Result<String, usize> {
    let set = |text: &str, field, value| RonIndex::new("case", text).with_value(field, value);
    let mut text = base.to_owned();
    for (axis, (field, value)) in values.enumerate() {
        // a group that another axis has brought shows its fields once it is printed anew
        let anew = || set(&runner.read(&text).ok()?.canonical, field, value);
        text = set(&text, field, value).or_else(anew).ok_or(axis)?;
    }
    Ok(text)
}

/// A field with its unit, unless its name ends with that.
pub(crate) fn with_unit(field: &str, unit: &str) -> String {
    let ending: String = unit
        .chars()
        .map(|c| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { '_' })
        .collect();
    if unit.is_empty() || field.to_ascii_lowercase().ends_with(&format!("_{ending}")) {
        return field.to_owned();
    }
    format!("{field} [{unit}]")
}

/// A case of a plan that is being made.
struct Taken {
    key: String,
    values: Vec<String>,
    /// Why it is refused.
    refused: Option<Problems>,
    /// Units of the axes that the base case does not have.
    units: Vec<Option<String>>,
}

/// Plans a sweep over the canonical text of its base case.
///
/// A case whose values do not go together stays a case, which fails. A value that the case file refuses in the same words
/// when it stands alone is an error of the sweep file.
///
/// # Errors
/// A grid that is too large; a base case that is refused; every value and field of an axis that the case does not take.
pub fn plan<R: Runner>(file: &SweepFile, base: String, runner: &R) -> Result<Plan, SweepError> {
    let samples = samples(file)?;
    let fields: Vec<String> = file.axes.iter().map(|axis| axis.field.clone()).collect();
    // what is wrong with the base case is no fault of an axis
    let own = runner.read(&base)?.case;
    let mut units: Vec<Option<String>> =
        fields.iter().map(|field| runner.unit(&own, field)).collect();
    let unknown: Vec<usize> = (0..units.len()).filter(|axis| units[*axis].is_none()).collect();
    let mut empty = Plan { fields, units: vec![], cases: vec![], base };
    let read_one = |values: &Vec<Value>| {
        let values: Vec<String> = values.iter().map(|(text, _)| text.clone()).collect();
        let text = empty.text(&values, runner)?;
        Ok(match runner.read(&text) {
            Ok(ReadCase { canonical, inputs, case }) => {
                let key = case_key(runner.version(), &canonical, &inputs);
                let unit = |axis: &usize| runner.unit(&case, &empty.fields[*axis]);
                Taken { key, values, refused: None, units: unknown.iter().map(unit).collect() }
            }
            Err(problems) => {
                let key = case_key(runner.version(), &text, &[]);
                Taken { key, values, refused: Some(problems), units: vec![] }
            }
        })
    };
    let found: Vec<Result<Taken, usize>> = samples.par_iter().map(read_one).collect();
    let mut alone = Alone { base: &empty.base, runner, read: BTreeMap::new() };
    let mut problems = Problems::default();
    let mut cases = Vec::with_capacity(found.len());
    for (found, values) in found.into_iter().zip(&samples) {
        match found {
            Err(axis) => {
                let message = "is no field of the case, nor one that can be added; name it as `hhc init` writes it: rotor.gj, flaps[0].start_r";
                let axis = &file.axes[axis];
                problems.push(
                    axis.place.clone(),
                    Fault::Refused { message: format!("{} {message}", axis.field) },
                );
            }
            Ok(taken) => {
                if let Some(refused) = &taken.refused {
                    problems.append(alone.faults(file, values, refused));
                }
                for (axis, unit) in unknown.iter().zip(taken.units) {
                    units[*axis] = units[*axis].take().or(unit);
                }
                let refused = taken.refused.map(|problems| problems.to_string());
                cases.push(PlannedCase { key: taken.key, values: taken.values, refused });
            }
        }
    }
    empty.units = units.into_iter().map(Option::unwrap_or_default).collect();
    Ok(problems.into_result(Some(Plan { cases, ..empty }))?)
}

/// Values of single axes in the base case.
struct Alone<'a, R> {
    base: &'a str,
    runner: &'a R,
    /// Problems by axis and value.
    read: BTreeMap<(usize, String), Problems>,
}

impl<R: Runner> Alone<'_, R> {
    /// The problems of a refused case that a value has on its own, at the place of the value.
    fn faults(&mut self, file: &SweepFile, values: &[Value], refused: &Problems) -> Problems {
        let mut own = Problems::default();
        for (i, (axis, (value, place))) in file.axes.iter().zip(values).enumerate() {
            let alone = self.read.entry((i, value.clone())).or_insert_with(|| {
                let text = varied(self.base, [(&axis.field, value)].into_iter(), self.runner);
                text.ok().and_then(|text| self.runner.read(&text).err()).unwrap_or_default()
            });
            for problem in alone.as_slice() {
                let same = |other: &&Problem| {
                    other.fault == problem.fault && other.place.field == problem.place.field
                };
                if refused.as_slice().iter().any(|other| same(&other)) {
                    own.push(
                        sweep_place(axis, value, place, problem),
                        fault_of(axis, value, problem),
                    );
                }
            }
        }
        own
    }
}

/// A key that the case does not know is a matter of the axis, anything else of its value.
fn sweep_place(axis: &crate::Axis, _: &str, place: &Place, problem: &Problem) -> Place {
    match problem.fault {
        Fault::Unknown { what: "key", .. } => axis.place.clone(),
        _ => place.clone(),
    }
}

fn fault_of(axis: &crate::Axis, value: &str, problem: &Problem) -> Fault {
    let field = problem.place.field.as_deref().unwrap_or(&axis.field);
    let message = match problem.fault {
        Fault::Unknown { what: "key", .. } => format!("{field}: {}", problem.fault),
        _ => format!("{value} for {}: {field} {}", axis.field, problem.fault),
    };
    Fault::Refused { message }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_its_unit_once() {
        for (field, unit, name) in [
            ("advance_ratio", "", "advance_ratio"),
            ("rotor.gj", "m0 Omega^2 R^4", "rotor.gj [m0 Omega^2 R^4]"),
            ("rotor.radius_m", "m", "rotor.radius_m"),
            ("rotor.mass_kg_m", "kg/m", "rotor.mass_kg_m"),
            ("flaps[0].start_r", "R", "flaps[0].start_r"),
            ("control.amplitude_V", "V", "control.amplitude_V"),
            ("rotor.term", "m", "rotor.term [m]"),
        ] {
            assert_eq!(with_unit(field, unit), name);
        }
    }
}
