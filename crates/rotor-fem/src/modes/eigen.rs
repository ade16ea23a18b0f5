//! Eigenvalue problems of the rotating blade: symmetric, and with gyroscopic terms.

use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Mat, Par, Side, c64};
use nalgebra::{Complex, DMatrix, DVector};

use crate::FemError;

/// A squared frequency with the displacements that belong to it.
pub(crate) struct EigenPair<T: nalgebra::Scalar> {
    /// Squared frequency, nominal rotor speed squared.
    pub(crate) squared_frequency: f64,
    /// Displacements, normalised to unit mass.
    pub(crate) vector: DVector<T>,
}

fn to_faer(matrix: &DMatrix<f64>) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)])
}

/// Cholesky factor of a symmetric matrix, none unless it is positive definite.
fn cholesky(matrix: &DMatrix<f64>) -> Option<Mat<f64>> {
    to_faer(matrix).llt(Side::Lower).ok().map(|factor| factor.L().to_owned())
}

/// `L^-1 A` in place.
fn solve_lower(lower: &Mat<f64>, a: &mut Mat<f64>) {
    solve_lower_triangular_in_place(lower.as_ref(), a.as_mut(), Par::Seq);
}

/// `L^-T A` in place.
fn solve_upper(lower: &Mat<f64>, a: &mut Mat<f64>) {
    solve_upper_triangular_in_place(lower.transpose(), a.as_mut(), Par::Seq);
}

/// `L1^-1 A L2^-T`.
fn congruence(l1: &Mat<f64>, a: &DMatrix<f64>, l2: &Mat<f64>) -> Mat<f64> {
    let mut left = to_faer(a);
    solve_lower(l1, &mut left);
    let mut both = left.transpose().to_owned();
    solve_lower(l2, &mut both);
    both.transpose().to_owned()
}

/// Squared frequency that round-off may put in the place of zero: the digits that the stiffest motion
/// leaves.
fn round_off(mass: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> f64 {
    let stiffest = |i| stiffness[(i, i)] / mass[(i, i)];
    1e-15 * (0..mass.nrows()).map(stiffest).fold(0.0, f64::max)
}

/// All solutions of `K x = w^2 M x`, lowest first.
///
/// Solved as `M x = mu (K + shift M) x`, `mu = 1 / (w^2 + shift)`, whose largest eigenvalues are the
/// low frequencies: they keep their digits beside stiff axial motion, and K may be singular.
///
/// # Errors
/// [`FemError::NotStable`] for a negative squared frequency, [`FemError::Eigen`] without convergence.
pub(crate) fn symmetric(
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
    shift: f64,
) -> Result<Vec<EigenPair<f64>>, FemError> {
    let size = mass.nrows();
    let lower = cholesky(&(stiffness + mass * shift))
        .ok_or(FemError::NotStable { squared_frequency: -shift })?;
    let reduced = congruence(&lower, mass, &lower);
    let eigen = reduced.self_adjoint_eigen(Side::Lower).map_err(|_| FemError::Eigen { size })?;
    let mut vectors = eigen.U().to_owned();
    solve_upper(&lower, &mut vectors);
    let mu = eigen.S().column_vector();
    let mut pairs: Vec<EigenPair<f64>> = (0..size)
        .filter(|&k| mu[k] > 0.0)
        .map(|k| EigenPair {
            squared_frequency: mu[k].recip() - shift,
            vector: DVector::from_fn(size, |i, _| vectors[(i, k)] / mu[k].sqrt()),
        })
        .collect();
    pairs.sort_by(|a, b| a.squared_frequency.total_cmp(&b.squared_frequency));
    if let Some(first) = pairs.first_mut() {
        // round-off of a rigid motion, against a true divergence
        if first.squared_frequency < -(1e-9 * shift + round_off(mass, stiffness)) {
            return Err(FemError::NotStable { squared_frequency: first.squared_frequency });
        }
    }
    for pair in &mut pairs {
        pair.squared_frequency = pair.squared_frequency.max(0.0);
    }
    Ok(pairs)
}

/// All solutions of `(K + i w G - w^2 M) q = 0` with w > 0, lowest first.
///
/// ```text
/// [M 0; 0 K] z' + [G K; -K 0] z = 0,   z = [q'; q]
/// ```
/// A symmetric positive definite and a skew matrix: with Cholesky factors L of the first, `i L^-1 [..]
/// L^-T` is Hermitian and its eigenvalues, the frequencies, are real by construction.
///
/// Source: L. Meirovitch, AIAA J. 12 (1974) 1337, who squares the skew matrix instead.
///
/// # Errors
/// [`FemError::NotStable`] unless K is positive definite, [`FemError::Eigen`] without convergence.
pub(crate) fn gyroscopic(
    mass: &DMatrix<f64>,
    gyro: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
    lowest_squared_frequency: f64,
) -> Result<Vec<EigenPair<Complex<f64>>>, FemError> {
    let size = mass.nrows();
    let unstable = FemError::NotStable { squared_frequency: lowest_squared_frequency };
    let (Some(lm), Some(lk)) = (cholesky(mass), cholesky(stiffness)) else {
        return Err(unstable);
    };
    let coriolis = congruence(&lm, gyro, &lm);
    // L_M^-1 K L_K^-T = L_M^-1 L_K
    let mut spring = lk.clone();
    for j in 0..size {
        for i in 0..j {
            spring[(i, j)] = 0.0;
        }
    }
    solve_lower(&lm, &mut spring);
    let skew = |i: usize, j: usize| match (i < size, j < size) {
        (true, true) => 0.5 * (coriolis[(i, j)] - coriolis[(j, i)]),
        (true, false) => spring[(i, j - size)],
        (false, true) => -spring[(j, i - size)],
        (false, false) => 0.0,
    };
    let hermitian: Mat<c64> = Mat::from_fn(2 * size, 2 * size, |i, j| c64::new(0.0, skew(i, j)));
    let eigen = hermitian
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| FemError::Eigen { size: 2 * size })?;
    let frequencies = eigen.S().column_vector();
    let vectors = eigen.U();
    // displacement half of z, real and imaginary part side by side
    let mut halves = Mat::from_fn(size, 4 * size, |i, j| {
        let entry = vectors[(size + i, j / 2)];
        if j % 2 == 0 { entry.re } else { entry.im }
    });
    solve_upper(&lk, &mut halves);
    let mut pairs: Vec<EigenPair<Complex<f64>>> = (0..2 * size)
        .filter(|&k| frequencies[k].re > 0.0)
        .map(|k| {
            let raw = DVector::from_fn(size, |i, _| {
                Complex::new(halves[(i, 2 * k)], halves[(i, 2 * k + 1)])
            });
            EigenPair { squared_frequency: frequencies[k].re.powi(2), vector: unit_mass(mass, raw) }
        })
        .collect();
    pairs.sort_by(|a, b| a.squared_frequency.total_cmp(&b.squared_frequency));
    Ok(pairs)
}

