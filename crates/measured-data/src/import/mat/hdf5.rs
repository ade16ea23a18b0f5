//! HDF5 files, among them MAT files of format 7.3: groups are structures, datasets arrays.
//!
//! Differs from source: cells and arrays of structures of format 7.3, which are references, are left out.

use super::{MatValue, Variables};
use crate::problem::Fault;
use crate::tables::Channel;
use hdf5_pure::{AttrValue, Dataset, Error, File, Group};

/// Most numbers of an array.
const MOST: u64 = 1 << 27;
/// Deepest nesting of groups, and most arrays and groups of a file.
const DEEPEST: usize = 16;
const MOST_OBJECTS: usize = 10_000;
/// Names of the attribute that holds the unit of an array.
const UNITS: [&str; 4] = ["unit", "units", "Unit", "Units"];

/// Reads every array of numbers; the unit of one that has such an attribute stands behind its name.
///
/// # Errors
/// What is damaged or not read, with the remedy.
pub(super) fn variables(file: &[u8]) -> Result<Variables, Fault> {
    let damaged = |error: Error| {
        Fault::Other(format!(
            "is an HDF5 file that cannot be read ({error}); write it again, in Python with h5py, in MATLAB with save('file.mat', '-v7')"
        ))
    };
    let file = File::from_bytes(file.to_vec()).map_err(damaged)?;
    let mut room = MOST_OBJECTS;
    group(&file.root(), 0, &mut room).map_err(damaged)
}

/// The arrays and groups of a group, by name.
fn group(group: &Group, depth: usize, room: &mut usize) -> Result<Variables, Error> {
    let mut found = Variables::new();
    let mut names = group.datasets()?;
    names.sort();
    for name in names {
        if let Some((name, value)) = array(&name, &group.dataset(&name)?)? {
            found.push((name, value));
        }
        *room = room.saturating_sub(1);
    }
    let mut names = group.groups()?;
    names.sort();
    // what MATLAB refers to by number
    names.retain(|name| !name.starts_with('#'));
    for name in names {
        if depth < DEEPEST && *room > 0 {
            *room -= 1;
            found.push((
                name.clone(),
                MatValue::Struct(self::group(&group.group(&name)?, depth + 1, room)?),
            ));
        }
    }
    Ok(found)
}

fn array(name: &str, dataset: &Dataset) -> Result<Option<(String, MatValue)>, Error> {
    let shape = dataset.shape()?;
    let count = shape.iter().try_fold(1_u64, |all, size| all.checked_mul(*size));
    if count.is_none_or(|count| count > MOST) {
        return Ok(None);
    }
    // texts and references are no numbers
    let Ok(values) = dataset.read_f64() else { return Ok(None) };
    // the last index runs fastest there, the first one here
    let mut sizes: Vec<usize> =
        shape.iter().rev().filter_map(|size| usize::try_from(*size).ok()).collect();
    while sizes.len() < 2 {
        sizes.push(1);
    }
    let attributes = dataset.attrs()?;
    let unit = UNITS.iter().find_map(|key| attributes.get(*key).and_then(AttrValue::as_str));
    let with_unit = unit.map(|unit| format!("{name} [{unit}]"));
    let known =
        with_unit.filter(|label| Channel::parse(name).is_none() && Channel::parse(label).is_some());
    Ok(Some((known.unwrap_or_else(|| name.to_owned()), MatValue::Numeric { sizes, values })))
}
