//! The free wake and one sweep of pseudo-implicit relaxation.

use super::filament::Filament;
use super::settings::{FreeWakeSettings, NearWakeMotion};
use super::sources::{BladeView, RollUp, SourceContext, Sources};
use super::{BladeLines, CirculationMap, WakeRotor};
use crate::kernel::{CoreModel, arc_velocity, induced_velocities};
use crate::vector::{Vec3, add, is_finite, norm, scale, sub};
use crate::{FlightState, SegmentSet, WakeError};

/// The wake of one of a rotor's alike blades, periodic in azimuth.
///
/// ```text
/// dr/dpsi + dr/dzeta = V_inf + v(r)         hub axes, lengths in R, velocities in Omega R
/// ```
/// Blade `b` of `N_b` at azimuth `psi` has the wake that blade 0 has at that azimuth, so that one grid of
/// azimuth and age holds all of them.
///
/// Source: Bagai and Leishman, J. Am. Helicopter Soc. 40 (1995) 29.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeWake {
    pub(crate) rotor: WakeRotor,
    pub(crate) settings: FreeWakeSettings,
    pub(crate) flight: FlightState,
    /// Mean induced inflow that carries a convected near wake, down positive.
    pub(crate) carrying_inflow: f64,
    pub(crate) lines: BladeLines,
    /// One per spanwise node.
    pub(crate) near: Vec<Filament>,
    /// One per rolled-up vortex.
    pub(crate) far: Vec<Filament>,
}

/// A filament of the wake as others see it.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeFilament {
    /// Station that releases it, unit `R`.
    pub release_r: f64,
    /// First age at which it carries vorticity, steps: younger, the near wake does.
    pub first_age: usize,
    /// Nodes in hub axes, unit `R`, `[azimuth][age]`.
    pub points: Vec<Vec<Vec3>>,
}

/// Velocities at all nodes of the free filaments.
type Velocities = Vec<Vec<Vec3>>;

impl FreeWake {
    /// A wake of undistorted helices, carried by the free stream and a uniform inflow.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for settings or a flight state out of range, and for blades on another
    /// azimuth grid.
    pub fn undistorted(
        rotor: WakeRotor,
        settings: FreeWakeSettings,
        flight: FlightState,
        carrying_inflow: f64,
        lines: BladeLines,
    ) -> Result<Self, WakeError> {
        settings.validate(rotor.blades())?;
        let flight = flight.validated()?;
        if !carrying_inflow.is_finite() {
            return Err(WakeError::BadInput {
                quantity: "carrying_inflow",
                value: carrying_inflow,
                expected: "a finite number",
            });
        }
        same_azimuths(&settings, lines.azimuths())?;
        let azimuths = settings.azimuths;
        let filament = |node, steps| Filament::new(node, steps, azimuths);
        let near = (0..=rotor.panels()).map(|n| filament(n, settings.near_steps())).collect();
        let released = RollUp::release_nodes(&settings.far, &rotor);
        let far = released.into_iter().map(|n| filament(n, settings.far_steps())).collect();
        let mut wake = Self { rotor, settings, flight, carrying_inflow, lines, near, far };
        let start = wake.clone();
        for filament in wake.near.iter_mut().chain(&mut wake.far) {
            let node = filament.node;
            filament.fill(azimuths, |i, k| start.carried(node, i, k));
        }
        wake.place_near_wake();
        Ok(wake)
    }

    /// Rotor and panels.
    pub fn rotor(&self) -> &WakeRotor {
        &self.rotor
    }

    /// The choices.
    pub fn settings(&self) -> &FreeWakeSettings {
        &self.settings
    }

    /// Flight state.
    pub fn flight(&self) -> &FlightState {
        &self.flight
    }

    /// Mean induced inflow that carries a convected near wake, tip speed, down positive.
    pub fn carrying_inflow(&self) -> f64 {
        self.carrying_inflow
    }

    /// Where the blades are.
    pub fn lines(&self) -> &BladeLines {
        &self.lines
    }

    /// The rolled-up vortices from root to tip.
    pub fn vortices(&self) -> Vec<WakeFilament> {
        self.shown(&self.far, self.settings.near_steps())
    }

    /// The trailers of the near wake from root to tip.
    pub fn near_wake(&self) -> Vec<WakeFilament> {
        self.shown(&self.near, 0)
    }

