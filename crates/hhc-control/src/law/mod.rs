//! The control law, eq. (10).

mod lag;
mod margins;
mod spectrum;
mod t_matrix;

pub use lag::{LagLoss, lag_loss};
pub use margins::{LoadMargin, TMargins};
pub use spectrum::RelaxedStep;
pub use t_matrix::TMatrix;

use crate::{ControlError, LoadWeights, error};
use nalgebra::{DMatrix, DVector, SVD};

/// The control that minimises the cost predicted by eq. (8) from one measurement.
///
/// ```text
/// u* = (T' W_Z T + rho I)^-1 T' W_Z (T u - Z)
///    = V diag(s_k / (s_k^2 + rho)) U' W_Z^(1/2) (T u - Z),      W_Z^(1/2) T = U diag(s_k) V'
/// ```
/// The second line is what is computed: one singular value decomposition serves every `rho`, and
/// the normal matrix, whose condition number is squared, is never formed. For `rho = 0` singular
/// values at rounding level are left out, which gives the optimum of least voltage.
///
/// Source: eq. (10), from eq. (7)-(9).
/// Differs from source: the printed sign and grouping are garbled; this is what (7)-(9) give.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackLaw {
    t: TMatrix,
    load_weights: Vec<f64>,
    left: DMatrix<f64>,
    singular_values: Vec<f64>,
    right_transposed: DMatrix<f64>,
}

const SVD_ITERATIONS: usize = 10_000;
/// Off-diagonal over diagonal at which the decomposition ends. With one unit of rounding it is wrong for some T of two flaps that
/// act alike: a singular value of 9.66 for 6.16.
const SVD_TOLERANCE: f64 = 5.0 * f64::EPSILON;

/// A measured state: a control vector and the outputs measured there.
#[derive(Debug, Clone, Copy)]
pub struct OperatingPoint<'a> {
    /// `u`, volt.
    pub control_volt: &'a [f64],
    /// `Z`, nondimensional.
    pub outputs: &'a [f64],
}

/// A quadratic form of the control: `u' P u / 2 + q' u`.
#[derive(Debug, Clone)]
pub(crate) struct Quadratic {
    /// `P`, symmetric.
    pub(crate) hessian: DMatrix<f64>,
    /// `q`.
    pub(crate) linear: DVector<f64>,
}

impl Quadratic {
    /// The form of the control over `volt`, its largest number 1.
    pub(crate) fn scaled(self, volt: f64) -> Self {
        let size = (self.hessian.amax() * volt * volt).max(self.linear.amax() * volt);
        let size = if size > 0.0 { size } else { 1.0 };
        Self { hessian: self.hessian * (volt * volt / size), linear: self.linear * (volt / size) }
    }

    /// The form with a proximal term in it, halved as the cost is.
    pub(crate) fn with(mut self, proximal: Proximal<'_>) -> Self {
        for (k, here) in proximal.control_volt.iter().enumerate() {
            self.hessian[(k, k)] += proximal.weight;
            self.linear[k] -= proximal.weight * here;
        }
        self
    }
}

/// The damping term of a trust-region step: `weight |u - u_here|^2` beside the cost.
///
/// Source: K. Levenberg, Quart. Appl. Math. 2 (1944) 164; D. Marquardt, SIAM J. Appl. Math. 11 (1963) 431.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Proximal<'a> {
    /// 1/V^2.
    pub(crate) weight: f64,
    /// Volt.
    pub(crate) control_volt: &'a [f64],
}

impl FeedbackLaw {
    /// The law of one T matrix (1/V) and load weights.
    ///
    /// # Errors
    /// [`ControlError::NoAuthority`] for a zero weighted T, [`ControlError::SingularValues`] if its
    /// decomposition fails, and what [`LoadWeights::diagonal`] refuses.
    pub fn new(t: &TMatrix, load_weights: &LoadWeights) -> Result<Self, ControlError> {
        let load_weights = load_weights.diagonal(t.loads())?;
        let mut weighted = t.as_matrix().clone();
        for (mut row, weight) in weighted.row_iter_mut().zip(&load_weights) {
            row *= weight.sqrt();
        }
        // Loads in rotor units per volt are of order 1e-6: the decomposition is made at order 1.
        let size = weighted.amax();
        if size == 0.0 {
            return Err(ControlError::NoAuthority);
        }
        weighted /= size;
        let (rows, columns) = weighted.shape();
        let failed = ControlError::SingularValues { rows, columns, iterations: SVD_ITERATIONS };
        let svd = SVD::try_new(weighted, true, true, SVD_TOLERANCE, SVD_ITERATIONS)
            .ok_or_else(|| failed.clone())?;
        let (Some(left), Some(right_transposed)) = (svd.u, svd.v_t) else {
            return Err(failed);
        };
        let singular_values = svd.singular_values.iter().map(|s| s * size).collect();
        Ok(Self { t: t.clone(), load_weights, left, singular_values, right_transposed })
    }

