//! Which arrays of a MAT file make up the record.

use super::value::{MatValue, Variables};
use crate::problem::RecordFault;

/// The columns of a record: names where the file gives them, and the numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MatColumns {
    /// Names of the columns, if they are fields.
    pub(super) names: Option<Vec<String>>,
    /// The columns, all of one length.
    pub(super) columns: Vec<Vec<f64>>,
    /// What was taken, in words.
    pub(super) taken: String,
}

/// Most numeric variables listed in a message.
const LISTED: usize = 12;

/// Takes the variable of a path (`bench.run(2).x`, `runs{3}`), or without one the only variable, or
/// all variables as if they were the fields of one.
///
/// A matrix gives its columns without names; rows stand for columns where there are more columns than
/// rows. A structure gives its numeric vectors, named by their fields.
pub(super) fn select(variables: &Variables, path: Option<&str>) -> Result<MatColumns, RecordFault> {
    let found = || listing(variables);
    let refused =
        |path: &str, what| RecordFault::MatVariable { path: path.into(), what, found: found() };
    let (value, name) = match path {
        Some(path) => (walk(variables, path).map_err(|what| refused(path, what))?, path.to_owned()),
        None => match variables.as_slice() {
            [] => return Err(refused("the file", "holds no variable")),
            [(name, value)] => (value, name.clone()),
            all => {
                let fields: Vec<(&str, &MatValue)> =
                    all.iter().map(|(n, v)| (n.as_str(), v)).collect();
                return vectors(&fields, "all variables")
                    .ok_or_else(|| refused("the file", "holds no vectors of one length"));
            }
        },
    };
    match value {
        MatValue::Numeric { sizes, values } => {
            let columns = matrix(sizes, values);
            columns
                .map(|columns| {
                    let size: Vec<String> = sizes.iter().map(usize::to_string).collect();
                    let taken = format!("{name}, {} numbers", size.join(" x "));
                    MatColumns { names: None, columns, taken }
                })
                .ok_or_else(|| refused(&name, "is no matrix of several columns"))
        }
        MatValue::Struct(fields) => {
            let fields: Vec<(&str, &MatValue)> =
                fields.iter().map(|(n, v)| (n.as_str(), v)).collect();
            vectors(&fields, &name)
                .ok_or_else(|| refused(&name, "is a structure without vectors of one length"))
        }
        MatValue::Structs(_) => {
            Err(refused(&name, "is an array of structures; choose one as in name(1)"))
        }
        MatValue::Cell(_) => Err(refused(&name, "is an array of cells; choose one as in name{1}")),
        MatValue::Text(_) => Err(refused(&name, "is a text")),
        MatValue::Other(_) => Err(refused(&name, "is of a class that holds no measurement")),
    }
}

/// The columns of a matrix with at least two of them.
fn matrix(sizes: &[usize], values: &[f64]) -> Option<Vec<Vec<f64>>> {
    let &[rows, columns] = sizes else { return None };
    if rows < 2 || columns < 2 {
        return None;
    }
    let column = |i: usize| values[i * rows..(i + 1) * rows].to_vec();
    let row = |i: usize| values.iter().skip(i).step_by(rows).copied().collect();
    Some(if rows >= columns {
        (0..columns).map(column).collect()
    } else {
        (0..rows).map(row).collect()
    })
}

/// The numeric vectors of the commonest length among fields; scalars and others are left out.
fn vectors(fields: &[(&str, &MatValue)], name: &str) -> Option<MatColumns> {
    let vector = |value: &MatValue| match value {
        MatValue::Numeric { sizes, values } if sizes.iter().filter(|s| **s != 1).count() == 1 => {
            Some(values.clone())
        }
        _ => None,
    };
    let all: Vec<(&str, Vec<f64>)> =
        fields.iter().filter_map(|(n, v)| Some((*n, vector(v)?))).collect();
    let longest = all.iter().map(|(_, v)| v.len()).max()?;
    let (names, columns): (Vec<String>, Vec<Vec<f64>>) =
        all.into_iter().filter(|(_, v)| v.len() == longest).map(|(n, v)| (n.to_owned(), v)).unzip();
    let taken = format!("{name}: {} of {longest} samples", names.join(", "));
    (columns.len() > 1).then_some(MatColumns { names: Some(names), columns, taken })
}

/// A step of a path: a field, then perhaps an index.
struct Step<'a> {
    field: &'a str,
    index: Option<usize>,
}

fn steps(path: &str) -> Option<Vec<Step<'_>>> {
    path.split('.')
        .map(|part| {
            let open = part.find(['(', '{']);
            let field = &part[..open.unwrap_or(part.len())];
            let index = match open {
                Some(open) => {
                    let inside = part[open + 1..].strip_suffix([')', '}'])?;
                    Some(inside.parse::<usize>().ok()?.checked_sub(1)?)
                }
                None => None,
            };
            (!field.is_empty()).then_some(Step { field, index })
        })
        .collect()
}

fn walk<'a>(variables: &'a Variables, path: &str) -> Result<&'a MatValue, &'static str> {
    let steps = steps(path).ok_or("is no path such as bench.run(2).x")?;
    let mut at: Option<&MatValue> = None;
    for step in steps {
        let mut value = match at {
            None => variables.iter().find(|(n, _)| n == step.field).map(|(_, v)| v),
            Some(MatValue::Struct(fields)) => {
                fields.iter().find(|(n, _)| n == step.field).map(|(_, v)| v)
            }
            Some(MatValue::Structs(_)) => {
                return Err("goes through an array of structures; choose one as in name(1)");
            }
            Some(_) => return Err("goes through what is no structure"),
        }
        .ok_or("is not there")?;
        if let Some(index) = step.index {
            value = match value {
                MatValue::Cell(all) | MatValue::Structs(all) => {
                    all.get(index).ok_or("has an index beyond its elements")?
                }
                MatValue::Struct(_) if index == 0 => value,
                _ => return Err("has an index, but is no array of cells or structures"),
            };
        }
        at = Some(value);
    }
    at.ok_or("is empty")
}

/// Numeric variables with their sizes, for messages.
fn listing(variables: &Variables) -> String {
    let mut names = Vec::new();
    for (name, value) in variables {
        list(name, value, &mut names);
    }
    let more = names.len().saturating_sub(LISTED);
    names.truncate(LISTED);
    if names.is_empty() {
        return "no numeric array".to_owned();
    }
    let text = names.join(", ");
    if more > 0 { format!("{text} and {more} more") } else { text }
}

fn list(name: &str, value: &MatValue, names: &mut Vec<String>) {
    match value {
        MatValue::Numeric { sizes, .. } => {
            let size: Vec<String> = sizes.iter().map(usize::to_string).collect();
            names.push(format!("{name} {}", size.join("x")));
        }
        MatValue::Cell(cells) => {
            for (i, cell) in cells.iter().enumerate() {
                list(&format!("{name}{{{}}}", i + 1), cell, names);
            }
        }
        MatValue::Structs(structs) => {
            for (i, one) in structs.iter().enumerate() {
                list(&format!("{name}({})", i + 1), one, names);
            }
        }
        MatValue::Struct(fields) => {
            for (field, value) in fields {
                list(&format!("{name}.{field}"), value, names);
            }
        }
        MatValue::Text(_) | MatValue::Other(_) => {}
    }
}