/// Scales to unit mass and turns the phase so that the real part carries as much of it as it can.
fn unit_mass(mass: &DMatrix<f64>, raw: DVector<Complex<f64>>) -> DVector<Complex<f64>> {
    let (re, im) = (raw.map(|z| z.re), raw.map(|z| z.im));
    let (rr, ii) = (re.dot(&(mass * &re)), im.dot(&(mass * &im)));
    let ri = re.dot(&(mass * &im));
    // q' M q (no conjugation) becomes real and positive
    let phase = 0.5 * (2.0 * ri).atan2(rr - ii);
    raw * (Complex::from_polar(1.0, -phase) / Complex::from((rr + ii).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever phase the eigenvalue routine leaves, the real part ends up with the most mass.
    #[test]
    fn the_phase_of_a_shape_is_turned_into_its_real_part() {
        let mass = DMatrix::from_row_slice(2, 2, &[2.0, 0.1, 0.1, 1.0]);
        let shape = DVector::from_vec(vec![Complex::new(3.0, 0.0), Complex::new(0.0, 0.5)]);
        let expected = unit_mass(&mass, shape.clone());
        let (re, im) = (expected.map(|z| z.re), expected.map(|z| z.im));
        assert!(re.dot(&(&mass * &im)).abs() < 1e-15);
        assert!(re.dot(&(&mass * &re)) > im.dot(&(&mass * &im)));
        for phase in [0.4, 1.2, -0.9] {
            let turned = unit_mass(&mass, &shape * Complex::from_polar(7.0, phase));
            // the sign stays open: the mode fixes it by its tip
            let gap = [1.0, -1.0]
                .map(|sign| (&turned * Complex::from(sign) - &expected).map(Complex::norm).amax());
            let gap = gap[0].min(gap[1]);
            assert!(gap < 1e-14, "{phase}: {gap:e}");
        }
    }
}