    /// The optimal control `u*` (volt) as seen from one measurement.
    ///
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `rho` | `rho` | 1/V^2 | >= 0 |
    /// | `control_volt` | `u` | volt | as measured |
    /// | `hub_loads` | `Z` | nondimensional | measured at `u` |
    ///
    /// # Errors
    /// Vectors of the wrong length or not finite, a negative `rho`.
    pub fn optimum_volt(
        &self,
        rho: f64,
        control_volt: &[f64],
        hub_loads: &[f64],
    ) -> Result<Vec<f64>, ControlError> {
        error::check_not_negative("control weight rho (1/V^2)", rho)?;
        let target = self.modal_target(OperatingPoint { control_volt, outputs: hub_loads })?;
        Ok(self.optimum_of(rho, &target))
    }

    /// Decrease of the cost that the law predicts from a measured state to another control.
    ///
    /// # Errors
    /// Vectors of the wrong length or not finite.
    pub(crate) fn promise(
        &self,
        rho: f64,
        from: OperatingPoint<'_>,
        target_volt: &[f64],
    ) -> Result<f64, ControlError> {
        let controls = self.shape().1;
        error::check_vector("control vector aimed at (volt)", target_volt, controls)?;
        let Quadratic { hessian, linear } = self.quadratic(rho, &self.modal_target(from)?);
        let [from, to] = [from.control_volt, target_volt].map(DVector::from_column_slice);
        // a difference of squares: the step first, then what it is multiplied with
        let step = &from - &to;
        Ok(step.dot(&(hessian * (&from + &to))) + 2.0 * linear.dot(&step))
    }

    /// Singular values of `W_Z^(1/2) T`, largest first, 1/V: the authority of each independent
    /// combination of controls. Their squares are the scale of `rho`.
    pub fn singular_values(&self) -> &[f64] {
        &self.singular_values
    }

    /// The largest of them over the smallest; 0 where there is none.
    pub fn condition(&self) -> f64 {
        let ends = self.singular_values().first().zip(self.singular_values().last());
        ends.map_or(0.0, |(first, last)| first / last)
    }

    /// Whether there are more controls than loads, so that the optimum without a weight is one of many.
    pub fn has_surplus_controls(&self) -> bool {
        let (loads, controls) = self.shape();
        controls > loads
    }

    /// Diagonal of `W_Z`.
    pub fn load_weights(&self) -> &[f64] {
        &self.load_weights
    }

    /// The T matrix of the law.
    pub fn t(&self) -> &TMatrix {
        &self.t
    }

    /// The law of another T matrix with the same load weights.
    pub(crate) fn with_t(&self, t: &TMatrix) -> Result<Self, ControlError> {
        Self::new(t, &LoadWeights::Diagonal(self.load_weights.clone()))
    }

    /// Number of loads and of controls.
    pub(crate) fn shape(&self) -> (usize, usize) {
        self.t.as_matrix().shape()
    }

    /// `U' W_Z^(1/2) (T u - Z)`.
    pub(crate) fn modal_target(
        &self,
        at: OperatingPoint<'_>,
    ) -> Result<DVector<f64>, ControlError> {
        let (loads, controls) = self.shape();
        error::check_vector("control vector (volt)", at.control_volt, controls)?;
        error::check_vector("measured outputs", at.outputs, loads)?;
        let mut target = self.t.as_matrix() * DVector::from_column_slice(at.control_volt);
        for ((value, load), weight) in target.iter_mut().zip(at.outputs).zip(&self.load_weights) {
            *value = (*value - load) * weight.sqrt();
        }
        Ok(self.left.tr_mul(&target))
    }

