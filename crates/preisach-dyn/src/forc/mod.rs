//! First-order reversal curves: measured curves in, density of a static model out.
//!
//! ```text
//! curves -> Everett map at the nodes of the grid -> density >= 0 -> play map
//! ```
//! Every curve begins at its reversal, to which the input fell from positive saturation, and rises.
//! Inputs and outputs may have any unit (field and moment, voltage and displacement): where this
//! module meets a grid, the unit of the input stands in the place of the volt, and that of the
//! output in the place of the degree.
//!
//! Source: C. R. Pike, A. P. Roberts, K. L. Verosub, *Characterizing interactions in fine magnetic
//! particle systems using first order reversal curves*, Journal of Applied Physics 85 (1999);
//! I. D. Mayergoyz, *Mathematical Models of Hysteresis* (1991), chapter 1, section 2.

mod everett_map;
mod fit;

pub use fit::{CurveMisfit, ForcFit, ForcSettings, HeldOutCurves, fit, held_out, misfit, outputs};

use crate::PreisachError;
use crate::check::{check_count, check_finite, check_positive, check_that, extremes, not_finite};
use crate::identify::records::record::UNEQUAL;
use serde::{Deserialize, Serialize};

/// One first-order reversal curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForcCurve {
    /// Inputs in the order measured; the first one is the reversal.
    pub input: Vec<f64>,
    /// Outputs at them.
    pub output: Vec<f64>,
}

impl ForcCurve {
    /// The input at which the curve turns; none for an empty curve.
    pub fn reversal_input(&self) -> Option<f64> {
        self.input.first().copied()
    }
}

/// A reading at one input in saturation, taken to see the instrument drift.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CalibrationPoint {
    /// The input, the same for all of them but for its own noise.
    pub input: f64,
    /// The output read.
    pub output: f64,
}

/// A family of first-order reversal curves.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ForcData {
    /// The curves in the order measured.
    pub curves: Vec<ForcCurve>,
    /// One reading directly before each curve, or none at all.
    pub calibration: Vec<CalibrationPoint>,
}

/// The fewest points of a curve that say anything: the reversal and one above it.
const FEWEST_POINTS: usize = 2;
/// The fewest curves that bound a density.
const FEWEST_CURVES: usize = 4;
/// How far a curve may fall back below its own reversal, as a share of the range of the inputs: the
/// noise of a regulated input.
const REVERSAL_NOISE: f64 = 0.01;

impl ForcData {
    /// Smallest and largest input of all curves and calibration points.
    pub fn input_range(&self) -> [f64; 2] {
        let curves = self.curves.iter().flat_map(|c| c.input.iter().copied());
        extremes(curves.chain(self.calibration.iter().map(|c| c.input)))
    }

    /// Largest minus smallest output of the curves.
    pub fn output_span(&self) -> f64 {
        let [low, high] = extremes(self.curves.iter().flat_map(|c| c.output.iter().copied()));
        high - low
    }

    /// Checks lengths, numbers and the order of the inputs.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`] curves or points, [`PreisachError::BadRecord`] for unequal columns,
    /// numbers that are not finite or a curve that falls below its reversal,
    /// [`PreisachError::OutOfRange`] unless there is one reading per curve or none and input and output
    /// change.
    pub fn check(&self) -> Result<(), PreisachError> {
        let (curves, readings) = (self.curves.len(), self.calibration.len());
        check_count("reversal curves", curves, FEWEST_CURVES)?;
        let expected = format!("one before each of {curves} reversal curves, or none");
        let paired = readings == 0 || readings == curves;
        check_that(paired, "number of calibration readings", readings as f64, expected)?;
        let bad = |curve: usize, index: usize, problem: &'static str, value: f64| {
            let record = format!("reversal curve {curve}");
            Err(PreisachError::BadRecord { record, index, problem, value })
        };
        for (curve, ForcCurve { input, output }) in self.curves.iter().enumerate() {
            if input.len() != output.len() {
                return bad(curve, input.len(), UNEQUAL, output.len() as f64);
            }
            if input.len() < FEWEST_POINTS {
                let problem = "a curve needs its reversal and a point above";
                return bad(curve, 0, problem, input.len() as f64);
            }
            for (index, (&u, &y)) in input.iter().zip(output).enumerate() {
                if let Some((problem, value)) = not_finite(u, y) {
                    return bad(curve, index, problem, value);
                }
            }
        }
        check_finite("calibration input", self.calibration.iter().map(|point| point.input))?;
        check_finite("calibration reading", self.calibration.iter().map(|point| point.output))?;
        let [low, high] = self.input_range();
        check_positive("range of the inputs of the curves", high - low)?;
        check_positive("range of the outputs of the curves", self.output_span())?;
        for (curve, ForcCurve { input, .. }) in self.curves.iter().enumerate() {
            let floor = input[0] - REVERSAL_NOISE * (high - low);
            if let Some((index, &value)) = input.iter().enumerate().find(|(_, u)| **u < floor) {
                let problem = "the input falls below the reversal, which must come first";
                return bad(curve, index, problem, value);
            }
        }
        Ok(())
    }

    /// The curves whose place in the family is, and is not, a whole multiple of `every` after
    /// `first`: what is held out, and what is left to train on. Readings go with their curves.
    pub fn split_every(&self, every: usize, first: usize) -> (Self, Self) {
        let (mut taken, mut left) = (Self::default(), Self::default());
        for (index, curve) in self.curves.iter().enumerate() {
            let is_taken = index >= first && (index - first).is_multiple_of(every.max(1));
            let part = if is_taken { &mut taken } else { &mut left };
            part.curves.push(curve.clone());
            part.calibration.extend(self.calibration.get(index));
        }
        (taken, left)
    }
}
