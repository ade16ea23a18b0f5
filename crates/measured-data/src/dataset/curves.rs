//! Data sets of first-order reversal curves.

use super::file::{DatasetKind, RunRole};
use super::loops::same_channels;
use super::open::{OpenDataset, numbered, run_field};
use crate::files::{Folder, Source};
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::{Channels, CurveRows, Declared, parse_curve_csv};

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
    /// What a reader should know.
    pub warnings: Vec<Problem>,
    /// blake3 of `dataset.ron` and of every file, in order.
    pub content_hash: String,
}

/// One measurement of a set of curves.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveRun {
    /// Name of the run.
    pub id: String,
    /// File name.
    pub file: String,
    /// What it is for.
    pub role: RunRole,
    /// What was done.
    pub note: String,
    /// The curves in the order measured.
    pub curves: Vec<ReversalCurve>,
}

/// One first-order reversal curve, as measured: no drift taken off.
#[derive(Debug, Clone, PartialEq)]
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
    let (input, output) = (open.dataset.input.clone(), open.dataset.output.clone());
    let declared = Declared { input: input.as_ref(), output: output.as_ref() };
    let mut channels: Option<Channels> = None;
    let mut runs = Vec::with_capacity(open.dataset.runs.len());
    for (number, run) in numbered(&open.dataset.runs) {
        let mut read = |open: &mut OpenDataset<'_>, file: &str, key: &str| {
            let source = open.read(file, &run_field(number, key))?;
            match parse_curve_csv(&source, declared) {
                Ok(rows) => {
                    let expected = channels.get_or_insert_with(|| rows.channels.clone());
                    same_channels(&source.name, &rows.channels, expected, &mut open.problems);
                    Some((source, rows))
                }
                Err(more) => {
                    open.problems.append(more);
                    None
                }
            }
        };
        let Some((source, rows)) = read(&mut open, &run.file, "file") else { continue };
        let mut curves = split(&source, &rows, &mut open.problems);
        if let Some(file) = &run.calibration
            && let Some((source, points)) = read(&mut open, file, "calibration")
        {
            calibrate(&source, &points, &mut curves, &mut open.problems);
        }
        let curves = curves.into_iter().map(|(_, curve)| curve).collect();
        let (id, file, role, note) = (run.id, run.file, run.role, run.note);
        runs.push(CurveRun { id, file, role, note, curves });
    }
    let data = channels.map(|channels| CurveData {
        folder: open.folder_name(),
        channels,
        runs,
        warnings: vec![],
        content_hash: open.content_hash(),
        title: open.dataset.title.clone(),
    });
    open.problems.into_result(data)
}

/// The rows of each curve; curve numbers must not decrease.
fn split(source: &Source, rows: &CurveRows, problems: &mut Problems) -> Vec<(f64, ReversalCurve)> {
    let mut curves: Vec<(f64, ReversalCurve)> = Vec::new();
    for (i, &number) in rows.curve.iter().enumerate() {
        let place = || Place::at(&source.name, rows.lines[i], 1).field("curve");
        let last = curves.last().map(|c| c.0);
        if number.fract() != 0.0 || number < 1.0 {
            let message = format!("{number} is no curve number; count the curves 1, 2, 3 ...");
            problems.push(place(), Fault::Refused { message });
        } else if last.is_some_and(|last| number < last) {
            let message = format!("curve {number} comes after a later one; sort the rows by curve");
            problems.push(place(), Fault::Refused { message });
        }
        if last != Some(number) {
            let empty = ReversalCurve { input: vec![], output: vec![], calibration: None };
            curves.push((number, empty));
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
    source: &Source,
    points: &CurveRows,
    curves: &mut [(f64, ReversalCurve)],
    problems: &mut Problems,
) {
    for (i, number) in points.curve.iter().enumerate() {
        let curve = curves.iter_mut().find(|c| c.0.total_cmp(number).is_eq());
        if let Some((_, curve)) = curve {
            curve.calibration = Some((points.input[i], points.output[i]));
        } else {
            let message = format!("there is no curve {number}");
            let place = Place::at(&source.name, points.lines[i], 1).field("curve");
            problems.push(place, Fault::Refused { message });
        }
    }
}
