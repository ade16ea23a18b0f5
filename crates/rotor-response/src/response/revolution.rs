//! Root loads and hinge moments over the revolution, summed from the motion and its loads.

use crate::loads::power::{PowerBalance, power};
use crate::loads::wrenches::{SixLoads, hub_loads};
use crate::response::evaluated::{Revolution, Work};
use crate::response::hinge::HingeMoment;
use crate::response::root_reaction::Loading;
use crate::response::system::ResponseSystem;
use crate::sections::air::SectionLoads;
use crate::sections::flight_air::{Lags, POINTS_TOGETHER};
use crate::structure::equations::{BladeState, SpanLoads};
use crate::{ResponseError, Rotor};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_fem::{OrbitSamples, PeriodicSolver, TimeElements};
use std::f64::consts::TAU;

/// Move of the accelerations at which they have settled.
pub(crate) const SETTLED: f64 = 1e-14;
/// What a move of the accelerations by the kept Newton matrix leaves to move, at most: 1e-14 where the apparent
/// mass is that of the matrix, more where it turns with the blade.
const KEPT_LEAVES: f64 = 1e-5;
/// Iterations of the accelerations.
const ACCELERATION_ITERATIONS: usize = 30;

/// Quadrature weights of the time points that sum to 1.
pub(crate) fn unit_weights(time: &TimeElements) -> Vec<f64> {
    time.weights().iter().map(|w| w / TAU).collect()
}

/// Harmonics of a history at the time points.
pub(crate) fn series(
    time: &TimeElements,
    history: impl Iterator<Item = f64>,
    count: usize,
) -> HarmonicSeries {
    let values: Vec<f64> = history.collect();
    HarmonicSeries::project(time.points(), &unit_weights(time), &values, count)
}

/// Lift per length and circulation of one section, rotor units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lifting {
    pub(crate) lift: f64,
    pub(crate) circulation: f64,
}

impl Lifting {
    pub(crate) fn of(loads: SectionLoads) -> Self {
        Self { lift: loads.fz, circulation: loads.circulation }
    }
}

impl Revolution {
    /// Lift and circulation at every point and lifting station. They do not ask for accelerations.
    pub(crate) fn lifting(&self) -> Vec<Vec<Lifting>> {
        (0..self.points()).map(|p| self.at(p).map(Lifting::of).collect()).collect()
    }
}

/// An orbit at the points, `f` of the system there, and its loads.
pub(crate) type Found = (OrbitSamples, DMatrix<f64>, Revolution);

/// Root loads and hinge moments at every azimuth point.
pub(crate) struct RevolutionLoads {
    /// Aerodynamic lift and circulation at the lifting stations, by point.
    pub(crate) lifting: Vec<Vec<Lifting>>,
    points: Vec<PointLoads>,
    pub(crate) power: PowerBalance,
    /// The accelerations that went into the sums.
    pub(crate) accelerations: DMatrix<f64>,
}

/// The loads at one azimuth point.
pub(crate) struct PointLoads {
    /// Root loads, forces then moments, in the axes that turn with the blade.
    pub(crate) root: [f64; 6],
    /// Aerodynamic and inertial, by flap.
    hinge: [Vec<f64>; 2],
    power: PowerBalance,
}

impl PointLoads {
    /// The sums at point `p` of a motion and its loads as they are.
    pub(crate) fn new(
        rotor: &Rotor,
        system: &ResponseSystem<'_>,
        samples: &OrbitSamples,
        revolution: &Revolution,
        p: usize,
        loads: &mut SpanLoads,
    ) -> Self {
        let (blade, couplings) = (rotor.blade(), rotor.model().couplings);
        let sections: Vec<SectionLoads> = revolution.at(p).collect();
        let coordinates = samples.at(p);
        let motion = &system.motion(samples, p);
        let loading = Loading::new(system, (motion, &sections), p, loads, coordinates);
        let pitch = system.points[p].air.pitch;
        let state = BladeState { motion, pitch, loads };
        let root = loading.on_hub(blade, couplings, state, coordinates[0]);
        let rates = samples.qd.column(p);
        let damped = rates.dot(&(&rotor.damping * rates));
        Self {
            root,
            hinge: system.hinge_moments(p, motion, &sections),
            power: power(blade, state, &loading.axial, damped, root[5]),
        }
    }
}

