//! The linearised rotor as matrices of state space: one blade over the azimuth, and all blades in multiblade coordinates.

use crate::response::evaluated::Work;
use crate::response::revolution::{RevolutionLoads, unit_weights};
use crate::response::system::ResponseSystem;
use crate::sections::flight_air::Lags;
use crate::{Condition, ResponseError, RotorSolution, RotorSolver};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::rotating_to_fixed;
use rotor_fem::{ModeKind, OrbitSamples, PeriodicSystem};

/// Loads of one blade on the hub.
const LOADS: usize = 6;
/// Steps of one-sided differences, of coordinates and of flap angles and their rates: loads are close to linear in both.
const MOTION_STEP: f64 = 1e-6;
const FLAP_STEP: f64 = 1e-5;

/// One blade about its periodic response, at azimuths of a revolution.
///
/// ```text
/// x' = A(psi) x + B(psi) u,     y = C(psi) x + D(psi) u
/// x = (q, q'),   u = (delta, delta', delta'') flap by flap,   y = Fx Fy Fz Mx My Mz on the hub in the fixed frame
/// M q'' + f(q, q', q'', delta, delta', delta'', psi) = 0   =>   q'' = -(M + f_q'')^-1 ( f_q q + f_q' q' + f_u u )
/// ```
/// Derivatives are by azimuth in rad: `Omega A` is that by time. Changes about the response, rotor units (loads in
/// `m0 Omega^2 R^2` and `R^3`), angles in rad, flaps trailing edge down positive. Blade `b` of `N` is the same at
/// `psi + 2 pi b / N`; the hub feels the sum of all `y`.
///
/// - *Held*: the inflow and the pilot controls, as in the response.
/// - *Quasi-steady*: the lag states of the sections are settled at every azimuth. With sections without lags (`QuasiSteady`)
///   nothing is left out; with others the motion of the shed wake is.
///
/// Source: W. Johnson, *Helicopter Theory* (1980), chapters 8 and 12.
#[derive(Debug, Clone, PartialEq)]
pub struct BladeStateSpace {
    /// Azimuths, rad: those of the time elements.
    pub azimuths_rad: Vec<f64>,
    /// Weight of each in a mean over the revolution; they sum to 1.
    pub weights: Vec<f64>,
    /// Family and number in it of every modal coordinate.
    pub modes: Vec<(ModeKind, usize)>,
    /// Number of flaps.
    pub flaps: usize,
    /// Number of blades.
    pub blades: usize,
    /// States x states at every azimuth.
    pub a: Vec<DMatrix<f64>>,
    /// States x inputs.
    pub b: Vec<DMatrix<f64>>,
    /// Loads x states.
    pub c: Vec<DMatrix<f64>>,
    /// Loads x inputs.
    pub d: Vec<DMatrix<f64>>,
}

/// A motion of all blades together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BladesTogether {
    /// All blades alike.
    Collective,
    /// `cos n psi_b`.
    Cosine(u32),
    /// `sin n psi_b`.
    Sine(u32),
    /// In turn up and down; of an even number of blades.
    Differential,
}

impl BladesTogether {
    /// Those of a number of blades, as many.
    pub fn of(blades: usize) -> Vec<Self> {
        let pairs = (1..).take(blades.saturating_sub(1) / 2);
        let mut all = vec![Self::Collective];
        all.extend(pairs.flat_map(|n| [Self::Cosine(n), Self::Sine(n)]));
        if blades.is_multiple_of(2) && blades > 0 {
            all.push(Self::Differential);
        }
        all
    }

    /// What a coordinate of 1 moves the blade at an azimuth by, with two derivatives; of the first blade.
    fn shape(self, azimuth_rad: f64) -> [f64; 3] {
        match self {
            Self::Collective | Self::Differential => [1.0, 0.0, 0.0],
            Self::Cosine(n) => {
                let n = f64::from(n);
                let (sin, cos) = (n * azimuth_rad).sin_cos();
                [cos, -n * sin, -n * n * cos]
            }
            Self::Sine(n) => {
                let n = f64::from(n);
                let (sin, cos) = (n * azimuth_rad).sin_cos();
                [sin, n * cos, -n * n * sin]
            }
        }
    }

    /// Weight of a blade in this coordinate, times the number of blades.
    fn weight(self, azimuth_rad: f64) -> f64 {
        let factor = if matches!(self, Self::Cosine(_) | Self::Sine(_)) { 2.0 } else { 1.0 };
        factor * self.shape(azimuth_rad)[0]
    }

    /// Whether the mean over blades of this coordinate and another one vanishes, since blades in turn cancel.
    fn cancels(self, other: Self) -> bool {
        (self == Self::Differential) != (other == Self::Differential)
    }
}

