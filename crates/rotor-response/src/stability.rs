//! Stability of the blade's periodic response.

use crate::{Condition, ResponseError, RotorSolution, RotorSolver};
use rotor_fem::{Floquet, ModeKind, PeriodicSystem};

/// One motion of the blade about its periodic response, `e^(s psi) p(psi)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BladeMotion {
    /// Real part of `s`, per rad of azimuth; negative when the motion dies out.
    pub growth_per_rad: f64,
    /// Frequency, per rev, 0 to 0.5: known up to whole numbers and sign.
    pub frequency_per_rev: f64,
    /// Family of the mode shape that leads the motion.
    pub kind: ModeKind,
    /// Its number in the family, from 1.
    pub number: usize,
}

/// Floquet exponents of one blade in flight.
///
/// One blade is disturbed, the inflow stays as it is and the circulation follows the motion without
/// delay (the lag states of the sections are settled). Blades couple through the hub and the inflow,
/// which is not part of it: air resonance and flap-lag of a moving hub are not seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Stability {
    /// The motions, least stable first.
    pub motions: Vec<BladeMotion>,
}

impl Stability {
    /// The least stable motion.
    pub fn least_stable(&self) -> Option<&BladeMotion> {
        self.motions.first()
    }

    /// Whether every motion dies out.
    pub fn is_stable(&self) -> bool {
        self.motions.iter().all(|m| m.growth_per_rad < 0.0)
    }
}

impl RotorSolver {
    /// Stability of a solution of this solver, obtained in `condition`.
    ///
    /// The tangents of the Newton matrix at the converged orbit, carried over one revolution
    /// ([`Floquet`](rotor_fem::Floquet)).
    ///
    /// # Errors
    /// [`ResponseError::FlapMotions`], and [`ResponseError::Fem`] if the monodromy matrix cannot be made.
    pub fn stability(
        &self,
        condition: &Condition,
        solution: &RotorSolution,
    ) -> Result<Stability, ResponseError> {
        let (given, expected) = (condition.flap_angles_rad.len(), self.rotor.model().flaps.len());
        if given != expected {
            return Err(ResponseError::FlapMotions { given, expected });
        }
        let points = self.point_inputs(condition, &solution.inflow);
        let system = self.rotor.system(&self.air, points);
        let tangents = system.tangents(&solution.orbit.sample(&self.time))?;
        let blade = self.rotor.blade();
        let motions = Floquet::of(&self.time, system.mass, &tangents)?
            .modes()
            .iter()
            .map(|mode| {
                let (kind, number) = blade.mode(mode.leading_dof);
                BladeMotion {
                    growth_per_rad: mode.growth_per_rad,
                    frequency_per_rev: mode.frequency_per_rev,
                    kind,
                    number,
                }
            })
            .collect();
        Ok(Stability { motions })
    }
}
