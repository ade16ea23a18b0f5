//! Anderson's acceleration of a fixed-point iteration.

use nalgebra::{DMatrix, DVector};

/// Corrections kept: more than the slow directions that a preconditioner leaves.
const DEPTH: usize = 8;
/// Singular values below this share of the largest are taken as zero.
const RANK_TOLERANCE: f64 = 1e-10;

/// The next iterate of `x = x + f(x)` from the last ones.
///
/// ```text
/// x_next = x + f - sum_j gamma_j (dx_j + df_j),    gamma = arg min | f - sum_j gamma_j df_j |
/// ```
/// For a linear `f` it is GMRES in other words: it ends in as many steps as there are unknowns whether
/// or not the plain iteration converges.
/// Source: D. G. Anderson, J. ACM 12 (1965) 547; H. Walker, P. Ni, SIAM J. Numer. Anal. 49 (2011) 1715.
#[derive(Debug, Clone, Default)]
pub(super) struct Anderson {
    last: Option<(DVector<f64>, DVector<f64>)>,
    /// Steps `dx` and `df`, oldest first.
    steps: Vec<(DVector<f64>, DVector<f64>)>,
}

impl Anderson {
    /// The next iterate from the present one and its correction `f(x)`.
    pub(super) fn next(&mut self, x: &DVector<f64>, f: &DVector<f64>) -> DVector<f64> {
        if let Some((x0, f0)) = &self.last {
            self.steps.push((x - x0, f - f0));
            if self.steps.len() > DEPTH {
                self.steps.remove(0);
            }
        }
        self.last = Some((x.clone(), f.clone()));
        let plain = x + f;
        if self.steps.is_empty() {
            return plain;
        }
        let columns: Vec<DVector<f64>> = self.steps.iter().map(|(_, df)| df.clone()).collect();
        let svd = DMatrix::from_columns(&columns).svd(true, true);
        let threshold = RANK_TOLERANCE * svd.singular_values.max();
        let Ok(gamma) = svd.solve(f, threshold) else { return plain };
        self.steps.iter().zip(gamma.iter()).fold(plain, |next, ((dx, df), g)| next - (dx + df) * *g)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear map that the plain iteration blows up on.
    #[test]
    fn a_linear_system_is_solved_in_as_many_steps_as_unknowns() {
        let matrix =
            DMatrix::from_row_slice(3, 3, &[5.0, 1.0, 0.0, -1.0, 2.0, 0.5, 0.0, 0.3, -4.0]);
        let b = DVector::from_vec(vec![1.0, 2.0, 3.0]);
        let mut x = DVector::zeros(3);
        let mut anderson = Anderson::default();
        for _ in 0..5 {
            let f = &b - &matrix * &x;
            x = anderson.next(&x, &f);
        }
        let left = (&b - &matrix * &x).amax();
        assert!(left < 1e-9, "{left:e}");
    }
}
