//! MAT files of level 4 (MATLAB 4, `save -v4`, Octave's `-v4`): matrices of numbers and texts, without a header.
//!
//! Source: The `MathWorks`, MAT-File Format, level 4.

use super::bytes::{Bytes, DOUBLE, Element, INT16, INT32, SINGLE, UINT8, UINT16};
use super::value::{MatValue, Variables};
use crate::problem::Fault;

/// Words before the name of a variable: type MOPT, rows, columns, imaginary flag, length of the name.
const WORDS: usize = 5;
/// Longest name.
const LONGEST: u32 = 64;

/// The digits of the type of a variable: machine, always 0, precision, kind of matrix.
fn digits(kind: u32) -> [u32; 4] {
    [kind / 1000, kind / 100 % 10, kind / 10 % 10, kind % 10]
}

/// Whether a file that begins so is little-endian; none if it is not of level 4, which has no signature.
pub(super) fn byte_order(start: &[u8]) -> Option<bool> {
    let (words, _) = start.as_chunks();
    let words: &[[u8; 4]; WORDS] = words.first_chunk()?;
    let is = |from_bytes: fn([u8; 4]) -> u32| {
        let [kind, _, _, is_imaginary, name] = words.map(from_bytes);
        let [machine, zero, precision, matrix] = digits(kind);
        let plausible = machine <= 4 && zero == 0 && precision <= 5 && matrix <= 2;
        plausible && is_imaginary <= 1 && (1..=LONGEST).contains(&name)
    };
    match () {
        () if is(u32::from_le_bytes) => Some(true),
        () if is(u32::from_be_bytes) => Some(false),
        () => None,
    }
}

/// Reads every variable; the imaginary parts are left out.
///
/// # Errors
/// What is damaged, with the byte offset; numbers of a VAX or a Cray.
pub(super) fn variables(file: &[u8], is_little: bool) -> Result<Variables, Fault> {
    let mut bytes = Bytes::new(file, 0, is_little, false);
    let mut all = Variables::new();
    while !bytes.is_empty() {
        all.push(variable(&mut bytes, is_little)?);
    }
    Ok(all)
}

fn variable(bytes: &mut Bytes<'_>, is_little: bool) -> Result<(String, MatValue), Fault> {
    let mut words = [0; WORDS];
    for word in &mut words {
        *word = bytes.u32()?;
    }
    let [kind, rows, columns, is_imaginary, length] = words;
    let [machine, zero, precision, matrix] = digits(kind);
    if (2..=4).contains(&machine) {
        return Err(bytes.fault("its numbers are those of a VAX or a Cray"));
    }
    let numbers_as = [DOUBLE, SINGLE, INT32, INT16, UINT16, UINT8];
    let is_known = machine <= 1 && zero == 0 && matrix <= 2;
    let number = numbers_as.get(precision as usize).filter(|_| is_known);
    let (Some(&number), true) = (number, is_imaginary <= 1 && (1..=LONGEST).contains(&length))
    else {
        return Err(bytes.fault("this is no variable"));
    };
    let width = match number {
        DOUBLE => 8,
        SINGLE | INT32 => 4,
        UINT8 => 1,
        _ => 2,
    };
    let name = bytes.take(length as usize)?;
    let end = name.iter().position(|byte| *byte == 0).unwrap_or(name.len());
    let name = String::from_utf8_lossy(&name[..end]).into_owned();
    let sizes = vec![rows as usize, columns as usize];
    let count = sizes[0].checked_mul(sizes[1]).filter(|count| *count < 1 << 31);
    let count = count.ok_or_else(|| bytes.fault("an array is too large"))?;
    let values = bytes.take(count * width)?;
    if is_imaginary == 1 {
        bytes.take(count * width)?;
    }
    let values = Bytes::new(values, 0, is_little, false);
    let values = Element { kind: number, bytes: values }.numbers()?;
    let value = match matrix {
        0 => MatValue::Numeric { sizes, values },
        1 => {
            let letter = |v: f64| format!("{v:.0}").parse().ok().and_then(char::from_u32);
            MatValue::Text(values.into_iter().filter_map(letter).collect())
        }
        _ => MatValue::Other("sparse matrix".to_owned()),
    };
    Ok((name, value))
}

