//! A wake that remembers what every blade has carried: nothing in it is periodic.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use super::influence::TargetBlock;
use super::march::{Shape, add_the_body, last_turn};
use super::settings::{NearWakeMotion, ReleasePoint};
use super::sources::{BladeView, Past, RollUp, SourceContext, Sources};
use super::{FreeWake, WakeSymmetry};
use crate::disk::blades::edge_between;
use crate::disk::inflow_map::mean_over_disk;
use crate::error::ensure;
use crate::kernel::{BLOCK, TakeVelocity, for_each_velocity};
use crate::vector::{Vec3, add, is_finite, scale, sub};
use crate::{BladePlace, CirculationMap, FlightState, WakeError};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::collections::VecDeque;

/// The wake of one blade.
#[derive(Debug, Clone)]
struct BladeWake {
    /// What the blade has carried.
    past: Past,
    /// Where the blade is, the present place first, then those of the ages of the near wake.
    places: VecDeque<BladePlace>,
    /// Where its tip vortex was released, by age.
    released: VecDeque<Vec3>,
    /// Trailers of the near wake where these are placed.
    near: Shape,
    /// What moves freely, and the induced velocities of its nodes.
    shape: Shape,
    velocity: Shape,
    /// The same a step before.
    before: [Shape; 2],
}

impl BladeWake {
    /// Carries every free node from its place a step before along the path of the air, new ones from where `release` says:
    ///
    /// ```text
    /// r(psi, zeta) = r(psi - d, zeta - d) + d [V_inf + mean of v at the four corners]
    /// ```
    fn carry(&mut self, release: impl Fn(usize) -> Vec3, step: f64, stream: Vec3) {
        let [last, of_last] = &self.before;
        for (j, points) in self.shape.iter_mut().enumerate() {
            points[0] = release(j);
            let (new, old) = (&self.velocity[j], &of_last[j]);
            for z in 1..points.len() {
                let mean = scale(add(add(new[z], new[z - 1]), add(old[z], old[z - 1])), 0.25);
                points[z] = add(last[j][z - 1], scale(add(stream, mean), step));
            }
        }
    }
}

/// A free wake in time behind blades that need not be alike, nor do the same every revolution: every vortex keeps the circulation
/// that its blade had when it was released. Nodes follow the air with the mean velocity of the corners that the sweeps of
/// [`FreeWake`] take, so that a periodic wake of theirs stays as it is.
///
/// [`WakeMarch`](super::WakeMarch) differs: it marches under a periodic circulation, by differences that turn an old helix.
///
/// A step is in two parts: [`move_on`](Self::move_on) to where the blades are, then
/// [`put_circulation`](Self::put_circulation) of what they carry there, which follows from what they feel
/// ([`felt`](Self::felt)).
#[derive(Debug, Clone)]
pub struct WakeInTime {
    /// Choices and flight; its own grid is where the march began.
    wake: FreeWake,
    circulation: CirculationMap,
    blades: Vec<BladeWake>,
    corrections: usize,
}

/// Corrections of a step: each takes away most of what the one before left.
const CORRECTIONS: usize = 2;

/// Values straight on from two before; the last ones where there are no earlier ones.
fn extrapolated(earlier: &Shape, last: &Shape) -> Shape {
    let mut out = last.clone();
    for (value, before) in out.iter_mut().flatten().zip(earlier.iter().flatten()) {
        *value = sub(scale(*value, 2.0), *before);
    }
    out
}

/// Induced velocity at the control points of all panels of all blades at an instant, linear in the circulation that these have
/// there; what they had before is in the rest. Values blade by blade.
///
/// ```text
/// lambda_i = A Gamma + lambda_0,     u_t = B Gamma + u_0
/// ```
#[derive(Debug, Clone)]
pub struct FeltNow {
    /// `A` and `B`, down through the disk and along it, tip speed per `Omega R^2`.
    pub of_circulation: [DMatrix<f64>; 2],
    /// `lambda_0` and `u_0`, tip speed.
    pub rest: [DVector<f64>; 2],
}

impl FeltNow {
    /// Induced velocities down through the disk and along it of a circulation, tip speed.
    pub fn velocities(&self, circulation: &DVector<f64>) -> [DVector<f64>; 2] {
        [0, 1].map(|c| &self.of_circulation[c] * circulation + &self.rest[c])
    }
}

/// Takes velocities at the points of a block: what the present circulations make, and the rest.
struct Split<'a> {
    sources: &'a Sources,
    block: &'a TargetBlock,
    circulation: &'a [f64],
    /// Rows of a ring, panels, and the present row of every blade.
    rows: usize,
    panels: usize,
    now: &'a [usize],
    /// By panel of all blades, down and along; the rest last.
    columns: Vec<[[f64; BLOCK]; 2]>,
}

