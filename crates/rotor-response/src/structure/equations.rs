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

use crate::Couplings;
use crate::structure::blade::ResponseBlade;
use crate::structure::motion::Motion;
use nalgebra::DMatrix;
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

/// Scratch arrays, one per use, so that nothing is allocated inside the azimuth loop.
#[derive(Debug, Clone, Default)]
pub(crate) struct StructureScratch {
    integrand: Vec<f64>,
    foreshortening_rate: Vec<f64>,
    coriolis_tension: Vec<f64>,
    force: [Vec<f64>; 3],
    slope_force: [Vec<f64>; 3],
    bending: [Vec<f64>; 2],
}

impl StructureScratch {
    fn resize(&mut self, n: usize) {
        for v in [&mut self.integrand, &mut self.foreshortening_rate, &mut self.coriolis_tension]
            .into_iter()
            .chain(&mut self.force)
            .chain(&mut self.slope_force)
            .chain(&mut self.bending)
        {
            v.resize(n, 0.0);
        }
    }
}

/// `out_j += sum_i w_i (f_i shape_ji + g_i slope_ji [+ b_i curvature_ji])`.
fn project(out: &mut [f64], weight: &[f64], parts: &[(&[Vec<f64>], &[f64])]) {
    for (j, o) in out.iter_mut().enumerate() {
        *o = parts
            .iter()
            .map(|(shapes, f)| {
                weight.iter().zip(&shapes[j]).zip(*f).map(|((w, s), f)| w * s * f).sum::<f64>()
            })
            .sum();
    }
}

