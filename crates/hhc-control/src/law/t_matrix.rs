//! The T matrix as a value.

use crate::{ControlError, error};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Sensitivity of the loads to the control voltages, `T = dZ/du`.
///
/// Rows are loads (nondimensional), in the order of [`crate::Measurement::outputs`]; columns are
/// controls (volt), in the order of [`crate::ControlLayout`]. Unit: 1/V.
#[derive(Debug, Clone, PartialEq)]
pub struct TMatrix {
    matrix: DMatrix<f64>,
}

impl TMatrix {
    /// A matrix from its columns: one per control, each with one number per load.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] without column or load, [`ControlError::Length`] for columns of
    /// different length, [`ControlError::NotFinite`].
    pub fn from_columns(columns: &[Vec<f64>]) -> Result<Self, ControlError> {
        let loads = columns.first().map_or(0, Vec::len);
        let (what, expected) = ("size of the T matrix", "a column and a load at least");
        error::check_range(loads > 0, what, 0.0, expected)?;
        for column in columns {
            error::check_vector("column of the T matrix (1/V)", column, loads)?;
        }
        let matrix = DMatrix::from_fn(loads, columns.len(), |load, control| columns[control][load]);
        Ok(Self { matrix })
    }

    /// The same from loads x controls.
    pub(crate) fn from_matrix(matrix: DMatrix<f64>) -> Result<Self, ControlError> {
        error::check_vector("T matrix (1/V)", matrix.as_slice(), matrix.len())?;
        Ok(Self { matrix })
    }

    /// Takes over the columns of a matrix behind its first one, as many as there are, times a factor, in place.
    pub(crate) fn set_scaled(&mut self, theta: &DMatrix<f64>, factor: f64) {
        let columns = theta.columns(1, self.matrix.ncols());
        self.matrix.zip_apply(&columns, |element, scaled| *element = factor * scaled);
    }

    /// Number of loads (rows).
    pub fn loads(&self) -> usize {
        self.matrix.nrows()
    }

    /// Number of controls (columns).
    pub fn controls(&self) -> usize {
        self.matrix.ncols()
    }

    /// Element of a load and a control, 1/V; `None` outside.
    pub fn at(&self, load: usize, control: usize) -> Option<f64> {
        self.matrix.get((load, control)).copied()
    }

    /// The columns, one per control.
    pub fn columns(&self) -> Vec<Vec<f64>> {
        self.matrix.column_iter().map(|column| column.iter().copied().collect()).collect()
    }

    /// The matrix for algebra: loads x controls, 1/V.
    pub fn as_matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// The change of the loads for a change of the control (volt), `T du`.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`].
    pub fn loads_for(&self, control_volt: &[f64]) -> Result<Vec<f64>, ControlError> {
        error::check_vector("control vector (volt)", control_volt, self.controls())?;
        Ok((&self.matrix * DVector::from_column_slice(control_volt)).iter().copied().collect())
    }

    /// Frobenius norm, 1/V: the square root of the sum of all squared elements.
    pub fn frobenius_norm(&self) -> f64 {
        self.matrix.norm()
    }

    /// The same with the voltage harmonic of every pair multiplied by a complex factor `g exp(i phi)`: what an
    /// actuator of another gain and phase makes of it.
    ///
    /// ```text
    /// [T_c, T_s]  <-  g [ T_c cos phi + T_s sin phi,  T_s cos phi - T_c sin phi ]
    /// ```
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `gain` | `g` | - | any |
    /// | `phase_rad` | `phi` | rad | any; a lag of the harmonic `A cos(n psi - phase)` is positive |
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for an odd number of controls, [`ControlError::NotFinite`].
    pub fn turned(&self, gain: f64, phase_rad: f64) -> Result<Self, ControlError> {
        self.turned_within(0..self.controls(), gain, phase_rad)
    }

    /// The same for the pairs of some controls alone, as of one flap; the others stay.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for controls that are not whole pairs of T, [`ControlError::NotFinite`].
    pub fn turned_within(
        &self,
        controls: Range<usize>,
        gain: f64,
        phase_rad: f64,
    ) -> Result<Self, ControlError> {
        error::check_vector("gain and phase of T", &[gain, phase_rad], 2)?;
        let (what, count) = ("controls of the T matrix", self.controls());
        let is_paired = [controls.start, controls.end, count].iter().all(|c| c.is_multiple_of(2));
        error::check_range(is_paired && controls.end <= count, what, count as f64, "pairs")?;
        let (sin, cos) = phase_rad.sin_cos();
        let mut matrix = self.matrix.clone();
        for c in controls.step_by(2) {
            let (cosine, sine) = (self.matrix.column(c), self.matrix.column(c + 1));
            matrix.set_column(c, &((cosine * cos + sine * sin) * gain));
            matrix.set_column(c + 1, &((sine * cos - cosine * sin) * gain));
        }
        Ok(Self { matrix })
    }

