//! Stability of the blade's periodic response.

use crate::{Condition, ResponseError, RotorSolution, RotorSolver};
use nalgebra::Complex;
use rotor_fem::{Floquet, ModeKind, PeriodicSystem};

/// One motion of the blade about its periodic response, `e^(s psi) p(psi)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BladeMotion {
    /// Factor by which the motion grows and turns in one revolution.
    pub multiplier: Complex<f64>,
    /// Real part of `s`, per rad of azimuth; negative when the motion dies out.
    pub growth_per_rad: f64,
    /// Frequency, per rev, 0 to 0.5: known up to whole numbers and sign.
    pub frequency_per_rev: f64,
    /// That of the frequencies `n +- frequency_per_rev`, n whole, with which the motion comes nearest to
    /// the leading mode, per rev: its `|s|` to the mode's undamped frequency.
    pub modal_frequency_per_rev: f64,
    /// Family of the mode shape that leads the motion.
    pub kind: ModeKind,
    /// Its number in the family, from 1.
    pub number: usize,
}

impl BladeMotion {
    /// Damping over critical, `-Re s / |s|` at [`Self::modal_frequency_per_rev`]; negative when the motion
    /// grows.
    pub fn damping_ratio(&self) -> f64 {
        let size = self.growth_per_rad.hypot(self.modal_frequency_per_rev);
        if size > 0.0 { -self.growth_per_rad / size } else { 0.0 }
    }
}

/// Of the frequencies `n +- frequency`, n whole, that whose exponent is nearest in size to a natural
/// frequency. Unit: per rev, growth per rad of azimuth.
fn nearest_frequency(growth: f64, frequency: f64, natural: f64) -> f64 {
    let mut best = frequency;
    let mut n = 0.0;
    while n <= natural.ceil() + 1.0 {
        for candidate in [n - frequency, n + frequency] {
            let distance = |f: f64| (growth.hypot(f) - natural).abs();
            if candidate >= 0.0 && distance(candidate) < distance(best) {
                best = candidate;
            }
        }
        n += 1.0;
    }
    best
}

/// What the lags of the sections do while the blade moves about its orbit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SectionLags {
    /// They move with the blade.
    #[default]
    Moving,
    /// They are settled at every azimuth: the circulation follows the motion without delay.
    Settled,
}

/// Floquet exponents of one blade in flight.
///
/// One blade is disturbed, the inflow stays as it is, and the lag states of the sections move with the blade: the
/// motions are those of structure and lags together (of attached sections; over tables and with dynamic stall, and at
/// stations whose flow turns round inside a time element, the lags are settled). Blades couple through the hub and the inflow,
/// which is not part of it: air resonance and flap-lag of a moving hub are not seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Stability {
    /// The motions, least stable first.
    pub motions: Vec<BladeMotion>,
}

impl Stability {
    /// The motion with the least damping over critical: what a reader asks for first. The fast torsion
    /// motions die out in fewer radians than slow ones of the same damping.
    pub fn least_damped(&self) -> Option<&BladeMotion> {
        self.motions.iter().min_by(|a, b| a.damping_ratio().total_cmp(&b.damping_ratio()))
    }

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
    /// The tangents of the Newton matrix at the converged orbit and the lags of the sections, carried over one
    /// revolution ([`Floquet::of`](rotor_fem::Floquet::of)).
    ///
    /// # Errors
    /// [`ResponseError::FlapMotions`], and [`ResponseError::Fem`] if the monodromy matrix cannot be made.
    pub fn stability(
        &self,
        condition: &Condition,
        solution: &RotorSolution,
    ) -> Result<Stability, ResponseError> {
        self.stability_with(condition, solution, SectionLags::Moving)
    }

    /// The same with lags as asked for.
    ///
    /// # Errors
    /// As [`Self::stability`].
    pub fn stability_with(
        &self,
        condition: &Condition,
        solution: &RotorSolution,
        lags: SectionLags,
    ) -> Result<Stability, ResponseError> {
        self.check_flaps(&condition.flap_angles_rad)?;
        let points = self.point_inputs(condition, &solution.inflow);
        let system = self.rotor.system(&self.air, points);
        let samples = solution.orbit.sample(&self.time);
        let tangents = system.tangents(&samples)?;
        let places = match lags {
            SectionLags::Moving => system.lag_places(&samples),
            SectionLags::Settled => Vec::new(),
        };
        let blade = self.rotor.blade();
        let motions = Floquet::of(&self.time, system.mass, &tangents, &places)?
            .modes
            .iter()
            .map(|mode| {
                let (kind, number) = blade.mode(mode.leading_dof);
                let natural = blade.frequencies[mode.leading_dof];
                let (growth, frequency) = (mode.growth_per_rad, mode.frequency_per_rev);
                BladeMotion {
                    multiplier: mode.multiplier,
                    modal_frequency_per_rev: nearest_frequency(growth, frequency, natural),
                    growth_per_rad: growth,
                    frequency_per_rev: frequency,
                    kind,
                    number,
                }
            })
            .collect();
        Ok(Stability { motions })
    }
}
