//! T from arrays with names and units, as [`crate::exported_case`] gives them out.

use super::labels::{AFTER_STEP, POINT_AT, T_OF, control_labels, load_axis, load_labels};
use super::settings::mismatches;
use crate::FlightError;
use rotor_case::{Case, HandedSet, HandedT};
use rotor_export::{Axis, Document, LabelledArray};

/// T of a document for the controllers of a case.
///
/// Every array `T_HARMONICS` is one set: rows are the loads of the case, columns its controls, pages the points before a
/// step of the thrust. Names, units and their order are those that the case exports. The advance ratios of the points come from
/// the array `conditions`; without it, from their names, which hold four digits.
///
/// Weights, limits, conditions and inflow that the document was written with are compared with those of the case: what differs
/// is told, and T is used all the same.
///
/// # Errors
/// [`FlightError::Arrays`] in words: no T, names, units, sizes or order that are not those of the case, numbers that are not
/// finite, advance ratios that do not rise.
pub fn handed_t(case: &Case, document: &Document) -> Result<HandedT, FlightError> {
    let arrays = document.arrays.iter().filter(|array| array.name.starts_with(T_OF));
    let conditions = document.arrays.iter().find(|array| array.name == "conditions");
    let sets =
        arrays.map(|array| set_of(case, array, conditions)).collect::<Result<Vec<_>, _>>()?;
    if sets.is_empty() {
        let names: Vec<&str> = document.arrays.iter().map(|array| array.name.as_str()).collect();
        return Err(wrong(format!(
            "no array of T, such as `T_3`, among `{}`; write the file by `hhc export CASE --what t`",
            names.join("`, `")
        )));
    }
    Ok(HandedT { sets, told: mismatches(case, document) })
}

fn wrong(message: String) -> FlightError {
    FlightError::Arrays { message }
}

fn set_of(
    case: &Case,
    array: &LabelledArray,
    conditions: Option<&LabelledArray>,
) -> Result<HandedSet, FlightError> {
    let name = &array.name;
    let numbers = name[T_OF.len()..].split('_').map(str::parse::<usize>);
    let harmonics: Vec<usize> = numbers.collect::<Result<_, _>>().map_err(|_| {
        wrong(format!(
            "array `{name}`: its name ends in harmonics per rev, such as `T_3` or `T_3_4`"
        ))
    })?;
    let [loads, controls, points] = &array.axes[..] else {
        let count = array.axes.len();
        return Err(wrong(format!(
            "array `{name}` has {count} indices, expected load, control and point"
        )));
    };
    agrees(name, loads, &load_axis(load_labels(case)))?;
    let expected = control_labels(case.flaps.len(), &harmonics);
    agrees(name, controls, &Axis::of_unit("control", expected, "V"))?;
    let [rows, columns, pages] = array.sizes();
    if array.values.len() != rows * columns * pages {
        let found = array.values.len();
        return Err(wrong(format!(
            "array `{name}` holds {found} numbers, expected {rows} loads x {columns} controls x {pages} points"
        )));
    }
    let mut set = HandedSet { harmonics, ..HandedSet::default() };
    for (k, point) in points.labels.iter().enumerate() {
        let Some(advance_ratio) = advance_ratio_of(point, k, points.labels.len(), conditions)?
        else {
            continue;
        };
        if set.advance_ratios.last().is_some_and(|last| *last >= advance_ratio) {
            return Err(wrong(format!(
                "array `{name}`, point `{point}`: advance ratios rise from point to point"
            )));
        }
        let at = |i: usize, j: usize| array.at(i, j, k).filter(|value| value.is_finite());
        let column = |j: usize| {
            let each = (0..rows).map(|i| {
                at(i, j).ok_or_else(|| {
                    wrong(format!(
                        "array `{name}`, point `{point}`: {} of {} is no finite number",
                        loads.labels[i], controls.labels[j]
                    ))
                })
            });
            each.collect::<Result<Vec<f64>, FlightError>>()
        };
        set.advance_ratios.push(advance_ratio);
        set.columns.push((0..columns).map(column).collect::<Result<_, _>>()?);
    }
    if set.columns.is_empty() {
        return Err(wrong(format!("array `{name}` has no point before a step of the thrust")));
    }
    Ok(set)
}

/// Advance ratio of a point; none of one after a step of the thrust.
fn advance_ratio_of(
    point: &str,
    index: usize,
    count: usize,
    conditions: Option<&LabelledArray>,
) -> Result<Option<f64>, FlightError> {
    let row = |name: &str| {
        let conditions = conditions.filter(|array| array.sizes()[1] == count)?;
        let row = conditions.axes.first()?.labels.iter().position(|label| label == name)?;
        conditions.at(row, index, 0)
    };
    if row("thrust_share").map_or_else(|| point.ends_with(AFTER_STEP), |share| share > 0.0) {
        return Ok(None);
    }
    let named = || point.strip_prefix(POINT_AT).and_then(|text| text.parse::<f64>().ok());
    match row("advance_ratio").or_else(named).filter(|mu| mu.is_finite() && *mu >= 0.0) {
        Some(advance_ratio) => Ok(Some(advance_ratio)),
        None => Err(wrong(format!(
            "point `{point}` has no advance ratio: name it such as `mu_0.3000`, or give the array `conditions`"
        ))),
    }
}

/// Refuses an index whose names, units or order are not those of the case.
fn agrees(array: &str, found: &Axis, expected: &Axis) -> Result<(), FlightError> {
    let what = &expected.name;
    if found.labels.len() != expected.labels.len() {
        return Err(wrong(format!(
            "array `{array}` has {} {what}s, the case has {}: `{}` to `{}`",
            found.labels.len(),
            expected.labels.len(),
            expected.labels.first().map_or("", String::as_str),
            expected.labels.last().map_or("", String::as_str)
        )));
    }
    for (k, (found, expected)) in found.labels.iter().zip(&expected.labels).enumerate() {
        if found != expected {
            return Err(wrong(format!(
                "array `{array}`: {what} {} is `{found}`, the case has `{expected}` there",
                k + 1
            )));
        }
    }
    if found.units.len() != expected.units.len() {
        return Err(wrong(format!(
            "array `{array}` has {} units of its {what}s, expected {}",
            found.units.len(),
            expected.units.len()
        )));
    }
    for ((label, found), expected) in found.labels.iter().zip(&found.units).zip(&expected.units) {
        if found != expected {
            return Err(wrong(format!(
                "array `{array}`: {what} `{label}` is in `{found}`, expected `{expected}`"
            )));
        }
    }
    Ok(())
}
