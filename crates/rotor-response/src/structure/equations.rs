//! Structural and inertial part of the modal equations at one azimuth.
//!
//! ```text
//! flap    int [ m s (c x + 2 v' - s w) - F_z ] F + N w_x F_x + M_w F_xx
//! lag     int [ -m (y_t + v) + 2 m c u' - 2 m s w' - F_y ] L + N v_x L_x + M_v L_xx
//! torsion int [ m km^2 th'' + m (km2^2 - km1^2) sin th cos th + (EI_z - EI_y) kz ky - M ] P
//!             + (GJ + kA^2 T) phi_x P_x
//! kz = v_xx cos th + w_xx sin th      ky = w_xx cos th - v_xx sin th
//! M_w = EI_z kz sin th + EI_y ky cos th      M_v = EI_z kz cos th - EI_y ky sin th
//! N = T + c int_x^1 2 m v'      T = c^2 int_x^1 m x      u' = -int_0^x (v_x v_x' + w_x w_x')
//! ```
//! (here `'` is the azimuth derivative and a subscript `x` the spanwise one; `y_t` is the torque offset; the constant mass part is
//! left to the time elements; `s`, `c` are sine and cosine of the precone). Inextensional blade, elastic axis, centre of
//! gravity and aerodynamic centre at the quarter chord.
//!
//! Source: second-order terms of Hodges and Dowell, NASA TN D-7818 (1974), in the order of Bir and
//! Chopra's UMARC; the same virtual work as the independent cross-check model of this project.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::Couplings;
use crate::structure::blade::ResponseBlade;
use crate::structure::motion::{Foreshortening, ModalRows, Motion};
use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};
use rotor_base::{LANES, Lanes, Number};
use rotor_fem::{ModalBlade, ModalMotion, PitchMotion};

/// Distributed loads at the stations at one azimuth, per length, mass `m0`, length R, time 1/Omega.
#[derive(Debug, Clone, Default)]
pub(crate) struct SpanLoads {
    /// Force normal to the disk, up.
    pub(crate) fz: Vec<f64>,
    /// Force in the disk, toward the leading edge.
    pub(crate) fy: Vec<f64>,
    /// Nose-up moment about the elastic axis.
    pub(crate) moment: Vec<f64>,
    /// Force along the blade and moments on the slopes `v_x` and `w_x`, of flaps that weigh beside
    /// the blade.
    pub(crate) axial: Vec<f64>,
    pub(crate) slope: [Vec<f64>; 2],
    /// Acceleration of gravity in the axes of the coned blade, `Omega^2 R`: its force `m g` keeps its
    /// direction whatever the blade does.
    pub(crate) gravity: [f64; 3],
}

impl SpanLoads {
    /// Force along the undeformed blade at a station: loads stand normal to the deflected blade.
    pub(crate) fn fx(&self, motion: &Motion, station: usize) -> f64 {
        -motion.w.slope[station] * self.fz[station] - motion.v.slope[station] * self.fy[station]
            + self.axial[station]
    }

    /// Force on the blade at a station in its coned axes: loads and weight.
    pub(crate) fn force(&self, blade: &ResponseBlade, motion: &Motion, station: usize) -> [f64; 3] {
        let [x, y, z] = self.gravity.map(|g| blade.mass[station] * g);
        [self.fx(motion, station) + x, self.fy[station] + y, self.fz[station] + z]
    }

    /// Loads at one station; the weight stands in [`gravity`](Self::gravity).
    pub(crate) fn set(&mut self, i: usize, load: &StationLoad) {
        (self.axial[i], self.fy[i], self.fz[i]) = (load.axial, load.fy, load.fz);
        (self.moment[i], self.slope[0][i], self.slope[1][i]) =
            (load.moment, load.slope[0], load.slope[1]);
    }

    /// No loads at `n` stations.
    pub(crate) fn clear(&mut self, n: usize) {
        self.gravity = [0.0; 3];
        let [slope_v, slope_w] = &mut self.slope;
        for v in [&mut self.fz, &mut self.fy, &mut self.moment, &mut self.axial, slope_v, slope_w] {
            v.clear();
            v.resize(n, 0.0);
        }
    }
}

/// Motion, root pitch and loads of the blade at one azimuth.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BladeState<'a> {
    pub(crate) motion: &'a Motion,
    pub(crate) pitch: PitchMotion,
    pub(crate) loads: &'a SpanLoads,
}

/// Loads of one station at one azimuth, or at several side by side, per length: those of [`SpanLoads`].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StationLoad<T = f64> {
    pub(crate) axial: T,
    pub(crate) fy: T,
    pub(crate) fz: T,
    pub(crate) moment: T,
    pub(crate) slope: [T; 2],
    pub(crate) gravity: [T; 3],
}

