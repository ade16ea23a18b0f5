//! TDMS files of `LabVIEW`: numeric channels with their units and stated sampling.
//!
//! Not read: big-endian files, raw data of `DAQmx`, channels whose scaling is left to the reader.
//!
//! Source: National Instruments, "TDMS File Format Internal Structure".

use super::in_memory::WholeColumns;
use crate::problem::Fault;

/// What a segment begins with.
pub(super) const MAGIC: &[u8] = b"TDSm";
/// Flags of a segment: it has objects, a new list of them, raw data; samples alternate, big-endian, `DAQmx`.
const OBJECTS: u32 = 1 << 1;
const NEW_LIST: u32 = 1 << 2;
const RAW: u32 = 1 << 3;
const ALTERNATE: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;
const DAQMX: u32 = 1 << 7;
/// Indices of raw data: there is none, it is as before.
const NONE: u32 = u32::MAX;
const AS_BEFORE: u32 = 0;
/// Types of values.
const TEXT: u32 = 0x20;
const TIMESTAMP: u32 = 0x44;
const F64: u32 = 10;

/// Bytes that are read one after the other.
struct Bytes<'a> {
    rest: &'a [u8],
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or_else(cut)?;
        self.rest = rest;
        Ok(taken)
    }

    fn u32(&mut self) -> Result<u32, Fault> {
        self.take(4)?.try_into().map(u32::from_le_bytes).map_err(|_| cut())
    }

    fn size(&mut self) -> Result<usize, Fault> {
        let word = self.take(8)?.try_into().map(u64::from_le_bytes).map_err(|_| cut())?;
        Ok(usize::try_from(word).unwrap_or(usize::MAX))
    }

    fn text(&mut self) -> Result<String, Fault> {
        let length = self.u32()? as usize;
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }
}

fn cut() -> Fault {
    Fault::Other("ends within a segment of the TDMS file; copy it again from its source".to_owned())
}

fn refused(what: &str) -> Fault {
    Fault::Other(format!(
        "{what}, which is not read; in DIAdem or Excel with the TDM add-in save it as CSV, or in Python: nptdms.TdmsFile.read(FILE).as_dataframe(time_index=True).to_csv('file.csv'), then --columns time_s=#1,command_V=#2,displacement_um=#3"
    ))
}

/// Bytes of a value of a type.
fn width(kind: u32) -> Result<usize, Fault> {
    match kind {
        1 | 5 | 0x21 => Ok(1),
        2 | 6 => Ok(2),
        3 | 7 | 9 | 0x19 => Ok(4),
        4 | 8 | F64 | 0x1a => Ok(8),
        TIMESTAMP => Ok(16),
        _ => Err(refused(&format!("holds values of type {kind:#x}"))),
    }
}

/// A number of a type; a time stamp is none that is used.
fn value(kind: u32, bytes: &[u8]) -> f64 {
    let mut wide = [0; 8];
    for (to, from) in wide.iter_mut().zip(bytes) {
        *to = *from;
    }
    let word = u64::from_le_bytes(wide);
    let signed = |bits: u32| (word.cast_signed() << (64 - bits)) >> (64 - bits);
    match kind {
        1 => signed(8) as f64,
        2 => signed(16) as f64,
        3 => signed(32) as f64,
        4 => word.cast_signed() as f64,
        9 | 0x19 => f32::from_le_bytes([wide[0], wide[1], wide[2], wide[3]]).into(),
        F64 | 0x1a => f64::from_le_bytes(wide),
        TIMESTAMP => f64::NAN,
        _ => word as f64,
    }
}

/// An object of the file.
#[derive(Default)]
struct Object {
    path: String,
    /// Type, number of values and bytes in a chunk of raw data.
    raw: Option<(u32, usize, usize)>,
    values: Vec<f64>,
    unit: Option<String>,
    step_s: Option<f64>,
    /// Time of its first sample, s.
    start_s: f64,
    is_scaled: bool,
}

impl Object {
    /// Takes the index of its raw data up; whether it has some in this segment.
    fn index(&mut self, bytes: &mut Bytes<'_>) -> Result<bool, Fault> {
        match bytes.u32()? {
            NONE => return Ok(false),
            AS_BEFORE => return Ok(self.raw.is_some()),
            length if length > 28 => return Err(refused("holds raw data of DAQmx")),
            _ => {}
        }
        let (kind, _dimension, count) = (bytes.u32()?, bytes.u32()?, bytes.size()?);
        let size = match kind {
            TEXT => bytes.size()?,
            _ => width(kind)?.checked_mul(count).ok_or_else(cut)?,
        };
        self.raw = Some((kind, count, size));
        Ok(true)
    }

    fn property(&mut self, bytes: &mut Bytes<'_>) -> Result<(), Fault> {
        let (name, kind) = (bytes.text()?, bytes.u32()?);
        if kind == TEXT {
            let text = bytes.text()?;
            if name == "unit_string" {
                self.unit = Some(text);
            }
            return Ok(());
        }
        let number = value(kind, bytes.take(width(kind)?)?);
        match name.as_str() {
            "wf_increment" => self.step_s = Some(number).filter(|step| *step > 0.0),
            "wf_start_offset" if number.is_finite() => self.start_s = number,
            "NI_Number_Of_Scales" => self.is_scaled = number > 0.0,
            _ => {}
        }
        Ok(())
    }

