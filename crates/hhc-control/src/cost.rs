//! The quadratic cost, eq. (7).

use crate::{ControlError, error};

/// The load weights `W_Z`.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadWeights {
    /// `W_Z = I` on the nondimensional loads.
    Identity,
    /// `W_Z = diag(w)`, each `w >= 0`, one per load (cosine and sine separately).
    Diagonal(Vec<f64>),
}

impl LoadWeights {
    /// Weight of each of `count` loads.
    ///
    /// # Errors
    /// [`ControlError::Length`] or [`ControlError::OutOfRange`] for a diagonal of the wrong length or
    /// with a negative or non-finite weight.
    pub fn diagonal(&self, count: usize) -> Result<Vec<f64>, ControlError> {
        match self {
            Self::Identity => Ok(vec![1.0; count]),
            Self::Diagonal(weights) => {
                error::check_vector("load weights", weights, count)?;
                for &weight in weights {
                    error::check_not_negative("load weight", weight)?;
                }
                Ok(weights.clone())
            }
        }
    }
}

/// The cost and its two parts.
///
/// ```text
/// J = J_Z + J_u,   J_Z = Z' W_Z Z,   J_u = rho u' u
/// ```
/// Source: eq. (7) with `W_u = rho I`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// `J_Z`, nondimensional load squared.
    pub loads: f64,
    /// `J_u`, same unit.
    pub control: f64,
}

impl Cost {
    /// Cost of loads `Z` (nondimensional) and control `u` (volt).
    ///
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `hub_loads` | `Z` | nondimensional | one per weight |
    /// | `load_weights` | diagonal of `W_Z` | - | >= 0 |
    /// | `control_volt` | `u` | volt | |
    /// | `rho` | `rho` | 1/V^2 | >= 0 |
    pub fn of(hub_loads: &[f64], load_weights: &[f64], control_volt: &[f64], rho: f64) -> Self {
        Self {
            loads: hub_loads.iter().zip(load_weights).map(|(z, w)| w * z * z).sum(),
            control: rho * control_volt.iter().map(|u| u * u).sum::<f64>(),
        }
    }

    /// `J = J_Z + J_u`.
    pub fn total(self) -> f64 {
        self.loads + self.control
    }
}

/// Reduction of the load cost, percent, without the control term.
///
/// ```text
/// 100 (1 - J_Z / J_Z0)
/// ```
/// `J_Z` is quadratic: a 50 % fall of every load is a 75 % reduction. Zero if there was nothing to
/// reduce and nothing was added.
pub fn reduction_percent(loads_cost_before: f64, loads_cost_after: f64) -> f64 {
    if loads_cost_before == 0.0 && loads_cost_after == 0.0 {
        0.0
    } else {
        100.0 * (1.0 - loads_cost_after / loads_cost_before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn cost_adds_its_parts() {
        let cost = Cost::of(&[1.0, -2.0], &[3.0, 0.5], &[2.0], 0.25);
        assert_abs_diff_eq!(cost.loads, 5.0, epsilon = 1e-15);
        assert_abs_diff_eq!(cost.control, 1.0, epsilon = 1e-15);
        assert_abs_diff_eq!(cost.total(), 6.0, epsilon = 1e-15);
    }

    #[test]
    fn halving_every_load_is_a_reduction_of_75_percent() {
        let (before, after) = ([0.4, -0.2, 0.1], [0.2, -0.1, 0.05]);
        let weights = LoadWeights::Diagonal(vec![1.0, 2.0, 5.0]).diagonal(3).unwrap();
        let cost = |z: &[f64]| Cost::of(z, &weights, &[], 0.0).loads;
        assert_abs_diff_eq!(reduction_percent(cost(&before), cost(&after)), 75.0, epsilon = 1e-12);
        assert_abs_diff_eq!(reduction_percent(0.0, 0.0), 0.0);
        assert!(reduction_percent(1.0, 3.75) < -270.0);
    }

    #[test]
    fn impossible_weights_are_refused() {
        for weights in [vec![1.0], vec![1.0, -1.0], vec![1.0, f64::NAN]] {
            assert!(LoadWeights::Diagonal(weights).diagonal(2).is_err());
        }
    }
}