impl<T: Number> StationLoad<T> {
    /// Adds other loads; the weight stays.
    pub(crate) fn add(&mut self, other: &Self) {
        self.axial += other.axial;
        self.fy += other.fy;
        self.fz += other.fz;
        self.moment += other.moment;
        for (slope, more) in self.slope.iter_mut().zip(other.slope) {
            *slope += more;
        }
    }
}

/// What the moderately deflected blade carries at a station in a block of lanes, per length: force in the axes of the coned
/// blade and nose-up moment, and moments on the slopes of lag and flap.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct AppliedLoad {
    pub(crate) load: [Lanes; 4],
    pub(crate) slope: [Lanes; 2],
}

impl AppliedLoad {
    /// Of loads that stand normal to the deflected blade, and its weight; the motion of the station stands in blocks of lanes.
    #[inline(always)]
    fn of(
        blade: &ResponseBlade,
        (i, motion, block): (usize, &Motion, usize),
        load: &StationLoad<Lanes>,
    ) -> Self {
        let [x, y, z] = load.gravity.map(|g| g * blade.mass[i]);
        let (w_x, v_x): (Lanes, Lanes) = (motion.w.slope(block), motion.v.slope(block));
        let axial = load.axial - w_x * load.fz - v_x * load.fy;
        Self { load: [axial + x, load.fy + y, load.fz + z, load.moment], slope: load.slope }
    }
}

/// Loads of one station in all blocks of lanes, compiled for the vector unit.
pub(crate) struct Applied<'a, L> {
    pub(crate) blade: &'a ResponseBlade,
    pub(crate) i: usize,
    pub(crate) motion: &'a Motion,
    /// Pitch and loads of a block.
    pub(crate) at: L,
    pub(crate) out: &'a mut [AppliedLoad],
}

impl<L: BlockLoad> WithSimd for Applied<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { blade, i, motion, at, out } = self;
        for (block, out) in out.iter_mut().enumerate() {
            *out = AppliedLoad::of(blade, (i, motion, block), &at.at(block).1);
        }
    }
}

/// What a station does on value, slope and curvature of flap, lag and torsion, per length.
#[derive(Debug, Clone, Copy)]
struct StationForce<T> {
    value: [T; 3],
    slope: [T; 3],
    curvature: [T; 2],
}

/// Scratch arrays of one station: what it does, times its weight, in lanes.
#[derive(Debug, Clone, Default)]
pub(crate) struct ForceRows {
    value: [Vec<f64>; 3],
    slope: [Vec<f64>; 3],
    curvature: [Vec<f64>; 2],
    coriolis: Vec<f64>,
}

impl ForceRows {
    fn resize(&mut self, lanes: usize) {
        let rows = self.value.iter_mut().chain(&mut self.slope).chain(&mut self.curvature);
        rows.for_each(|row| row.resize(lanes, 0.0));
    }
}

/// `out += f value + g slope + b curvature` of a mode at a station, lane by lane.
#[inline(always)]
fn add_work(out: &mut [f64], shape: [f64; 3], [f, g, b]: [&[f64]; 3]) {
    let [value, slope, curvature] = shape;
    for (((out, f), g), b) in out.iter_mut().zip(f).zip(g).zip(b) {
        *out += f * value + g * slope + b * curvature;
    }
}

/// Work of a station on all modes from its loads, block by block of lanes: a type of its own, for a closure would be
/// called, not inlined, by the function that is compiled for the vector unit.
struct StationWork<'a, L> {
    blade: &'a ResponseBlade,
    full: bool,
    i: usize,
    motion: &'a Motion,
    rows: &'a ModalRows,
    foreshortening: &'a Foreshortening,
    /// Pitch and loads of a block.
    at: L,
    forces: &'a mut ForceRows,
    out: &'a mut [f64],
}

