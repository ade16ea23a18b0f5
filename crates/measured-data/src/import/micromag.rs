//! First-order reversal curves as a MicroMag 2900/3900 magnetometer writes them.
//!
//! A text header (`key = value`, `Units of measure: cgs`), then blocks of `field,moment` rows between
//! blank lines, then a closing line. A block of one row at the calibration field `HCal` is the drift
//! calibration taken before the curve that follows; every other block is a curve.

use crate::files::Source;
use crate::problem::{Fault, Place, Problems, RecordFault};
use crate::tables::{Channel, Unit};

/// Deviation from `HCal` within which a single row is a calibration.
const CALIBRATION_FIELD: f64 = 0.01;

/// Curves of a MicroMag file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MicroMag {
    /// The sample, as the file names it.
    pub(super) title: String,
    /// Field.
    pub(super) input: Channel,
    /// Moment.
    pub(super) output: Channel,
    /// The curves with their calibration.
    pub(super) curves: Vec<Curve>,
}

/// One curve.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Curve {
    /// Field and moment of the calibration before it.
    pub(super) calibration: Option<(f64, f64)>,
    /// Field and moment, field increasing.
    pub(super) points: Vec<(f64, f64)>,
}

/// The lines a MicroMag file begins and ends with.
const BEGIN: &str = "MicroMag";
const END: &str = "Data File ends";

/// Whether a text begins like a MicroMag file.
pub(super) fn is_micromag(start: &[u8]) -> bool {
    start.starts_with(BEGIN.as_bytes())
}

struct Header<'a> {
    lines: Vec<(usize, &'a str)>,
    /// Line the data begin at, from 0.
    data: usize,
}

impl<'a> Header<'a> {
    /// The text behind `key` and its `=` or `:`.
    fn value(&self, key: &str) -> Option<(usize, &'a str)> {
        self.lines.iter().find_map(|(number, line)| {
            let rest = line.strip_prefix(key)?.trim_start();
            Some((*number, rest.strip_prefix(['=', ':'])?.trim()))
        })
    }

    fn number(&self, file: &str, key: &'static str, problems: &mut Problems) -> Option<f64> {
        let Some((line, text)) = self.value(key) else {
            problems.push(Place::file(file), RecordFault::MicroMagHeader { key }.into());
            return None;
        };
        let number = text.parse::<f64>().ok().filter(|v| v.is_finite());
        if number.is_none() {
            let fault = Fault::NotANumber { text: text.to_owned() };
            problems.push(Place::at(file, line, 1).field(key), fault);
        }
        number
    }
}

