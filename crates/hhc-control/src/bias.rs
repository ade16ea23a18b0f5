//! The bias voltage that keeps the mean flap angle zero.

use crate::root::{Bracketed, Trial, root_between};
use crate::{ControlError, RunError, error};

/// Finds the steady voltage `u_st` of one actuator for which the mean flap angle vanishes.
///
/// ```text
/// mean over one period of delta[u_st + sum_N (u_Nc cos N psi + u_Ns sin N psi)] = 0
/// ```
/// With hysteresis the mean angle is not that of the mean voltage, so `u_st` changes with every
/// control vector and is solved anew; it is not a control.
///
/// Assumes: the mean angle is a monotone function of the bias, rising or falling.
/// Source: eq. (6).
#[derive(Debug, Clone, PartialEq)]
pub struct BiasSolver {
    /// Lowest and highest bias allowed, volt.
    pub range_volt: [f64; 2],
    /// Where to start, volt: the bias of a similar control.
    pub guess_volt: f64,
    /// Estimate of the change of mean angle with bias, degrees per volt, not zero.
    pub slope_deg_per_volt: f64,
    /// Largest mean angle accepted, degrees, positive.
    pub tolerance_deg: f64,
}

/// A bias and what it leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BiasSolution {
    /// The bias `u_st`, volt.
    pub bias_volt: f64,
    /// The mean flap angle left, degrees.
    pub mean_flap_deg: f64,
    /// How often the mean angle was asked for.
    pub evaluations: usize,
}

impl BiasSolver {
    /// The bias, from the mean flap angle (degrees) as a function of the bias (volt).
    ///
    /// # Errors
    /// [`ControlError::BiasOutOfRange`] if the mean angle does not change sign in the range,
    /// [`ControlError::BiasJump`] if it jumps over zero, a refused setting, or the actuator's own
    /// error.
    pub fn solve<E: std::error::Error + 'static>(
        &self,
        mut mean_flap_deg: impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<BiasSolution, RunError<E>> {
        self.check()?;
        let [low_volt, high_volt] = self.range_volt;
        let mut evaluations = 0;
        let mut trial = |x: f64| -> Result<Trial<()>, RunError<E>> {
            evaluations += 1;
            let f =
                mean_flap_deg(x).map_err(RunError::plant("asked for its mean flap angle", &[x]))?;
            error::check_vector("mean flap angle (deg)", &[f], 1)?;
            Ok(Trial { x, f, state: () })
        };
        let good = |t: &Trial<()>| t.f.abs() <= self.tolerance_deg;

        let first = trial(self.guess_volt.clamp(low_volt, high_volt))?;
        // A step a quarter longer than the slope asks for brackets the root if the slope is fair.
        let step = -1.25 * first.f / self.slope_deg_per_volt;
        let aimed = (first.x + step).clamp(low_volt, high_volt);
        let ends = if step > 0.0 { [high_volt, low_volt] } else { [low_volt, high_volt] };
        let root = 'search: {
            if good(&first) {
                break 'search first;
            }
            for x in [aimed, ends[0], ends[1]] {
                let other = trial(x)?;
                if good(&other) {
                    break 'search other;
                }
                if other.f.is_sign_negative() != first.f.is_sign_negative() {
                    match root_between((first, other), self.tolerance_deg, &mut trial)? {
                        Bracketed::Root(root) => break 'search root,
                        Bracketed::Jump { negative, positive } => {
                            return Err(RunError::Control(ControlError::BiasJump {
                                bias_volt: negative.x,
                                below_deg: negative.f,
                                above_deg: positive.f,
                                tolerance_deg: self.tolerance_deg,
                            }));
                        }
                    }
                }
            }
            let (low_deg, high_deg) = (trial(low_volt)?.f, trial(high_volt)?.f);
            return Err(
                ControlError::BiasOutOfRange { low_volt, high_volt, low_deg, high_deg }.into()
            );
        };
        Ok(BiasSolution { bias_volt: root.x, mean_flap_deg: root.f, evaluations })
    }

    fn check(&self) -> Result<(), ControlError> {
        let [low, high] = self.range_volt;
        error::check_vector("bias range and guess (volt)", &[low, high, self.guess_volt], 3)?;
        error::check_positive("width of the bias range (volt)", high - low)?;
        error::check_positive("size of the bias slope (deg/V)", self.slope_deg_per_volt.abs())?;
        error::check_positive("tolerance on the mean flap angle (deg)", self.tolerance_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn solver() -> BiasSolver {
        BiasSolver {
            range_volt: [-20.0, 150.0],
            guess_volt: 65.0,
            slope_deg_per_volt: 10.0 / 85.0,
            tolerance_deg: 1e-6,
        }
    }

    /// An asymmetric, saturating mean angle.
    fn mean(bias_volt: f64) -> f64 {
        10.0 * ((bias_volt - 58.0) / 60.0).tanh() + 0.8
    }

    #[test]
    fn the_mean_angle_vanishes_in_few_evaluations() {
        let exact = 58.0 + 60.0 * (-0.08_f64).atanh();
        for guess_volt in [-20.0, 20.0, 65.0, 150.0] {
            for sign in [1.0, -1.0] {
                let slope_deg_per_volt = sign * 10.0 / 85.0;
                let solver = BiasSolver { guess_volt, slope_deg_per_volt, ..solver() };
                let found = solver.solve(|v| Ok::<_, Infallible>(sign * mean(v))).unwrap();
                assert!(found.mean_flap_deg.abs() <= 1e-6);
                assert!((found.bias_volt - exact).abs() < 1e-5);
                assert!(found.evaluations <= 9, "{}", found.evaluations);
            }
        }
    }

    #[test]
    fn a_wrong_slope_only_costs_evaluations() {
        for slope_deg_per_volt in [-1.0, 1e-4, 1e4] {
            let solver = BiasSolver { slope_deg_per_volt, ..solver() };
            assert!(solver.solve(|v| Ok::<_, Infallible>(mean(v))).is_ok());
        }
    }

    #[test]
    fn a_warm_start_costs_one_evaluation() {
        let cold = solver().solve(|v| Ok::<_, Infallible>(mean(v))).unwrap();
        let warm = BiasSolver { guess_volt: cold.bias_volt, ..solver() };
        assert_eq!(warm.solve(|v| Ok::<_, Infallible>(mean(v))).unwrap().evaluations, 1);
    }

    #[test]
    fn what_cannot_be_solved_is_said() {
        let one_sided = solver().solve(|v| Ok::<_, Infallible>(mean(v) + 30.0));
        assert!(matches!(one_sided, Err(RunError::Control(ControlError::BiasOutOfRange { .. }))));
        let jump = solver().solve(|v| Ok::<_, Infallible>(if v > 60.0 { 1.0 } else { -1.0 }));
        assert!(matches!(jump, Err(RunError::Control(ControlError::BiasJump { .. }))));
        let nan = solver().solve(|_| Ok::<_, Infallible>(f64::NAN));
        assert!(matches!(nan, Err(RunError::Control(ControlError::NotFinite { .. }))));
        let reversed = BiasSolver { range_volt: [150.0, -20.0], ..solver() };
        assert!(reversed.solve(|v| Ok::<_, Infallible>(mean(v))).is_err());
    }
}
