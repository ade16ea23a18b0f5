//! Newton's method with a Jacobian that is kept and brought up to date by Broyden's formula.

use crate::error::RotorTruthError;
use nalgebra::{DMatrix, DVector, Dyn, LU};
use rayon::prelude::*;

/// Step of the differences that give the Jacobian.
const DIFFERENCE: f64 = 1e-7;

/// A factored Jacobian.
#[derive(Debug, Clone)]
pub struct Jacobian(LU<f64, Dyn, Dyn>);

/// What a solution took.
#[derive(Debug, Clone)]
pub struct Found {
    /// The unknowns.
    pub x: Vec<f64>,
    /// Steps taken.
    pub iterations: usize,
    /// Largest residual at the last evaluation.
    pub residual: f64,
    /// Whether the last step was small enough.
    pub is_converged: bool,
}

impl Jacobian {
    /// By forward differences.
    pub fn at(x: &[f64], of: &(impl Fn(&[f64]) -> Vec<f64> + Sync)) -> Self {
        let base = of(x);
        let column = |j: usize| {
            let mut moved = x.to_vec();
            moved[j] += DIFFERENCE;
            DVector::from_iterator(
                x.len(),
                of(&moved).iter().zip(&base).map(|(own, base)| (own - base) / DIFFERENCE),
            )
        };
        let columns: Vec<DVector<f64>> = (0..x.len()).into_par_iter().map(column).collect();
        Self(DMatrix::from_columns(&columns).lu())
    }

    fn step(&self, residual: &[f64]) -> Result<DVector<f64>, RotorTruthError> {
        let right = DVector::from_column_slice(residual);
        self.0.solve(&right).map(|own| -own).ok_or(RotorTruthError::Singular)
    }

    /// Solves `of(x) = 0` from a start until a step is smaller than a tolerance; Broyden's good update (Kelley 1995, 7.2).
    ///
    /// # Errors
    /// [`RotorTruthError::Singular`].
    pub fn solve(
        &self,
        start: &[f64],
        tolerance: f64,
        most: usize,
        of: &(impl Fn(&[f64]) -> Vec<f64> + Sync),
    ) -> Result<Found, RotorTruthError> {
        let mut x = DVector::from_column_slice(start);
        let mut steps = vec![self.step(&of(x.as_slice()))?];
        for iterations in 1..=most {
            let Some(last) = steps.last().cloned() else { break };
            x += &last;
            let values = of(x.as_slice());
            let residual = values.iter().fold(0.0_f64, |most, own| most.max(own.abs()));
            let mut z = self.step(&values)?;
            for pair in steps.windows(2) {
                let along = pair[0].dot(&z) / pair[0].norm_squared().max(1e-300);
                z.axpy(along, &pair[1], 1.0);
            }
            let along = last.dot(&z) / last.norm_squared().max(1e-300);
            let next = z / (1.0 - along).max(0.2);
            let is_converged = next.amax() < tolerance;
            if is_converged {
                x += &next;
            }
            if is_converged || iterations == most || !residual.is_finite() {
                return Ok(Found { x: x.as_slice().to_vec(), iterations, residual, is_converged });
            }
            steps.push(next);
        }
        let (x, residual) = (x.as_slice().to_vec(), f64::INFINITY);
        Ok(Found { x, iterations: 0, residual, is_converged: false })
    }
}
