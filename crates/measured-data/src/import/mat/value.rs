//! The arrays of a MAT file of level 5.

use super::bytes::{Bytes, COMPRESSED, INT8, MATRIX, UINT32, UTF8};
use crate::problem::RecordFault;
use std::io::Read;

/// An array of a MAT file.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum MatValue {
    /// Numbers, the first index running fastest; the imaginary part is left out.
    Numeric { sizes: Vec<usize>, values: Vec<f64> },
    /// Characters.
    Text(String),
    /// Cells, the first index running fastest.
    Cell(Vec<MatValue>),
    /// A structure: its fields.
    Struct(Vec<(String, MatValue)>),
    /// An array of structures of several or no elements, the first index running fastest.
    Structs(Vec<MatValue>),
    /// An array of a class that holds no measurement.
    Other(&'static str),
}

/// The variables of a file, in their order.
pub(super) type Variables = Vec<(String, MatValue)>;

/// Deepest nesting of structures and cells.
const DEEPEST: usize = 32;
/// Most bytes of the decompressed variables of a file together.
const MOST_DECOMPRESSED: usize = 1 << 30;
/// Length of the header.
const HEADER: usize = 128;

/// What a MAT file is, by its first bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::import) enum MatLevel {
    /// Level 5: MATLAB 5 to 7.
    Five { little_endian: bool },
    /// Level 4.
    Four,
    /// HDF5, MATLAB's format 7.3.
    Hdf5,
}