/// Takes the work of moments on the slopes of lag and flap off a residual.
fn subtract_slope_work(blade: &ResponseBlade, loads: &SpanLoads, out: &mut [f64]) {
    let weight = blade.grid.weight();
    let (nf, nl) = (blade.flap.count(), blade.lag.count());
    let mut work = vec![0.0; nf + nl];
    let (flap, lag) = work.split_at_mut(nf);
    project(flap, weight, &[(&blade.flap.slope, &loads.slope[1])]);
    project(lag, weight, &[(&blade.lag.slope, &loads.slope[0])]);
    for (value, work) in out.iter_mut().zip(work) {
        *value -= work;
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
    /// Generalised residual of any couplings without the constant mass part and without damping, at modal
    /// coordinates, rates and accelerations.
    pub(crate) fn residual(
        &self,
        state: BladeState<'_>,
        coordinates: [&[f64]; 3],
        scratch: &mut StructureScratch,
        out: &mut [f64],
    ) {
        let blade = self.blade;
        if let Some(modal) = &blade.modal {
            self.moderate_residual(modal, state, coordinates, out);
        } else {
            modal_residual(blade, self.couplings, state, scratch, out);
            for (o, springs) in out.iter_mut().zip(blade.root_spring.row_iter()) {
                *o += springs.iter().zip(coordinates[0]).map(|(k, q)| k * q).sum::<f64>();
            }
        }
        if blade.flaps_beside_blade() {
            subtract_slope_work(blade, state.loads, out);
        }
    }

    /// Generalised residual of the moderately deflected blade without the constant mass part.
    ///
    /// ```text
    /// Q(q, q', q'') - M q'' - virtual work of (F_x, F_y, F_z, M),   F_x = -w_x F_z - v_x F_y
    /// ```
    /// Loads stand normal to the deflected blade; their axial part works on the foreshortening.
    fn moderate_residual(
        &self,
        modal: &ModalBlade,
        state: BladeState<'_>,
        [q, qd, qdd]: [&[f64]; 3],
        out: &mut [f64],
    ) {
        let BladeState { motion, pitch, loads } = state;
        let coordinates = ModalMotion { value: q, rate: qd, acceleration: qdd };
        let own = modal.force(coordinates, pitch);
        let applied: Vec<[f64; 4]> = (0..loads.fz.len())
            .map(|i| {
                let [x, y, z] = loads.force(self.blade, motion, i);
                [x, y, z, loads.moment[i]]
            })
            .collect();
        let work = modal.applied(q, pitch, &applied);
        for (i, value) in out.iter_mut().enumerate() {
            let constant: f64 = self.mass.row(i).iter().zip(qdd).map(|(m, a)| m * a).sum();
            *value = own[i] - constant - work[i];
        }
    }
}

/// Generalised residual without the constant mass part, modal order flap, lag, torsion.
fn modal_residual(
    blade: &ResponseBlade,
    couplings: Couplings,
    state: BladeState<'_>,
    scratch: &mut StructureScratch,
    out: &mut [f64],
) {
    let BladeState { motion, pitch, loads } = state;
    let n = blade.grid.len();
    scratch.resize(n);
    let full = couplings != Couplings::Linear;
    let s = scratch;
    let (along, across) = blade.precone.sin_cos();
    if full {
        for i in 0..n {
            s.integrand[i] = motion.v.slope[i] * motion.v.slope_rate[i]
                + motion.w.slope[i] * motion.w.slope_rate[i];
        }
        blade.grid.integral_from_root(&s.integrand, &mut s.foreshortening_rate);
        for i in 0..n {
            s.integrand[i] = 2.0 * across * blade.mass[i] * motion.v.rate[i];
        }
        blade.grid.integral_to_tip(&s.integrand, &mut s.coriolis_tension);
    } else {
        s.foreshortening_rate.fill(0.0);
        s.coriolis_tension.fill(0.0);
    }
    for i in 0..n {
        let (m, x) = (blade.mass[i], blade.grid.x()[i]);
        let (w, v, phi) = (&motion.w, &motion.v, &motion.phi);
        let theta = pitch.angle_rad + blade.twist[i] + phi.value[i];
        let tension = blade.tension[i] + s.coriolis_tension[i];
        let radii = blade.km2_squared[i] - blade.km1_squared[i];
        let (eiy, eiz) = (blade.ei_flap[i], blade.ei_lag[i]);
        let [_, weight_y, weight_z] = loads.gravity.map(|g| m * g);
        s.force[0][i] = m * along * (across * x + 2.0 * v.rate[i] - along * w.value[i])
            - loads.fz[i]
            - weight_z;
        s.force[1][i] = -m * (blade.offsets.torque + v.value[i])
            - 2.0 * m * (across * s.foreshortening_rate[i] + along * w.rate[i])
            - loads.fy[i]
            - weight_y;
        s.slope_force[0][i] = tension * w.slope[i];
        s.slope_force[1][i] = tension * v.slope[i];
        s.slope_force[2][i] = (blade.gj[i] + blade.ka_squared[i] * blade.tension[i]) * phi.slope[i];
        let propeller;
        if full {
            let (sin, cos) = theta.sin_cos();
            let kz = v.curvature[i] * cos + w.curvature[i] * sin;
            let ky = w.curvature[i] * cos - v.curvature[i] * sin;
            s.bending[0][i] = eiz * kz * sin + eiy * ky * cos;
            s.bending[1][i] = eiz * kz * cos - eiy * ky * sin;
            propeller = m * radii * sin * cos + (eiz - eiy) * kz * ky;
        } else {
            s.bending[0][i] = eiy * w.curvature[i];
            s.bending[1][i] = eiz * v.curvature[i];
            propeller = m * radii * theta;
        }
        let km_squared = blade.km1_squared[i] + blade.km2_squared[i];
        s.force[2][i] = m * km_squared * pitch.acceleration + propeller - loads.moment[i];
    }
    let weight = blade.grid.weight();
    let (nf, nl) = (blade.flap.count(), blade.lag.count());
    let (out_flap, rest) = out.split_at_mut(nf);
    let (out_lag, out_torsion) = rest.split_at_mut(nl);
    for (out, shapes, k) in [(out_flap, &blade.flap, 0), (out_lag, &blade.lag, 1)] {
        project(
            out,
            weight,
            &[
                (&shapes.value, &s.force[k]),
                (&shapes.slope, &s.slope_force[k]),
                (&shapes.curvature, &s.bending[k]),
            ],
        );
    }
    project(
        out_torsion,
        weight,
        &[(&blade.torsion.value, &s.force[2]), (&blade.torsion.slope, &s.slope_force[2])],
    );
}
