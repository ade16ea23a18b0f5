//! The arrays of a MAT file of level 5.

use super::bytes::{Bytes, COMPRESSED, INT8, MATRIX, UINT32, UTF8};
use crate::problem::Fault;
use std::io::Read;

/// An array of a MAT file.
#[derive(Debug, Clone, PartialEq)]
pub enum MatValue {
    /// Numbers, the first index running fastest; the imaginary part is left out.
    Numeric {
        /// Length along every index, two at least.
        sizes: Vec<usize>,
        /// As many as the sizes multiply to.
        values: Vec<f64>,
    },
    /// Characters.
    Text(String),
    /// Cells, the first index running fastest.
    Cell(Vec<MatValue>),
    /// A structure: its fields.
    Struct(Vec<(String, MatValue)>),
    /// An array of structures of several or no elements, the first index running fastest.
    Structs(Vec<MatValue>),
    /// An array of a class that holds no measurement.
    Other(String),
}

/// The variables of a file, in their order.
pub type Variables = Vec<(String, MatValue)>;

/// Deepest nesting of structures and cells.
const DEEPEST: usize = 32;
/// Most bytes of the decompressed variables of a file together.
const MOST_DECOMPRESSED: usize = 1 << 30;
/// Length of the header.
pub(super) const HEADER: usize = 128;

/// Whether a file of level 5 is little-endian, by its header.
pub(super) fn level_5(start: &[u8]) -> Option<bool> {
    match start.get(124..128)? {
        [0, 1, b'I', b'M'] => Some(true),
        [1, 0, b'M', b'I'] => Some(false),
        _ => None,
    }
}

/// Reads every variable of a MAT file of level 5.
///
/// # Errors
/// What is damaged, with the byte offset.
pub(super) fn variables(file: &[u8], little_endian: bool) -> Result<Variables, Fault> {
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
pub(super) fn inflate(bytes: &Bytes<'_>, room: usize) -> Result<Vec<u8>, Fault> {
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
pub(super) const CELL: u32 = 1;
pub(super) const STRUCT: u32 = 2;
const OBJECT: u32 = 3;
pub(super) const CHAR: u32 = 4;
const SPARSE: u32 = 5;
/// The last of the numeric classes, which begin behind `SPARSE`.
const LAST_NUMERIC: u32 = 15;

/// One array with its name.
fn array(mut bytes: Bytes<'_>, depth: usize) -> Result<(String, MatValue), Fault> {
    if bytes.is_empty() {
        return Ok((String::new(), MatValue::Numeric { sizes: vec![0, 0], values: vec![] }));
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
        return Ok((String::new(), MatValue::Other("object".to_owned())));
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
            MatValue::Cell((0..count).map(|_| inner(&mut bytes, depth)).collect::<Result<_, _>>()?)
        }
        STRUCT => structure(&mut bytes, count, depth)?,
        OBJECT => MatValue::Other("object".to_owned()),
        SPARSE => MatValue::Other("sparse matrix".to_owned()),
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

/// An array inside another one.
fn inner(bytes: &mut Bytes<'_>, depth: usize) -> Result<MatValue, Fault> {
    let element = bytes.element()?;
    if element.kind != MATRIX {
        return Err(element.bytes.fault("an array was expected inside a cell or structure"));
    }
    Ok(array(element.bytes, depth + 1)?.1)
}

fn structure(bytes: &mut Bytes<'_>, count: usize, depth: usize) -> Result<MatValue, Fault> {
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
    let mut structure = || -> Result<MatValue, Fault> {
        let fields = field_names.iter().map(|name| Ok((name.clone(), inner(bytes, depth)?)));
        fields.collect::<Result<_, _>>().map(MatValue::Struct)
    };
    let mut structs = (0..count).map(|_| structure()).collect::<Result<Vec<_>, _>>()?;
    match structs.len() {
        1 => Ok(structs.remove(0)),
        _ => Ok(MatValue::Structs(structs)),
    }
}