/// The level of a MAT file; none if it is none. `named_mat`: the file's name ends in `.mat`, without
/// which level 4, which has no signature, is not looked for.
pub(in crate::import) fn mat_level(start: &[u8], named_mat: bool) -> Option<MatLevel> {
    const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
    if start.starts_with(HDF5)
        || start.get(512..).is_some_and(|s| s.starts_with(HDF5))
        || start.starts_with(b"MATLAB 7.3")
    {
        return Some(MatLevel::Hdf5);
    }
    let order = start.get(126..128);
    let version = start.get(124..126);
    match (order, version) {
        (Some(b"IM"), Some([0, 1])) => return Some(MatLevel::Five { little_endian: true }),
        (Some(b"MI"), Some([1, 0])) => return Some(MatLevel::Five { little_endian: false }),
        _ => {}
    }
    // level 4: the type MOPT, rows, columns, imaginary flag, length of the name
    let word = |at: usize, little: bool| -> Option<u32> {
        let bytes: [u8; 4] = start.get(at..at + 4)?.try_into().ok()?;
        Some(if little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    };
    let is_four = |little: bool| {
        let kind = word(0, little)?;
        let digits = (kind / 1000, kind / 100 % 10, kind / 10 % 10, kind % 10);
        let plausible = digits.0 <= 4 && digits.1 == 0 && digits.2 <= 5 && digits.3 <= 2;
        let name = word(16, little)?;
        (plausible && word(12, little)? <= 1 && (1..=64).contains(&name)).then_some(())
    };
    let four = named_mat && (is_four(true).is_some() || is_four(false).is_some());
    four.then_some(MatLevel::Four)
}

/// Reads every variable of a MAT file of level 5.
///
/// # Errors
/// [`RecordFault::Mat`] with the byte offset, [`RecordFault::Mat4`], [`RecordFault::Hdf5`].
pub(super) fn read_variables(file: &[u8]) -> Result<Variables, RecordFault> {
    let little_endian = match mat_level(file, true) {
        Some(MatLevel::Five { little_endian }) => little_endian,
        Some(MatLevel::Four) => return Err(RecordFault::Mat4),
        Some(MatLevel::Hdf5) => return Err(RecordFault::Hdf5),
        None => {
            let what = "the header names no byte order: it is no MAT file of level 5";
            return Err(RecordFault::Mat { offset: 124.min(file.len()), compressed: false, what });
        }
    };
    let body = file.get(HEADER..).unwrap_or_default();
    let mut bytes = Bytes::new(body, HEADER, little_endian, false);
    let mut variables = Variables::new();
    let mut room = MOST_DECOMPRESSED;
    while !bytes.is_empty() {
        let element = bytes.element()?;
        match element.kind {
            MATRIX => variables.push(array(element.bytes, 0)?),
            COMPRESSED => {
                let data = inflate(&element.bytes, room)?;
                room -= data.len();
                let mut inner = Bytes::new(&data, 0, little_endian, true);
                let element = inner.element()?;
                if element.kind != MATRIX {
                    return Err(inner.fault("a compressed element holds no array"));
                }
                variables.push(array(element.bytes, 0)?);
            }
            // what the format does not know at this place carries no variable
            _ => {}
        }
    }
    // function workspaces and the like have no name
    variables.retain(|(name, _)| !name.is_empty());
    Ok(variables)
}

/// The bytes of a compressed variable, `room` at most.
pub(super) fn inflate(bytes: &Bytes<'_>, room: usize) -> Result<Vec<u8>, RecordFault> {
    let mut data = Vec::new();
    let decoder = flate2::read::ZlibDecoder::new(bytes.rest());
    decoder
        .take(room as u64 + 1)
        .read_to_end(&mut data)
        .map_err(|_| bytes.fault("a compressed variable cannot be decompressed"))?;
    if data.len() > room {
        return Err(bytes.fault("the compressed variables have more than 1 GiB together"));
    }
    Ok(data)
}

/// Classes of arrays.
const CELL: u32 = 1;
const STRUCT: u32 = 2;
const OBJECT: u32 = 3;
const CHAR: u32 = 4;
const SPARSE: u32 = 5;
/// The last of the numeric classes, which begin behind `SPARSE`.
const LAST_NUMERIC: u32 = 15;

/// One array with its name.
fn array(mut bytes: Bytes<'_>, depth: usize) -> Result<(String, MatValue), RecordFault> {
    if bytes.is_empty() {
        return Ok((String::new(), empty()));
    }
    if depth > DEEPEST {
        return Err(bytes.fault("structures or cells are nested too deeply"));
    }
    let flags = bytes.element()?;
    let class = match flags.first_word() {
        Some(word) if flags.kind == UINT32 => word & 0xff,
        _ => return Err(flags.bytes.fault("an array begins without its flags")),
    };
    if class > LAST_NUMERIC || class == 0 {
        // functions and objects of classes: their layout is not public
        return Ok((String::new(), MatValue::Other("object")));
    }
    let sizes = bytes.element()?.sizes()?;
    let product = |sizes: &[usize]| sizes.iter().try_fold(1_usize, |p, s| p.checked_mul(*s));
    let count = product(&sizes).ok_or_else(|| bytes.fault("an array is too large"))?;
    let name = bytes.element()?;
    if !matches!(name.kind, INT8 | UTF8) {
        return Err(name.bytes.fault("the name of an array is no text"));
    }
    let name = name.text();
    let value = match class {
        CELL => {
            let mut cells = Vec::new();
            for _ in 0..count {
                cells.push(inner(&mut bytes, depth)?);
            }
            MatValue::Cell(cells)
        }
        STRUCT => structure(&mut bytes, count, depth)?,
        OBJECT => MatValue::Other("object"),
        SPARSE => MatValue::Other("sparse matrix"),
        CHAR => {
            let element = bytes.element()?;
            let characters = element.numbers()?;
            if element.kind == UTF8 {
                MatValue::Text(element.text())
            } else {
                // whole numbers below 2^32 by their types
                let letter = |v: f64| format!("{v:.0}").parse().ok().and_then(char::from_u32);
                MatValue::Text(characters.into_iter().filter_map(letter).collect())
            }
        }
        _ => {
            let element = bytes.element()?;
            let values = element.numbers()?;
            if values.len() != count {
                return Err(element.bytes.fault("the sizes of an array and its numbers disagree"));
            }
            MatValue::Numeric { sizes, values }
        }
    };
    Ok((name, value))
}

fn empty() -> MatValue {
    MatValue::Numeric { sizes: vec![0, 0], values: vec![] }
}

/// An array inside another one.
fn inner(bytes: &mut Bytes<'_>, depth: usize) -> Result<MatValue, RecordFault> {
    let element = bytes.element()?;
    if element.kind != MATRIX {
        return Err(element.bytes.fault("an array was expected inside a cell or structure"));
    }
    Ok(array(element.bytes, depth + 1)?.1)
}

fn structure(bytes: &mut Bytes<'_>, count: usize, depth: usize) -> Result<MatValue, RecordFault> {
    let length = bytes.element()?.sizes()?.first().copied().unwrap_or_default();
    let names = bytes.element()?;
    if length == 0 || length > 256 {
        return Err(names.bytes.fault("field names have no or an absurd length"));
    }
    let field_names: Vec<String> = names
        .bytes
        .rest()
        .chunks_exact(length)
        .map(|name| {
            let end = name.iter().position(|b| *b == 0).unwrap_or(length);
            String::from_utf8_lossy(&name[..end]).into_owned()
        })
        .collect();
    if field_names.is_empty() {
        return Ok(MatValue::Struct(vec![]));
    }
    let mut structs = Vec::new();
    for _ in 0..count {
        let mut fields = Vec::new();
        for name in &field_names {
            fields.push((name.clone(), inner(bytes, depth)?));
        }
        structs.push(MatValue::Struct(fields));
    }
    match structs.len() {
        1 => Ok(structs.remove(0)),
        _ => Ok(MatValue::Structs(structs)),
    }
}