    fn shown(&self, filaments: &[Filament], first_age: usize) -> Vec<WakeFilament> {
        filaments
            .iter()
            .map(|f| WakeFilament {
                release_r: self.rotor.nodes()[f.node],
                first_age,
                points: (0..self.settings.azimuths).map(|i| f.at(i).to_vec()).collect(),
            })
            .collect()
    }

    /// Gives the wake another flight state, blades and mean inflow; the geometry stays as a start.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] as for a new wake.
    pub fn set_condition(
        &mut self,
        flight: FlightState,
        carrying_inflow: f64,
        lines: BladeLines,
    ) -> Result<(), WakeError> {
        same_azimuths(&self.settings, lines.azimuths())?;
        self.flight = flight.validated()?;
        self.carrying_inflow = carrying_inflow;
        self.lines = lines;
        for filament in &mut self.far {
            for i in 0..self.settings.azimuths {
                let at = filament.index(i, 0);
                filament.points[at] = self.lines.edge_at(i)[filament.node];
            }
        }
        self.place_near_wake();
        Ok(())
    }

    /// The same wake on another number of azimuth steps: its distortion against undistorted helices,
    /// interpolated linearly along azimuth and age; the start of the next stage of a sequence of grids.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] if the number does not suit the rotor.
    pub fn on_grid(&self, azimuths: usize, lines: BladeLines) -> Result<Self, WakeError> {
        let settings = self.settings.with_azimuths(azimuths);
        let mut out = Self::undistorted(
            self.rotor.clone(),
            settings,
            self.flight,
            self.carrying_inflow,
            lines,
        )?;
        let ratio = (self.settings.azimuths, azimuths);
        let helix = out.clone();
        let pairs = out.far.iter_mut().zip(&self.far).chain(out.near.iter_mut().zip(&self.near));
        for (new, old) in pairs {
            let node = new.node;
            let mut distortion = old.clone();
            distortion
                .fill(self.settings.azimuths, |i, k| sub(old.at(i)[k], self.carried(node, i, k)));
            new.fill(azimuths, |i, k| {
                add(helix.carried(node, i, k), sampled(&distortion, i, k, ratio))
            });
        }
        out.place_near_wake();
        Ok(out)
    }

    /// Free stream in hub axes, tip speed.
    pub(crate) fn free_stream(&self) -> Vec3 {
        [self.flight.advance_ratio, 0.0, -self.flight.normal_inflow()]
    }

    /// Point that node `node` released `k` steps before azimuth `i`, carried undistorted.
    fn carried(&self, node: usize, i: usize, k: usize) -> Vec3 {
        let azimuths = self.settings.azimuths;
        let release = self.lines.edge_at((i + azimuths - k % azimuths) % azimuths)[node];
        let wind = sub(self.free_stream(), [0.0, 0.0, self.carrying_inflow]);
        add(release, scale(wind, k as f64 * self.settings.step_rad()))
    }

    /// Puts the near wake where its motion is prescribed.
    fn place_near_wake(&mut self) {
        let azimuths = self.settings.azimuths;
        let motion = self.settings.near_wake_motion;
        let mut near = std::mem::take(&mut self.near);
        for filament in &mut near {
            let node = filament.node;
            let place = |i: usize, k: usize| match motion {
                // a free one keeps its shape but for the release
                NearWakeMotion::Free if k > 0 => filament.at(i)[k],
                NearWakeMotion::BladePlane => self.swept(node, i, k),
                NearWakeMotion::FollowsTip => self.following(node, i, k),
                _ => self.carried(node, i, k),
            };
            let mut points = Vec::with_capacity(filament.points.len());
            for i in 0..azimuths {
                points.extend((0..=filament.steps).map(|k| place(i, k)));
            }
            filament.points = points;
        }
        self.near = near;
    }

    /// The carried point moved by its share of the distortion of the tip vortex.
    fn following(&self, node: usize, i: usize, k: usize) -> Vec3 {
        let carried = self.carried(node, i, k);
        match self.far.last() {
            Some(tip) if k <= tip.steps => {
                let moved = sub(tip.at(i)[k], self.carried(tip.node, i, k));
                add(carried, scale(moved, self.rotor.nodes()[node]))
            }
            _ => carried,
        }
    }