/// All blades in multiblade coordinates, averaged over the revolution: coefficients that do not change.
///
/// ```text
/// q_b = q_0 + sum q_nc cos n psi_b + q_ns sin n psi_b + (-1)^b q_d
/// X' = A X + B U,    Z = C X + D U
/// X = (all q, all q'),   q coordinate by coordinate, mode by mode;   U likewise, flap by flap (delta, delta', delta'');   Z hub loads
/// ```
/// In hover without cyclic pitch it is the periodic rotor itself, for three blades or more: the loads of one or two in the fixed
/// frame keep a part that changes with the azimuth. In flight the mean of every coefficient is kept and its harmonics are dropped:
/// it answers slow motions, not what the harmonics carry from one frequency to another.
///
/// Source: R. Coleman, A. Feingold, NACA report 1351 (1958); W. Johnson, *Helicopter Theory* (1980), section 8-4.
#[derive(Debug, Clone, PartialEq)]
pub struct MultibladeStateSpace {
    /// The coordinates.
    pub coordinates: Vec<BladesTogether>,
    /// States x states.
    pub a: DMatrix<f64>,
    /// States x inputs.
    pub b: DMatrix<f64>,
    /// Loads x states.
    pub c: DMatrix<f64>,
    /// Loads x inputs.
    pub d: DMatrix<f64>,
}

impl RotorSolver {
    /// State space of one blade about a solution of this solver, obtained in `condition`.
    ///
    /// # Errors
    /// [`ResponseError::FlapMotions`]; [`ResponseError::MassMatrix`] where mass and apparent mass together have no inverse;
    /// the errors of an evaluation of the revolution.
    pub fn state_space(
        &self,
        condition: &Condition,
        solution: &RotorSolution,
    ) -> Result<BladeStateSpace, ResponseError> {
        self.check_flaps(&condition.flap_angles_rad)?;
        let points = self.point_inputs(condition, &solution.inflow);
        let system = self.rotor.system(&self.air, points);
        let samples = OrbitSamples {
            qdd: solution.accelerations.clone(),
            ..solution.orbit.sample(&self.time)
        };
        let (modes, flaps) = (system.dof(), condition.flap_angles_rad.len());
        let base = self.quasi_steady(&system, &samples)?;
        let along_motion = (0..3 * modes)
            .into_par_iter()
            .map(|column| {
                let mut moved = samples.clone();
                let part = match column / modes {
                    0 => &mut moved.q,
                    1 => &mut moved.qd,
                    _ => &mut moved.qdd,
                };
                part.row_mut(column % modes).add_scalar_mut(MOTION_STEP);
                Ok(self.quasi_steady(&system, &moved)?.slope(&base, MOTION_STEP))
            })
            .collect::<Result<Vec<Evaluated>, ResponseError>>()?;
        let along_flaps = (0..3 * flaps)
            .into_par_iter()
            .map(|column| {
                let mut points = system.points.clone();
                for point in &mut points {
                    point.flap[column / 3][column % 3] += FLAP_STEP;
                }
                let moved = self.quasi_steady(&system.with_points(points), &samples)?;
                Ok(moved.slope(&base, FLAP_STEP))
            })
            .collect::<Result<Vec<Evaluated>, ResponseError>>()?;
        let azimuths_rad = self.time.points().to_vec();
        let mut made = BladeStateSpace {
            weights: unit_weights(&self.time),
            modes: (0..modes).map(|k| self.rotor.blade().mode(k)).collect(),
            flaps,
            blades: self.rotor.model().blades,
            a: Vec::new(),
            b: Vec::new(),
            c: Vec::new(),
            d: Vec::new(),
            azimuths_rad,
        };
        for p in 0..made.azimuths_rad.len() {
            let of = |part: usize| {
                let slope = |i: usize, j: usize| along_motion[part * modes + j].forces[(i, p)];
                DMatrix::from_fn(modes, modes, slope)
            };
            let mass = (system.mass + of(2)).lu();
            let solved = |right: DMatrix<f64>| {
                mass.solve(&-right).ok_or(ResponseError::MassMatrix { modes })
            };
            let forces = DMatrix::from_fn(modes, 3 * flaps, |i, j| along_flaps[j].forces[(i, p)]);
            let (by_q, by_rate) = (solved(of(0))?, solved(of(1))?);
            let by_flaps = solved(forces)?;
            let fixed = |root: DVector<f64>| in_fixed_frame(made.azimuths_rad[p], &root);
            let loads = |of: &[Evaluated]| {
                let columns: Vec<_> = of.iter().map(|e| fixed(e.root.column(p).into())).collect();
                DMatrix::from_columns(&columns)
            };
            let load = loads(&along_motion);
            let by_acceleration = load.columns(2 * modes, modes);
            let mut a = DMatrix::zeros(2 * modes, 2 * modes);
            a.view_mut((0, modes), (modes, modes)).fill_with_identity();
            a.view_mut((modes, 0), (modes, modes)).copy_from(&by_q);
            a.view_mut((modes, modes), (modes, modes)).copy_from(&by_rate);
            let mut b = DMatrix::zeros(2 * modes, 3 * flaps);
            b.view_mut((modes, 0), (modes, 3 * flaps)).copy_from(&by_flaps);
            let mut c = load.columns(0, 2 * modes).into_owned();
            c += by_acceleration * a.rows(modes, modes);
            let mut d = if flaps > 0 { loads(&along_flaps) } else { DMatrix::zeros(LOADS, 0) };
            d += by_acceleration * &by_flaps;
            made.a.push(a);
            made.b.push(b);
            made.c.push(c);
            made.d.push(d);
        }
        Ok(made)
    }