    /// The optimum for a modal target, volt.
    pub(crate) fn optimum_of(&self, rho: f64, target: &DVector<f64>) -> Vec<f64> {
        let gains = DVector::from_iterator(target.len(), self.gains(rho));
        let scaled = target.component_mul(&gains);
        self.right_transposed.tr_mul(&scaled).iter().copied().collect()
    }

    /// `J_Z` that the law predicts at its optimum from zero control, where it is `loads_cost`; the modal target is that at
    /// zero control.
    pub(crate) fn predicted_loads_cost(
        &self,
        rho: f64,
        target: &DVector<f64>,
        loads_cost: f64,
    ) -> f64 {
        // of the part of the loads that the control reaches, rho / (s^2 + rho) of every amplitude is left
        let modes = self.singular_values.iter().zip(self.gains(rho)).zip(target.iter());
        modes.fold(loads_cost, |cost, ((s, gain), z)| {
            let left = 1.0 - s * gain;
            cost - z * z * (1.0 - left * left)
        })
    }

    /// The predicted cost, halved and without its constant, as a form of the control (volt):
    /// `u' P u / 2 + q' u`.
    pub(crate) fn quadratic(&self, rho: f64, target: &DVector<f64>) -> Quadratic {
        let mut scaled = self.right_transposed.clone();
        for (mut row, s) in scaled.row_iter_mut().zip(&self.singular_values) {
            row *= *s;
        }
        let n = scaled.ncols();
        let hessian = scaled.tr_mul(&scaled) + DMatrix::identity(n, n) * rho;
        Quadratic { hessian, linear: -scaled.tr_mul(target) }
    }

    /// The optimum for a modal target with a proximal term, volt.
    pub(crate) fn optimum_near(
        &self,
        rho: f64,
        target: &DVector<f64>,
        proximal: Proximal<'_>,
    ) -> Vec<f64> {
        if proximal.weight == 0.0 {
            return self.optimum_of(rho, target);
        }
        let Quadratic { hessian, linear } = self.quadratic(rho, target).with(proximal);
        // positive definite: the proximal term alone is
        let found = hessian.cholesky().map(|factors| factors.solve(&-linear));
        found.map_or_else(|| self.optimum_of(rho, target), |u| u.iter().copied().collect())
    }

    /// Second derivative of the predicted cost along a step, halved, 1/V^2; 0 along no step.
    pub(crate) fn curvature(&self, rho: f64, step_volt: &[f64]) -> f64 {
        let step = DVector::from_column_slice(step_volt);
        let square = step.norm_squared();
        if square == 0.0 {
            return 0.0;
        }
        let image = self.t.as_matrix() * &step;
        let loads = image.iter().zip(&self.load_weights).map(|(z, w)| w * z * z);
        loads.sum::<f64>() / square + rho
    }

    /// Euclidean norm of the optimum, volt; never grows with `rho`.
    pub(crate) fn optimum_norm(&self, rho: f64, target: &DVector<f64>) -> f64 {
        target.iter().zip(self.gains(rho)).map(|(v, g)| (v * g).powi(2)).sum::<f64>().sqrt()
    }

    /// Square of the largest singular value, 1/V^2: the scale of `rho`.
    pub(crate) fn largest_authority(&self) -> f64 {
        self.singular_values.first().map_or(0.0, |s| s * s)
    }

    /// The `rho` for which the optimum has a given norm (volt), to about 1 part in 1000; the nearest
    /// end of 32 decades about [`Self::largest_authority`] if none has.
    pub(crate) fn effort_for_norm(&self, norm_volt: f64, target: &DVector<f64>) -> f64 {
        let middle = self.largest_authority().ln();
        let (mut low, mut high) = (middle - 37.0, middle + 37.0);
        while high - low > 1e-3 {
            let x = f64::midpoint(low, high);
            let end =
                if self.optimum_norm(x.exp(), target) > norm_volt { &mut low } else { &mut high };
            *end = x;
        }
        f64::midpoint(low, high).exp()
    }

    /// `s_k / (s_k^2 + rho)`, volt per unit of load.
    fn gains(&self, rho: f64) -> impl Iterator<Item = f64> {
        let largest = self.singular_values.first().copied().unwrap_or_default();
        let size = self.t.loads().max(self.t.controls()) as f64;
        let floor = largest * f64::EPSILON * size;
        self.singular_values.iter().map(move |&s| if s > floor { s / (s * s + rho) } else { 0.0 })
    }
}
