//! Whether a loop with a constant T contracts: the spectral radius of its iteration.

use crate::law::{Proximal, Quadratic};
use crate::{ControlError, FeedbackLaw, OperatingPoint, TMatrix, error};
use nalgebra::{DMatrix, DVector};

/// The step of a loop with fixed cycles: `u <- u + gain (argmin J + s |u - u_here|^2  -  u_here)`, the blocks of `T'WT` between two
/// flaps times `q`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelaxedStep {
    /// `rho`, 1/V^2, 0 or above.
    pub rho: f64,
    /// `s`, the weight of the change from cycle to cycle, 1/V^2, 0 or above.
    pub rate_weight: f64,
    /// Part of the way that a step goes, above 0 and at most 1.
    pub gain: f64,
    /// `q`, the chance that a flap acts, above 0 and at most 1.
    pub flap_survival: f64,
    /// Controls of one flap, which stand together; matters where `q` is below 1.
    pub controls_of_flap: usize,
}

impl RelaxedStep {
    /// A step without weights that goes a part of the way, of flaps that all act.
    pub fn of_gain(gain: f64) -> Self {
        Self { rho: 0.0, rate_weight: 0.0, gain, flap_survival: 1.0, controls_of_flap: 1 }
    }

    pub(super) fn check(&self) -> Result<(), ControlError> {
        error::check_not_negative("control weight rho (1/V^2)", self.rho)?;
        error::check_not_negative("rate weight (1/V^2)", self.rate_weight)?;
        error::check_chance(self.flap_survival)?;
        error::check_gain(self.gain)
    }
}

impl FeedbackLaw {
    /// Largest factor by which an error of the control may be multiplied from step to step where the true
    /// sensitivity is another than that of the law.
    ///
    /// ```text
    /// u_(k+1) - u* = M (u_k - u*),    M = I - (T0' W_Z T0 + rho I)^-1 (T0' W_Z T + rho I)
    /// ```
    /// Whole steps converge, wherever they start from near `u*`, if the largest eigenvalue of `M` in size is below 1;
    /// above it they do not, and only halving or a new T helps. With `T = g exp(i phi) T0` and `rho = 0` it is
    /// `|1 - g exp(i phi)|`.
    ///
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `rho` | `rho` | 1/V^2 | >= 0, held from step to step |
    /// | `there` | `T` | 1/V | where the loop is, or ends |
    ///
    /// # Errors
    /// A `T` of another shape, a negative `rho`.
    ///
    /// Source: eq. (10) as a fixed-point iteration.
    pub fn iteration_spectral_radius(
        &self,
        rho: f64,
        there: &TMatrix,
    ) -> Result<f64, ControlError> {
        self.relaxed_spectral_radius(RelaxedStep { rho, ..RelaxedStep::of_gain(1.0) }, there)
    }

    /// The same where a step goes only a part of the way and its change is weighted:
    ///
    /// ```text
    /// M = I - gain (T0' W_Z T0 + (rho + s) I)^-1 (T0' W_Z T + rho I),                q = 1
    /// M = (1 - gain) I - gain N^-1 (T0' W_Z (T - T0) - s I),      N = (T0' W_Z T0)_q + (rho + s) I
    /// ```
    /// `(..)_q`: the blocks between two flaps times `q`. With `T = T0` and `s = 0` it is `1 - gain` whatever `q` is.
    ///
    /// # Errors
    /// As [`Self::iteration_spectral_radius`].
    pub fn relaxed_spectral_radius(
        &self,
        step: RelaxedStep,
        there: &TMatrix,
    ) -> Result<f64, ControlError> {
        step.check()?;
        let (loads, controls) = self.shape();
        error::check_length("controls of the true T", there.controls(), controls)?;
        error::check_length("loads of the true T", there.loads(), loads)?;
        // column by column: where eq. (10) goes to from a unit error, less the unit
        let mut iteration = DMatrix::identity(controls, controls);
        for (mut column, change) in iteration.column_iter_mut().zip(there.columns()) {
            let unit: Vec<f64> = column.iter().copied().collect();
            let at = OperatingPoint { control_volt: &unit, outputs: &change };
            column.copy_from_slice(&self.aim_volt(step, at)?);
        }
        let gain = step.gain;
        iteration = iteration * gain + DMatrix::identity(controls, controls) * (1.0 - gain);
        Ok(spectral_radius(iteration))
    }

    /// Where a step aims at from a measurement, the whole way, volt.
    pub(super) fn aim_volt(
        &self,
        step: RelaxedStep,
        at: OperatingPoint<'_>,
    ) -> Result<Vec<f64>, ControlError> {
        let target = self.modal_target(at)?;
        let proximal = Proximal { weight: step.rate_weight, control_volt: at.control_volt };
        if step.flap_survival < 1.0 {
            return self.aim_of_flaps_that_may_fail(step, &target, proximal);
        }
        Ok(self.optimum_near(step.rho, &target, proximal))
    }