    /// The same with the harmonic of one load multiplied by a complex factor `g exp(i phi)`: what an instrument of another gain
    /// and phase makes of it. Rows `2 load` and `2 load + 1` are its cosine and its sine.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for a load that T lacks, [`ControlError::NotFinite`].
    pub fn with_load_turned(
        &self,
        load: usize,
        gain: f64,
        phase_rad: f64,
    ) -> Result<Self, ControlError> {
        error::check_vector("gain and phase of a load", &[gain, phase_rad], 2)?;
        let (what, count) = ("loads of the T matrix", self.loads());
        error::check_range(2 * load + 1 < count, what, count as f64, "a pair for every load")?;
        let (sin, cos) = phase_rad.sin_cos();
        let mut matrix = self.matrix.clone();
        let (cosine, sine) = (self.matrix.row(2 * load), self.matrix.row(2 * load + 1));
        matrix.set_row(2 * load, &((cosine * cos - sine * sin) * gain));
        matrix.set_row(2 * load + 1, &((sine * cos + cosine * sin) * gain));
        Ok(Self { matrix })
    }

    /// Difference from a reference matrix, relative to that matrix.
    ///
    /// ```text
    /// |T - T_ref|_F / |T_ref|_F
    /// ```
    /// # Errors
    /// [`ControlError::Length`] for matrices of different shape, [`ControlError::NoAuthority`] for a
    /// zero reference.
    pub fn relative_difference(&self, reference: &Self) -> Result<f64, ControlError> {
        error::check_length("rows of the T matrix", self.loads(), reference.loads())?;
        error::check_length("columns of the T matrix", self.controls(), reference.controls())?;
        let norm = reference.frobenius_norm();
        if norm == 0.0 {
            return Err(ControlError::NoAuthority);
        }
        Ok((&self.matrix - &reference.matrix).norm() / norm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn shape_norm_and_product() {
        let t = TMatrix::from_columns(&[vec![1.0, 2.0, 0.0], vec![0.0, 0.0, -2.0]]).unwrap();
        assert_eq!((t.loads(), t.controls()), (3, 2));
        assert_eq!(t.at(1, 0), Some(2.0));
        assert_eq!(t.at(3, 0), None);
        assert_eq!(t.columns()[1], vec![0.0, 0.0, -2.0]);
        assert_abs_diff_eq!(t.frobenius_norm(), 3.0, epsilon = 1e-15);
        assert_eq!(t.loads_for(&[3.0, 0.5]).unwrap(), vec![3.0, 6.0, -1.0]);
        assert!(t.loads_for(&[3.0]).is_err());
    }

    #[test]
    fn relative_difference_is_relative_to_the_reference() {
        let t = TMatrix::from_columns(&[vec![0.0, 4.0], vec![3.0, 0.0]]).unwrap();
        let u = TMatrix::from_columns(&[vec![0.0, 4.0], vec![3.0, 0.5]]).unwrap();
        assert_abs_diff_eq!(u.relative_difference(&t).unwrap(), 0.1, epsilon = 1e-15);
        let narrow = TMatrix::from_columns(&[vec![0.0, 4.0]]).unwrap();
        assert!(narrow.relative_difference(&t).is_err());
        let zero = TMatrix::from_columns(&[vec![0.0, 0.0], vec![0.0, 0.0]]).unwrap();
        assert_eq!(t.relative_difference(&zero), Err(ControlError::NoAuthority));
    }

    /// A quarter turn makes the sine's column of the cosine's: `cos(n psi - 90 deg) = sin(n psi)`.
    #[test]
    fn a_quarter_turn_is_a_lag_of_90_degrees() {
        let t = TMatrix::from_columns(&[vec![1.0, 2.0], vec![3.0, 5.0]]).unwrap();
        let turned = t.turned(2.0, std::f64::consts::FRAC_PI_2).unwrap().columns();
        for (found, exact) in turned.concat().iter().zip([6.0, 10.0, -2.0, -4.0]) {
            assert_abs_diff_eq!(*found, exact, epsilon = 1e-14);
        }
        assert!(TMatrix::from_columns(&[vec![1.0]]).unwrap().turned(1.0, 0.0).is_err());
        assert!(t.turned(f64::NAN, 0.0).is_err());
    }

    #[test]
    fn impossible_matrices_are_refused() {
        for columns in [vec![], vec![vec![]], vec![vec![1.0], vec![]], vec![vec![f64::INFINITY]]] {
            assert!(TMatrix::from_columns(&columns).is_err());
        }
    }
}
