//! Where vortices pass the blades, and what the segments of the wake carry.

use super::FreeWake;
use super::filament::Filament;
use super::sources::SourceContext;
use crate::CirculationMap;
use crate::WakeError;
use crate::vector::{Vec3, add, dot, norm, scale, sub};
use rayon::prelude::*;

/// The nearest approach of a tip vortex or another rolled-up vortex to a blade that did not just release it.
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
    /// Core radius there as the blade feels it, unit `R`: closer than that, the strength of the interaction is decided by
    /// the core.
    pub core_radius: f64,
}

impl ClosestPassage {
    /// Whether the vortex passes the blade closer than its core.
    pub fn within_core(&self) -> bool {
        self.distance < self.core_radius
    }
}

/// What a segment of the wake carries, as the blades feel it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SegmentState {
    /// Circulation in the right-hand sense about the direction of growing age, `Omega R^2`.
    pub circulation: f64,
    /// Core radius, unit `R`.
    pub core_radius: f64,
}

/// States of the segments of one filament, `[azimuth][age]`, one less than its nodes.
pub type FilamentStates = Vec<Vec<SegmentState>>;

impl FreeWake {
    /// The nearest approach of a rolled-up vortex to a blade, between segments and panels, at the azimuths of the grid; on
    /// the wake of the blade itself from an age of 45 deg on. What is younger than the near wake counts with the core of
    /// its trailers.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid.
    pub fn closest_passage(
        &self,
        circulation: &CirculationMap,
    ) -> Result<Option<ClosestPassage>, WakeError> {
        self.check(circulation)?;
        let context = self.context(circulation, self.turn());
        let phases = 0..self.phases_that_differ();
        let met = phases.flat_map(|phase| {
            let blades = self.blade_azimuths(phase).take(self.blades_that_differ());
            blades.flat_map(move |met| self.blade_azimuths(phase).map(move |from| (met, from)))
        });
        let met: Vec<(usize, usize)> = met.collect();
        let closest = |(met, from)| self.closest_of(met, from, &context);
        let all: Vec<Option<ClosestPassage>> = met.into_par_iter().map(closest).collect();
        Ok(all.into_iter().flatten().min_by(|a, b| a.distance.total_cmp(&b.distance)))
    }

    /// The same for the blade at one azimuth and the vortices of that at another.
    fn closest_of(
        &self,
        met: usize,
        from: usize,
        context: &SourceContext<'_>,
    ) -> Option<ClosestPassage> {
        let step = self.settings.step_rad();
        let first = if met == from { (self.settings.azimuths / 8).max(1) } else { 0 };
        let line = self.lines.at(met);
        let segments = self.far.iter().enumerate().flat_map(|(f, filament)| {
            let segments = filament.at(from).windows(2).enumerate().skip(first);
            segments.map(move |(k, ends)| (f, k, [ends[0], ends[1]]))
        });
        let pairs = segments.flat_map(|(f, k, ends)| {
            line.windows(2).map(move |panel| (f, k, segment_distance(ends, [panel[0], panel[1]])))
        });
        let (f, k, (distance, part, foot)) = pairs.min_by(|a, b| a.2.0.total_cmp(&b.2.0))?;
        let core_radius = if k < self.settings.near_steps() {
            context.trailer_radius(self.far[f].node, self.periodic(from), k)
        } else {
            context.rolled_up_radius(f, self.periodic(from), k)
        };
        Some(ClosestPassage {
            azimuth_rad: met as f64 * step,
            station: norm(foot),
            age_rad: (k as f64 + part) * step,
            distance,
            core_radius,
        })
    }

    /// Circulation and core radius of the segments of every rolled-up vortex, in the order of
    /// [`vortices`](Self::vortices).
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid.
    pub fn vortex_states(
        &self,
        circulation: &CirculationMap,
    ) -> Result<Vec<FilamentStates>, WakeError> {
        self.check(circulation)?;
        let context = self.context(circulation, self.turn());
        Ok(self.states_of(&self.far, |f, i, k| SegmentState {
            circulation: context.rolled_up_strength(f, self.periodic(i), k),
            core_radius: context.rolled_up_radius(f, self.periodic(i), k),
        }))
    }

    /// The same of the trailers of the near wake, in the order of [`near_wake`](Self::near_wake).
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid.
    pub fn trailer_states(
        &self,
        circulation: &CirculationMap,
    ) -> Result<Vec<FilamentStates>, WakeError> {
        self.check(circulation)?;
        let context = self.context(circulation, self.turn());
        Ok(self.states_of(&self.near, |n, i, k| SegmentState {
            circulation: context.trailer_strength(n, self.periodic(i), k),
            core_radius: context.trailer_radius(n, self.periodic(i), k),
        }))
    }

    /// States of the segments of some filaments by number of the filament, azimuth and age.
    fn states_of(
        &self,
        filaments: &[Filament],
        state: impl Fn(usize, usize, usize) -> SegmentState,
    ) -> Vec<FilamentStates> {
        let of = |(f, filament): (usize, &Filament)| {
            let row = |i: usize| (0..filament.steps).map(|k| state(f, i, k)).collect();
            (0..self.settings.azimuths).map(row).collect()
        };
        filaments.iter().enumerate().map(of).collect()
    }
}

/// Distance of two straight segments, the part of the way along the first and the point of the second where it is.
fn segment_distance([a0, a1]: [Vec3; 2], [b0, b1]: [Vec3; 2]) -> (f64, f64, Vec3) {
    let (u, v, w) = (sub(a1, a0), sub(b1, b0), sub(a0, b0));
    let (uu, uv, vv, uw, vw) = (dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w));
    let part = |x: f64| if x.is_finite() { x.clamp(0.0, 1.0) } else { 0.0 };
    let along_b = |s: f64| part((vw + s * uv) / vv);
    // where the lines are nearest, the other end held to its segment, and back
    let s = part((uv * vw - vv * uw) / (uu * vv - uv * uv));
    let t = along_b(s);
    let s = part((t * uv - uw) / uu);
    let t = along_b(s);
    let foot = add(b0, scale(v, t));
    (norm(sub(add(a0, scale(u, s)), foot)), s, foot)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the least of many pairs of points.
    #[test]
    fn segments_are_as_far_as_their_nearest_points() {
        let pairs: [([Vec3; 2], [Vec3; 2]); 6] = [
            ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[0.3, -1.0, 0.2], [0.4, 1.0, 0.1]]),
            ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[0.0, 0.5, 0.0], [1.0, 0.5, 0.0]]),
            ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[1.5, 0.5, 0.0], [2.0, 3.0, 1.0]]),
            ([[0.0, 0.0, 0.0], [1.0, 0.2, 0.1]], [[-1.0, -1.0, 0.0], [0.9, 0.1, 0.4]]),
            ([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[0.0, 1.0, -1.0], [0.0, 1.0, 1.0]]),
            ([[0.2, 0.9, 0.3], [0.5, -0.3, 0.3]], [[2.0, -0.9, 0.0], [0.6, -0.8, 0.1]]),
        ];
        for (a, b) in pairs {
            const N: usize = 400;
            let at = |[from, to]: [Vec3; 2], k: usize| {
                add(from, scale(sub(to, from), k as f64 / N as f64))
            };
            let mut least = f64::INFINITY;
            for j in 0..=N {
                for k in 0..=N {
                    least = least.min(norm(sub(at(a, j), at(b, k))));
                }
            }
            let (distance, ..) = segment_distance(a, b);
            assert!((least - 4e-3..=least + 1e-12).contains(&distance), "{distance} {least}");
        }
    }
}
