//! Sweeps until the geometry stays, and what is worth a warning about it.

use super::{CirculationMap, FreeWake};
use crate::WakeError;
use crate::vector::{Vec3, dot, norm, scale, sub};

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

/// The nearest approach of a rolled-up vortex to a blade that did not just release it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestPassage {
    /// Azimuth of the blade met, rad.
    pub azimuth_rad: f64,
    /// Station of the blade, unit `R`.
    pub station: f64,
    /// Age of the vortex, rad.
    pub age_rad: f64,
    /// Distance, unit `R`.
    pub distance: f64,
    /// Core radius at release, unit `R`: closer than that, the strength of the interaction is decided by
    /// the core.
    pub core_radius: f64,
}

impl ClosestPassage {
    /// Whether the vortex passes the blade closer than its core.
    pub fn within_core(&self) -> bool {
        self.distance < self.core_radius
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

    /// The nearest approach of a rolled-up vortex, behind the near wake, to a blade.
    pub fn closest_passage(&self) -> Option<ClosestPassage> {
        let step = self.settings.step_rad();
        let first = self.settings.near_steps().min(self.settings.azimuths / 8).max(1);
        let mut least: Option<ClosestPassage> = None;
        for phase in 0..self.phases() {
            for met in self.blade_azimuths(phase) {
                let line = self.lines.at(met);
                for from in self.blade_azimuths(phase) {
                    for f in &self.far {
                        for (k, p) in f.at(from).iter().enumerate().skip(first) {
                            let (distance, station) = distance_to_line(*p, line);
                            if least.is_none_or(|l| distance < l.distance) {
                                least = Some(ClosestPassage {
                                    azimuth_rad: met as f64 * step,
                                    station,
                                    age_rad: k as f64 * step,
                                    distance,
                                    core_radius: self.settings.core.radius,
                                });
                            }
                        }
                    }
                }
            }
        }
        least
    }
}

/// Distance of a point to the straight line between the ends of a blade, and the station of its foot.
fn distance_to_line(p: Vec3, line: &[Vec3]) -> (f64, f64) {
    let (Some(&root), Some(&tip)) = (line.first(), line.last()) else {
        return (f64::INFINITY, 0.0);
    };
    let along = sub(tip, root);
    let t = (dot(sub(p, root), along) / dot(along, along)).clamp(0.0, 1.0);
    let foot = crate::vector::add(root, scale(along, t));
    (norm(sub(p, foot)), norm(foot))
}
