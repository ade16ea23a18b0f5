//! HDF5 files, among them MAT files of format 7.3: groups are structures, datasets arrays.
//!
//! Source: netCDF Climate and Forecast conventions, 8.1 Packed Data, 2.5.1 Missing Data: `scale_factor`, `add_offset`,
//! `_FillValue`.
//!
//! Differs from source: cells and arrays of structures of format 7.3, which are references, are left out.

use super::{MatValue, Variables};
use crate::problem::Fault;
use crate::tables::{Channel, Unit};
use hdf5_pure::{AttrValue, DType, Dataset, Error, File, Group};
use std::collections::BTreeMap;

/// Most numbers of an array.
const MOST: u64 = 1 << 27;
/// Deepest nesting of groups, and most arrays and groups of a file.
const DEEPEST: usize = 16;
const MOST_OBJECTS: usize = 10_000;
/// Names of the attribute that holds the unit of an array.
const UNITS: [&str; 4] = ["unit", "units", "Unit", "Units"];
/// Words behind which a single letter is a number, no unit: `channel_A`.
const NUMBERED: [&str; 8] =
    ["channel", "ch", "input", "output", "port", "probe", "sensor", "signal"];

type Attributes = BTreeMap<String, AttrValue>;

fn damaged(what: &str, error: &Error) -> Fault {
    Fault::Other(format!(
        "is an HDF5 file {what} ({error}); write it again, in Python with h5py, in MATLAB with save('file.mat', '-v7')"
    ))
}

/// Reads every array of numbers; the unit of one that has such an attribute stands behind its name. What cannot be read is
/// there with the reason, texts and references are not.
///
/// # Errors
/// What is damaged, with the remedy; a name and an attribute that state different units.
pub(super) fn variables(file: &[u8]) -> Result<Variables, Fault> {
    let file = File::from_bytes(file.to_vec()).map_err(|e| damaged("that cannot be read", &e))?;
    let mut room = MOST_OBJECTS;
    group(&file.root(), "/", 0, &mut room)
}

/// The arrays and groups of a group, by name.
fn group(group: &Group, path: &str, depth: usize, room: &mut usize) -> Result<Variables, Fault> {
    let unlisted = |error: Error| {
        let what = format!(
            "whose group `{path}` cannot be listed: it is damaged, or one of its members is a soft or external link, which is not followed; replace links by the arrays themselves, in h5py f['name'] = f['target'], which makes a hard link"
        );
        damaged(&what, &error)
    };
    let mut found = Variables::new();
    let mut names = group.datasets().map_err(unlisted)?;
    names.sort();
    for name in names {
        let dataset = group.dataset(&name).map_err(unlisted)?;
        found.extend(array(&name, &dataset)?);
        *room = room.saturating_sub(1);
    }
    let mut names = group.groups().map_err(unlisted)?;
    names.sort();
    // what MATLAB refers to by number
    names.retain(|name| !name.starts_with('#'));
    for name in names {
        if depth < DEEPEST && *room > 0 {
            *room -= 1;
            let inner = group.group(&name).map_err(unlisted)?;
            let inner = self::group(&inner, &format!("{path}{name}/"), depth + 1, room)?;
            found.push((name, MatValue::Struct(inner)));
        }
    }
    Ok(found)
}

/// An array with its name, or why it is not read; none of texts and references.
///
/// # Errors
/// A name and an attribute that state different units.
fn array(name: &str, dataset: &Dataset) -> Result<Option<(String, MatValue)>, Fault> {
    let value = match numbers(dataset) {
        Ok(None) => return Ok(None),
        Ok(Some(value)) => value,
        Err(what) => return Ok(Some((name.to_owned(), MatValue::Other(what)))),
    };
    let attributes = dataset.attrs().unwrap_or_default().into_iter().collect();
    Ok(Some((named(name, &attributes)?, value)))
}

