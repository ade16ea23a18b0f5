//! The bytes of a MAT file: byte order, element tags, numbers.

use crate::problem::Fault;

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

    /// A fault at the present place.
    pub(super) fn fault(&self, what: &str) -> Fault {
        let of = if self.compressed { " of a compressed variable" } else { "" };
        Fault::Other(format!(
            "damaged MAT file at byte {}{of}: {what}; save it again with save('file.mat', '-v7')",
            self.base + self.at
        ))
    }

    /// The next `count` bytes.
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let end = self.at.checked_add(count).filter(|end| *end <= self.data.len());
        let end =
            end.ok_or_else(|| self.fault("it ends inside an element: the file is truncated"))?;
        let bytes = &self.data[self.at..end];
        self.at = end;
        Ok(bytes)
    }

    /// The next word.
    pub(super) fn u32(&mut self) -> Result<u32, Fault> {
        let bytes = self.take(4)?;
        Ok(self.word(bytes))
    }

    fn word(&self, bytes: &[u8]) -> u32 {
        let mut word = [0; 4];
        word.copy_from_slice(bytes);
        if self.little_endian { u32::from_le_bytes(word) } else { u32::from_be_bytes(word) }
    }

    /// The next element; its padding is skipped.
    pub(super) fn element(&mut self) -> Result<Element<'a>, Fault> {
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
    pub(super) fn numbers(&self) -> Result<Vec<f64>, Fault> {
        match self.kind {
            INT8 => self.values(|bytes| f64::from(i8::from_le_bytes(bytes))),
            UINT8 | UTF8 => self.values(|bytes| f64::from(u8::from_le_bytes(bytes))),
            INT16 => self.values(|bytes| f64::from(i16::from_le_bytes(bytes))),
            UINT16 | UTF16 => self.values(|bytes| f64::from(u16::from_le_bytes(bytes))),
            INT32 => self.values(|bytes| f64::from(i32::from_le_bytes(bytes))),
            UINT32 | UTF32 => self.values(|bytes| f64::from(u32::from_le_bytes(bytes))),
            SINGLE => self.values(|bytes| f64::from(f32::from_le_bytes(bytes))),
            DOUBLE => self.values(f64::from_le_bytes),
            INT64 => self.values(|bytes| i64::from_le_bytes(bytes) as f64),
            UINT64 => self.values(|bytes| u64::from_le_bytes(bytes) as f64),
            _ => Err(self.bytes.fault("numbers were expected here")),
        }
    }

    /// The values of `N` bytes each; `value` takes them with the lowest byte first.
    fn values<const N: usize>(&self, value: impl Fn([u8; N]) -> f64) -> Result<Vec<f64>, Fault> {
        let (chunks, rest) = self.bytes.rest().as_chunks();
        if !rest.is_empty() {
            return Err(self.bytes.fault("the size of an element is no whole number of values"));
        }
        let in_order = |mut bytes: [u8; N]| {
            if !self.bytes.little_endian {
                bytes.reverse();
            }
            bytes
        };
        Ok(chunks.iter().map(|bytes| value(in_order(*bytes))).collect())
    }

    /// The whole numbers of an element, all 0 or more.
    pub(super) fn sizes(&self) -> Result<Vec<usize>, Fault> {
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