    /// `f` and the root loads at every azimuth, lags settled.
    fn quasi_steady(
        &self,
        system: &ResponseSystem<'_>,
        samples: &OrbitSamples,
    ) -> Result<Evaluated, ResponseError> {
        let mut forces = DMatrix::zeros(system.dof(), samples.q.ncols());
        let lags = Some(Lags::Settled);
        let revolution = system.evaluate(samples, lags, &mut Work::default(), Some(&mut forces))?;
        let loads = RevolutionLoads::of(&self.rotor, &self.time, system, samples, &revolution);
        let columns: Vec<DVector<f64>> =
            loads.roots().map(|root| DVector::from_row_slice(&root)).collect();
        Ok(Evaluated { forces, root: DMatrix::from_columns(&columns) })
    }
}

/// `f` and the six root loads, a column for each azimuth; or changes of these.
struct Evaluated {
    forces: DMatrix<f64>,
    root: DMatrix<f64>,
}

impl Evaluated {
    fn slope(self, base: &Self, step: f64) -> Self {
        Self { forces: (self.forces - &base.forces) / step, root: (self.root - &base.root) / step }
    }
}

fn in_fixed_frame(azimuth_rad: f64, root: &DVector<f64>) -> DVector<f64> {
    let part = |k: usize| rotating_to_fixed(azimuth_rad, [root[k], root[k + 1], root[k + 2]]);
    DVector::from_iterator(LOADS, part(0).into_iter().chain(part(3)))
}

impl BladeStateSpace {
    /// All blades together, the mean of the revolution.
    pub fn multiblade(&self) -> MultibladeStateSpace {
        let coordinates = BladesTogether::of(self.blades);
        let (count, modes, inputs) = (coordinates.len(), self.modes.len(), 3 * self.flaps);
        let half = count * modes;
        let mut a = DMatrix::zeros(2 * half, 2 * half);
        a.view_mut((0, half), (half, half)).fill_with_identity();
        let mut b = DMatrix::zeros(2 * half, count * inputs);
        let mut c = DMatrix::zeros(LOADS, 2 * half);
        let mut d = DMatrix::zeros(LOADS, count * inputs);
        let places = self.azimuths_rad.iter().zip(&self.weights).enumerate();
        for (p, (&psi, &share)) in places {
            let a_here = &self.a[p];
            let (by_q, by_rate) = (
                a_here.view((modes, 0), (modes, modes)),
                a_here.view((modes, modes), (modes, modes)),
            );
            let b_here = self.b[p].rows(modes, modes).into_owned();
            let (c_q, c_rate) = (self.c[p].columns(0, modes), self.c[p].columns(modes, modes));
            let identity = DMatrix::identity(modes, modes);
            for (j, column) in coordinates.iter().enumerate() {
                let [v, v1, v2] = column.shape(psi);
                let on_q = by_q * v + by_rate * v1 - &identity * v2;
                let on_rate = by_rate * v - &identity * (2.0 * v1);
                let on_flaps = together(&b_here, [v, v1, v2]);
                for (i, row) in coordinates.iter().enumerate() {
                    if row.cancels(*column) {
                        continue;
                    }
                    let w = share * row.weight(psi);
                    let (r, k) = (half + i * modes, j * modes);
                    let mut add = |at: usize, block: &DMatrix<f64>| {
                        let mut view = a.view_mut((r, at), (modes, modes));
                        view += block * w;
                    };
                    add(k, &on_q);
                    add(half + k, &on_rate);
                    let mut view = b.view_mut((r, j * inputs), (modes, inputs));
                    view += &on_flaps * w;
                }
                if !column.cancels(BladesTogether::Collective) {
                    let all = share * self.blades as f64;
                    let mut view = c.columns_mut(j * modes, modes);
                    view += (c_q * v + c_rate * v1) * all;
                    let mut view = c.columns_mut(half + j * modes, modes);
                    view += c_rate * (v * all);
                    let mut view = d.columns_mut(j * inputs, inputs);
                    view += together(&self.d[p], [v, v1, v2]) * all;
                }
            }
        }
        MultibladeStateSpace { coordinates, a, b, c, d }
    }
}

/// Columns of (angle, rate, acceleration) of each flap for a motion of all blades together.
///
/// ```text
/// delta_b = v d,   delta_b' = v d' + v' d,   delta_b'' = v d'' + 2 v' d' + v'' d
/// ```
fn together(of_blade: &DMatrix<f64>, [v, v1, v2]: [f64; 3]) -> DMatrix<f64> {
    let mut out = of_blade.clone();
    for flap in 0..of_blade.ncols() / 3 {
        let [angle, rate, acceleration] = [0, 1, 2].map(|k| of_blade.column(3 * flap + k));
        out.set_column(3 * flap, &(angle * v + rate * v1 + acceleration * v2));
        out.set_column(3 * flap + 1, &(rate * v + acceleration * (2.0 * v1)));
        out.set_column(3 * flap + 2, &(acceleration * v));
    }
    out
}