impl RevolutionLoads {
    /// Force summation with accelerations that satisfy the equations of motion at each azimuth, settled
    /// until they move by no more than `absolute`.
    pub(crate) fn new(
        rotor: &Rotor,
        orbits: &PeriodicSolver,
        system: &ResponseSystem<'_>,
        found: Found,
        absolute: f64,
    ) -> Result<Self, ResponseError> {
        let (samples, revolution) = settled_motion(rotor, orbits, system, found, absolute)?;
        Ok(Self::of(rotor, orbits.time(), system, &samples, &revolution))
    }

    /// Force summation of a motion as it is.
    pub(crate) fn of(
        rotor: &Rotor,
        time: &TimeElements,
        system: &ResponseSystem<'_>,
        samples: &OrbitSamples,
        revolution: &Revolution,
    ) -> Self {
        let points: Vec<PointLoads> = (0..revolution.points())
            .into_par_iter()
            .with_min_len(POINTS_TOGETHER)
            .map_init(SpanLoads::default, |loads, p| {
                PointLoads::new(rotor, system, samples, revolution, p, loads)
            })
            .collect();
        let mut power = PowerBalance::default();
        for (weight, at) in unit_weights(time).into_iter().zip(&points) {
            power.add(weight, &at.power);
        }
        Self { lifting: revolution.lifting(), points, power, accelerations: samples.qdd.clone() }
    }

    /// Root loads at every azimuth, forces then moments, in the axes that turn with the blade.
    pub(crate) fn roots(&self) -> impl Iterator<Item = [f64; 6]> {
        self.points.iter().map(|at| at.root)
    }

    pub(crate) fn root(&self, time: &TimeElements, count: usize) -> SixLoads {
        let component = |k: usize| series(time, self.points.iter().map(|at| at.root[k]), count);
        SixLoads { components: std::array::from_fn(component) }
    }

    pub(crate) fn hinge(&self, time: &TimeElements, count: usize) -> Vec<HingeMoment> {
        let flaps = self.points.first().map_or(0, |at| at.hinge[0].len());
        let of = |part: usize, flap: usize| {
            series(time, self.points.iter().map(|at| at.hinge[part][flap]), count)
        };
        (0..flaps).map(|k| HingeMoment { aerodynamic: of(0, k), inertial: of(1, k) }).collect()
    }

    pub(crate) fn hub(&self, rotor: &Rotor, time: &TimeElements) -> SixLoads {
        let count = rotor.discretisation.load_harmonics;
        hub_loads(&vec![self.root(time, count + 1); rotor.model().blades], count)
    }
}

/// The motion with accelerations that satisfy the equations of motion at each azimuth, and its air loads.
///
/// The orbit gives positions and rates; the accelerations follow from
/// `M q'' + f(q, q', q'', psi) = 0`, iterated because apparent mass makes `f` depend weakly on them: with
/// the apparent mass of the Newton matrix that is kept, or with none, until they move by no more than
/// `absolute` and 1e-13 of the largest, or with the kept matrix would.
fn settled_motion(
    rotor: &Rotor,
    orbits: &PeriodicSolver,
    system: &ResponseSystem<'_>,
    (mut samples, mut forces, mut revolution): Found,
    absolute: f64,
) -> Result<(OrbitSamples, Revolution), ResponseError> {
    let mass = &rotor.mass;
    let inverse =
        mass.clone().cholesky().ok_or(ResponseError::MassMatrix { modes: mass.nrows() })?;
    let mut work = Work::default();
    for _ in 0..ACCELERATION_ITERATIONS {
        let unbalanced = &forces + mass * &samples.qdd;
        let (moves, left) = match orbits.lacking_accelerations(&unbalanced) {
            Some(moves) => (moves, KEPT_LEAVES),
            None => (-inverse.solve(&unbalanced), 1.0),
        };
        let enough = absolute + 1e-13 * samples.qdd.amax();
        if moves.amax() <= enough {
            break;
        }
        samples.qdd += &moves;
        let last = left * moves.amax() <= enough;
        let residual = (!last).then_some(&mut forces);
        revolution = system.evaluate(&samples, Some(Lags::Followed), &mut work, residual)?;
        if last {
            break;
        }
    }
    Ok((samples, revolution))
}
