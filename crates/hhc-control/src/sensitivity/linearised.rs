//! T identified again at every control: from the plant's linearised solution, or by differences.

use super::{Identified, by_differences};
use crate::{ControlError, ControlStep, OperatingPoint, Plant, RunError, TMatrix};
use nalgebra::{DMatrix, DVector};

/// T of the present control.
pub(super) struct Linearised<'a> {
    step_volt: &'a [f64],
    /// The control it is the T of; none where it has to be found anew.
    known_at: Option<Vec<f64>>,
    /// What was measured since T was identified.
    tried: Vec<Measured>,
    corrections_left: usize,
    /// Whether the plant is asked for a linearised solution; not once it had none or led nowhere.
    is_offered: bool,
}

/// A control and the outputs measured there.
type Measured = [DVector<f64>; 2];

impl<'a> Linearised<'a> {
    /// T0 is that of zero control.
    pub(super) fn new(step_volt: &'a [f64], controls: usize) -> Self {
        Self {
            step_volt,
            known_at: Some(vec![0.0; controls]),
            tried: Vec::new(),
            corrections_left: controls,
            is_offered: true,
        }
    }

    /// T of a control that it is not known at; none where it is known, or at an edge of the range that leaves no
    /// room for differences: the T of the control before stays.
    pub(super) fn identify<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
    ) -> Result<Option<Identified>, RunError<P::Error>> {
        let control = &here.control_volt;
        if self.known_at.as_ref() == Some(control) {
            return Ok(None);
        }
        self.tried.clear();
        self.corrections_left = control.len();
        self.known_at = Some(control.clone());
        if self.is_offered {
            let found = plant.linearised_t(control);
            if let Some(t) = found.map_err(RunError::plant("linearised", control))? {
                return Ok(Some((t, 0)));
            }
        }
        self.is_offered = false;
        by_differences(plant, here.point(), self.step_volt)
    }

    pub(super) fn observe(&mut self, at: OperatingPoint<'_>) {
        self.tried.push([at.control_volt, at.outputs].map(DVector::from_column_slice));
    }

    /// After a step that was rejected in full: whether another one is worth computing, and T corrected along the step.
    /// As often as there are controls; after that T is to be identified by differences.
    pub(super) fn correct(
        &mut self,
        t: &DMatrix<f64>,
        here: &ControlStep,
        target_volt: &[f64],
    ) -> Result<(bool, Option<TMatrix>), ControlError> {
        if self.corrections_left == 0 {
            let was_offered = std::mem::take(&mut self.is_offered);
            self.known_at = None;
            return Ok((was_offered, None));
        }
        self.corrections_left -= 1;
        let corrected = corrected(t, here, target_volt, &std::mem::take(&mut self.tried));
        let corrected = corrected.map(TMatrix::from_matrix).transpose()?;
        Ok((corrected.is_some(), corrected))
    }
}

/// T with the derivative of the loads along a rejected step put right.
///
/// ```text
/// Z(u + a s) - Z(u) = a z_1 + a^2 z_2  by least squares over the parts a that were measured
/// T += (z_1 - T s) s' / (s' s)
/// ```
/// None where nothing was measured along the step.
///
/// Source: the rank-one form is Broyden's: *A class of methods for solving nonlinear simultaneous
/// equations*, Math. Comp. 19 (1965); the parabola instead of a chord is ours.
fn corrected(
    t: &DMatrix<f64>,
    here: &ControlStep,
    target_volt: &[f64],
    tried: &[Measured],
) -> Option<DMatrix<f64>> {
    let from = DVector::from_column_slice(&here.control_volt);
    let loads = DVector::from_column_slice(&here.measurement.outputs);
    let step = DVector::from_column_slice(target_volt) - &from;
    let square = step.norm_squared();
    let (mut moments, mut sums) = ([0.0; 3], [loads.clone() * 0.0, loads.clone() * 0.0]);
    for [control, outputs] in tried {
        let part = (control - &from).dot(&step) / square;
        let change = outputs - &loads;
        for (k, moment) in moments.iter_mut().enumerate() {
            *moment += part.powi(2 + i32::try_from(k).unwrap_or(0));
        }
        sums[0].axpy(part, &change, 1.0);
        sums[1].axpy(part * part, &change, 1.0);
    }
    let [m2, m3, m4] = moments;
    let determinant = m2 * m4 - m3 * m3;
    let slope = if tried.len() > 1 && determinant > 1e-9 * m2 * m4 {
        (&sums[0] * m4 - &sums[1] * m3) / determinant
    } else if m2 > 0.0 {
        &sums[0] / m2
    } else {
        return None;
    };
    Some(t + (slope - t * &step) * step.transpose() / square)
}