impl TakeVelocity for Split<'_> {
    #[inline(always)]
    fn take(&mut self, segment: usize, [x, y, z]: [&[f64; BLOCK]; 3]) {
        let along = self.block.along(x, y);
        for (at, factor) in self.sources.terms(segment).iter() {
            let (row, panel) = (at / self.panels, at % self.panels);
            let blade = row / self.rows;
            let (column, factor) = if row == self.now[blade] {
                (blade * self.panels + panel, factor)
            } else {
                (self.columns.len() - 1, factor * self.circulation[at])
            };
            let [down, of_along] = &mut self.columns[column];
            for k in 0..BLOCK {
                down[k] -= factor * z[k];
                of_along[k] += factor * along[k];
            }
        }
    }
}

impl WakeInTime {
    /// Starts from a periodic wake and its circulation: blade 0 at azimuth 0, every blade with the past that the periodic one
    /// has at its azimuth.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a circulation of another grid, and for an axial wake, whose blades are alike.
    pub fn new(wake: FreeWake, circulation: &CirculationMap) -> Result<Self, WakeError> {
        wake.check(circulation)?;
        let axial = f64::from(u8::from(wake.settings.symmetry == WakeSymmetry::Axial));
        ensure(axial == 0.0, "symmetry of a wake in time", axial, "Periodic: blades on their own")?;
        let settings = &wake.settings;
        let (azimuths, panels) = (settings.azimuths, wake.rotor.panels());
        let rows = (settings.turns + settings.far_turns + 2) * azimuths;
        let starts: Vec<usize> = wake.blade_azimuths(0).collect();
        let back = |azimuth: usize, age: usize| (azimuth + azimuths - age % azimuths) % azimuths;
        let remembered = CirculationMap::from_fn(starts.len() * rows, panels, |row, s| {
            circulation.row(row % rows % azimuths)[s]
        })?;
        let roll_up = RollUp::new(&settings.far, &wake.rotor, circulation);
        let tip = roll_up.nodes.len() - 1;
        let blades = starts
            .iter()
            .enumerate()
            .map(|(b, &azimuth)| {
                let ages = 0..=settings.near_steps();
                let place = |age: usize| {
                    let i = back(azimuth, age);
                    let [line, edge] = [wake.lines.at(i), wake.lines.edge_at(i)];
                    BladePlace { line: line.to_vec(), edge: edge.to_vec() }
                };
                let released = |age: usize| wake.far[tip].at(back(azimuth, age))[0];
                BladeWake {
                    past: Past { first: b * rows, rows, now: azimuth },
                    places: ages.clone().map(place).collect(),
                    released: ages.map(released).collect(),
                    near: wake.near.iter().map(|f| f.at(azimuth).to_vec()).collect(),
                    shape: wake.free().map(|f| f.at(azimuth).to_vec()).collect(),
                    velocity: Shape::new(),
                    before: Default::default(),
                }
            })
            .collect();
        let corrections = CORRECTIONS;
        let mut out = Self { wake, circulation: remembered, blades, corrections };
        out.refresh_velocities();
        Ok(out)
    }

    /// The same with another number of corrections of every step, 1 at least; 2 by default.
    #[must_use]
    pub fn with_corrections(self, corrections: usize) -> Self {
        Self { corrections: corrections.max(1), ..self }
    }

    /// The choices of the wake, and the wake it began with.
    pub fn began_with(&self) -> &FreeWake {
        &self.wake
    }

    /// Rolled-up vortices of a blade from root to tip: nodes in hub axes by age, unit `R`.
    pub fn vortices(&self, blade: usize) -> &[Vec<Vec3>] {
        &self.blades[blade].shape[self.wake.free_of_near()..]
    }

    /// Carries the wake over one azimuth step to where the blades are; they carry what they carried there a revolution ago, but
    /// for what has changed since, until
    /// [`put_circulation`](Self::put_circulation).
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a flight at another advance ratio or for other blades; [`WakeError::WakeLost`] if a node left
    /// the numbers. The wake is then as it was.
    pub fn move_on(
        &mut self,
        flight: FlightState,
        places: Vec<BladePlace>,
    ) -> Result<(), WakeError> {
        let (given, expected) = (places.len(), "one place for every blade");
        ensure(given == self.blades.len(), "places of blades", given as f64, expected)?;
        let (mu, nodes) = (flight.advance_ratio, self.wake.rotor.panels() + 1);
        let same = (mu - self.wake.flight.advance_ratio).abs() <= 1e-12;
        ensure(same, "advance_ratio of a step", mu, "that of the start")?;
        for BladePlace { line, edge } in &places {
            let fits = line.len() == nodes && edge.len() == nodes;
            ensure(fits, "nodes of a blade", line.len() as f64, "panels of the wake and one")?;
        }
        let flight = flight.validated()?;
        let mut moved = self.clone();
        moved.wake.flight = flight;
        moved.step_to(places)?;
        *self = moved;
        Ok(())
    }

