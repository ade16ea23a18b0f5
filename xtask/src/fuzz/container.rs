//! Packed inputs opened, changed inside and packed again, so that a change reaches what is behind the checks of the packing.

use std::io::{Read, Write};

use chacha20::ChaCha8Rng;
use flate2::Crc;
use flate2::read::{DeflateDecoder, GzDecoder, ZlibDecoder};
use flate2::write::{GzEncoder, ZlibEncoder};
use rand::RngExt;

use super::bytes::{Form, number, of_bytes};
use super::parts;

/// Most bytes of an opened part.
const MOST_BYTES: u64 = 1 << 20;

/// A packed input with a change inside; none if it cannot be opened.
pub(super) fn changed_inside(form: Form, bytes: &[u8], random: &mut ChaCha8Rng) -> Option<Vec<u8>> {
    match form {
        Form::Zip => {
            let mut files = unzipped(bytes)?;
            let which = random.random_range(0..files.len());
            let text = &mut files[which].1;
            for _ in 0..random.random_range(1..=4) {
                of_xml(text, random);
            }
            Some(zipped(&files))
        }
        Form::Mat => {
            let mut elements = elements(bytes)?;
            let which = random.random_range(0..elements.len());
            for _ in 0..random.random_range(1..=4) {
                parts::of_binary(&mut elements[which].1, random);
            }
            Some([bytes[..HEADER].to_vec(), packed(&elements)].concat())
        }
        Form::Gzip => {
            let mut text = Vec::new();
            GzDecoder::new(bytes).take(MOST_BYTES).read_to_end(&mut text).ok()?;
            for _ in 0..random.random_range(1..=4) {
                parts::of_table(&mut text, random);
            }
            let mut encoder = GzEncoder::new(Vec::new(), flate2::Compression::fast());
            encoder.write_all(&text).ok()?;
            encoder.finish().ok()
        }
        _ => None,
    }
}

/// An element of an XML text is left out or doubled, or a number or some bytes become others.
fn of_xml(text: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    let tags: Vec<usize> =
        text.iter().enumerate().filter(|(_, byte)| **byte == b'<').map(|(at, _)| at).collect();
    if tags.len() < 3 {
        return of_bytes(text, random);
    }
    let first = random.random_range(0..tags.len() - 1);
    let last = (first + random.random_range(1..8_usize)).min(tags.len() - 1);
    let part = tags[first]..tags[last];
    match random.random_range(0..5_u32) {
        0 => drop(text.drain(part)),
        1 => {
            let copy = text[part.clone()].to_vec();
            drop(text.splice(part.start..part.start, copy));
        }
        2 => of_bytes(text, random),
        _ => number(text, part.start, random),
    }
}

/// Bytes before the elements of a MAT file of level 5.
const HEADER: usize = 128;
/// Type of a compressed element.
const COMPRESSED: u32 = 15;

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}

fn size(bytes: &[u8], at: usize) -> Option<usize> {
    usize::try_from(word(bytes, at)?).ok()
}

/// Types and contents of the elements of a MAT file, opened.
fn elements(bytes: &[u8]) -> Option<Vec<(u32, Vec<u8>)>> {
    let mut found = Vec::new();
    let mut at = HEADER;
    while at + 8 <= bytes.len() {
        let (kind, length) = (word(bytes, at)?, size(bytes, at + 4)?);
        let data = bytes.get(at + 8..at + 8 + length)?;
        let mut open = data.to_vec();
        if kind == COMPRESSED {
            open.clear();
            ZlibDecoder::new(data).take(MOST_BYTES).read_to_end(&mut open).ok()?;
        }
        found.push((kind, open));
        at += 8 + length;
    }
    (!found.is_empty()).then_some(found)
}

fn length(bytes: &[u8]) -> [u8; 4] {
    u32::try_from(bytes.len()).unwrap_or(u32::MAX).to_le_bytes()
}