impl<L: BlockLoad> WithSimd for StationWork<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { blade, full, i, motion, rows, foreshortening, at, forces, out } = self;
        let lanes = rows.lanes();
        forces.resize(lanes);
        let [_, across] = blade.cone;
        let outboard = blade.lag_outboard.iter().map(|moment| 2.0 * across * moment[i]);
        rows.sum(&mut forces.coriolis, (1, blade.flap.count()), outboard);
        let shortening_rate = foreshortening.at(1, i);
        let second = full && !shortening_rate.is_empty();
        let weight = blade.grid.weight()[i];
        for block in 0..lanes / LANES {
            let (pitch, load) = at.at(block);
            let second = if second {
                [Lanes::read(shortening_rate, block), Lanes::read(&forces.coriolis, block)]
            } else {
                [Lanes::default(); 2]
            };
            let force = station_force(blade, full, (i, motion, block), (pitch, &load), second);
            for k in 0..3 {
                (force.value[k] * weight).write(&mut forces.value[k], block);
                (force.slope[k] * weight).write(&mut forces.slope[k], block);
            }
            for k in 0..2 {
                (force.curvature[k] * weight).write(&mut forces.curvature[k], block);
            }
        }
        let mut rows = out.chunks_exact_mut(lanes);
        for (k, of) in [&blade.flap, &blade.lag, &blade.torsion].into_iter().enumerate() {
            let [f, g] = [&forces.value[k], &forces.slope[k]];
            let b = forces.curvature.get(k).unwrap_or(f);
            let bent = if of.bend { 1.0 } else { 0.0 };
            let shapes = of.value.iter().zip(&of.slope).zip(&of.curvature);
            for (((value, slope), curvature), out) in shapes.zip(rows.by_ref()) {
                add_work(out, [value[i], slope[i], bent * curvature[i]], [f, g, b]);
            }
        }
    }
}

/// Pitch and loads of a station in a block of lanes. Its function is to be `inline(always)`: only then is it compiled for
/// the vector unit.
pub(crate) trait BlockLoad {
    fn at(&self, block: usize) -> (PitchMotion<Lanes>, StationLoad<Lanes>);
}

/// A pitch without loads.
struct Unloaded(PitchMotion);

impl BlockLoad for Unloaded {
    #[inline(always)]
    fn at(&self, _: usize) -> (PitchMotion<Lanes>, StationLoad<Lanes>) {
        let PitchMotion { angle_rad, rate, acceleration } = self.0;
        let [angle_rad, rate, acceleration] = [angle_rad, rate, acceleration].map(Lanes::of);
        (PitchMotion { angle_rad, rate, acceleration }, StationLoad::default())
    }
}

/// The structural equations of a blade.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Equations<'a> {
    pub(crate) blade: &'a ResponseBlade,
    /// Which terms they keep.
    pub(crate) couplings: Couplings,
    /// Constant part of the mass matrix.
    pub(crate) mass: &'a DMatrix<f64>,
}

impl Equations<'_> {
    /// Generalised residual of the moderately deflected blade in a block of lanes, mode by mode, without the constant mass part
    /// and without damping; `loads` are those at the stations.
    ///
    /// ```text
    /// Q(q, q', q'') - M q'' - virtual work of (F_x, F_y, F_z, M),   F_x = -w_x F_z - v_x F_y
    /// ```
    /// Loads stand normal to the deflected blade; their axial part works on the foreshortening.
    pub(crate) fn moderate_residual(
        &self,
        modal: &ModalBlade,
        (rows, block): (&ModalRows, usize),
        pitch: PitchMotion<Lanes>,
        loads: &[AppliedLoad],
    ) -> Vec<Lanes> {
        let [value, rate, acceleration] = rows.block(block);
        let motion = ModalMotion { value: &value, rate: &rate, acceleration: &acceleration };
        let applied: Vec<[Lanes; 4]> = loads.iter().map(|own| own.load).collect();
        let mut left = modal.unbalanced_side_by_side(motion, pitch, &applied);
        for (value, mass) in left.iter_mut().zip(self.mass.row_iter()) {
            for (m, a) in mass.iter().zip(&acceleration) {
                *value -= *a * *m;
            }
        }
        if self.blade.flaps_beside_blade() {
            subtract_slope_work(self.blade, loads, &mut left);
        }
        left
    }

    /// Adds what one station does in the equations of `Linear` and `Full` to the generalised residual, mode by mode
    /// in lanes: without the constant mass part, damping and springs at the root. `at` gives pitch and loads of a block.
    pub(crate) fn add_station(
        &self,
        i: usize,
        motion: &Motion,
        (rows, foreshortening): (&ModalRows, &Foreshortening),
        at: impl BlockLoad,
        (forces, out): (&mut ForceRows, &mut [f64]),
    ) {
        let (blade, full) = (self.blade, self.couplings != Couplings::Linear);
        let work = StationWork { blade, full, i, motion, rows, foreshortening, at, forces, out };
        Arch::new().dispatch(work);
    }

    /// Generalised residual of one azimuth without air, without the constant mass part and without damping.
    pub(crate) fn still_residual(
        &self,
        coordinates: [&[f64]; 3],
        pitch: PitchMotion,
        out: &mut [f64],
    ) {
        let blade = self.blade;
        if let Some(modal) = &blade.modal {
            let [value, rate, acceleration] = coordinates;
            let motion = ModalMotion { value, rate, acceleration };
            let own = modal.force(motion, pitch);
            for ((out, own), mass) in out.iter_mut().zip(own).zip(self.mass.row_iter()) {
                *out = own - mass.iter().zip(acceleration).map(|(m, a)| m * a).sum::<f64>();
            }
            return;
        }
        let mut motion = Motion::default();
        let (mut rows, mut shortening) = (ModalRows::default(), Foreshortening::default());
        rows.fill_state(coordinates);
        shortening.fill(blade, self.couplings, &rows);
        let mut forces = ForceRows::default();
        let mut in_lanes = vec![0.0; out.len() * LANES];
        for i in 0..blade.grid.len() {
            motion.fill_station(blade, i, &rows, &shortening);
            let state = (&rows, &shortening);
            self.add_station(i, &motion, state, Unloaded(pitch), (&mut forces, &mut in_lanes));
        }
        for (o, lanes) in out.iter_mut().zip(in_lanes.chunks_exact(LANES)) {
            *o = lanes[0];
        }
        for (o, springs) in out.iter_mut().zip(blade.root_spring.row_iter()) {
            *o += springs.iter().zip(coordinates[0]).map(|(k, q)| k * q).sum::<f64>();
        }
    }
}

