//! Shape functions of the 15-dof element.

use nalgebra::SVector;

/// Degrees of freedom of one element.
pub(crate) const ELEMENT_DOF: usize = 15;
/// Degrees of freedom one element adds to the blade: those of its inboard joint and its inner nodes.
pub(crate) const STRIDE: usize = 9;
/// Degrees of freedom of a joint.
pub(crate) const JOINT_DOF: usize = 6;

/// A row that turns the element's degrees of freedom into one quantity at a point.
pub(crate) type Row = SVector<f64, ELEMENT_DOF>;

/// Positions of the degrees of freedom in an element.
///
/// Inboard joint `u v v' w w' phi`, inner nodes `u(1/3) u(2/3) phi(1/2)`, outboard joint as inboard.
pub(crate) mod place {
    /// Axial nodes at 0, 1/3, 2/3, 1 of the element.
    pub(crate) const AXIAL: [usize; 4] = [0, 6, 7, 9];
    /// Lag value and slope inboard, value and slope outboard.
    pub(crate) const LAG: [usize; 4] = [1, 2, 10, 11];
    /// Flap value and slope inboard, value and slope outboard.
    pub(crate) const FLAP: [usize; 4] = [3, 4, 12, 13];
    /// Twist nodes at 0, 1/2, 1 of the element.
    pub(crate) const TWIST: [usize; 3] = [5, 8, 14];
}

/// Cubic Hermite polynomials on an element of `length`: `[dof][derivative 0, 1, 2]`.
///
/// `s` in [0, 1] runs from the inboard to the outboard end; derivatives are with respect to radius.
pub(crate) fn hermite(s: f64, length: f64) -> [[f64; 3]; 4] {
    let l = length;
    let (s2, s3) = (s * s, s * s * s);
    [
        [1.0 - 3.0 * s2 + 2.0 * s3, (6.0 * s2 - 6.0 * s) / l, (12.0 * s - 6.0) / (l * l)],
        [l * (s - 2.0 * s2 + s3), 1.0 - 4.0 * s + 3.0 * s2, (6.0 * s - 4.0) / l],
        [3.0 * s2 - 2.0 * s3, (6.0 * s - 6.0 * s2) / l, (6.0 - 12.0 * s) / (l * l)],
        [l * (s3 - s2), 3.0 * s2 - 2.0 * s, (6.0 * s - 2.0) / l],
    ]
}

/// Cubic Lagrange polynomials through 0, 1/3, 2/3, 1: `[node][value, derivative]`.
pub(crate) fn cubic(s: f64, length: f64) -> [[f64; 2]; 4] {
    let (s2, s3) = (s * s, s * s * s);
    [
        [1.0 - 5.5 * s + 9.0 * s2 - 4.5 * s3, (-5.5 + 18.0 * s - 13.5 * s2) / length],
        [9.0 * s - 22.5 * s2 + 13.5 * s3, (9.0 - 45.0 * s + 40.5 * s2) / length],
        [-4.5 * s + 18.0 * s2 - 13.5 * s3, (-4.5 + 36.0 * s - 40.5 * s2) / length],
        [s - 4.5 * s2 + 4.5 * s3, (1.0 - 9.0 * s + 13.5 * s2) / length],
    ]
}

/// Quadratic Lagrange polynomials through 0, 1/2, 1: `[node][derivative 0, 1, 2]`.
pub(crate) fn quadratic(s: f64, length: f64) -> [[f64; 3]; 3] {
    let (l, s2) = (length, s * s);
    [
        [1.0 - 3.0 * s + 2.0 * s2, (4.0 * s - 3.0) / l, 4.0 / (l * l)],
        [4.0 * s - 4.0 * s2, (4.0 - 8.0 * s) / l, -8.0 / (l * l)],
        [2.0 * s2 - s, (4.0 * s - 1.0) / l, 4.0 / (l * l)],
    ]
}

/// All displacement rows of the element at one point.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    /// `u`, `u'`.
    pub(crate) axial: [Row; 2],
    /// `v`, `v'`, `v''`.
    pub(crate) lag: [Row; 3],
    /// `w`, `w'`, `w''`.
    pub(crate) flap: [Row; 3],
    /// `phi`, `phi'`.
    pub(crate) twist: [Row; 2],
}

impl Rows {
    /// The rows at `s` in [0, 1] of an element of `length`.
    pub(crate) fn at(s: f64, length: f64) -> Self {
        let mut rows = Self {
            axial: [Row::zeros(); 2],
            lag: [Row::zeros(); 3],
            flap: [Row::zeros(); 3],
            twist: [Row::zeros(); 2],
        };
        for (i, shape) in place::AXIAL.into_iter().zip(cubic(s, length)) {
            for (row, value) in rows.axial.iter_mut().zip(shape) {
                row[i] = value;
            }
        }
        for ((i, j), shape) in place::LAG.into_iter().zip(place::FLAP).zip(hermite(s, length)) {
            for (k, value) in shape.into_iter().enumerate() {
                rows.lag[k][i] = value;
                rows.flap[k][j] = value;
            }
        }
        for (i, shape) in place::TWIST.into_iter().zip(quadratic(s, length)) {
            for (row, value) in rows.twist.iter_mut().zip(shape) {
                row[i] = value;
            }
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// Interpolating a polynomial of the family's degree gives it and its derivatives back.
    #[test]
    fn each_family_holds_its_polynomials() {
        let length = 0.4;
        let f = |x: f64| [1.0 + 2.0 * x - x * x + 3.0 * x.powi(3), 2.0 - 2.0 * x + 9.0 * x * x];
        let g = |x: f64| [1.0 + 2.0 * x - x * x, 2.0 - 2.0 * x];
        let mut dof = Row::zeros();
        for (i, s) in place::AXIAL.into_iter().zip([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]) {
            dof[i] = f(s * length)[0];
        }
        for (family, factor) in [(place::LAG, 1.0), (place::FLAP, -2.0)] {
            for (k, s) in [0.0, 1.0].into_iter().enumerate() {
                dof[family[2 * k]] = factor * f(s * length)[0];
                dof[family[2 * k + 1]] = factor * f(s * length)[1];
            }
        }
        for (i, s) in place::TWIST.into_iter().zip([0.0, 0.5, 1.0]) {
            dof[i] = g(s * length)[0];
        }
        for s in [0.0, 0.17, 0.5, 0.93, 1.0] {
            let x = s * length;
            let rows = Rows::at(s, length);
            for k in 0..2 {
                assert_abs_diff_eq!(rows.axial[k].dot(&dof), f(x)[k], epsilon = 1e-13);
                assert_abs_diff_eq!(rows.lag[k].dot(&dof), f(x)[k], epsilon = 1e-13);
                assert_abs_diff_eq!(rows.flap[k].dot(&dof), -2.0 * f(x)[k], epsilon = 1e-13);
                assert_abs_diff_eq!(rows.twist[k].dot(&dof), g(x)[k], epsilon = 1e-13);
            }
            assert_abs_diff_eq!(rows.lag[2].dot(&dof), -2.0 + 18.0 * x, epsilon = 1e-12);
        }
    }
}