/// The numbers of an array; none of texts and references.
///
/// # Errors
/// Why it is not read.
fn numbers(dataset: &Dataset) -> Result<Option<MatValue>, String> {
    let unread = |error: Error| error.to_string();
    match dataset.dtype().map_err(unread)? {
        DType::String | DType::VariableLengthString | DType::ObjectReference => return Ok(None),
        DType::Compound(fields) => {
            let fields: Vec<String> = fields.into_iter().map(|(name, _)| name).collect();
            return Err(format!(
                "a compound of {}; write each of its fields as an array of its own",
                fields.join(", ")
            ));
        }
        _ => {}
    }
    let shape = dataset.shape().map_err(unread)?;
    let count = shape.iter().try_fold(1_u64, |all, size| all.checked_mul(*size));
    if count.is_none_or(|count| count > MOST) {
        return Err(format!("more than {MOST} numbers; write a part of it"));
    }
    let mut values = dataset.read_f64().map_err(unread)?;
    let attributes = dataset.attrs().map_err(unread)?;
    unpack(&mut values, &attributes.into_iter().collect())?;
    // the last index runs fastest there, the first one here
    let mut sizes: Vec<usize> =
        shape.iter().rev().filter_map(|size| usize::try_from(*size).ok()).collect();
    while sizes.len() < 2 {
        sizes.push(1);
    }
    Ok(Some(MatValue::Numeric { sizes, values }))
}

/// Takes up what attributes say of packed numbers: what stands for none, then the factor, then what is added.
fn unpack(values: &mut [f64], attributes: &Attributes) -> Result<(), String> {
    let number = |key: &str| {
        let Some(value) = attributes.get(key) else { return Ok(None) };
        let whole = || Some(value.as_i64()? as f64).or_else(|| Some(value.as_u64()? as f64));
        let number = value.as_f64().or_else(whole);
        number.map(Some).ok_or_else(|| format!("its attribute `{key}` is no number; correct it"))
    };
    let (factor, shift) = (number("scale_factor")?, number("add_offset")?);
    let (factor, shift) = (factor.unwrap_or(1.0), shift.unwrap_or(0.0));
    if !(factor.is_finite() && factor.abs() > 0.0 && shift.is_finite()) {
        return Err(format!(
            "scale_factor is {factor} and add_offset {shift}, expected finite numbers, the first one other than 0; correct them"
        ));
    }
    let fill = number("_FillValue")?.map(f64::to_bits);
    for value in values {
        let is_none = fill == Some(value.to_bits());
        *value = if is_none { f64::NAN } else { factor * *value + shift };
    }
    Ok(())
}

