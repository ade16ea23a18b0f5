//! Data sets of first-order reversal curves.

use super::file::{DatasetKind, RunFile};
use super::loops::same_channels;
use super::open::{OpenDataset, run_field};
use crate::files::Folder;
use crate::problem::{Fault, Place, Problems};
use crate::tables::{Channels, Rows, parse_rows};

/// A data set of first-order reversal curves, checked.
///
/// Quasi-static: a curve begins at its reversal, where the input turns up on its way down from
/// saturation, and is measured with the input increasing. There is no time.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveData {
    /// One line about the data.
    pub title: String,
    /// Folder the data come from, for messages and results.
    pub folder: String,
    /// Input and output with their units.
    pub channels: Channels,
    /// The measurements in the order of the file.
    pub runs: Vec<CurveRun>,
    /// blake3 of `dataset.ron` and of every file, in order.
    pub content_hash: String,
}

/// One measurement of a set of curves.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveRun {
    /// What `dataset.ron` says of it.
    pub entry: RunFile,
    /// The curves in the order measured.
    pub curves: Vec<ReversalCurve>,
}

/// One first-order reversal curve, as measured: no drift taken off.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReversalCurve {
    /// Inputs from the reversal on, in the unit of the input.
    pub input: Vec<f64>,
    /// Outputs, in the unit of the output.
    pub output: Vec<f64>,
    /// The drift calibration just before the curve: input and output at saturation. The output of
    /// all calibrations is the same but for drift.
    pub calibration: Option<(f64, f64)>,
}

impl ReversalCurve {
    /// Input of the reversal, in the unit of the input.
    pub fn reversal(&self) -> Option<f64> {
        self.input.first().copied()
    }
}

/// Reads a data folder of kind `ReversalCurves`.
///
/// # Errors
/// Every problem of `dataset.ron` and of every table, ordered by file and line.
pub fn read_curves(folder: &Folder) -> Result<CurveData, Problems> {
    let mut open = OpenDataset::open(folder, DatasetKind::ReversalCurves)?;
    let declared = open.declared();
    let mut channels: Option<Channels> = None;
    let mut read = |open: &mut OpenDataset<'_>, file: &str, field: &str| {
        let source = open.read(file, field)?;
        let rows = parse_rows(&source, "curve", &declared);
        let rows = rows.map_err(|more| open.problems.append(more)).ok()?;
        let expected = channels.get_or_insert_with(|| rows.channels.clone());
        same_channels(&source.name, &rows.channels, expected, &mut open.problems);
        Some((source.name, rows))
    };
    let mut runs = Vec::with_capacity(open.dataset.runs.len());
    for (number, run) in open.dataset.runs.clone().into_iter().enumerate() {
        let Some((name, rows)) = read(&mut open, &run.file, &run_field(number, "file")) else {
            continue;
        };
        let mut curves = split(&name, &rows, &mut open.problems);
        if let Some(file) = &run.calibration
            && let Some((name, points)) = read(&mut open, file, &run_field(number, "calibration"))
        {
            calibrate(&name, &points, &mut curves, &mut open.problems);
        }
        let curves = curves.into_iter().map(|(_, curve)| curve).collect();
        runs.push(CurveRun { entry: run, curves });
    }
    let (folder, content_hash) = open.origin();
    let data = channels.map(|channels| CurveData {
        folder,
        channels,
        runs,
        content_hash,
        title: open.dataset.title,
    });
    open.problems.into_result(data)
}

/// The rows of each curve; curve numbers must not decrease.
fn split(file: &str, rows: &Rows, problems: &mut Problems) -> Vec<(f64, ReversalCurve)> {
    let mut curves: Vec<(f64, ReversalCurve)> = Vec::new();
    for (i, &number) in rows.leading.iter().enumerate() {
        let last = curves.last().map(|c| c.0);
        let message = if number.fract() != 0.0 || number < 1.0 {
            Some(format!("{number} is no curve number; count the curves 1, 2, 3 ..."))
        } else if last.is_some_and(|last| number < last) {
            Some(format!("curve {number} comes after a later one; sort the rows by curve"))
        } else {
            None
        };
        if let Some(message) = message {
            let place = Place::at(file, rows.lines[i], 1).field("curve");
            problems.push(place, Fault::Refused { message });
        }
        if last != Some(number) {
            curves.push((number, ReversalCurve::default()));
        }
        if let Some((_, curve)) = curves.last_mut() {
            curve.input.push(rows.input[i]);
            curve.output.push(rows.output[i]);
        }
        if problems.as_slice().len() > 5 {
            break;
        }
    }
    curves
}

fn calibrate(
    file: &str,
    points: &Rows,
    curves: &mut [(f64, ReversalCurve)],
    problems: &mut Problems,
) {
    for (i, number) in points.leading.iter().enumerate() {
        if let Some((_, curve)) = curves.iter_mut().find(|c| c.0.total_cmp(number).is_eq()) {
            curve.calibration = Some((points.input[i], points.output[i]));
        } else {
            let message = format!("there is no curve {number}");
            let place = Place::at(file, points.lines[i], 1).field("curve");
            problems.push(place, Fault::Refused { message });
        }
    }
}
