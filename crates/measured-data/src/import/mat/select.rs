//! Which arrays of a MAT file make up the record.

use super::value::{MatValue, Variables};
use crate::import::in_memory::WholeColumns;
use crate::problem::Fault;
use std::fmt::Write;

/// Most numeric variables listed in a message.
const LISTED: usize = 12;

/// Takes the variable of a path (`bench.run(2).x`, `runs{3}`), or without one the only variable, or
/// all variables as if they were the fields of one.
///
/// A matrix gives its columns without names; rows stand for columns where there are more columns than
/// rows. A structure gives its numeric vectors, named by their fields.
pub(super) fn select(variables: &Variables, path: Option<&str>) -> Result<WholeColumns, Fault> {
    let refused = |path: &str, what: &str| {
        let found = listing(variables);
        Fault::Other(format!("`{path}` {what}; the file has: {found}; choose one with --variable"))
    };
    let mut read = variables.iter().filter(|(_, value)| !matches!(value, MatValue::Other(_)));
    let (value, name) = match (path, read.next(), read.next()) {
        (Some(path), ..) => {
            (walk(variables, path).map_err(|what| refused(path, what))?, path.to_owned())
        }
        (None, None, _) => return Err(refused("the file", "holds no variable that is read")),
        (None, Some((name, value)), None) => (value, name.clone()),
        (None, ..) => {
            return structure(variables, "all variables")
                .ok_or_else(|| refused("the file", "holds no vectors of one length"));
        }
    };
    let found = match value {
        MatValue::Numeric { sizes, values } => matrix(sizes, values)
            .map(|columns| {
                let taken = format!("{name}, {} numbers", size(sizes, " x "));
                WholeColumns { names: None, columns, step_s: None, taken }
            })
            .ok_or("is no matrix of several columns"),
        MatValue::Struct(fields) => {
            structure(fields, &name).ok_or("is a structure without vectors of one length")
        }
        MatValue::Structs(_) => Err("is an array of structures; choose one as in name(1)"),
        MatValue::Cell(_) => Err("is an array of cells; choose one as in name{1}"),
        MatValue::Text(_) => Err("is a text"),
        MatValue::Other(_) => Err("is of a class that holds no measurement"),
    };
    found.map_err(|what| refused(&name, what))
}

fn size(sizes: &[usize], times: &str) -> String {
    sizes.iter().map(usize::to_string).collect::<Vec<_>>().join(times)
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

/// The record of a structure: its vectors, its signals, or those of the only structure in it.
fn structure(fields: &[(String, MatValue)], name: &str) -> Option<WholeColumns> {
    let signals = fields.iter().find(|(field, _)| field == "signals").map(|(_, value)| value);
    let found = signals.and_then(|signals| vectors(&with_time(fields, signals), name));
    found.or_else(|| vectors(fields, name)).or_else(|| {
        let inner = fields.iter().filter_map(|(field, value)| match value {
            MatValue::Struct(fields) => Some((field, fields)),
            _ => None,
        });
        let &[(field, fields)] = &inner.collect::<Vec<_>>()[..] else { return None };
        structure(fields, &format!("{name}.{field}"))
    })
}

/// The fields of Simulink's "structure with time" beside the columns of its signals, which their labels name.
fn with_time(fields: &[(String, MatValue)], signals: &MatValue) -> Vec<(String, MatValue)> {
    let signals = match signals {
        MatValue::Structs(all) => &all[..],
        one => std::slice::from_ref(one),
    };
    let time = fields.iter().find(|(field, _)| field == "time");
    let mut all: Vec<(String, MatValue)> =
        time.map(|(_, time)| ("time_s".to_owned(), time.clone())).into_iter().collect();
    for (number, signal) in signals.iter().enumerate() {
        let MatValue::Struct(own) = signal else { continue };
        let find = |name: &str| own.iter().find(|(field, _)| field == name).map(|(_, v)| v);
        let label = match find("label") {
            Some(MatValue::Text(label)) if !label.is_empty() => label.clone(),
            _ => format!("signal{}", number + 1),
        };
        let Some(MatValue::Numeric { sizes, values }) = find("values") else { continue };
        let columns = matrix(sizes, values).unwrap_or_else(|| vec![values.clone()]);
        let is_one = columns.len() == 1;
        for (i, values) in columns.into_iter().enumerate() {
            let name = if is_one { label.clone() } else { format!("{label}_{}", i + 1) };
            all.push((name, MatValue::Numeric { sizes: vec![values.len(), 1], values }));
        }
    }
    all
}

/// The numeric vectors of the commonest length among fields, of lengths alike in number the longest; scalars and others are
/// left out.
fn vectors(fields: &[(String, MatValue)], name: &str) -> Option<WholeColumns> {
    let vector = |(name, value): &'_ (String, MatValue)| match value {
        MatValue::Numeric { sizes, values } if sizes.iter().filter(|s| **s != 1).count() == 1 => {
            Some((name.clone(), values.clone()))
        }
        _ => None,
    };
    let all: Vec<(String, Vec<f64>)> = fields.iter().filter_map(vector).collect();
    let count = |length: usize| all.iter().filter(|(_, v)| v.len() == length).count();
    let length = all.iter().map(|(_, v)| v.len()).max_by_key(|v| (count(*v), *v))?;
    let (names, columns): (Vec<_>, Vec<_>) =
        all.into_iter().filter(|(_, v)| v.len() == length).unzip();
    let mut taken = format!("{name}: {} of {length} samples", names.join(", "));
    for (name, value) in fields {
        if let MatValue::Other(what) = value {
            let _ = write!(taken, "; {name} is not read: {what}");
        }
    }
    (columns.len() > 1).then_some(WholeColumns { names: Some(names), columns, step_s: None, taken })
}

/// The steps of a path: a field, then perhaps an index.
fn steps(path: &str) -> Option<Vec<(&str, Option<usize>)>> {
    let step = |part| {
        let Some((field, index)) = str::split_once(part, ['(', '{']) else {
            return Some((part, None));
        };
        let index: usize = index.strip_suffix([')', '}'])?.parse().ok()?;
        Some((field, Some(index.checked_sub(1)?)))
    };
    path.split('.').map(|part| step(part).filter(|(field, _)| !field.is_empty())).collect()
}

fn walk<'a>(variables: &'a Variables, path: &str) -> Result<&'a MatValue, &'static str> {
    let mut fields = Ok(variables);
    let mut value = None;
    for (field, index) in steps(path).ok_or("is no path such as bench.run(2).x")? {
        let found = fields?.iter().find(|(name, _)| name == field).ok_or("is not there")?;
        let found = match (&found.1, index) {
            (found, None) | (found @ MatValue::Struct(_), Some(0)) => found,
            (MatValue::Cell(all) | MatValue::Structs(all), Some(index)) => {
                all.get(index).ok_or("has an index beyond its elements")?
            }
            _ => return Err("has an index, but is no array of cells or structures"),
        };
        fields = match found {
            MatValue::Struct(fields) => Ok(fields),
            MatValue::Structs(_) => {
                Err("goes through an array of structures; choose one as in name(1)")
            }
            _ => Err("goes through what is no structure"),
        };
        value = Some(found);
    }
    value.ok_or("is empty")
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
            names.push(format!("{name} {}", size(sizes, "x")));
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
        MatValue::Other(what) => names.push(format!("{name} (not read: {what})")),
        MatValue::Text(_) => {}
    }
}
