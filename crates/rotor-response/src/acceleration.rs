//! Acceleration of a fixed-point iteration in many unknowns.

use nalgebra::{DMatrix, DVector};

/// Earlier steps that are remembered.
const DEPTH: usize = 16;
/// Singular values below this part of the largest say nothing.
const SINGULAR: f64 = 1e-10;

/// Anderson's method: the next point is the best of the affine hull of the last ones, as their steps say.
///
/// ```text
/// min |f_k - dF g|,      x_(k+1) = x_k + f_k - (dX + dF) g
/// ```
/// with the steps `f` and the differences `dX`, `dF` of the last points and steps.
///
/// Source: D. G. Anderson, J. ACM 12 (1965) 547; H. F. Walker, P. Ni, SIAM J. Numer. Anal. 49 (2011) 1715.
#[derive(Debug, Clone, Default)]
pub(crate) struct Anderson {
    last: Option<(DVector<f64>, DVector<f64>)>,
    points: Vec<DVector<f64>>,
    steps: Vec<DVector<f64>>,
}

impl Anderson {
    /// The next point from a point and the step a plain iteration would take there.
    pub(crate) fn next(&mut self, point: &[f64], step: &[f64]) -> Vec<f64> {
        let (x, f) = (DVector::from_column_slice(point), DVector::from_column_slice(step));
        if let Some((x0, f0)) = self.last.take() {
            self.points.push(&x - x0);
            self.steps.push(&f - f0);
            if self.points.len() > DEPTH {
                self.points.remove(0);
                self.steps.remove(0);
            }
        }
        let mut next = &x + &f;
        if !self.steps.is_empty() {
            let matrix = DMatrix::from_columns(&self.steps);
            let svd = matrix.svd(true, true);
            let tolerance = SINGULAR * svd.singular_values.max();
            if let Ok(weights) = svd.solve(&f, tolerance) {
                for ((weight, dx), df) in weights.iter().zip(&self.points).zip(&self.steps) {
                    next -= (dx + df) * *weight;
                }
            }
        }
        self.last = Some((x, f));
        next.as_slice().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear map that a plain iteration runs away with: `x <- b - 1.5 x` in one direction, slow in others.
    #[test]
    fn a_map_that_diverges_on_its_own_is_solved() {
        let slopes = [-1.5, 0.9, 0.3, -0.4];
        let exact = [0.4, 10.0, 1.0 / 0.7, 1.0 / 1.4];
        let mut x = vec![0.0; 4];
        let mut anderson = Anderson::default();
        for _ in 0..8 {
            let step: Vec<f64> = x.iter().zip(slopes).map(|(x, s)| 1.0 + s * x - x).collect();
            x = anderson.next(&x, &step);
        }
        for (got, want) in x.iter().zip(exact) {
            assert!((got - want).abs() < 1e-9, "{got} {want}");
        }
    }
}
