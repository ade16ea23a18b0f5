//! Where the wake lies without free motion, and the same wake on another grid.

use super::FreeWake;
use super::filament::Filament;
use super::settings::{FreeWakeSettings, NearWakeMotion};
use crate::WakeError;
use crate::vector::{Vec3, add, scale, sub};
use crate::{BladeLines, WakeRotor};
use rayon::prelude::*;

impl FreeWake {
    /// The same wake on another number of azimuth steps: the start of the next stage of a sequence of grids.
    ///
    /// # Errors
    /// As [`Self::remade`].
    pub fn on_grid(&self, azimuths: usize, lines: BladeLines) -> Result<Self, WakeError> {
        self.remade(self.rotor.clone(), self.settings.with_azimuths(azimuths), lines)
    }

    /// A wake of other panels, settings and lifting lines with the distortion of this one against undistorted helices,
    /// interpolated linearly along azimuth and age; rolled-up vortices that this one has not are undistorted.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] if the settings do not suit the rotor.
    pub fn remade(
        &self,
        rotor: WakeRotor,
        settings: FreeWakeSettings,
        lines: BladeLines,
    ) -> Result<Self, WakeError> {
        let mut out = Self::undistorted(rotor, settings, self.flight, self.carrying_inflow, lines)?;
        let (before, azimuths) = (self.settings.azimuths, out.settings.azimuths);
        let helix = out.clone();
        let take_over = |new: &mut Filament, old: &Filament| {
            let distortion = |i: usize, k: usize| {
                let (i, k) = (i % before, k.min(old.steps));
                sub(old.at(i)[k], self.carried(old.node, i, k))
            };
            let node = new.node;
            new.fill(azimuths, |i, k| {
                add(helix.carried(node, i, k), sampled(distortion, [i, k], before, azimuths))
            });
        };
        for (new, all) in [(&mut out.far, &self.far), (&mut out.near, &self.near)] {
            for new in new {
                if let Some(old) = all.iter().find(|old| old.node == new.node) {
                    take_over(new, old);
                }
            }
        }
        out.place_near_wake();
        Ok(out)
    }

    /// Point that node `node` released `k` steps before azimuth `i`, carried undistorted.
    pub(crate) fn carried(&self, node: usize, i: usize, k: usize) -> Vec3 {
        let azimuths = self.settings.azimuths;
        let release = self.lines.edge_at((i + azimuths - k % azimuths) % azimuths)[node];
        add(release, self.wind_over(k))
    }

    /// How far the free stream and the mean inflow carry within `k` steps.
    pub(super) fn wind_over(&self, k: usize) -> Vec3 {
        let wind = sub(self.free_stream(), [0.0, 0.0, self.carrying_inflow]);
        scale(wind, k as f64 * self.settings.step_rad())
    }

    /// Puts the near wake where its motion is prescribed.
    pub(crate) fn place_near_wake(&mut self) {
        let azimuths = self.settings.azimuths;
        let motion = self.settings.near_wake_motion;
        let mut near = std::mem::take(&mut self.near);
        near.par_iter_mut().for_each(|filament| {
            let before = filament.clone();
            filament.fill(azimuths, |i, k| match motion {
                // a free one keeps its shape but for the release
                NearWakeMotion::Free if k > 0 => before.at(i)[k],
                NearWakeMotion::BladePlane => self.swept(before.node, i, k),
                NearWakeMotion::FollowsTip => self.following(before.node, i, k),
                _ => self.carried(before.node, i, k),
            });
        });
        self.near = near;
    }

    /// The carried point moved by its share of the distortion of the tip vortex.
    fn following(&self, node: usize, i: usize, k: usize) -> Vec3 {
        let carried = self.carried(node, i, k);
        match self.far.last() {
            Some(tip) if k <= tip.steps => {
                let azimuths = self.settings.azimuths;
                let released = tip.at((i + azimuths - k % azimuths) % azimuths)[0];
                let moved = sub(tip.at(i)[k], add(released, self.wind_over(k)));
                add(carried, scale(moved, self.rotor.nodes()[node]))
            }
            _ => carried,
        }
    }

    /// The arc behind a blade at azimuth `i` on which its node would come back by `k` steps.
    fn swept(&self, node: usize, i: usize, k: usize) -> Vec3 {
        self.swept_back(self.lines.edge_at(i)[node], k)
    }

    /// A place on a blade turned back by `k` steps.
    pub(super) fn swept_back(&self, [x, y, z]: Vec3, k: usize) -> Vec3 {
        let (sin, cos) = (k as f64 * self.settings.step_rad()).sin_cos();
        [x * cos + y * sin, y * cos - x * sin, z]
    }
}

/// Value of a function of azimuth and age on another grid, linear between its nodes; grids by their azimuth steps.
fn sampled(
    value: impl Fn(usize, usize) -> Vec3,
    [i, k]: [usize; 2],
    before: usize,
    now: usize,
) -> Vec3 {
    let [(p, s), (z, t)] =
        [i, k].map(|n| (n * before / now, (n * before % now) as f64 / now as f64));
    let mix = |a: Vec3, b: Vec3, t: f64| add(scale(a, 1.0 - t), scale(b, t));
    mix(mix(value(p, z), value(p, z + 1), t), mix(value(p + 1, z), value(p + 1, z + 1), t), s)
}