fn packed(elements: &[(u32, Vec<u8>)]) -> Vec<u8> {
    let mut out = Vec::new();
    for (kind, open) in elements {
        let mut data = open.clone();
        if *kind == COMPRESSED {
            let mut encoder = ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
            // writing to memory cannot fail
            let _ = encoder.write_all(open);
            data = encoder.finish().unwrap_or_default();
        }
        out.extend(kind.to_le_bytes());
        out.extend(length(&data));
        out.extend(data);
    }
    out
}

/// Names and contents of the files of a ZIP file. Source: PKWARE, APPNOTE 6.3, sections 4.3.7, 4.3.12 and 4.3.16.
fn unzipped(bytes: &[u8]) -> Option<Vec<(Vec<u8>, Vec<u8>)>> {
    let end = bytes.windows(4).rposition(|window| window == b"PK\x05\x06")?;
    let half =
        |at: usize| Some(usize::from(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?)));
    let mut at = size(bytes, end + 16)?;
    let mut files = Vec::new();
    for _ in 0..half(end + 10)? {
        let method = half(at + 10)?;
        let (packed, local) = (size(bytes, at + 20)?, size(bytes, at + 42)?);
        let name = bytes.get(at + 46..at + 46 + half(at + 28)?)?.to_vec();
        at += 46 + half(at + 28)? + half(at + 30)? + half(at + 32)?;
        let start = local + 30 + half(local + 26)? + half(local + 28)?;
        let data = bytes.get(start..start + packed)?;
        let mut content = Vec::new();
        match method {
            0 => content.extend(data),
            _ => drop(DeflateDecoder::new(data).take(MOST_BYTES).read_to_end(&mut content).ok()?),
        }
        files.push((name, content));
    }
    (!files.is_empty()).then_some(files)
}

/// The ZIP file of some files, not compressed, with fitting checksums.
fn zipped(files: &[(Vec<u8>, Vec<u8>)]) -> Vec<u8> {
    let (mut out, mut list) = (Vec::new(), Vec::new());
    for (name, content) in files {
        let mut crc = Crc::new();
        crc.update(content);
        let mut common = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0];
        common.extend(crc.sum().to_le_bytes());
        common.extend(length(content));
        common.extend(length(content));
        common.extend(&length(name)[..2]);
        common.extend([0, 0]);
        list.extend(b"PK\x01\x02\x14\0");
        list.extend(&common);
        list.extend([0; 10]);
        list.extend(length(&out));
        list.extend(name);
        out.extend(b"PK\x03\x04");
        out.extend(&common);
        out.extend(name);
        out.extend(content);
    }
    let count = u16::try_from(files.len()).unwrap_or(u16::MAX).to_le_bytes();
    let start = length(&out);
    let listed = length(&list);
    out.extend(list);
    out.extend(b"PK\x05\x06\0\0\0\0");
    out.extend(count);
    out.extend(count);
    out.extend(listed);
    out.extend(start);
    out.extend([0, 0]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::read_bytes;
    use crate::workspace::root;

    /// Opened and packed again, the contents of shipped files are what they were.
    #[test]
    fn packing_again_keeps_the_content() {
        let fixtures = root().join("fixtures/instruments");
        let workbook = read_bytes(&fixtures.join("excel_xlsx.xlsx")).unwrap();
        let files = unzipped(&workbook).unwrap();
        assert!(files.iter().any(|(name, _)| name.ends_with(b"sheet1.xml")), "{}", files.len());
        assert_eq!(unzipped(&zipped(&files)).unwrap(), files);
        let mat = read_bytes(&root().join("fixtures/mat/bench_struct.mat")).unwrap();
        let open = elements(&mat).unwrap();
        assert!(open.iter().all(|(kind, _)| *kind == COMPRESSED));
        let again = [mat[..HEADER].to_vec(), packed(&open)].concat();
        assert_eq!(elements(&again).unwrap(), open);
        assert!(unzipped(b"PK\x05\x06").is_none() && elements(&[0; 64]).is_none());
    }
}
