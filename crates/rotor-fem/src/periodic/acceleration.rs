//! Anderson mixing: acceleration of a fixed-point iteration.

use std::collections::VecDeque;

use nalgebra::DMatrix;

/// Columns that keep less than this fraction of their length after orthogonalisation are dropped.
const DEPENDENT: f64 = 1e-9;

/// Anderson mixing with a short memory.
///
/// ```text
/// x_next = x + s - sum_j gamma_j (dx_j + ds_j),   gamma minimises | s - sum_j gamma_j ds_j |
/// ```
/// with `s` the step that the plain iteration takes at `x` and `dx_j`, `ds_j` the differences of the last iterates and steps.
///
/// Source: D. G. Anderson, J. ACM 12 (1965) 547; the form is the "type II" of H. Fang and Y. Saad,
/// Numer. Linear Algebra Appl. 16 (2009) 197.
#[derive(Debug, Clone)]
pub struct Anderson {
    depth: usize,
    last: Option<(DMatrix<f64>, DMatrix<f64>)>,
    /// Differences of iterates and of steps, newest first.
    differences: VecDeque<(DMatrix<f64>, DMatrix<f64>)>,
}

impl Anderson {
    /// Mixing of `depth` earlier steps; depth 0 leaves steps as they are.
    pub fn new(depth: usize) -> Self {
        Self { depth, last: None, differences: VecDeque::new() }
    }

    /// Forgets all earlier steps.
    pub fn clear(&mut self) {
        self.last = None;
        self.differences.clear();
    }

    /// The next iterate from the present one and the step the plain iteration takes there, both of one
    /// shape.
    pub fn propose(&mut self, x: &DMatrix<f64>, step: &DMatrix<f64>) -> DMatrix<f64> {
        if let Some((last_x, last_step)) = self.last.take()
            && self.depth > 0
        {
            self.differences.push_front((x - last_x, step - last_step));
            self.differences.truncate(self.depth);
        }
        self.last = Some((x.clone(), step.clone()));

        // modified Gram-Schmidt on the step differences, the iterate differences carried along
        let mut basis: Vec<(DMatrix<f64>, DMatrix<f64>)> = Vec::new();
        for (dx, ds) in &self.differences {
            let (mut dx, mut ds) = (dx.clone(), ds.clone());
            let length = ds.norm();
            for (bx, bs) in &basis {
                let overlap = bs.dot(&ds);
                ds -= bs * overlap;
                dx -= bx * overlap;
            }
            let left = ds.norm();
            if left > DEPENDENT * length {
                basis.push((dx / left, ds / left));
            }
        }
        let mut next = x + step;
        let mut rest = step.clone();
        for (bx, bs) in &basis {
            let gamma = bs.dot(&rest);
            rest -= bs * gamma;
            next -= (bx + bs) * gamma;
        }
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    /// A linear fixed point in `n` dimensions is found in `n + 1` mixed steps; plain steps are slow.
    #[test]
    fn a_linear_problem_ends_within_its_dimension() {
        let rate = DMatrix::from_row_slice(3, 3, &[0.9, 0.1, 0.0, -0.2, 0.8, 0.1, 0.0, 0.1, -0.7]);
        let load = DVector::from_vec(vec![1.0, -2.0, 0.5]);
        let run = |depth: usize| -> f64 {
            let mut mixing = Anderson::new(depth);
            let mut x = DMatrix::zeros(3, 1);
            for _ in 0..4 {
                let step = &rate * &x + DMatrix::from_column_slice(3, 1, load.as_slice()) - &x;
                x = mixing.propose(&x, &step);
            }
            let step = &rate * &x + DMatrix::from_column_slice(3, 1, load.as_slice()) - &x;
            step.amax()
        };
        assert!(run(3) < 1e-12, "mixed: {:e}", run(3));
        assert!(run(0) > 0.1, "plain: {:e}", run(0));
    }

    /// Maps that the plain iteration runs away with.
    #[test]
    fn a_map_that_diverges_on_its_own_is_solved() {
        let matrix =
            DMatrix::from_row_slice(3, 3, &[5.0, 1.0, 0.0, -1.0, 2.0, 0.5, 0.0, 0.3, -4.0]);
        let b = DMatrix::from_column_slice(3, 1, &[1.0, 2.0, 3.0]);
        let mut x = DMatrix::zeros(3, 1);
        let mut mixing = Anderson::new(8);
        for _ in 0..5 {
            x = mixing.propose(&x, &(&b - &matrix * &x));
        }
        let left = (&b - &matrix * &x).amax();
        assert!(left < 1e-9, "{left:e}");
    }
}