/// The name of an array with the unit that an attribute states, where the name has none.
fn named(name: &str, attributes: &Attributes) -> Result<String, Fault> {
    let stated = UNITS.iter().find_map(|key| attributes.get(*key).and_then(AttrValue::as_str));
    let Some((text, unit)) = stated.and_then(|text| Some((text, Unit::find(text.trim())?))) else {
        return Ok(name.to_owned());
    };
    let is_numbered = |channel: &Channel| {
        channel.unit.symbol.len() == 1 && NUMBERED.contains(&channel.name.as_str())
    };
    match Channel::parse(name).filter(|channel| !is_numbered(channel)) {
        Some(channel) if channel.unit.symbol == unit.symbol => Ok(name.to_owned()),
        Some(channel) => Err(Fault::Other(format!(
            "holds the array `{name}`, whose name states {} and whose attribute states {text}; correct the one that is wrong",
            channel.unit.symbol
        ))),
        None => {
            let label = format!("{name} [{}]", unit.symbol);
            Ok(if Channel::parse(&label).is_some() { label } else { name.to_owned() })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{is_hdf5, read_variables, select::select};
    use super::*;
    use crate::files::open_reader;
    use crate::import::{START, SourceKind, recognise};
    use hdf5_pure::FileBuilder;
    use std::io::Read;
    use std::path::Path;

    /// An array of whole numbers with attributes.
    type Array<'a> = (&'a str, &'a [i16], &'a [(&'a str, AttrValue)]);

    /// A file of arrays.
    fn file(arrays: &[Array<'_>]) -> FileBuilder {
        let mut file = FileBuilder::new();
        for (name, values, attributes) in arrays {
            let dataset = file.create_dataset(name).with_i16_data(values);
            for (key, value) in *attributes {
                dataset.set_attr(key, value.clone());
            }
        }
        file
    }

    fn text(unit: &str) -> AttrValue {
        AttrValue::String(unit.to_owned())
    }

    #[test]
    fn packed_numbers_are_unpacked() {
        let packed = [
            ("scale_factor", AttrValue::F64(0.5)),
            ("add_offset", AttrValue::I32(-10)),
            ("_FillValue", AttrValue::I16(-999)),
        ];
        let file = file(&[("x_um", &[4, -999, 8], &packed), ("u_V", &[4, -999, 8], &[])]);
        let found = read_variables(&file.finish().unwrap()).unwrap();
        let [(_, MatValue::Numeric { values: u, .. }), (_, MatValue::Numeric { values: x, .. })] =
            &found[..]
        else {
            panic!("{found:?}")
        };
        assert_eq!(format!("{u:?} {x:?}"), "[4.0, -999.0, 8.0] [-8.0, NaN, -6.0]");
        let nothing = [("scale_factor", AttrValue::F64(0.0))];
        let named = [("add_offset", text("ten"))];
        let file = self::file(&[("a", &[1, 2], &nothing), ("b", &[1, 2], &named)]);
        let said = select(&read_variables(&file.finish().unwrap()).unwrap(), None).unwrap_err();
        let said = said.to_string();
        assert!(said.contains("a (not read: scale_factor is 0"), "{said}");
        assert!(said.contains("b (not read: its attribute `add_offset` is no number"), "{said}");
    }

    #[test]
    fn the_unit_of_an_attribute_and_that_of_a_name() {
        let named = |name: &str, unit: &str| {
            let file = file(&[(name, &[1, 2, 3], &[("units", text(unit))])]).finish().unwrap();
            read_variables(&file).map(|all| all[0].0.clone()).map_err(|fault| fault.to_string())
        };
        for (name, unit, expected) in [
            ("time_s", "s", "time_s"),
            ("time_s", "since noon", "time_s"),
            ("laser", "um", "laser [um]"),
            ("channel_A", "V", "channel_A [V]"),
            ("current_A", "A", "current_A"),
        ] {
            assert_eq!(named(name, unit).unwrap(), expected);
        }
        for (name, unit) in [("time_s", "ms"), ("current_A", "V")] {
            let said = named(name, unit).unwrap_err();
            assert!(said.contains(&format!("`{name}`, whose name states")), "{said}");
            assert!(said.contains(&format!("attribute states {unit}; correct")), "{said}");
        }
    }

    #[test]
    fn what_is_not_read_is_named() {
        // in an old group, a soft link is an entry without an address
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/instruments");
        let mut linked = Vec::new();
        open_reader(&folder.join("hdf5_units.h5")).unwrap().read_to_end(&mut linked).unwrap();
        let entry = linked.windows(4).position(|window| window == b"SNOD").unwrap() + 8;
        linked[entry + 8..entry + 16].fill(0xff);
        linked[entry + 16] = 2;
        let said = read_variables(&linked).unwrap_err().to_string();
        assert!(said.contains("group `/` cannot be listed"), "{said}");
        assert!(said.contains("a soft or external link") && said.contains("hard link"), "{said}");
        // a table of rows
        let mut file = file(&[("t_s", &[0, 1, 2], &[]), ("u_V", &[4, 5, 6], &[])]);
        let mut row = hdf5_pure::CompoundTypeBuilder::new();
        row = row.f64_field("a").f64_field("b");
        file.create_dataset("table").with_compound_data(row.build().unwrap(), vec![0; 48], 3);
        let found = select(&read_variables(&file.finish().unwrap()).unwrap(), None).unwrap();
        assert_eq!(found.columns.len(), 2);
        let expected = "; table is not read: a compound of a, b; write each of its fields";
        assert!(found.taken.contains(expected), "{}", found.taken);
    }

    #[test]
    fn blocks_of_the_user_of_any_size() {
        for size in [0, 512, 1024, 2048, 65_536] {
            let mut file = file(&[("t_s", &[0, 1, 2], &[]), ("u_V", &[4, 5, 6], &[])]);
            if size > 0 {
                file.with_userblock(size);
            }
            let bytes = file.finish().unwrap();
            assert!(is_hdf5(&bytes), "{size}");
            let start = &bytes[..bytes.len().min(usize::try_from(START).unwrap())];
            assert_eq!(recognise(start, Path::new("a.h5")), Ok(SourceKind::Mat), "{size}");
            assert_eq!(read_variables(&bytes).unwrap().len(), 2, "{size}");
        }
    }
}