/// Takes the work of moments on the slopes of lag and flap off a residual.
fn subtract_slope_work(blade: &ResponseBlade, loads: &[AppliedLoad], out: &mut [Lanes]) {
    let modes = [(&blade.flap, 1), (&blade.lag, 0)];
    let shapes = modes.into_iter().flat_map(|(of, load)| of.slope.iter().map(move |s| (s, load)));
    for (value, (shape, load)) in out.iter_mut().zip(shapes) {
        for ((weight, slope), own) in blade.grid.weight().iter().zip(shape).zip(loads) {
            *value -= own.slope[load] * (weight * slope);
        }
    }
}

/// What one station does at one azimuth, or at several side by side, `Full` or `Linear`. Its motion stands in a lane or a
/// block of lanes; the last argument is what the integrals along the blade give there: rate of the foreshortening and
/// Coriolis tension.
#[inline(always)]
fn station_force<T: Number>(
    blade: &ResponseBlade,
    full: bool,
    (i, motion, lane): (usize, &Motion, usize),
    (pitch, load): (PitchMotion<T>, &StationLoad<T>),
    [foreshortening_rate, coriolis_tension]: [T; 2],
) -> StationForce<T> {
    let [along, across] = blade.cone;
    let (m, x) = (blade.mass[i], blade.grid.x()[i]);
    let (w, v, phi) = (&motion.w, &motion.v, &motion.phi);
    let theta = pitch.angle_rad + blade.twist[i] + phi.value::<T>(lane);
    let tension = coriolis_tension + blade.tension[i];
    let radii = blade.km2_squared[i] - blade.km1_squared[i];
    let (eiy, eiz) = (blade.ei_flap[i], blade.ei_lag[i]);
    let [_, gravity_y, gravity_z] = load.gravity;
    let (weight_y, weight_z) = (gravity_y * m, gravity_z * m);
    let (w_xx, v_xx): (T, T) = (w.curvature(lane), v.curvature(lane));
    let (curvature, propeller) = if full {
        let (sin, cos) = theta.sin_cos();
        let kz = v_xx * cos + w_xx * sin;
        let ky = w_xx * cos - v_xx * sin;
        let bending = [kz * eiz * sin + ky * eiy * cos, kz * eiz * cos - ky * eiy * sin];
        (bending, sin * cos * (m * radii) + kz * ky * (eiz - eiy))
    } else {
        ([w_xx * eiy, v_xx * eiz], theta * (m * radii))
    };
    let km_squared = blade.km1_squared[i] + blade.km2_squared[i];
    StationForce {
        value: [
            (v.rate::<T>(lane) * 2.0 + across * x - w.value::<T>(lane) * along) * (m * along)
                - load.fz
                - weight_z,
            -((v.value::<T>(lane) + blade.offsets.torque) * m)
                - (foreshortening_rate * across + w.rate::<T>(lane) * along) * (2.0 * m)
                - load.fy
                - weight_y,
            pitch.acceleration * (m * km_squared) + propeller - load.moment,
        ],
        slope: [
            tension * w.slope::<T>(lane) - load.slope[1],
            tension * v.slope::<T>(lane) - load.slope[0],
            phi.slope::<T>(lane) * (blade.gj[i] + blade.ka_squared[i] * blade.tension[i]),
        ],
        curvature,
    }
}