    /// Its name with its unit: that of `/'group'/'channel'`.
    fn name(&self) -> String {
        let name = self.path.rsplit("/'").next().unwrap_or_default();
        let name = name.trim_end_matches('\'').replace("''", "'");
        match self.unit.as_ref().filter(|unit| !unit.is_empty()) {
            Some(unit) if crate::tables::Channel::parse(&name).is_none() => {
                format!("{name} [{unit}]")
            }
            _ => name,
        }
    }
}

/// Reads the channels of most samples.
///
/// # Errors
/// What is cut off or not read.
pub(super) fn read_tdms(file: &[u8]) -> Result<WholeColumns, Fault> {
    let mut bytes = Bytes { rest: file };
    let mut objects: Vec<Object> = Vec::new();
    let mut order: Vec<usize> = Vec::new();
    while bytes.rest.starts_with(MAGIC) {
        bytes.take(4)?;
        let (flags, _version) = (bytes.u32()?, bytes.u32()?);
        let (next, raw) = (bytes.size()?, bytes.size()?);
        if flags & BIG_ENDIAN != 0 {
            return Err(refused("is a big-endian TDMS file"));
        }
        if flags & DAQMX != 0 {
            return Err(refused("holds raw data of DAQmx"));
        }
        // a recorder that was stopped leaves the length open
        let length = if next == usize::MAX { bytes.rest.len() } else { next };
        let mut segment = Bytes { rest: bytes.take(length)? };
        let mut meta = Bytes { rest: segment.take(raw)? };
        if flags & NEW_LIST != 0 {
            order.clear();
        }
        if flags & OBJECTS != 0 {
            for _ in 0..meta.u32()? {
                let path = meta.text()?;
                let known = objects.iter().position(|object| object.path == path);
                let at = known.unwrap_or(objects.len());
                if known.is_none() {
                    objects.push(Object { path, ..Object::default() });
                }
                let has_raw = objects[at].index(&mut meta)?;
                order.retain(|own| *own != at || has_raw);
                if has_raw && !order.contains(&at) {
                    order.push(at);
                }
                for _ in 0..meta.u32()? {
                    objects[at].property(&mut meta)?;
                }
            }
        }
        if flags & RAW != 0 {
            raw_data(&mut objects, &order, &mut segment, flags & ALTERNATE != 0)?;
        }
    }
    if !bytes.rest.is_empty() {
        return Err(cut());
    }
    channels(objects)
}

/// Reads the chunks of a segment.
fn raw_data(
    objects: &mut [Object],
    order: &[usize],
    bytes: &mut Bytes<'_>,
    alternate: bool,
) -> Result<(), Fault> {
    let indices: Vec<(usize, u32, usize, usize)> = order
        .iter()
        .filter_map(|at| objects[*at].raw.map(|(kind, count, size)| (*at, kind, count, size)))
        .collect();
    let chunk = indices.iter().fold(0_usize, |sum, (.., size)| sum.saturating_add(*size));
    if chunk == 0 {
        return Ok(());
    }
    let first = indices.first().map_or(0, |(_, _, count, _)| *count);
    if alternate && indices.iter().any(|(_, _, count, _)| *count != first) {
        return Err(refused("holds channels of different lengths whose samples alternate"));
    }
    while bytes.rest.len() >= chunk {
        if alternate {
            for _ in 0..first {
                for (at, kind, ..) in &indices {
                    let number = value(*kind, bytes.take(width(*kind)?)?);
                    objects[*at].values.push(number);
                }
            }
            continue;
        }
        for (at, kind, _, size) in &indices {
            let raw = bytes.take(*size)?;
            if *kind != TEXT {
                let numbers = raw.chunks_exact(width(*kind)?).map(|bytes| value(*kind, bytes));
                objects[*at].values.extend(numbers);
            }
        }
    }
    Ok(())
}

/// The channels of most samples as columns.
fn channels(objects: Vec<Object>) -> Result<WholeColumns, Fault> {
    let longest = objects.iter().map(|object| object.values.len()).max().unwrap_or(0);
    let taken = objects.into_iter().filter(|o| o.values.len() == longest && longest > 0);
    let taken: Vec<Object> = taken.collect();
    if taken.iter().any(|object| object.is_scaled) {
        return Err(refused("holds channels that are to be scaled by the reader"));
    }
    let step_s = taken.first().and_then(|object| object.step_s);
    let start = taken.first().map(|object| object.start_s.to_bits());
    let is_alike = |o: &Object| o.step_s == step_s && Some(o.start_s.to_bits()) == start;
    if !taken.iter().all(is_alike) {
        return Err(refused("holds channels of different sampling or start"));
    }
    let names: Vec<String> = taken.iter().map(Object::name).collect();
    let words = format!("{} of {longest} samples", names.join(", "));
    let columns = taken.into_iter().map(|object| object.values).collect();
    Ok(WholeColumns { names: Some(names), columns, step_s, taken: words })
}
