//! The wake marched in time, blade by blade.

use super::FreeWake;
use super::filament::rms_distance;
use super::settings::WakeMethod;
use super::sources::{BladeView, SourceContext, Sources};
use crate::CirculationMap;
use crate::WakeError;
use crate::kernel::{CoreModel, induced_velocities};
use crate::vector::{Vec3, about_the_shaft, add, is_finite, norm, scale, sub};

use std::f64::consts::TAU;

/// Free filaments of one blade: `[filament][age]`.
pub(super) type Shape = Vec<Vec<Vec3>>;

/// The present and the two earlier shapes of one blade's wake, and the velocities of the present one.
#[derive(Debug, Clone)]
struct BladeState {
    azimuth: usize,
    levels: [Shape; 3],
    velocity: Shape,
}

/// Mean displacement of some rolled-up vortices over their last free turn.
pub(super) fn last_turn<'a>(far: impl Iterator<Item = &'a Vec<Vec3>>, azimuths: usize) -> Vec3 {
    let (mut sum, mut count) = ([0.0; 3], 0);
    for points in far {
        for k in (points.len() - azimuths).max(azimuths)..points.len() {
            sum = add(sum, sub(points[k], points[k - azimuths]));
            count += 1;
        }
    }
    scale(sum, 1.0 / f64::from(count.max(1)))
}

/// Fills the newest level of a blade's filaments from the two before, released where `release` says.
fn carry_blade(
    [now, a, b]: &mut [Shape; 3],
    velocity: &Shape,
    release: impl Fn(usize) -> Vec3,
    step: f64,
    stream: Vec3,
) {
    for (j, points) in now.iter_mut().enumerate() {
        points[0] = release(j);
        for z in 1..points.len() {
            let mean = scale(add(velocity[j][z], velocity[j][z - 1]), 0.5);
            let wind = scale(add(stream, mean), 4.0 * step);
            let before = scale(add(a[j][z], a[j][z - 1]), 4.0);
            let earlier = scale(add(b[j][z], b[j][z - 1]), -1.0);
            let sum = add(add(points[z - 1], before), add(earlier, wind));
            points[z] = scale(sum, 1.0 / 7.0);
        }
    }
}

/// Adds the flow round a body to the velocities at a shape.
pub(super) fn add_the_body(wake: &FreeWake, shape: &Shape, velocity: &mut Shape) {
    for (v, at) in velocity.iter_mut().flatten().zip(shape.iter().flatten()) {
        *v = add(*v, wake.by_the_body(*at));
    }
}

impl FreeWake {
    /// Induced velocities at the shapes of the first blades of these.
    pub(super) fn velocities_of(
        &self,
        shapes: &[&Shape],
        views: &[BladeView<'_>],
        context: &SourceContext<'_>,
    ) -> Vec<Shape> {
        let circulation = context.circulation;
        let set = Sources::of_geometry(views, context).segments(context, circulation.values());
        let targets: Vec<Vec3> =
            shapes.iter().flat_map(|shape| shape.iter().flatten().copied()).collect();
        let mut values = induced_velocities(&targets, &set).into_iter();
        let corrected = self.settings.core.model == CoreModel::RosenheadMoore;
        let peaks = circulation.outboard_peaks();
        let of_blade = |(shape, view): (&&Shape, &BladeView<'_>)| {
            let mut of_blade: Shape =
                shape.iter().map(|points| values.by_ref().take(points.len()).collect()).collect();
            if let (true, Some(tip), Some(v)) = (corrected, shape.last(), of_blade.last_mut()) {
                self.add_arcs_of(tip, view.past, circulation, &peaks, v);
            }
            of_blade
        };
        shapes.iter().zip(views).map(of_blade).collect()
    }
}

/// A time-accurate free wake, every blade on its own: predictor-corrector with a second-order backward
/// difference in azimuth (PC2B).
///
/// ```text
/// 7 r(p,z) = r(p,z-1) + 4 [r(p-1,z) + r(p-1,z-1)] - [r(p-2,z) + r(p-2,z-1)]
///            + 4 d [V_inf + mean of v(p,z) and v(p,z-1)]
/// ```
/// which is `(3 r_p - 4 r_(p-1) + r_(p-2)) / 2d` on both ends of the cell with the central difference in age, all
/// at the new azimuth. In hover and at low speed, where relaxation may settle on what no real wake does.
///
/// Differs from source: there the difference is about the middle of the cell,
/// `(3 r_p - r_(p-1) - 3 r_(p-2) + r_(p-3)) / 4d`, with the mean of `v` over four corners. That is the mean of the
/// formula here at `p` and at `p - 1`, so that an error which changes sign from step to step satisfies it and stays for
/// ever: the start leaves one of some `1e-4 R`. Here it dies out.
///
/// A helix that is only carried along comes out turned by `d^2 / 3` rad per rad of age: steps of 15 deg move it by 0.1 R within two
/// turns, steps of 7.5 deg by a quarter of that. Differences along the path of the air have no such error, but nothing in them
/// damps what alternates along the filament, and a hovering wake loses its first turn within twenty revolutions.
///
/// Source: Bhagwat and Leishman, J. Am. Helicopter Soc. 46 (2001) 59.
#[derive(Debug, Clone)]
pub struct WakeMarch {
    wake: FreeWake,
    blades: Vec<BladeState>,
}

impl FreeWake {
    /// Carries the wake on by some sweeps or revolutions; returns the last RMS displacement, unit `R`.
    ///
    /// # Errors
    /// As [`sweep`](Self::sweep) and [`WakeMarch::revolutions`]; the wake is then the last good one.
    pub fn carry_on(
        &mut self,
        method: WakeMethod,
        count: usize,
        circulation: &CirculationMap,
    ) -> Result<f64, WakeError> {
        self.carry_on_in_part(method, count, circulation, 1.0)
    }

