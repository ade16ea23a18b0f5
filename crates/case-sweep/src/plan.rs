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

/// Key and values of a case, and why it is refused.
type Taken = (String, Vec<String>, Option<Problems>);

/// What a case text is: read, or refused.
type Read = Result<(String, Vec<String>), Problems>;

fn read<R: Runner>(runner: &R, text: &str) -> Read {
    runner.read(text).map(|ReadCase { canonical, inputs, .. }| (canonical, inputs))
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
    let empty = Plan { fields, cases: vec![], base };
    // what is wrong with the base case is no fault of an axis
    read(runner, &empty.base)?;
    let read_one = |values: &Vec<Value>| {
        let texts: Vec<String> = values.iter().map(|(text, _)| text.clone()).collect();
        let text = empty.text(&texts, runner)?;
        Ok(match read(runner, &text) {
            Ok((canonical, inputs)) => {
                (case_key(runner.version(), &canonical, &inputs), texts, None)
            }
            Err(problems) => (case_key(runner.version(), &text, &[]), texts, Some(problems)),
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
            Ok((key, values_of, refused)) => {
                if let Some(refused) = &refused {
                    problems.append(alone.faults(file, values, refused));
                }
                let refused = refused.map(|problems| problems.to_string());
                cases.push(PlannedCase { key, values: values_of, refused });
            }
        }
    }
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
                text.ok().and_then(|text| read(self.runner, &text).err()).unwrap_or_default()
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
