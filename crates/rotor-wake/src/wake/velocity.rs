//! What the wake induces: at its own nodes and anywhere.

use super::FreeWake;
use super::filament::Filament;
use super::sources::{BladeView, Past, RollUp, SourceContext, Sources};
use crate::CirculationMap;
use crate::kernel::{CoreModel, arc_velocity, induced_velocities};
use crate::vector::{Vec3, about_the_shaft, add, scale, sub};
use crate::{SegmentSet, WakeError};
use rayon::prelude::*;

/// Velocities at all nodes of the free filaments.
pub(super) type Velocities = Vec<Vec<Vec3>>;

impl FreeWake {
    /// What a blade at an azimuth has carried: the same every revolution.
    pub(super) fn periodic(&self, azimuth: usize) -> Past {
        Past { first: 0, rows: self.settings.azimuths, now: azimuth }
    }

    fn view(&self, azimuth: usize) -> BladeView<'_> {
        BladeView {
            past: self.periodic(azimuth),
            line: self.lines.at(azimuth),
            edge: self.lines.edge_at(azimuth),
            near: self.near.iter().map(|f| f.at(azimuth)).collect(),
            far: self.far.iter().map(|f| f.at(azimuth)).collect(),
        }
    }

    /// Mean displacement of the rolled-up vortices over the last free turn.
    pub(super) fn turn(&self) -> Vec3 {
        let azimuths = self.settings.azimuths;
        let mut sum = [0.0; 3];
        for filament in &self.far {
            for i in 0..azimuths {
                let points = filament.at(i);
                for k in filament.steps - azimuths..=filament.steps {
                    if k >= azimuths {
                        sum = add(sum, sub(points[k], points[k - azimuths]));
                    }
                }
            }
        }
        let counted = (azimuths + 1).min(self.settings.far_steps() - azimuths + 1);
        scale(sum, 1.0 / (self.far.len() * azimuths * counted) as f64)
    }

    /// What the sources are built with, for a displacement of the wake in one turn.
    pub(super) fn context<'a>(
        &'a self,
        circulation: &'a CirculationMap,
        turn: Vec3,
    ) -> SourceContext<'a> {
        SourceContext {
            rotor: &self.rotor,
            settings: &self.settings,
            roll_up: RollUp::new(&self.settings.far, &self.rotor, circulation),
            circulation,
            advance_ratio: self.flight.advance_ratio,
            chord: self.lines.chord(),
            turn,
        }
    }

    fn views(&self, phase: usize) -> Vec<BladeView<'_>> {
        self.blade_azimuths(phase).map(|i| self.view(i)).collect()
    }

    /// Sources of one instant as the blades feel them.
    pub(crate) fn load_sources(&self, phase: usize, context: &SourceContext<'_>) -> Sources {
        Sources::of_loads(&self.views(phase), context)
    }

    /// Segments of every instant, for the kernel.
    fn all_segments(
        &self,
        circulation: &CirculationMap,
        sources: fn(&[BladeView<'_>], &SourceContext<'_>) -> Sources,
    ) -> Vec<SegmentSet> {
        let context = self.context(circulation, self.turn());
        (0..self.phases_that_differ())
            .into_par_iter()
            .map(|p| sources(&self.views(p), &context).segments(&context, circulation.values()))
            .collect()
    }

    /// Induced velocity at points in hub axes, averaged over the revolution, and that of the body: what a slow probe
    /// measures.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid.
    pub fn mean_velocity(
        &self,
        points: &[Vec3],
        circulation: &CirculationMap,
    ) -> Result<Vec<Vec3>, WakeError> {
        self.check(circulation)?;
        let sets = self.all_segments(circulation, Sources::of_loads);
        let mut mean: Vec<Vec3> = points.iter().map(|at| self.by_the_body(*at)).collect();
        for set in &sets {
            for (m, v) in mean.iter_mut().zip(induced_velocities(points, set)) {
                *m = add(*m, scale(v, 1.0 / sets.len() as f64));
            }
        }
        Ok(mean)
    }

    /// Induced velocity at every node of the free filaments.
    pub(super) fn velocities(&self, circulation: &CirculationMap) -> Velocities {
        let sets = self.all_segments(circulation, Sources::of_geometry);
        let free: Vec<&Filament> = self.free().collect();
        let stride = self.settings.velocity_stride;
        let computed = |f: &Filament, k: usize| k.is_multiple_of(stride) || k == f.steps;
        let of_phases: Vec<Vec<((usize, usize), Vec3)>> = sets
            .par_iter()
            .enumerate()
            .map(|(phase, set)| {
                let (mut places, mut targets) = (Vec::new(), Vec::new());
                for (j, f) in free.iter().enumerate() {
                    for i in self.blade_azimuths(phase).take(self.blades_that_differ()) {
                        for k in (0..=f.steps).filter(|&k| computed(f, k)) {
                            places.push((j, f.index(i, k)));
                            targets.push(f.at(i)[k]);
                        }
                    }
                }
                places.into_iter().zip(induced_velocities(&targets, set)).collect()
            })
            .collect();
        let mut out: Velocities = free.iter().map(|f| vec![[0.0; 3]; f.points.len()]).collect();
        for ((j, index), v) in of_phases.into_iter().flatten() {
            out[j][index] = v;
        }
        if self.is_axial() {
            for (f, v) in free.iter().zip(&mut out) {
                self.turn_with_the_blades(f, v);
            }
        }
        if self.settings.core.model == CoreModel::RosenheadMoore {
            self.add_arcs(circulation, &free, &mut out);
        }
        for (f, v) in free.iter().zip(&mut out) {
            for (at, v) in f.points.iter().zip(v) {
                *v = add(*v, self.by_the_body(*at));
            }
        }
        if stride > 1 {
            for (f, v) in free.iter().zip(&mut out) {
                interpolate(f, self.settings.azimuths, stride, v);
            }
        }
        out
    }

    /// Gives every azimuth the velocities of the first one, turned.
    fn turn_with_the_blades(&self, f: &Filament, v: &mut [Vec3]) {
        for i in 1..self.settings.azimuths {
            let angle = i as f64 * self.settings.step_rad();
            for k in 0..=f.steps {
                v[f.index(i, k)] = about_the_shaft(v[f.index(0, k)], angle);
            }
        }
    }

    /// What the curvature between adjacent segments adds to the tip vortices.
    fn add_arcs(&self, circulation: &CirculationMap, free: &[&Filament], out: &mut Velocities) {
        let peaks = circulation.outboard_peaks();
        for (f, v) in free.iter().zip(out) {
            if f.steps != self.settings.far_steps() || f.node != self.rotor.panels() {
                continue;
            }
            for i in 0..self.settings.azimuths {
                let at = f.index(i, 0)..=f.index(i, f.steps);
                self.add_arcs_of(f.at(i), self.periodic(i), circulation, &peaks, &mut v[at]);
            }
        }
    }

    /// The same for the tip vortex of one blade.
    pub(super) fn add_arcs_of(
        &self,
        points: &[Vec3],
        past: Past,
        circulation: &CirculationMap,
        peaks: &[usize],
        v: &mut [Vec3],
    ) {
        // the core at release: with grown ones the wake of a two-bladed rotor in hover does not settle
        let radius = self.settings.core.radius.max(self.settings.core.mutual_radius);
        for (k, arc) in points.windows(3).enumerate() {
            let release = past.row(k + 1);
            let strength = circulation.row(release)[peaks[release]];
            let arc = [arc[0], arc[1], arc[2]];
            v[k + 1] = add(v[k + 1], arc_velocity(arc, strength, radius));
        }
    }
}

/// Linear interpolation between computed ages along the path of the air, on which azimuth and age grow
/// together.
fn interpolate(f: &Filament, azimuths: usize, stride: usize, v: &mut [Vec3]) {
    for k in (0..f.steps).filter(|k| !k.is_multiple_of(stride)) {
        let below = k - k % stride;
        let above = (below + stride).min(f.steps);
        let t = (k - below) as f64 / (above - below) as f64;
        for i in 0..azimuths {
            let a = v[f.index((i + azimuths - (k - below)) % azimuths, below)];
            let b = v[f.index((i + above - k) % azimuths, above)];
            v[f.index(i, k)] = add(scale(a, 1.0 - t), scale(b, t));
        }
    }
}
