//! The FORC diagram: second mixed derivative by local polynomial smoothing.

use nalgebra::{Matrix6, Vector6};
use preisach_dyn::PreisachError;
use preisach_dyn::forc::{ForcCurve, ForcData};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// One point of a FORC diagram.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DiagramPoint {
    /// Reversal `H_a` of the curve, in the unit of the inputs.
    pub reversal_input: f64,
    /// Input `H` of the point, likewise.
    pub input: f64,
    /// Half-width `(H - H_a) / 2` of the relays there: their coercivity.
    pub half_width: f64,
    /// Centre `(H + H_a) / 2` of the relays there: the interaction field.
    pub centre: f64,
    /// Density `rho = -1/2 d2y / (dH_a dH)`, output per input squared.
    pub density: f64,
}

/// The FORC diagram of a family of curves.
///
/// ```text
/// y ~ a1 + a2 H_a + a3 H_a^2 + a4 H + a5 H^2 + a6 H_a H      over (2 SF + 1)^2 points
/// rho = -a6 / 2
/// ```
/// The window holds the `2 SF + 1` curves about the point's own and, on each, the `2 SF + 1` points
/// nearest to its input. Points whose window leaves the family (the outermost curves, the first and
/// last points of a curve, and those next to the diagonal where a curve has no points below its
/// reversal) are left out. `SF` is the smoothing factor: it trades noise against resolution, and
/// ridges narrower than `SF` steps are smeared to about that width.
///
/// Points come curve by curve in the order measured, whatever the number of threads.
///
/// # Errors
/// As [`ForcData::check`]; [`PreisachError::OutOfRange`] for `SF = 0` or fewer than `2 SF + 1` curves.
///
/// Source: Pike, Roberts and Verosub (1999), the polynomial and the factor; a curve of relays that
/// jump by 2 has the density `rho` of the Preisach operator.
pub fn diagram(data: &ForcData, smoothing: usize) -> Result<Vec<DiagramPoint>, PreisachError> {
    data.check()?;
    check_count("smoothing factor", smoothing, 1)?;
    let curves = data.curves.len();
    check_count("reversal curves", curves, 2 * smoothing + 1)?;
    let rows: Vec<Vec<DiagramPoint>> = (smoothing..curves - smoothing)
        .into_par_iter()
        .map(|index| {
            let window = &data.curves[index - smoothing..=index + smoothing];
            let curve = &data.curves[index];
            let inputs = curve.input.iter();
            inputs.filter_map(|&input| point(window, curve.input[0], input, smoothing)).collect()
        })
        .collect();
    Ok(rows.into_iter().flatten().collect())
}

/// Refuses a count that is too small to mean anything.
fn check_count(quantity: &'static str, value: usize, least: usize) -> Result<(), PreisachError> {
    let expected = || format!("at least {least}").into();
    let refused = |value| PreisachError::OutOfRange { quantity, value, expected: expected() };
    if value >= least { Ok(()) } else { Err(refused(value as f64)) }
}

/// The diagram at one point; none if its window is not complete.
fn point(
    window: &[ForcCurve],
    reversal_input: f64,
    input: f64,
    smoothing: usize,
) -> Option<DiagramPoint> {
    let mut samples = Vec::with_capacity((2 * smoothing + 1) * (2 * smoothing + 1));
    for curve in window {
        let nearest = nearest(&curve.input, input);
        let (first, last) = (nearest.checked_sub(smoothing)?, nearest + smoothing);
        // the end of the curve must not lie closer to the point than its own neighbours
        if last >= curve.input.len() {
            return None;
        }
        let reversal = curve.input[0] - reversal_input;
        let near = (first..=last).map(|i| [reversal, curve.input[i] - input, curve.output[i]]);
        samples.extend(near);
    }
    let size = |axis: usize| samples.iter().fold(0.0_f64, |m, s| m.max(s[axis].abs()));
    let (a_size, b_size) = (size(0), size(1));
    if !(a_size > 0.0 && b_size > 0.0) {
        return None;
    }
    let level = samples.iter().map(|s| s[2]).sum::<f64>() / samples.len() as f64;
    let (mut normal, mut right) = (Matrix6::zeros(), Vector6::zeros());
    for [a, b, y] in samples {
        let (a, b) = (a / a_size, b / b_size);
        let row = Vector6::new(1.0, a, a * a, b, b * b, a * b);
        normal += row * row.transpose();
        right += row * (y - level);
    }
    let mixed = normal.cholesky()?.solve(&right)[5] / (a_size * b_size);
    Some(DiagramPoint {
        reversal_input,
        input,
        half_width: 0.5 * (input - reversal_input),
        centre: 0.5 * (input + reversal_input),
        density: -0.5 * mixed,
    })
}

/// Index of the input nearest to `at`.
fn nearest(inputs: &[f64], at: f64) -> usize {
    let distance = |(_, u): &(usize, &f64)| (**u - at).abs();
    let closest = inputs.iter().enumerate().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    closest.map_or(0, |(index, _)| index)
}