    /// The same where the flaps lean less on each other.
    fn aim_of_flaps_that_may_fail(
        &self,
        step: RelaxedStep,
        target: &DVector<f64>,
        proximal: Proximal<'_>,
    ) -> Result<Vec<f64>, ControlError> {
        let mut form = self.quadratic(step.rho, target);
        let width = step.controls_of_flap.max(1);
        for (j, mut column) in form.hessian.column_iter_mut().enumerate() {
            for (i, value) in column.iter_mut().enumerate() {
                *value *= if i / width == j / width { 1.0 } else { step.flap_survival };
            }
        }
        let Quadratic { hessian, linear } = form.with(proximal);
        let least = hessian.amax() * f64::EPSILON * hessian.nrows() as f64;
        let found = match hessian.clone().cholesky() {
            Some(factors) => factors.solve(&-linear),
            // a control that does nothing stays at 0
            None => hessian
                .svd(true, true)
                .solve(&-linear, least)
                .map_err(|_| ControlError::NoAuthority)?,
        };
        Ok(found.iter().copied().collect())
    }
}

/// Powers of two of a matrix whose norm gives its radius: those of a matrix far from normal are close by then.
const SQUARINGS: u32 = 40;

/// Largest eigenvalue in size, from Gelfand's formula `lim |M^k|^(1/k)`: it needs no eigenvalues, which a nearly exact T
/// has all but equal.
fn spectral_radius(mut matrix: DMatrix<f64>) -> f64 {
    let (mut log, mut share) = (0.0, 1.0);
    for _ in 0..SQUARINGS {
        let norm = matrix.norm();
        if norm == 0.0 {
            return 0.0;
        }
        log += share * norm.ln();
        share *= 0.5;
        matrix /= norm;
        matrix = &matrix * &matrix;
    }
    log.exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LoadWeights;

    /// Directions of one authority each: a weight `s` of the change leaves `1 - gain c / (c + s)` of an error.
    #[test]
    fn a_weighted_change_slows_the_loop_as_theory_says() {
        let column = |j: usize| (0..6).map(|i| if i == j { 2.0 } else { 0.0 }).collect();
        let t = TMatrix::from_columns(&(0..4).map(column).collect::<Vec<Vec<f64>>>()).unwrap();
        let law = FeedbackLaw::new(&t, &LoadWeights::Identity).unwrap();
        for (rho, rate_weight, gain) in [(0.0, 0.0, 0.5), (0.0, 4.0, 0.5), (1.0, 3.0, 1.0)] {
            let step = RelaxedStep { rho, rate_weight, ..RelaxedStep::of_gain(gain) };
            let found = law.relaxed_spectral_radius(step, &t).unwrap();
            let exact = 1.0 - gain * (4.0 + rho) / (4.0 + rho + rate_weight);
            assert!((found - exact).abs() < 1e-12, "{step:?}: {found} {exact}");
        }
        let wrong = RelaxedStep { rate_weight: -1.0, ..RelaxedStep::of_gain(0.5) };
        assert!(law.relaxed_spectral_radius(wrong, &t).is_err());
        let never = RelaxedStep { flap_survival: 0.0, ..RelaxedStep::of_gain(0.5) };
        assert!(law.relaxed_spectral_radius(never, &t).is_err());
    }

    /// Two flaps with one control each of the same loads, in unison: the sum of their voltages is the error that a wrong gain
    /// leaves, and `q` makes two flaps weigh `1 + q`. Exact: `1 - gain - gain (gamma - 1) 2 / (1 + q)`.
    #[test]
    fn flaps_that_may_fail_slow_the_loop_as_theory_says() {
        let column: Vec<f64> = (0..6).map(|i| f64::from(i) - 2.0).collect();
        let t = TMatrix::from_columns(&[column.clone(), column]).unwrap();
        let law = FeedbackLaw::new(&t, &LoadWeights::Identity).unwrap();
        // two columns of length sqrt(19) that are the same
        assert!((law.singular_values()[0] - 38.0_f64.sqrt()).abs() < 1e-12);
        for (flap_survival, stronger) in [(0.9, 1.0), (0.9, 4.0), (0.5, 5.0)] {
            let step = RelaxedStep { flap_survival, ..RelaxedStep::of_gain(0.5) };
            let there = t.turned(stronger, 0.0).unwrap();
            let found = law.relaxed_spectral_radius(step, &there).unwrap();
            let exact = 0.5 - (stronger - 1.0) / (1.0 + flap_survival);
            assert!((found - exact.abs().max(0.5)).abs() < 1e-9, "{step:?}: {found} {exact}");
        }
    }

    /// A T wrong by a complex factor: the radius is known.
    #[test]
    fn a_wrong_gain_and_phase_give_the_factor_of_theory() {
        let column = |j: usize| -> Vec<f64> {
            (0..6).map(|i| (0.8 * f64::from(i) + 1.3 * j as f64).sin() + 0.1 * j as f64).collect()
        };
        let columns: Vec<Vec<f64>> = (0..4).map(column).collect();
        let t0 = TMatrix::from_columns(&columns).unwrap();
        let law = FeedbackLaw::new(&t0, &LoadWeights::Identity).unwrap();
        for (gain, phase_deg) in [(1.0, 0.0), (0.7, 0.0), (1.0, 40.0), (1.2, -75.0)] {
            let (sin, cos) = f64::to_radians(phase_deg).sin_cos();
            let there = t0.turned(gain, f64::to_radians(phase_deg)).unwrap();
            let found = law.iteration_spectral_radius(0.0, &there).unwrap();
            let exact = f64::hypot(1.0 - gain * cos, gain * sin);
            assert!((found - exact).abs() < 1e-10, "{gain} {phase_deg}: {found} {exact}");
        }
    }
}