    /// The same of which the nodes go a part of the way, 0 to 1: of each sweep, or once after the revolutions. Returns the
    /// last RMS displacement of the whole way.
    ///
    /// # Errors
    /// As [`carry_on`](Self::carry_on).
    pub fn carry_on_in_part(
        &mut self,
        method: WakeMethod,
        count: usize,
        circulation: &CirculationMap,
        part: f64,
    ) -> Result<f64, WakeError> {
        let mut displacement = f64::INFINITY;
        match method {
            WakeMethod::Relaxed => {
                for _ in 0..count {
                    displacement = self.sweep_in_part(circulation, part)?;
                }
            }
            WakeMethod::Marched => {
                let mut march = WakeMarch::new(self.clone());
                let outcome = march.revolutions(count, circulation);
                let before = std::mem::replace(self, march.wake);
                displacement = outcome?.last().copied().unwrap_or(displacement);
                if part < 1.0 {
                    self.draw_back(&before, part);
                }
            }
        }
        Ok(displacement)
    }
}

impl WakeMarch {
    /// Starts from a wake; its two earlier shapes are those of the periodic grid.
    pub fn new(wake: FreeWake) -> Self {
        let azimuths = wake.settings.azimuths;
        let shape = |i: usize| -> Shape { wake.free().map(|f| f.at(i).to_vec()).collect() };
        let blades = wake
            .blade_azimuths(0)
            .map(|azimuth| BladeState {
                azimuth,
                levels: [0, 1, 2].map(|back| shape((azimuth + azimuths - back) % azimuths)),
                velocity: Vec::new(),
            })
            .collect();
        Self { wake, blades }
    }

    /// The wake of blade 0 over the last revolution.
    pub fn wake(&self) -> &FreeWake {
        &self.wake
    }

    /// Goes on for some revolutions; returns for each the RMS change of the wake of blade 0 against the
    /// revolution before, unit `R`.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid; [`WakeError::WakeLost`] if a node left
    /// the numbers.
    pub fn revolutions(
        &mut self,
        count: usize,
        circulation: &CirculationMap,
    ) -> Result<Vec<f64>, WakeError> {
        self.wake.check(circulation)?;
        let mut changes = Vec::with_capacity(count);
        for _ in 0..count {
            let before = self.wake.clone();
            for _ in 0..self.wake.settings.azimuths {
                if let Err(error) = self.step(circulation) {
                    self.wake = before;
                    return Err(error);
                }
            }
            let change = rms_distance(before.far.iter().zip(&self.wake.far));
            if !change.is_finite() {
                self.wake = before;
                return Err(WakeError::WakeLost { displacement: change });
            }
            changes.push(change);
        }
        Ok(changes)
    }

