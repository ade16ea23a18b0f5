//! Newton steps with the true derivative of the residual, the factorised matrix being its preconditioner.

use nalgebra::{DMatrix, DVector};

/// Directions of a search at most.
const DIRECTIONS: usize = 20;
/// Part of the first residual at which the search ends: a Newton step need not be exact.
const ENOUGH: f64 = 1e-3;
/// A direction that keeps less than this part of its length after orthogonalisation is none.
const DEPENDENT: f64 = 1e-10;

/// Solution of `A x = b` by GMRES from `x = 0`, as far as [`DIRECTIONS`] directions reach.
///
/// `apply` gives `A v` for a `v` of unit length. The search ends early where the rest is small enough.
///
/// Source: Y. Saad and M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856.
///
/// # Errors
/// Those of `apply`.
pub(crate) fn solve<E>(
    b: &DMatrix<f64>,
    mut apply: impl FnMut(&DMatrix<f64>) -> Result<DMatrix<f64>, E>,
) -> Result<DMatrix<f64>, E> {
    let length = b.norm();
    if length == 0.0 {
        return Ok(b.clone());
    }
    let mut basis = vec![b / length];
    // columns of Hessenberg's matrix: A v_j in the basis
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut shares = DVector::zeros(0);
    while columns.len() < DIRECTIONS {
        let mut next = apply(&basis[columns.len()])?;
        let whole = next.norm();
        let mut column: Vec<f64> = Vec::new();
        for direction in &basis {
            let share = direction.dot(&next);
            next -= direction * share;
            column.push(share);
        }
        let left = next.norm();
        column.push(left);
        columns.push(column);
        let n = columns.len();
        let hessenberg =
            DMatrix::from_fn(n + 1, n, |i, j| columns[j].get(i).copied().unwrap_or(0.0));
        let mut wanted = DVector::zeros(n + 1);
        wanted[0] = length;
        // an error only without the factors that are asked for above
        let Ok(found) = hessenberg.clone().svd(true, true).solve(&wanted, f64::EPSILON) else {
            break;
        };
        let rest = (wanted - hessenberg * &found).norm();
        shares = found;
        if rest <= ENOUGH * length || left <= DEPENDENT * whole {
            break;
        }
        basis.push(next / left);
    }
    let mut x = DMatrix::zeros(b.nrows(), b.ncols());
    for (direction, share) in basis.iter().zip(&shares) {
        x += direction * *share;
    }
    Ok(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One far from symmetric, with eigenvalues on both sides of zero: a plain iteration runs away.
    #[test]
    fn a_linear_system_is_solved_in_its_order() {
        let order = 9;
        let entry = |i: usize, j: usize| {
            let diagonal = if i == j { 1.0 - 0.4 * i as f64 } else { 0.0 };
            diagonal + 0.3 * ((7 * i + 3 * j) as f64).sin()
        };
        let matrix = DMatrix::from_fn(order, order, entry);
        let exact = DMatrix::from_fn(order, 1, |i, _| (i as f64).cos());
        let mut applied = 0;
        let mut apply = |v: &DMatrix<f64>| -> Result<DMatrix<f64>, ()> {
            applied += 1;
            Ok(&matrix * v)
        };
        let mut x = DMatrix::zeros(order, 1);
        for _ in 0..3 {
            let rest = &matrix * (&exact - &x);
            x += solve(&rest, &mut apply).unwrap();
        }
        assert!((&x - exact).norm() < 1e-6, "{x}");
        assert!(applied <= 3 * order, "{applied}");
    }

    #[test]
    fn nothing_asked_is_nothing_found_and_a_fault_is_told() {
        let zero = DMatrix::zeros(3, 1);
        assert_eq!(solve(&zero, |_| Err("asked")), Ok(zero.clone()));
        assert_eq!(solve(&zero.add_scalar(1.0), |_| Err("fault")), Err("fault"));
    }
}
