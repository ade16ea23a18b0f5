//! MAT files of level 5 out of values, not compressed, little-endian: what [`super::value`] reads back bit by bit.
//!
//! Source: The `MathWorks`, MAT-File Format, level 5.

use super::bytes::{DOUBLE, INT8, INT32, MATRIX, UINT32, UTF16};
use super::value::{CELL, CHAR, HEADER, MatValue, STRUCT};

/// Class of an array of doubles.
const DOUBLE_CLASS: u32 = 6;
/// Least length of a field's name with its end, bytes.
const FIELD_NAME: usize = 32;

/// The bytes of a MAT file of level 5 with some variables, each with its name.
///
/// MATLAB takes names of at most 31 letters, digits and underscores that begin with a letter. Arrays of a class that holds
/// no measurement become empty.
pub fn mat_file(variables: &[(String, MatValue)]) -> Vec<u8> {
    let mut file = b"MATLAB 5.0 MAT-file, written by hhc".to_vec();
    file.resize(HEADER - 4, b' ');
    file.extend(0x0100_u16.to_le_bytes());
    file.extend(b"IM");
    for (name, value) in variables {
        file.extend(array(name, value));
    }
    file
}

/// A count in the 32 bits of the format; what has more is beyond any file of this level.
fn word(count: usize) -> [u8; 4] {
    u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes()
}

/// Type, length, data, padding.
fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut out = [kind.to_le_bytes(), word(data.len())].concat();
    out.extend(data);
    out.resize(out.len().next_multiple_of(8), 0);
    out
}

/// A whole array with its name, empty inside of another one.
fn array(name: &str, value: &MatValue) -> Vec<u8> {
    let row = |count: usize| vec![1, count];
    let (class, sizes, content) = match value {
        MatValue::Numeric { sizes, values } => {
            let data: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            (DOUBLE_CLASS, sizes.clone(), element(DOUBLE, &data))
        }
        MatValue::Text(text) => {
            let units: Vec<u16> = text.encode_utf16().collect();
            let data: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
            (CHAR, row(units.len()), element(UTF16, &data))
        }
        MatValue::Cell(cells) => {
            (CELL, row(cells.len()), cells.iter().flat_map(|cell| array("", cell)).collect())
        }
        MatValue::Struct(fields) => (STRUCT, row(1), structures(&[fields])),
        MatValue::Structs(all) => {
            let fields = |value: &MatValue| match value {
                MatValue::Struct(fields) => fields.clone(),
                _ => vec![],
            };
            let all: Vec<Vec<(String, MatValue)>> = all.iter().map(fields).collect();
            let all: Vec<&Vec<(String, MatValue)>> = all.iter().collect();
            (STRUCT, row(all.len()), structures(&all))
        }
        MatValue::Other(_) => (DOUBLE_CLASS, vec![0, 0], element(DOUBLE, &[])),
    };
    let mut body = element(UINT32, &[class.to_le_bytes(), [0; 4]].concat());
    body.extend(element(INT32, &sizes.iter().flat_map(|size| word(*size)).collect::<Vec<u8>>()));
    body.extend(element(INT8, name.as_bytes()));
    body.extend(content);
    element(MATRIX, &body)
}

/// Names of the fields and the values of all structures, which have the fields of the first.
fn structures(all: &[&Vec<(String, MatValue)>]) -> Vec<u8> {
    let names = all.first().map_or(&[][..], |fields| fields.as_slice());
    let longest = names.iter().map(|(name, _)| name.len() + 1).fold(FIELD_NAME, usize::max);
    let mut text = Vec::new();
    for (number, (name, _)) in names.iter().enumerate() {
        text.extend(name.as_bytes());
        text.resize((number + 1) * longest, 0);
    }
    // the length of a name is a short element: its size and type share a word
    let mut out = [(4 << 16 | INT32).to_le_bytes(), word(longest)].concat();
    out.extend(element(INT8, &text));
    out.extend(all.iter().flat_map(|fields| fields.iter()).flat_map(|(_, value)| array("", value)));
    out
}

#[cfg(test)]
mod tests {
    use super::super::read_variables;
    use super::*;

    /// One number, byte by byte by the document of the format.
    #[test]
    fn one_number_has_the_bytes_of_the_format() {
        let value = MatValue::Numeric { sizes: vec![1, 1], values: vec![1.5] };
        let file = mat_file(&[("x".to_owned(), value)]);
        let expected: [[u8; 8]; 9] = [
            [14, 0, 0, 0, 64, 0, 0, 0],
            [6, 0, 0, 0, 8, 0, 0, 0],
            [6, 0, 0, 0, 0, 0, 0, 0],
            [5, 0, 0, 0, 8, 0, 0, 0],
            [1, 0, 0, 0, 1, 0, 0, 0],
            [1, 0, 0, 0, 1, 0, 0, 0],
            [b'x', 0, 0, 0, 0, 0, 0, 0],
            [9, 0, 0, 0, 8, 0, 0, 0],
            [0, 0, 0, 0, 0, 0, 0xf8, 0x3f],
        ];
        assert_eq!(file[124..128], [0, 1, b'I', b'M']);
        assert_eq!(file[128..], expected.concat());
    }

    /// Every bit of every number, every name and every text comes back.
    #[test]
    fn what_is_written_is_read_back_bit_by_bit() {
        let values = vec![0.1, -1.0 / 3.0, 5e-324, f64::MAX, -0.0, 1e-17];
        let numeric = MatValue::Numeric { sizes: vec![1, 3, 2], values: values.clone() };
        let fields = |text: &str| {
            MatValue::Struct(vec![
                ("values".to_owned(), numeric.clone()),
                ("a_name_of_thirty_one_characters".to_owned(), MatValue::Text(text.to_owned())),
            ])
        };
        let cells = ["fx", "", "µ = 0,3 °"].map(|text| MatValue::Text(text.to_owned()));
        let variables = vec![
            ("x".to_owned(), numeric.clone()),
            ("labels".to_owned(), MatValue::Cell(cells.to_vec())),
            ("T_2_3".to_owned(), fields("1/V")),
            ("both".to_owned(), MatValue::Structs(vec![fields("a"), fields("b")])),
        ];
        let read = read_variables(&mat_file(&variables)).unwrap();
        assert_eq!(read, variables);
        let MatValue::Numeric { values: found, .. } = &read[0].1 else { unreachable!() };
        for (found, value) in found.iter().zip(&values) {
            assert_eq!(found.to_bits(), value.to_bits());
        }
    }
}
