//! The bytes of a MAT file: byte order, element tags, numbers.

use crate::problem::RecordFault;

/// Bytes that are read from front to back, never beyond their end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bytes<'a> {
    data: &'a [u8],
    at: usize,
    /// Offset of `data[0]` in the file, or in the decompressed variable.
    base: usize,
    little_endian: bool,
    compressed: bool,
}

/// Types of data elements.
pub(super) const INT8: u32 = 1;
pub(super) const UINT8: u32 = 2;
pub(super) const INT16: u32 = 3;
pub(super) const UINT16: u32 = 4;
pub(super) const INT32: u32 = 5;
pub(super) const UINT32: u32 = 6;
pub(super) const SINGLE: u32 = 7;
pub(super) const DOUBLE: u32 = 9;
pub(super) const INT64: u32 = 12;
pub(super) const UINT64: u32 = 13;
pub(super) const MATRIX: u32 = 14;
pub(super) const COMPRESSED: u32 = 15;
pub(super) const UTF8: u32 = 16;
pub(super) const UTF16: u32 = 17;
pub(super) const UTF32: u32 = 18;

/// A data element: its type and its bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element<'a> {
    pub(super) kind: u32,
    pub(super) bytes: Bytes<'a>,
}

impl<'a> Bytes<'a> {
    pub(super) fn new(data: &'a [u8], base: usize, little_endian: bool, compressed: bool) -> Self {
        Self { data, at: 0, base, little_endian, compressed }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.at >= self.data.len()
    }

    pub(super) fn rest(&self) -> &'a [u8] {
        &self.data[self.at..]
    }

    pub(super) fn is_little_endian(&self) -> bool {
        self.little_endian
    }

    /// A fault at the present place.
    pub(super) fn fault(&self, what: &'static str) -> RecordFault {
        RecordFault::Mat { offset: self.base + self.at, compressed: self.compressed, what }
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], RecordFault> {
        let end = self.at.checked_add(count).filter(|end| *end <= self.data.len());
        let end =
            end.ok_or_else(|| self.fault("it ends inside an element: the file is truncated"))?;
        let bytes = &self.data[self.at..end];
        self.at = end;
        Ok(bytes)
    }

    fn u32(&mut self) -> Result<u32, RecordFault> {
        let bytes = self.take(4)?;
        Ok(self.word(bytes))
    }

    fn word(&self, bytes: &[u8]) -> u32 {
        let mut word = [0; 4];
        word.copy_from_slice(bytes);
        if self.little_endian { u32::from_le_bytes(word) } else { u32::from_be_bytes(word) }
    }

    /// The next element; its padding is skipped.
    pub(super) fn element(&mut self) -> Result<Element<'a>, RecordFault> {
        let tag = self.u32()?;
        let (little_endian, compressed) = (self.little_endian, self.compressed);
        // a short element has its size in the upper half of the first word, its data in the second
        let (kind, size) =
            if tag >> 16 == 0 { (tag, self.u32()?) } else { (tag & 0xffff, tag >> 16) };
        let short = tag >> 16 != 0;
        if short && size > 4 {
            return Err(self.fault("a short element has more than four bytes"));
        }
        let size = usize::try_from(size).map_err(|_| self.fault("an element is too long"))?;
        let base = self.base + self.at;
        let data = self.take(size)?;
        // compressed elements alone are not padded; at the end of the file padding may be missing
        let padding = if short {
            4 - size
        } else if kind == COMPRESSED {
            0
        } else {
            (8 - size % 8) % 8
        };
        self.at = (self.at + padding).min(self.data.len());
        Ok(Element { kind, bytes: Bytes { data, at: 0, base, little_endian, compressed } })
    }
}

impl Element<'_> {
    /// The numbers of a numeric element.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, RecordFault> {
        let data = self.bytes.rest();
        let little = self.bytes.is_little_endian();
        macro_rules! read {
            ($type:ty, $size:literal, $convert:expr) => {{
                let chunks = data.chunks_exact($size);
                if !chunks.remainder().is_empty() {
                    let what = "the size of an element is no whole number of values";
                    return Err(self.bytes.fault(what));
                }
                let convert = $convert;
                chunks
                    .map(|chunk| {
                        let mut bytes = [0; $size];
                        bytes.copy_from_slice(chunk);
                        convert(if little {
                            <$type>::from_le_bytes(bytes)
                        } else {
                            <$type>::from_be_bytes(bytes)
                        })
                    })
                    .collect()
            }};
        }
        Ok(match self.kind {
            INT8 => read!(i8, 1, f64::from),
            UINT8 | UTF8 => read!(u8, 1, f64::from),
            INT16 => read!(i16, 2, f64::from),
            UINT16 | UTF16 => read!(u16, 2, f64::from),
            INT32 => read!(i32, 4, f64::from),
            UINT32 | UTF32 => read!(u32, 4, f64::from),
            SINGLE => read!(f32, 4, f64::from),
            DOUBLE => read!(f64, 8, |v: f64| v),
            INT64 => read!(i64, 8, |v: i64| v as f64),
            UINT64 => read!(u64, 8, |v: u64| v as f64),
            _ => return Err(self.bytes.fault("numbers were expected here")),
        })
    }

    /// The whole numbers of an element, all 0 or more.
    pub(super) fn sizes(&self) -> Result<Vec<usize>, RecordFault> {
        if !matches!(self.kind, INT32 | UINT32) {
            return Err(self.bytes.fault("sizes were expected here"));
        }
        let size = |v: &[u8]| usize::try_from(self.bytes.word(v)).ok().filter(|v| *v < 1 << 31);
        let sizes = self.bytes.rest().chunks_exact(4).map(size).collect::<Option<Vec<_>>>();
        sizes.ok_or_else(|| self.bytes.fault("a size is negative"))
    }

    /// The first four bytes as a word.
    pub(super) fn first_word(&self) -> Option<u32> {
        self.bytes.rest().get(..4).map(|bytes| self.bytes.word(bytes))
    }

    /// The text of an element of bytes.
    pub(super) fn text(&self) -> String {
        let text = String::from_utf8_lossy(self.bytes.rest());
        text.trim_end_matches('\0').to_owned()
    }
}