#[cfg(test)]
mod tests {
    use super::super::read_variables;
    use super::*;
    use crate::import::mat::byte_order as order;

    /// A variable; shares no code with the reader.
    fn written(is_little: bool, kind: u32, sizes: [u32; 2], name: &str, data: &[u8]) -> Vec<u8> {
        let words = [kind, sizes[0], sizes[1], 0, u32::try_from(name.len()).unwrap() + 1];
        let word = |v: &u32| if is_little { v.to_le_bytes() } else { v.to_be_bytes() };
        let mut out: Vec<u8> = words.iter().flat_map(word).collect();
        out.extend(name.bytes().chain([0]).chain(data.iter().copied()));
        out
    }

    #[test]
    fn every_precision_in_both_byte_orders() {
        let little = |v: f64| v.to_le_bytes().to_vec();
        let file = [
            written(true, 0, [3, 1], "time_s", &[0.0, 0.5, 1.0].map(little).concat()),
            written(true, 10, [3, 1], "u_V", &[-1.5_f32, 2.0, 3.25].map(f32::to_le_bytes).concat()),
            written(true, 20, [1, 3], "x_um", &[-70_000_i32, 2, 3].map(i32::to_le_bytes).concat()),
            written(true, 30, [1, 1], "short", &(-7_i16).to_le_bytes()),
            written(true, 40, [1, 1], "word", &60_000_u16.to_le_bytes()),
            written(true, 51, [1, 5], "title", b"bench"),
        ]
        .concat();
        assert_eq!(order(&file, true), Some(Ok(true)));
        assert_eq!(order(&file, false), None, "there is no signature: the name decides");
        let numeric = |sizes: [usize; 2], values: &[f64]| MatValue::Numeric {
            sizes: sizes.to_vec(),
            values: values.to_vec(),
        };
        let expected = [
            ("time_s", numeric([3, 1], &[0.0, 0.5, 1.0])),
            ("u_V", numeric([3, 1], &[-1.5, 2.0, 3.25])),
            ("x_um", numeric([1, 3], &[-70_000.0, 2.0, 3.0])),
            ("short", numeric([1, 1], &[-7.0])),
            ("word", numeric([1, 1], &[60_000.0])),
            ("title", MatValue::Text("bench".into())),
        ];
        let expected = expected.map(|(name, value)| (name.to_owned(), value));
        assert_eq!(read_variables(&file).unwrap(), expected);
        let big = |v: f64| v.to_be_bytes().to_vec();
        let file = written(false, 1000, [2, 2], "a", &[1.0, 2.0, 3.0, 4.0].map(big).concat());
        assert_eq!(
            read_variables(&file).unwrap(),
            [("a".to_owned(), numeric([2, 2], &[1.0, 2.0, 3.0, 4.0]))]
        );
    }

    #[test]
    fn damage_is_named() {
        let whole = written(true, 0, [3, 1], "u", &[0; 24]);
        let said = |file: &[u8]| read_variables(file).unwrap_err().to_string();
        for end in 20..whole.len() {
            assert!(said(&whole[..end]).contains("the file is truncated"), "{end}");
        }
        let more = [whole.clone(), vec![9; 30]].concat();
        assert!(said(&more).contains("damaged MAT file at byte 66: this is no variable"));
        let huge = written(true, 0, [u32::MAX, u32::MAX], "u", &[0; 24]);
        assert!(said(&huge).contains("an array is too large"));
        let vax = written(true, 2000, [3, 1], "u", &[0; 24]);
        assert!(said(&vax).contains("those of a VAX or a Cray; save it again"), "{}", said(&vax));
    }
}
