//! One sweep of pseudo-implicit relaxation.

use super::FreeWake;
use super::filament::rms_distance;
use super::settings::{FarField, FreeWakeSettings};
use super::sources::RollUp;
use super::velocity::Velocities;
use crate::CirculationMap;
use crate::WakeError;
use crate::vector::{Vec3, add, is_finite, scale, sub};

/// Ages of a rough sweep between which velocities are interpolated.
const ROUGH_STRIDE: usize = 2;

impl FreeWake {
    /// The geometry that the velocities carry the wake to.
    fn moved(&self, velocities: &Velocities, releases: &[Vec<Vec3>]) -> Self {
        let mut out = self.clone();
        let azimuths = self.settings.azimuths;
        let step = self.settings.step_rad();
        let stream = self.free_stream();
        for ((f, v), releases) in out.free_mut().zip(velocities).zip(releases) {
            for (i, release) in releases.iter().enumerate() {
                let at = f.index(i, 0);
                f.points[at] = *release;
            }
            for k in 1..=f.steps {
                for i in 0..azimuths {
                    let before = (i + azimuths - 1) % azimuths;
                    let corners = [(i, k), (before, k), (i, k - 1), (before, k - 1)];
                    let mut mean = [0.0; 3];
                    for (p, z) in corners {
                        mean = add(mean, v[f.index(p, z)]);
                    }
                    let by = scale(add(stream, scale(mean, 0.25)), step);
                    let at = f.index(i, k);
                    f.points[at] = add(f.points[f.index(before, k - 1)], by);
                }
            }
        }
        out
    }

    /// Where the free filaments are released, `[filament][azimuth]`.
    pub(super) fn releases(&self, circulation: &CirculationMap) -> Vec<Vec<Vec3>> {
        let azimuths = 0..self.settings.azimuths;
        let roll_up = RollUp::new(&self.settings.far, &self.rotor, circulation);
        let stations = roll_up.release_stations(self.settings.release, &self.rotor, circulation);
        let near = self
            .near
            .iter()
            .filter(|_| self.near_is_free())
            .map(|f| azimuths.clone().map(|i| self.lines.edge_at(i)[f.node]).collect());
        let far = stations.iter().map(|stations| {
            let places = stations.iter().enumerate();
            places.map(|(i, r)| self.lines.edge_between(i, &self.rotor, *r)).collect()
        });
        near.chain(far).collect()
    }

    /// Leaves the free nodes at a part of the way from another wake to this one.
    pub(super) fn draw_back(&mut self, from: &Self, part: f64) {
        for (here, there) in self.free_mut().zip(from.free()) {
            for (to, from) in here.points.iter_mut().zip(&there.points) {
                *to = add(*from, scale(sub(*to, *from), part));
            }
        }
        self.place_near_wake();
    }

    /// One predictor-corrector sweep; returns the RMS displacement of the free nodes, unit `R`.
    ///
    /// The predictor carries every node with the velocities of the geometry before, the corrector with a
    /// mean of these and of the velocities at the predicted geometry. On equal steps of azimuth and age:
    ///
    /// ```text
    /// r(psi, zeta) = r(psi - d, zeta - d) + d [V_inf + mean of v at the four corners]
    /// ```
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid; [`WakeError::WakeLost`] if a node left
    /// the numbers: the wake is then as it was before.
    pub fn sweep(&mut self, circulation: &CirculationMap) -> Result<f64, WakeError> {
        self.sweep_in_part(circulation, 1.0)
    }

    /// A sweep of a wake that is far from settled, at a third of the cost: velocities at every second age, those of old
    /// vortices in single precision.
    ///
    /// # Errors
    /// As [`sweep`](Self::sweep).
    pub fn rough_sweep(&mut self, circulation: &CirculationMap) -> Result<f64, WakeError> {
        let FreeWakeSettings { velocity_stride, far_field, .. } = self.settings;
        self.settings.velocity_stride = velocity_stride.max(ROUGH_STRIDE);
        self.settings.far_field = FarField::Single;
        let displacement = self.sweep(circulation);
        (self.settings.velocity_stride, self.settings.far_field) = (velocity_stride, far_field);
        displacement
    }

    /// A sweep of which the nodes go a part of the way, 0 to 1: it settles where whole sweeps go back and forth. Returns
    /// the RMS displacement of the whole way.
    ///
    /// # Errors
    /// As [`sweep`](Self::sweep).
    pub fn sweep_in_part(
        &mut self,
        circulation: &CirculationMap,
        part: f64,
    ) -> Result<f64, WakeError> {
        self.check(circulation)?;
        let first = self.velocities(circulation);
        let releases = self.releases(circulation);
        let predicted = self.moved(&first, &releases);
        let mut second = predicted.velocities(circulation);
        let weight = self.settings.relaxation;
        for (new, old) in second.iter_mut().flatten().zip(first.iter().flatten()) {
            *new = add(scale(*new, weight), scale(*old, 1.0 - weight));
        }
        let mut corrected = self.moved(&second, &releases);
        corrected.place_near_wake();
        let rms = rms_distance(corrected.free().zip(self.free()));
        if !(rms.is_finite() && corrected.free().all(|f| f.points.iter().all(|p| is_finite(*p)))) {
            return Err(WakeError::WakeLost { displacement: rms });
        }
        if part < 1.0 {
            corrected.draw_back(self, part);
        }
        *self = corrected;
        Ok(rms)
    }
}
