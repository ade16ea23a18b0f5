//! Density of a static model from reversal curves, by constrained least squares.

use super::everett_map::{corners, play_map, unknown, weights};
use super::{ForcCurve, ForcData};
use crate::check::{check_count, check_positive, extremes};
use crate::identify::fit::program::{LeastSquaresProgram, Row, offset};
use crate::identify::fit::static_fit::{Smoothness, merged, smooth_density};
use crate::{PlayMemory, PreisachError, PreisachGrid, StartState, StaticPreisach, VoltageRange};
use rotor_base::mean_square;
use serde::{Deserialize, Serialize};

/// Settings of a fit to reversal curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ForcSettings {
    /// Levels of the grid.
    pub levels: usize,
    /// Weight of the smoothness of the density, relative to the squared error of the fit.
    pub smoothness: f64,
    /// Inputs the grid covers, in the unit of the inputs; none takes the range of the data.
    pub range: Option<VoltageRange>,
}

impl Default for ForcSettings {
    /// 48 levels over the range of the data.
    fn default() -> Self {
        Self { levels: 48, smoothness: 1e-6, range: None }
    }
}

/// How a model reproduces one curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CurveMisfit {
    /// Its reversal, in the unit of the inputs.
    pub reversal_input: f64,
    /// Root mean square error over the range of all outputs, percent.
    pub rms_percent: f64,
    /// Largest error over the range of all outputs, percent.
    pub largest_percent: f64,
}

/// A static model from reversal curves.
#[derive(Debug, Clone, PartialEq)]
pub struct ForcFit {
    /// The model; its grid is in the unit of the inputs, its output in that of the outputs.
    pub model: StaticPreisach,
    /// How it reproduces the curves it was fitted to.
    pub curves: Vec<CurveMisfit>,
}

/// Fits a static model to reversal curves.
///
/// ```text
/// y(H on the curve of H_a) = y_top - E(top, H_a) + E(H, H_a)
/// min  mean (y_top - E(top, H_a) + E(H, H_a) - y)^2 / range^2
///      + smoothness * cells * sum_neighbours (m_a - m_b)^2 / range^2      m = rise of a cell >= 0
/// ```
/// The unknowns are the Everett values at the nodes: each sample touches six of them and each rise
/// four, so the program stays sparse at any number of levels. The reversible part is the rise of
/// play 0; it is smoothed along the diagonal only.
///
/// Assumes: the input came down from the upper end of the range, where the output was saturated.
/// Correct the drift first.
///
/// # Errors
/// As [`ForcData::check`]; refused settings; [`PreisachError::QuadraticProgram`].
pub fn fit(data: &ForcData, settings: &ForcSettings) -> Result<ForcFit, PreisachError> {
    data.check()?;
    check_positive("smoothness", settings.smoothness)?;
    let [low, high] = data.input_range();
    let range = settings.range.map_or_else(|| VoltageRange::new(low, high), Ok)?;
    check_count("levels", settings.levels, 2)?;
    let grid = PreisachGrid::new(range, settings.levels)?;
    let levels = grid.levels();
    let span = data.output_span();
    let outputs = data.curves.iter().flat_map(|c| c.output.iter().copied());
    let offset = offset(extremes(outputs));
    let mut program = LeastSquaresProgram::new(unknown(levels, levels - 1) + 1);
    let samples: usize = data.curves.iter().map(|c| c.input.len()).sum();
    let weight = 1.0 / samples as f64;
    for ForcCurve { input, output } in &data.curves {
        for (&u, &y) in input.iter().zip(output) {
            let mut row: Row = vec![(0, 1.0)];
            weights(&grid, range.highest_volt(), input[0], -1.0, &mut row);
            weights(&grid, u, input[0], 1.0, &mut row);
            program.add(&merged(row), (y - offset) / span, weight);
        }
    }
    let cells = levels * (levels + 1) / 2;
    let smoothness = Smoothness::Sides(settings.smoothness);
    smooth_density(levels, cells as f64, smoothness, rise, &mut program);
    let solution = program.solve("density of the reversal curves")?;
    let mut map = play_map(levels, &solution, span);
    map.constant += offset;
    let model = StaticPreisach::new(grid, map)?;
    let curves = data.curves.iter().map(|curve| misfit(&model, curve, span)).collect();
    Ok(ForcFit { model, curves })
}

/// `scale` times the rise of a cell as a row.
fn rise(j: usize, q: usize, scale: f64) -> Row {
    let inside = corners(j, q).into_iter().filter(|&(i, k, _)| i > k);
    merged(inside.map(|(i, k, sign)| (unknown(i, k), scale * sign)).collect())
}

/// Outputs of a model along a reversal curve, from saturation.
pub fn outputs(model: &StaticPreisach, curve: &ForcCurve) -> Vec<f64> {
    let grid = model.grid();
    let top = grid.range().highest_volt();
    let mut memory = PlayMemory::new(grid, top, StartState::FallingFromHighest);
    curve.input.iter().map(|&u| model.apply(&mut memory, u)).collect()
}

/// Simulates a reversal curve from saturation and compares; `span` is the range that errors are
/// shares of.
pub fn misfit(model: &StaticPreisach, curve: &ForcCurve, span: f64) -> CurveMisfit {
    let pairs = outputs(model, curve).into_iter().zip(&curve.output);
    let errors: Vec<f64> = pairs.map(|(simulated, measured)| simulated - measured).collect();
    let largest = errors.iter().fold(0.0_f64, |most, error| most.max(error.abs()));
    CurveMisfit {
        reversal_input: curve.reversal_input().unwrap_or(f64::NAN),
        rms_percent: 100.0 * mean_square(&errors).sqrt() / span,
        largest_percent: 100.0 * largest / span,
    }
}

/// How curves are reproduced that the fit has not seen.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldOutCurves {
    /// The curves held out, in the order measured.
    pub curves: Vec<CurveMisfit>,
    /// Root mean square over all of them, percent of the range of all outputs.
    pub rms_percent: f64,
    /// The largest root mean square of a curve, percent.
    pub worst_curve_percent: f64,
}

/// Holds out every `every`-th curve, starting with the one at `first`, fits the others and compares.
///
/// # Errors
/// As [`fit`]; [`PreisachError::OutOfRange`] if nothing is held out.
pub fn held_out(
    data: &ForcData,
    settings: &ForcSettings,
    every: usize,
    first: usize,
) -> Result<HeldOutCurves, PreisachError> {
    data.check()?;
    let (tested, trained) = data.split_every(every, first);
    check_count("held-out reversal curves", tested.curves.len(), 1)?;
    let [low, high] = data.input_range();
    let range = Some(settings.range.unwrap_or(VoltageRange::new(low, high)?));
    let fitted = fit(&trained, &ForcSettings { range, ..*settings })?;
    let span = data.output_span();
    let curves: Vec<CurveMisfit> =
        tested.curves.iter().map(|curve| misfit(&fitted.model, curve, span)).collect();
    let errors: Vec<f64> = curves.iter().map(|c| c.rms_percent).collect();
    Ok(HeldOutCurves {
        rms_percent: mean_square(&errors).sqrt(),
        worst_curve_percent: errors.iter().copied().fold(0.0, f64::max),
        curves,
    })
}