/// Reads a MicroMag FORC file.
///
/// # Errors
/// Every problem with its line: a missing key, a bad row, fewer curves or points than promised.
pub(super) fn read_micromag(source: &Source) -> Result<MicroMag, Problems> {
    let mut problems = Problems::default();
    let file = source.name.as_str();
    let all: Vec<&str> = source.text.lines().map(str::trim).collect();
    let is_row = |line: &&str| {
        line.starts_with(['+', '-', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9', '.'])
            && line.split(',').take(2).all(|f| f.trim().parse::<f64>().is_ok())
            && line.contains(',')
    };
    let data = all.iter().position(is_row).unwrap_or(all.len());
    let lines = all[..data].iter().enumerate().map(|(i, l)| (i + 1, *l)).collect();
    let header = Header { lines, data };
    let curves_promised = header.number(file, "NCrv", &mut problems);
    let rows_promised = header.number(file, "NData", &mut problems);
    let calibration_field = header.number(file, "HCal", &mut problems);
    let units = units(&header, file, &mut problems);
    let (Some(promised), Some(rows), Some(field), Some((field_unit, moment_unit))) =
        (curves_promised, rows_promised, calibration_field, units)
    else {
        return problems.into_result(None);
    };
    let blocks = blocks(&all, header.data, file, &mut problems);
    let found_rows: usize = blocks.iter().map(Vec::len).sum();
    let mut curves: Vec<Curve> = Vec::new();
    let mut calibration = None;
    for points in blocks {
        match points.as_slice() {
            [(h, m)] if (h / field - 1.0).abs() < CALIBRATION_FIELD => calibration = Some((*h, *m)),
            _ => curves.push(Curve { calibration: calibration.take(), points }),
        }
    }
    for (of, found, promised) in [
        ("curves are there", curves.len(), promised),
        ("rows of numbers are there", found_rows, rows),
    ] {
        if (found as f64 - promised).abs() > 0.5 {
            let promised = whole(promised);
            let fault = RecordFault::MicroMagCount { of, found, promised };
            problems.push(Place::at(file, all.len().max(1), 1), fault.into());
        }
    }
    let title = header
        .lines
        .iter()
        .find(|(_, l)| l.len() > 2 && l.starts_with('"') && l.ends_with('"'))
        .map(|(_, l)| l.trim_matches('"').to_owned())
        .unwrap_or_default();
    let channel = |name: &str, unit| Channel { name: name.to_owned(), unit };
    let (input, output) = (channel("field", field_unit), channel("moment", moment_unit));
    problems.into_result(Some(MicroMag { title, input, output, curves }))
}

/// A count that was written as a decimal number.
fn whole(value: f64) -> usize {
    format!("{value:.0}").parse().unwrap_or(usize::MAX)
}

/// Units of field and moment: `cgs` is Oe and emu, `SI` is T (`mu0 H`) and A m^2.
fn units(header: &Header<'_>, file: &str, problems: &mut Problems) -> Option<(Unit, Unit)> {
    let key = "Units of measure";
    let Some((line, text)) = header.value(key) else {
        problems.push(Place::file(file), RecordFault::MicroMagHeader { key }.into());
        return None;
    };
    let (field, moment) = match text.to_lowercase().as_str() {
        "cgs" => ("Oe", "emu"),
        "si" | "hybrid si" => ("T", "A_m2"),
        _ => {
            let known = "cgs, SI, Hybrid SI".to_owned();
            let fault = Fault::UnknownChoice { found: text.to_owned(), known, nearest: None };
            problems.push(Place::at(file, line, 1).field(key), fault);
            return None;
        }
    };
    Unit::find(field).zip(Unit::find(moment))
}

/// The rows between blank lines.
fn blocks(
    lines: &[&str],
    data: usize,
    file: &str,
    problems: &mut Problems,
) -> Vec<Vec<(f64, f64)>> {
    let mut blocks: Vec<Vec<(f64, f64)>> = vec![vec![]];
    let mut closed = false;
    for (i, line) in lines.iter().enumerate().skip(data) {
        if line.contains(END) {
            closed = true;
            break;
        }
        if line.is_empty() {
            blocks.push(vec![]);
            continue;
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let numbers: Vec<f64> =
            fields.iter().filter_map(|f| f.parse().ok()).filter(|v: &f64| v.is_finite()).collect();
        // a third column holds the temperature
        match numbers.as_slice() {
            [h, m] | [h, m, _] if numbers.len() == fields.len() => {
                if let Some(block) = blocks.last_mut() {
                    block.push((*h, *m));
                }
            }
            _ if problems.as_slice().len() < 5 => {
                let fault = Fault::NotANumber { text: (*line).to_owned() };
                problems.push(Place::at(file, i + 1, 1).field("field,moment"), fault);
            }
            _ => {}
        }
    }
    if !closed {
        let text = lines.last().copied().unwrap_or_default().to_owned();
        problems
            .push(Place::at(file, lines.len().max(1), 1), Fault::Truncated { text, expected: 2 });
    }
    blocks.retain(|block| !block.is_empty());
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "MicroMag 2900/3900 Data File (Series 0015)\r\nFirst-order reversal curves\r\nUnits of measure: cgs\r\n\"a test's wire\"\r\n\r\nHCal           = +1.0E+03\r\nNCrv           = 2\r\nNData          = 7\r\n\r\n+1.001E+03,+1.0E-03\r\n\r\n+1.0E+02,+5.0E-04\r\n+2.0E+02,+6.0E-04\r\n\r\n+9.99E+02,+1.1E-03\r\n\r\n+0.0E+00,+4.0E-04\r\n+1.0E+02,+4.5E-04\r\n+2.0E+02,+5.5E-04\r\n\r\nMicroMag 2900/3900 Data File ends\r\n";

    fn read(text: &str) -> Result<MicroMag, Problems> {
        read_micromag(&Source { name: "f".into(), text: text.into() })
    }

    #[test]
    fn curves_calibrations_and_units() {
        let found = read(GOOD).unwrap();
        assert_eq!(
            (found.input.label(), found.output.label()),
            ("field_Oe".into(), "moment_emu".into())
        );
        assert_eq!(found.title, "a test's wire");
        assert_eq!(found.curves.len(), 2);
        assert_eq!(found.curves[0].calibration, Some((1001.0, 1e-3)));
        assert_eq!(found.curves[1].points, [(0.0, 4e-4), (100.0, 4.5e-4), (200.0, 5.5e-4)]);
        let si = read(&GOOD.replace(": cgs", ": SI")).unwrap();
        assert_eq!((si.input.label(), si.output.label()), ("field_T".into(), "moment_A_m2".into()));
        // a curve of one point away from HCal is a curve
        let short = GOOD.replace("+2.0E+02,+6.0E-04\r\n", "").replace("= 7", "= 6");
        assert_eq!(read(&short).unwrap().curves[0].points.len(), 1);
    }

    #[test]
    fn what_is_missing_is_named() {
        let text =
            |from: &str, to: &str| read(&GOOD.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(text("NCrv", "Ncrv").contains("no line `NCrv`"));
        assert!(
            text("NCrv           = 2", "NCrv = 3")
                .contains("2 curves are there, the header promises 3")
        );
        assert!(text("NData          = 7", "NData = 8").contains("7 rows of numbers are there"));
        assert!(
            text("+5.0E-04", "+5.0x-04")
                .contains("f:12:1: field,moment: `+1.0E+02,+5.0x-04` is not a number")
        );
        assert!(
            text(": cgs", ": furlongs")
                .contains("f:3:1: Units of measure: unknown choice `furlongs`")
        );
        let cut = read(&GOOD[..GOOD.len() - 60]).unwrap_err().to_string();
        assert!(cut.contains("truncated"), "{cut}");
    }

    #[test]
    fn no_prefix_panics_or_passes() {
        for cut in 0..GOOD.len() - 6 {
            assert!(read(&GOOD[..cut]).is_err(), "cut at {cut}");
        }
    }
}
