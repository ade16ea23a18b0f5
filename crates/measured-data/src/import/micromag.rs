//! First-order reversal curves as a MicroMag 2900/3900 magnetometer writes them.
//!
//! A text header (`key = value`, `Units of measure: cgs`), then blocks of `field,moment` rows between
//! blank lines, then a closing line. A block of one row at the calibration field `HCal` is the drift
//! calibration taken before the curve that follows; every other block is a curve.

use super::whole;
use crate::files::Source;
use crate::problem::{Fault, Place, Problem, Problems};
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

/// The lines before the data, and the file they are from.
struct Header<'a> {
    file: &'a str,
    lines: &'a [&'a str],
}

impl<'a> Header<'a> {
    /// The text behind `key` and its `=` or `:`, and its place.
    fn value(&self, key: &str) -> Result<(Place, &'a str), Problem> {
        let found = self.lines.iter().enumerate().find_map(|(i, line)| {
            let rest = line.strip_prefix(key)?.trim_start().strip_prefix(['=', ':'])?;
            Some((Place::at(self.file, i + 1, 1).field(key), rest.trim()))
        });
        found.ok_or_else(|| {
            let message = format!(
                "the MicroMag header has no line `{key}`; it is no FORC file, or it is damaged"
            );
            Problem::new(Place::file(self.file), Fault::Other(message))
        })
    }

    fn number(&self, key: &str) -> Result<f64, Problem> {
        let (place, text) = self.value(key)?;
        let number = text.parse::<f64>().ok().filter(|v| v.is_finite());
        number.ok_or_else(|| Problem::new(place, Fault::NotANumber { text: text.to_owned() }))
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
    let header = Header { file, lines: &all[..data] };
    let [promised, rows, field] =
        ["NCrv", "NData", "HCal"].map(|key| problems.note(header.number(key)));
    let units = problems.note(units(&header)).flatten();
    let (Some(promised), Some(rows), Some(field), Some((field_unit, moment_unit))) =
        (promised, rows, field, units)
    else {
        return problems.into_result(None);
    };
    let blocks = blocks(&all, data, file, &mut problems);
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
            let message = format!(
                "{found} {of}, the header promises {}: the file is truncated or damaged; copy it again from the instrument",
                whole(promised)
            );
            problems.push(Place::at(file, all.len().max(1), 1), Fault::Other(message));
        }
    }
    let title = header
        .lines
        .iter()
        .find(|l| l.len() > 2 && l.starts_with('"') && l.ends_with('"'))
        .map(|l| l.trim_matches('"').to_owned())
        .unwrap_or_default();
    let channel = |name: &str, unit| Channel { name: name.to_owned(), unit };
    let (input, output) = (channel("field", field_unit), channel("moment", moment_unit));
    problems.into_result(Some(MicroMag { title, input, output, curves }))
}

/// Units of field and moment: `cgs` is Oe and emu, `SI` is T (`mu0 H`) and A m^2.
fn units(header: &Header<'_>) -> Result<Option<(Unit, Unit)>, Problem> {
    let (place, text) = header.value("Units of measure")?;
    let (field, moment) = match text.to_lowercase().as_str() {
        "cgs" => ("Oe", "emu"),
        "si" | "hybrid si" => ("T", "A_m2"),
        _ => {
            let (found, known) = (text.to_owned(), "cgs, SI, Hybrid SI".to_owned());
            let fault = Fault::Unknown { what: "choice", found, known, nearest: None };
            return Err(Problem::new(place, fault));
        }
    };
    Ok(Unit::find(field).zip(Unit::find(moment)))
}

/// The rows between blank lines.
fn blocks(
    lines: &[&str],
    data: usize,
    file: &str,
    problems: &mut Problems,
) -> Vec<Vec<(f64, f64)>> {
    let closing = lines.iter().skip(data).position(|line| line.contains(END));
    let end = closing.map_or(lines.len(), |at| data + at);
    let rows: Vec<(usize, &str)> = (data..end).map(|i| (i + 1, lines[i])).collect();
    let mut point = |(line, text): &(usize, &str)| {
        let fields = text.split(',').map(|field| field.trim().parse::<f64>().ok());
        let numbers: Option<Vec<f64>> = fields.map(|v| v.filter(|v| v.is_finite())).collect();
        // a third column holds the temperature
        if let Some([h, m] | [h, m, _]) = numbers.as_deref() {
            return Some((*h, *m));
        }
        if problems.as_slice().len() < 5 {
            let fault = Fault::NotANumber { text: (*text).to_owned() };
            problems.push(Place::at(file, *line, 1).field("field,moment"), fault);
        }
        None
    };
    let blocks = rows.split(|(_, text)| text.is_empty()).filter(|block| !block.is_empty());
    let blocks = blocks.map(|block| block.iter().filter_map(&mut point).collect()).collect();
    if closing.is_none() {
        let text = lines.last().copied().unwrap_or_default().to_owned();
        let place = Place::at(file, lines.len().max(1), 1);
        problems.push(place, Fault::Truncated { text, expected: 2 });
    }
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
