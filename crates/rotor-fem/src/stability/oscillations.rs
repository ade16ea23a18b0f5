//! Free oscillations of a linear system with constant coefficients.

use faer::Mat;
use nalgebra::{Complex, DMatrix};

use crate::FemError;

/// A free motion `x e^(s t)` of `M x'' + C x' + K x = 0`.
#[derive(Debug, Clone, PartialEq)]
pub struct Oscillation {
    /// The exponent `s` per unit of time: growth, and frequency (never negative: one of each conjugate pair).
    pub exponent: Complex<f64>,
    /// The displacements, up to a factor.
    pub shape: Vec<Complex<f64>>,
}

/// All free oscillations, lowest frequency first.
///
/// ```text
/// [x; x']' = [0 1; -M^-1 K  -M^-1 C] [x; x']
/// ```
/// No symmetry is asked of the matrices: they may hold damping, gyroscopic and circulatory parts.
///
/// # Errors
/// [`FemError::MassSingular`]; [`FemError::Eigen`] without convergence or for entries that are not finite.
pub fn oscillations(
    mass: &DMatrix<f64>,
    damping: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
) -> Result<Vec<Oscillation>, FemError> {
    let dof = mass.nrows();
    let size = 2 * dof;
    let lu = mass.clone().lu();
    let (Some(k), Some(c)) = (lu.solve(stiffness), lu.solve(damping)) else {
        return Err(FemError::MassSingular { azimuth_rad: 0.0 });
    };
    if k.iter().chain(&c).any(|v| !v.is_finite()) {
        return Err(FemError::Eigen { size });
    }
    let matrix = Mat::from_fn(size, size, |i, j| match (i < dof, j < dof) {
        (true, _) => f64::from(j == i + dof),
        (false, true) => -k[(i - dof, j)],
        (false, false) => -c[(i - dof, j - dof)],
    });
    let eigen = matrix.eigen().map_err(|_| FemError::Eigen { size })?;
    let (values, vectors) = (eigen.S().column_vector(), eigen.U());
    let complex = |z: faer::c64| Complex::new(z.re, z.im);
    let mut motions: Vec<Oscillation> = (0..size)
        .filter(|&k| values[k].im >= 0.0)
        .map(|k| Oscillation {
            exponent: complex(values[k]),
            shape: (0..dof).map(|i| complex(vectors[(i, k)])).collect(),
        })
        .collect();
    motions.sort_by(|a, b| a.exponent.im.total_cmp(&b.exponent.im));
    Ok(motions)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// Two gyroscopically coupled oscillators: `w^4 - (k1 + k2 + g^2) w^2 + k1 k2 = 0`; the rates lead the
    /// displacements by a quarter of a turn.
    #[test]
    fn a_gyroscopic_pair_meets_its_closed_form() {
        let (k1, k2, g) = (2.0_f64, 5.0, 0.8);
        let square = |entries: [f64; 4]| DMatrix::from_row_slice(2, 2, &entries);
        let motions = oscillations(
            &DMatrix::identity(2, 2),
            &square([0.0, -g, g, 0.0]),
            &square([k1, 0.0, 0.0, k2]),
        )
        .unwrap();
        let half = 0.5 * (k1 + k2 + g * g);
        let apart = (half * half - k1 * k2).sqrt();
        let expected = [(half - apart).sqrt(), (half + apart).sqrt()];
        assert_eq!(motions.len(), 2);
        for (motion, frequency) in motions.iter().zip(expected) {
            assert_abs_diff_eq!(motion.exponent.im, frequency, epsilon = 1e-12);
            assert_abs_diff_eq!(motion.exponent.re, 0.0, epsilon = 1e-12);
            let ratio = motion.shape[1] / motion.shape[0];
            assert_abs_diff_eq!(ratio.re, 0.0, epsilon = 1e-12);
        }
    }

    #[test]
    fn damping_is_the_real_part() {
        let one = |value| DMatrix::from_element(1, 1, value);
        let motions = oscillations(&one(2.0), &one(2.0 * 2.0 * 0.1 * 3.0), &one(18.0)).unwrap();
        assert_abs_diff_eq!(motions[0].exponent.re, -0.3, epsilon = 1e-13);
        assert_abs_diff_eq!(motions[0].exponent.im, 3.0 * 0.99_f64.sqrt(), epsilon = 1e-13);
    }
}