    /// The same with every blade's wake given its neighbour's in turn: how far the wakes of the blades
    /// are from being alike, the largest distance of corresponding nodes over one revolution, unit `R`.
    ///
    /// # Errors
    /// As [`revolutions`](Self::revolutions).
    pub fn asymmetry(&mut self, circulation: &CirculationMap) -> Result<f64, WakeError> {
        let azimuths = self.wake.settings.azimuths;
        let blades = self.blades.len();
        let mut seen: Vec<Vec<Shape>> = vec![vec![Shape::new(); azimuths]; blades];
        for _ in 0..azimuths {
            self.step(circulation)?;
            for (state, seen) in self.blades.iter().zip(&mut seen) {
                seen[state.azimuth].clone_from(&state.levels[0]);
            }
        }
        let mut worst = 0.0_f64;
        for other in &seen[1..] {
            let pairs = other.iter().flatten().flatten().zip(seen[0].iter().flatten().flatten());
            worst = pairs.fold(worst, |w, (a, b)| w.max(norm(sub(*a, *b))));
        }
        Ok(worst)
    }

    fn step(&mut self, circulation: &CirculationMap) -> Result<(), WakeError> {
        if self.blades.iter().any(|b| b.velocity.is_empty()) {
            self.refresh_velocities(circulation);
        }
        let azimuths = self.wake.settings.azimuths;
        for state in &mut self.blades {
            state.azimuth = (state.azimuth + 1) % azimuths;
            state.levels.rotate_right(1);
            let [now, last, _] = &mut state.levels;
            now.clone_from(last);
        }
        // predictor: the velocities at the new azimuth are those of the last one
        let releases = self.wake.releases(circulation);
        self.carry(&releases);
        self.refresh_velocities(circulation);
        self.carry(&releases);
        self.refresh_velocities(circulation);
        self.record()
    }

    /// Fills the newest level of every blade.
    fn carry(&mut self, releases: &[Vec<Vec3>]) {
        let (step, stream) = (self.wake.settings.step_rad(), self.wake.free_stream());
        for BladeState { azimuth, levels, velocity } in &mut self.blades {
            carry_blade(levels, velocity, |j| releases[j][*azimuth], step, stream);
        }
    }

    /// Induced velocities of the newest level of every blade.
    fn refresh_velocities(&mut self, circulation: &CirculationMap) {
        let wake = &self.wake;
        let views: Vec<BladeView<'_>> = self.blades.iter().map(|b| self.view(b)).collect();
        let context = wake.context(circulation, self.turn());
        let differing = &self.blades[..wake.blades_that_differ()];
        let shapes: Vec<&Shape> = differing.iter().map(|b| &b.levels[0]).collect();
        let velocities = wake.velocities_of(&shapes, &views, &context);
        let spacing = TAU / self.blades.len() as f64;
        for (b, state) in self.blades.iter_mut().enumerate() {
            // in an axial wake the other blades have what the first one has, turned
            let turned = |v: &Vec3| about_the_shaft(*v, b as f64 * spacing);
            state.velocity = match velocities.get(b) {
                Some(own) => own.clone(),
                None => velocities[0].iter().map(|v| v.iter().map(turned).collect()).collect(),
            };
            add_the_body(wake, &state.levels[0], &mut state.velocity);
        }
    }

    fn view<'a>(&'a self, state: &'a BladeState) -> BladeView<'a> {
        let wake = &self.wake;
        let shape = &state.levels[0];
        let (free_near, far) = shape.split_at(self.wake.free_of_near());
        let near = if wake.near_is_free() {
            free_near.iter().map(Vec::as_slice).collect()
        } else {
            wake.near.iter().map(|f| f.at(state.azimuth)).collect()
        };
        BladeView {
            past: wake.periodic(state.azimuth),
            line: wake.lines.at(state.azimuth),
            edge: wake.lines.edge_at(state.azimuth),
            near,
            far: far.iter().map(Vec::as_slice).collect(),
        }
    }

    /// Mean displacement over the last free turn, over all blades.
    fn turn(&self) -> Vec3 {
        let far = self.blades.iter().flat_map(|b| &b.levels[0][self.wake.free_of_near()..]);
        last_turn(far, self.wake.settings.azimuths)
    }

    /// Stores the newest shape of blade 0 in the periodic grid.
    fn record(&mut self) -> Result<(), WakeError> {
        let Some(state) = self.blades.first() else { return Ok(()) };
        for (f, points) in self.wake.free_mut().zip(&state.levels[0]) {
            if !points.iter().all(|p| is_finite(*p)) {
                return Err(WakeError::WakeLost { displacement: f64::NAN });
            }
            let at = f.index(state.azimuth, 0);
            f.points[at..at + points.len()].copy_from_slice(points);
        }
        Ok(())
    }
}
