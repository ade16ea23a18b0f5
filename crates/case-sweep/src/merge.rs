//! One table of all results.

use crate::plan::with_unit;
use crate::status::{Status, status};
use crate::store::{Cell, Outcome, Store};
use crate::{Plan, SweepError};
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Keys and files that a message names; of more it says how many.
const NAMED: usize = 5;

/// All results of a sweep, in the order of its cases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Merged {
    /// Fields of the axes.
    pub axes: Vec<String>,
    /// Units of the axes, empty for a pure number or a word.
    #[serde(default)]
    pub axis_units: Vec<String>,
    /// Names of the columns, with units.
    pub columns: Vec<String>,
    /// One for each case that has a result.
    pub cases: Vec<MergedCase>,
}

/// A case with its result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MergedCase {
    /// Its number, from 1.
    pub case: usize,
    /// Its key.
    pub key: String,
    /// Its value on each axis: a number, or RON.
    #[serde(serialize_with = "members", deserialize_with = "of_members")]
    pub values: Vec<(String, Cell)>,
    /// Why there are no numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// What was found.
    #[serde(serialize_with = "members", deserialize_with = "of_members")]
    pub found: Vec<(String, Cell)>,
    /// What a reader should know before using it.
    pub warnings: Vec<String>,
}

fn members<S: Serializer>(pairs: &[(String, Cell)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(pairs.iter().map(|(name, cell)| (name, cell)))
}

/// Members of an object in their order.
fn of_members<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(String, Cell)>, D::Error> {
    struct Members;
    impl<'de> Visitor<'de> for Members {
        type Value = Vec<(String, Cell)>;

        fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            f.write_str("an object of numbers and words")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut pairs = Vec::new();
            while let Some(pair) = map.next_entry()? {
                pairs.push(pair);
            }
            Ok(pairs)
        }
    }
    from.deserialize_map(Members)
}

/// Merges the results of a plan.
///
/// # Errors
/// [`SweepError::Incomplete`] with the results that are missing, damaged or of no case, unless `partial` leaves them out.
pub fn merge(plan: &Plan, store: &Store, partial: bool) -> Result<Merged, SweepError> {
    if !partial {
        let faults = faults(&status(store, plan), plan);
        if !faults.is_empty() {
            return Err(SweepError::Incomplete(faults));
        }
    }
    let (axes, axis_units) = (plan.fields.clone(), plan.units.clone());
    let mut merged = Merged { axes, axis_units, columns: vec![], cases: vec![] };
    for (i, planned) in plan.cases.iter().enumerate() {
        let Some(stored) = store.get(&planned.key).1 else { continue };
        let (found, warnings, failed) = match stored.outcome {
            Outcome::Found { columns, warnings } => (columns, warnings, None),
            Outcome::Failed { reason } => (vec![], vec![], Some(reason)),
        };
        for (name, _) in &found {
            if !merged.columns.contains(name) {
                merged.columns.push(name.clone());
            }
        }
        let values = plan.fields.iter().zip(&planned.values);
        let values = values.map(|(field, value)| (field.clone(), cell_of(value))).collect();
        let key = planned.key.clone();
        merged.cases.push(MergedCase { case: i + 1, key, values, failed, found, warnings });
    }
    Ok(merged)
}

/// What keeps a sweep from being merged, in words.
fn faults(status: &Status, plan: &Plan) -> Vec<String> {
    // a key tells nobody which case it is
    let which = |key: &String| {
        let place = plan.cases.iter().position(|case| case.key == *key);
        let case = place.map(|i| (i + 1, plan.fields.iter().zip(&plan.cases[i].values)));
        case.map_or_else(String::new, |(number, values)| {
            let values: Vec<String> = values.map(|(f, value)| format!("{f} {value}")).collect();
            format!("case {number}, {}: ", values.join(", "))
        })
    };
    let named = |list: &[String], what: &str, remedy: &str| {
        let more = list.len().saturating_sub(NAMED);
        let more = if more > 0 { format!("\n  and {more} more") } else { String::new() };
        let first: Vec<String> =
            list.iter().take(NAMED).map(|key| format!("{}{key}", which(key))).collect();
        let said = format!("{what}: {}; {remedy}\n  {}{more}", list.len(), first.join("\n  "));
        (!list.is_empty()).then_some(said)
    };
    let again = "run the sweep again, which computes these alone, or leave them out with --partial";
    [
        named(&status.missing, "cases without a result", again),
        named(&status.damaged, "results that are cut off or altered", again),
        named(
            &status.foreign,
            "files that are results of no case of this sweep",
            "they are of another sweep or version: remove them, or leave them out with --partial",
        ),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// A number where the text is one, else the text.
fn cell_of(value: &str) -> Cell {
    value.parse().map_or_else(|_| Cell::Text(value.to_owned()), Cell::Number)
}

impl Merged {
    /// The value of a case in a column or on an axis.
    pub fn number(case: &MergedCase, name: &str) -> Option<f64> {
        let (_, cell) = case.values.iter().chain(&case.found).find(|(own, _)| own == name)?;
        if let Cell::Number(value) = cell { Some(*value) } else { None }
    }

    /// A name with its unit: an axis whose name does not end with its unit has it in brackets behind.
    pub fn with_unit(&self, name: &str) -> String {
        let axis = self.axes.iter().position(|axis| axis == name);
        let unit = axis.and_then(|axis| self.axis_units.get(axis));
        with_unit(name, unit.map_or("", String::as_str))
    }

    /// The table: number, axes, `failed`, columns, `warnings` (how many) and key; an empty cell has no value.
    pub fn csv(&self) -> String {
        let one = |cell: &str| cell.replace(['\n', '\r'], " ");
        let mut header = vec!["case".to_owned()];
        header.extend(self.axes.iter().map(|field| one(&self.with_unit(field))));
        header.push("failed".to_owned());
        header.extend(self.columns.iter().map(|name| one(name)));
        header.extend(["warnings".to_owned(), "key".to_owned()]);
        let row =
            |case: &MergedCase| {
                let found = |name: &String| case.found.iter().find(|(own, _)| own == name);
                let mut row = vec![case.case.to_string()];
                row.extend(case.values.iter().map(|(_, cell)| one(&shown(cell))));
                row.push(one(case.failed.as_deref().unwrap_or_default()));
                let columns = self.columns.iter();
                row.extend(columns.map(|name| {
                    found(name).map_or_else(String::new, |(_, cell)| one(&shown(cell)))
                }));
                row.extend([case.warnings.len().to_string(), case.key.clone()]);
                row
            };
        let mut table = csv::Writer::from_writer(Vec::new());
        for row in std::iter::once(header).chain(self.cases.iter().map(row)) {
            // writing to memory cannot fail
            let _ = table.write_record(row);
        }
        String::from_utf8(table.into_inner().unwrap_or_default()).unwrap_or_default()
    }
}

fn shown(cell: &Cell) -> String {
    match cell {
        // the shortest text that reads back to the same bits
        Cell::Number(value) if *value != 0.0 && !(1e-4..1e9).contains(&value.abs()) => {
            format!("{value:e}")
        }
        Cell::Number(value) => format!("{value}"),
        Cell::Text(text) => text.clone(),
        Cell::Nothing(()) => String::new(),
    }
}