    fn step_to(&mut self, places: Vec<BladePlace>) -> Result<(), WakeError> {
        let (panels, azimuths) = (self.wake.rotor.panels(), self.wake.settings.azimuths);
        let mut values = self.circulation.values().to_vec();
        for (blade, place) in self.blades.iter_mut().zip(places) {
            blade.past.now = (blade.past.now + 1) % blade.past.rows;
            // as a revolution ago, but for what has changed since
            let [now, last, then, before_then] =
                [0, 1, azimuths, azimuths + 1].map(|age| blade.past.row(age) * panels);
            for s in 0..panels {
                values[now + s] = values[last + s] + values[then + s] - values[before_then + s];
            }
            // first guess of the velocities at the new azimuth: straight on
            let guess = extrapolated(&blade.before[1], &blade.velocity);
            blade.before = [blade.shape.clone(), std::mem::replace(&mut blade.velocity, guess)];
            blade.places.pop_back();
            blade.places.push_front(place);
            blade.released.pop_back();
            blade.released.push_front([0.0; 3]);
        }
        self.circulation = CirculationMap::new(panels, values)?;
        self.carry();
        for _ in 0..self.corrections {
            self.refresh_velocities();
            self.carry();
        }
        let mut all = self.blades.iter().flat_map(|b| b.shape.iter().flatten());
        if !all.all(|p| is_finite(*p)) {
            return Err(WakeError::WakeLost { displacement: f64::NAN });
        }
        Ok(())
    }

    /// Mean by area of values at the panels of all blades, blade by blade.
    pub fn mean_over_blades(&self, values: &DVector<f64>) -> f64 {
        let rotor = &self.wake.rotor;
        mean_over_disk(&rotor.stations(), &rotor.widths(), values.as_slice())
    }

    /// What the blades feel where they are now.
    pub fn felt(&self) -> FeltNow {
        let context = self.context();
        let views: Vec<BladeView<'_>> = self.blades.iter().map(|b| self.view(b)).collect();
        let sources = Sources::of_loads(&views, &context);
        let segments = sources.unit_segments(&context);
        let (panels, rows) = (self.wake.rotor.panels(), self.blades[0].past.rows);
        let now: Vec<usize> = self.blades.iter().map(|b| b.past.row(0)).collect();
        let size = self.blades.len() * panels;
        let parts: Vec<_> = self
            .targets()
            .into_par_iter()
            .map(|block| {
                let mut split = Split {
                    sources: &sources,
                    block: &block,
                    circulation: self.circulation.values(),
                    rows,
                    panels,
                    now: &now,
                    columns: vec![[[0.0; BLOCK]; 2]; size + 1],
                };
                for_each_velocity(&block.points, &segments, &mut split);
                let columns = split.columns;
                (block, columns)
            })
            .collect();
        let zero = || (DMatrix::zeros(size, size), DVector::zeros(size));
        let [(mut a, mut a0), (mut b, mut b0)] = [zero(), zero()];
        for (block, columns) in parts {
            for (lane, (&row, &point)) in block.rows.iter().zip(&block.points).enumerate() {
                for (column, [down, along]) in columns[..size].iter().enumerate() {
                    a[(row, column)] = down[lane];
                    b[(row, column)] = along[lane];
                }
                a[(row, row)] -= block.own[lane];
                let [x, y, z] = self.wake.by_the_body(point);
                let [down, along] = &columns[size];
                a0[row] = down[lane] - z;
                b0[row] = along[lane] + x * block.sines[lane] - y * block.cosines[lane];
            }
        }
        FeltNow { of_circulation: [a, b], rest: [a0, b0] }
    }

    /// Circulation that the blades carry where they are now, blade by blade, `Omega R^2`.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for another number of values, or one that is not finite.
    pub fn put_circulation(&mut self, circulation: &DVector<f64>) -> Result<(), WakeError> {
        let panels = self.wake.rotor.panels();
        let (count, expected) = (circulation.len(), "blades times panels of the wake");
        let fits = count == self.blades.len() * panels;
        ensure(fits, "values of the circulation", count as f64, expected)?;
        let mut values = self.circulation.values().to_vec();
        for (blade, of_blade) in self.blades.iter().zip(circulation.as_slice().chunks(panels)) {
            let row = blade.past.row(0);
            values[row * panels..(row + 1) * panels].copy_from_slice(of_blade);
        }
        self.circulation = CirculationMap::new(panels, values)?;
        self.refresh_velocities();
        Ok(())
    }