    /// The arc behind a blade at azimuth `i` on which its node would come back by `k` steps.
    fn swept(&self, node: usize, i: usize, k: usize) -> Vec3 {
        let [x, y, z] = self.lines.edge_at(i)[node];
        let (sin, cos) = (k as f64 * self.settings.step_rad()).sin_cos();
        [x * cos + y * sin, y * cos - x * sin, z]
    }

    /// Instants that differ: after one blade spacing the wakes of all blades are what they were.
    pub(crate) fn phases(&self) -> usize {
        self.settings.azimuths / self.rotor.blades()
    }

    /// Azimuths of the blades at an instant.
    pub(crate) fn blade_azimuths(&self, phase: usize) -> impl Iterator<Item = usize> + use<> {
        let (spacing, blades) = (self.phases(), self.rotor.blades());
        (0..blades).map(move |b| phase + b * spacing)
    }

    fn view(&self, azimuth: usize) -> BladeView<'_> {
        BladeView {
            azimuth,
            line: self.lines.at(azimuth),
            edge: self.lines.edge_at(azimuth),
            near: self.near.iter().map(|f| f.at(azimuth)).collect(),
            far: self.far.iter().map(|f| f.at(azimuth)).collect(),
        }
    }

    /// Mean displacement of the rolled-up vortices over the last free turn.
    fn turn(&self) -> Vec3 {
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

    pub(crate) fn young_lengths(&self) -> Vec<Vec<f64>> {
        let length = |p: &[Vec3]| norm(sub(p[1], p[0]));
        self.far
            .iter()
            .map(|f| (0..self.settings.azimuths).map(|i| length(f.at(i))).collect())
            .collect()
    }

    /// Calls `f` with what the sources are built with.
    pub(crate) fn with_context<T>(
        &self,
        circulation: &CirculationMap,
        f: impl FnOnce(&SourceContext<'_>) -> T,
    ) -> T {
        let roll_up = RollUp::new(&self.settings.far, &self.rotor, circulation);
        let context = SourceContext {
            rotor: &self.rotor,
            settings: &self.settings,
            roll_up: &roll_up,
            circulation,
            turn: self.turn(),
            young: &self.young_lengths(),
        };
        f(&context)
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
        self.with_context(circulation, |context| {
            (0..self.phases())
                .map(|p| sources(&self.views(p), context).segments(context, circulation.values()))
                .collect()
        })
    }

    /// Induced velocity at points in hub axes, averaged over the revolution: what a slow probe measures.
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
        let mut mean = vec![[0.0; 3]; points.len()];
        for set in &sets {
            for (m, v) in mean.iter_mut().zip(induced_velocities(points, set)) {
                *m = add(*m, scale(v, 1.0 / sets.len() as f64));
            }
        }
        Ok(mean)
    }

    /// Checks a circulation against the grid.
    pub(crate) fn check(&self, circulation: &CirculationMap) -> Result<(), WakeError> {
        same_azimuths(&self.settings, circulation.azimuths())?;
        if circulation.panels() != self.rotor.panels() {
            return Err(WakeError::BadInput {
                quantity: "panels of the circulation",
                value: circulation.panels() as f64,
                expected: "the panels of the wake",
            });
        }
        Ok(())
    }

    fn free(&self) -> impl Iterator<Item = &Filament> {
        let near_is_free = self.settings.near_wake_motion == NearWakeMotion::Free;
        self.near.iter().filter(move |_| near_is_free).chain(&self.far)
    }

    /// Induced velocity at every node of the free filaments.
    fn velocities(&self, circulation: &CirculationMap) -> Velocities {
        let sets = self.all_segments(circulation, Sources::of_geometry);
        let free: Vec<&Filament> = self.free().collect();
        let mut out: Velocities = free.iter().map(|f| vec![[0.0; 3]; f.points.len()]).collect();
        let stride = self.settings.velocity_stride;
        let computed = |f: &Filament, k: usize| k.is_multiple_of(stride) || k == f.steps;
        for (phase, set) in sets.iter().enumerate() {
            let mut places = Vec::new();
            let mut targets = Vec::new();
            for (j, f) in free.iter().enumerate() {
                for i in self.blade_azimuths(phase) {
                    for k in (0..=f.steps).filter(|&k| computed(f, k)) {
                        places.push((j, f.index(i, k)));
                        targets.push(f.at(i)[k]);
                    }
                }
            }
            for ((j, index), v) in places.into_iter().zip(induced_velocities(&targets, set)) {
                out[j][index] = v;
            }
        }
        if self.settings.core.model == CoreModel::RosenheadMoore {
            self.add_arcs(circulation, &free, &mut out);
        }
        if stride > 1 {
            for (f, v) in free.iter().zip(&mut out) {
                interpolate(f, self.settings.azimuths, stride, v);
            }
        }
        out
    }

    /// What the curvature between adjacent segments adds to the rolled-up vortices.
    fn add_arcs(&self, circulation: &CirculationMap, free: &[&Filament], out: &mut Velocities) {
        let peaks = circulation.outboard_peaks();
        let azimuths = self.settings.azimuths;
        for (f, v) in free.iter().zip(out) {
            if f.steps != self.settings.far_steps() || f.node != self.rotor.panels() {
                continue;
            }
            for i in 0..azimuths {
                let points = f.at(i);
                for k in 1..f.steps {
                    let release = (i + azimuths - k % azimuths) % azimuths;
                    let strength = circulation.row(release)[peaks[release]];
                    let arc = [points[k - 1], points[k], points[k + 1]];
                    let at = f.index(i, k);
                    v[at] = add(v[at], arc_velocity(arc, strength, self.settings.core.radius));
                }
            }
        }
    }

    /// The geometry that the velocities carry the wake to.
    fn moved(&self, velocities: &Velocities) -> Self {
        let mut out = self.clone();
        let azimuths = self.settings.azimuths;
        let step = self.settings.step_rad();
        let stream = self.free_stream();
        let near_is_free = self.settings.near_wake_motion == NearWakeMotion::Free;
        let Self { near, far, lines, .. } = &mut out;
        let free = near.iter_mut().filter(|_| near_is_free).chain(far);
        for (f, v) in free.zip(velocities) {
            for i in 0..azimuths {
                let at = f.index(i, 0);
                f.points[at] = lines.edge_at(i)[f.node];
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
        self.check(circulation)?;
        let first = self.velocities(circulation);
        let predicted = self.moved(&first);
        let mut second = predicted.velocities(circulation);
        let weight = self.settings.relaxation;
        for (new, old) in second.iter_mut().flatten().zip(first.iter().flatten()) {
            *new = add(scale(*new, weight), scale(*old, 1.0 - weight));
        }
        let mut corrected = self.moved(&second);
        corrected.place_near_wake();
        let (mut sum, mut count) = (0.0, 0);
        for (new, old) in corrected.free().zip(self.free()) {
            for (a, b) in new.points.iter().zip(&old.points) {
                let d = norm(sub(*a, *b));
                sum += d * d;
                count += 1;
            }
        }
        let rms = (sum / f64::from(count.max(1))).sqrt();
        if !(rms.is_finite() && corrected.free().all(|f| f.points.iter().all(|p| is_finite(*p)))) {
            return Err(WakeError::WakeLost { displacement: rms });
        }
        *self = corrected;
        Ok(rms)
    }
}

/// Point of a filament of another grid, linear between its nodes; grids by their azimuth steps.
fn sampled(old: &Filament, i: usize, k: usize, (before, now): (usize, usize)) -> Vec3 {
    let azimuths = before;
    let (p, z) = (i * before / now, k * before / now);
    let fraction = |n: usize| (n * before % now) as f64 / now as f64;
    let (s, t) = (fraction(i), fraction(k));
    let value = |p: usize, z: usize| old.at(p % azimuths)[z.min(old.steps)];
    let mix = |a: Vec3, b: Vec3, t: f64| add(scale(a, 1.0 - t), scale(b, t));
    mix(mix(value(p, z), value(p, z + 1), t), mix(value(p + 1, z), value(p + 1, z + 1), t), s)
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

fn same_azimuths(settings: &FreeWakeSettings, given: usize) -> Result<(), WakeError> {
    if given == settings.azimuths {
        return Ok(());
    }
    Err(WakeError::BadInput {
        quantity: "azimuths of the blades or the circulation",
        value: given as f64,
        expected: "the azimuth steps of the wake",
    })
}
