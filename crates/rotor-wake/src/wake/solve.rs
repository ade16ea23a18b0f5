//! Sweeps until the geometry stays.

use super::FreeWake;
use crate::CirculationMap;
use crate::WakeError;

/// A displacement this many times the smallest so far means that the iteration runs away.
const RUNAWAY: f64 = 30.0;

/// How a geometry was reached.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WakeConvergence {
    /// RMS displacement of every sweep, unit `R`.
    pub history: Vec<f64>,
}

impl WakeConvergence {
    /// Sweeps done.
    pub fn iterations(&self) -> usize {
        self.history.len()
    }

    /// RMS displacement of the last sweep, unit `R`.
    pub fn displacement(&self) -> f64 {
        self.history.last().copied().unwrap_or(f64::INFINITY)
    }
}

impl FreeWake {
    /// Sweeps with a given circulation until the RMS displacement is below the tolerance.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid; [`WakeError::WakeLost`] and
    /// [`WakeError::WakeDiverged`] if it runs away, [`WakeError::WakeNotSettled`] after the last
    /// iteration allowed. The wake is then the best geometry met.
    pub fn solve(&mut self, circulation: &CirculationMap) -> Result<WakeConvergence, WakeError> {
        let mut convergence = WakeConvergence::default();
        let mut best: Option<(f64, Self)> = None;
        let most = self.settings.max_iterations;
        let tolerance = self.settings.tolerance;
        for iteration in 1..=most {
            let displacement = match self.sweep(circulation) {
                Ok(displacement) => displacement,
                Err(error) => {
                    if let Some((_, wake)) = best {
                        *self = wake;
                    }
                    return Err(error);
                }
            };
            convergence.history.push(displacement);
            if displacement <= tolerance {
                return Ok(convergence);
            }
            let least = best.as_ref().map_or(f64::INFINITY, |b| b.0);
            if displacement < least {
                best = Some((displacement, self.clone()));
            } else if displacement > RUNAWAY * least && displacement > 0.05 {
                if let Some((_, wake)) = best {
                    *self = wake;
                }
                return Err(WakeError::WakeDiverged { iteration, displacement, least });
            }
        }
        let least = best.as_ref().map_or(f64::INFINITY, |b| b.0);
        if let Some((_, wake)) = best {
            *self = wake;
        }
        Err(WakeError::WakeNotSettled { iterations: most, displacement: least, tolerance })
    }
}