    /// Circulation that the blades carry now, blade by blade, `Omega R^2`.
    pub fn circulation(&self) -> DVector<f64> {
        let rows = self.blades.iter().map(|b| self.circulation.row(b.past.row(0)));
        DVector::from_vec(rows.flatten().copied().collect())
    }

    fn context(&self) -> SourceContext<'_> {
        let far = self.blades.iter().flat_map(|b| &b.shape[self.wake.free_of_near()..]);
        let turn = last_turn(far, self.wake.settings.azimuths);
        self.wake.context(&self.circulation, turn)
    }

    fn targets(&self) -> Vec<TargetBlock> {
        let (settings, panels) = (&self.wake.settings, self.wake.rotor.panels());
        let mut blocks: Vec<TargetBlock> = Vec::new();
        for (b, blade) in self.blades.iter().enumerate() {
            let azimuth = blade.past.now as f64 * settings.step_rad();
            let BladePlace { line, edge } = &blade.places[0];
            for s in 0..panels {
                if blocks.last().is_none_or(|block| block.points.len() == BLOCK) {
                    blocks.push(TargetBlock::default());
                }
                if let Some(block) = blocks.last_mut() {
                    let ends = [&line[s..s + 2], &edge[s..s + 2]];
                    block.push(b * panels + s, ends, azimuth, settings);
                }
            }
        }
        blocks
    }

    fn view<'a>(&'a self, blade: &'a BladeWake) -> BladeView<'a> {
        let (free_near, far) = blade.shape.split_at(self.wake.free_of_near());
        let near = if self.wake.near_is_free() { free_near } else { &blade.near };
        let BladePlace { line, edge } = &blade.places[0];
        BladeView {
            past: blade.past,
            line,
            edge,
            near: near.iter().map(Vec::as_slice).collect(),
            far: far.iter().map(Vec::as_slice).collect(),
        }
    }

    /// Fills the newest level of every blade, and places what of the near wake is placed.
    fn carry(&mut self) {
        let wake = &self.wake;
        let (step, stream, near) =
            (wake.settings.step_rad(), wake.free_stream(), self.wake.free_of_near());
        let roll_up = RollUp::new(&wake.settings.far, &wake.rotor, &self.circulation);
        let point = wake.settings.release;
        for blade in &mut self.blades {
            let (edge, row) = (blade.places[0].edge.clone(), blade.past.row(0));
            let release = |j: usize| match (j.checked_sub(near), point) {
                (None, _) => edge[wake.near[j].node],
                (Some(f), ReleasePoint::Station) => edge[roll_up.nodes[f]],
                (Some(f), ReleasePoint::Centroid) => {
                    let at = roll_up.release_station(f, row, point, &wake.rotor, &self.circulation);
                    edge_between(&edge, &wake.rotor, at)
                }
            };
            blade.carry(release, step, stream);
            if let Some(tip) = blade.shape.last() {
                blade.released[0] = tip[0];
            }
            if near == 0 {
                blade.near = wake.near_behind(blade);
            }
        }
    }

    fn refresh_velocities(&mut self) {
        let context = self.context();
        let views: Vec<BladeView<'_>> = self.blades.iter().map(|b| self.view(b)).collect();
        let shapes: Vec<&Shape> = self.blades.iter().map(|b| &b.shape).collect();
        let velocities = self.wake.velocities_of(&shapes, &views, &context);
        for (blade, mut velocity) in self.blades.iter_mut().zip(velocities) {
            add_the_body(&self.wake, &blade.shape, &mut velocity);
            blade.velocity = velocity;
        }
    }
}

impl FreeWake {
    /// Trailers of the near wake behind a blade in time, where their motion is prescribed: as on the periodic grid.
    fn near_behind(&self, blade: &BladeWake) -> Shape {
        let motion = self.settings.near_wake_motion;
        let ages = 0..=self.settings.near_steps();
        let of_node = |node: usize| -> Vec<Vec3> {
            let carried = |k: usize| add(blade.places[k].edge[node], self.wind_over(k));
            let at = |k: usize| match motion {
                NearWakeMotion::BladePlane => self.swept_back(blade.places[0].edge[node], k),
                NearWakeMotion::FollowsTip => {
                    let tip = &blade.shape[blade.shape.len() - 1];
                    let undistorted = add(blade.released[k], self.wind_over(k));
                    let moved = sub(tip[k], undistorted);
                    add(carried(k), scale(moved, self.rotor.nodes()[node]))
                }
                _ => carried(k),
            };
            ages.clone().map(at).collect()
        };
        (0..=self.rotor.panels()).map(of_node).collect()
    }
}
