//! Root loads and hinge moments over the revolution, summed from the motion and its loads.

use crate::loads::power::{PowerBalance, power};
use crate::loads::wrenches::{SixLoads, hub_loads};
use crate::response::hinge::HingeMoment;
use crate::response::root_reaction::Loading;
use crate::response::system::{ResponseSystem, Revolution};
use crate::sections::air::SectionLoads;
use crate::sections::flight_air::POINTS_TOGETHER;
use crate::structure::equations::{BladeState, SpanLoads};
use crate::{ResponseError, Rotor};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_fem::{OrbitSamples, PeriodicSolution, PeriodicSolver, TimeElements};
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

/// Lift per length and circulation of one section, rotor units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lifting {
    pub(crate) lift: f64,
    pub(crate) circulation: f64,
}

impl Lifting {
    pub(crate) fn of(loads: &SectionLoads) -> Self {
        Self { lift: loads.fz, circulation: loads.circulation }
    }

    pub(crate) fn circulation(&self) -> f64 {
        self.circulation
    }
}

/// Root loads and hinge moments at every azimuth point.
pub(crate) struct RevolutionLoads {
    /// Aerodynamic lift and circulation at the lifting stations, by point.
    pub(crate) lifting: Vec<Vec<Lifting>>,
    root: Vec<[f64; 6]>,
    /// Aerodynamic and inertial hinge moment of each flap.
    hinge: Vec<[Vec<f64>; 2]>,
    pub(crate) power: PowerBalance,
    /// The accelerations that went into the sums.
    pub(crate) accelerations: DMatrix<f64>,
}

/// The loads at one azimuth point.
struct PointLoads {
    lifting: Vec<Lifting>,
    root: [f64; 6],
    /// Aerodynamic and inertial, by flap.
    hinge: [Vec<f64>; 2],
    power: PowerBalance,
}

impl PointLoads {
    fn new(
        rotor: &Rotor,
        system: &ResponseSystem<'_>,
        samples: &OrbitSamples,
        revolution: &Revolution,
        p: usize,
        loads: &mut SpanLoads,
    ) -> Self {
        let (blade, couplings) = (rotor.blade(), rotor.model().couplings);
        let (motion, sections) = (&revolution.motions[p], &revolution.sections[p]);
        let column = |m: &DMatrix<f64>| -> Vec<f64> { m.column(p).iter().copied().collect() };
        let [q, qd, qdd] = [&samples.q, &samples.qd, &samples.qdd].map(column);
        let loading = Loading::new(system, revolution, p, loads, [&q, &qd, &qdd]);
        let pitch = system.points[p].air.pitch;
        let state = BladeState { motion, pitch, loads };
        let root = loading.on_hub(blade, couplings, state, &q);
        let rates = DVector::from_column_slice(&qd);
        let damped = rates.dot(&(rotor.damping() * &rates));
        Self {
            lifting: sections.iter().map(Lifting::of).collect(),
            root,
            hinge: system.hinge_moments(p, motion, sections),
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
        orbit: &PeriodicSolution,
        absolute: f64,
    ) -> Result<Self, ResponseError> {
        let (samples, revolution) = settled_motion(rotor, orbits, system, orbit, absolute)?;
        Ok(Self::of(rotor, orbits.time(), system, &samples, &revolution))
    }

    /// Force summation of a motion as it is.
    pub(crate) fn summed(
        rotor: &Rotor,
        time: &TimeElements,
        system: &ResponseSystem<'_>,
        samples: &OrbitSamples,
    ) -> Result<Self, ResponseError> {
        Ok(Self::of(rotor, time, system, samples, &system.revolution(samples)?))
    }

    fn of(
        rotor: &Rotor,
        time: &TimeElements,
        system: &ResponseSystem<'_>,
        samples: &OrbitSamples,
        revolution: &Revolution,
    ) -> Self {
        let points: Vec<PointLoads> = (0..revolution.motions.len())
            .into_par_iter()
            .with_min_len(POINTS_TOGETHER)
            .map_init(SpanLoads::default, |loads, p| {
                PointLoads::new(rotor, system, samples, revolution, p, loads)
            })
            .collect();
        let mut hinge = vec![[Vec::new(), Vec::new()]; rotor.model().flaps.len()];
        let mut balance = PowerBalance::default();
        for (weight, at) in unit_weights(time).into_iter().zip(&points) {
            balance.add(weight, &at.power);
            for (k, history) in hinge.iter_mut().enumerate() {
                for (part, moment) in history.iter_mut().zip(&at.hinge) {
                    part.push(moment[k]);
                }
            }
        }
        let accelerations = samples.qdd.clone();
        let root = points.iter().map(|at| at.root).collect();
        let lifting = points.into_iter().map(|at| at.lifting).collect();
        Self { lifting, root, hinge, power: balance, accelerations }
    }

    fn series(time: &TimeElements, values: &[f64], count: usize) -> HarmonicSeries {
        HarmonicSeries::project(time.points(), &unit_weights(time), values, count)
    }

    pub(crate) fn root(&self, time: &TimeElements, count: usize) -> SixLoads {
        let component = |k: usize| {
            let values: Vec<f64> = self.root.iter().map(|r| r[k]).collect();
            Self::series(time, &values, count)
        };
        SixLoads {
            components: [
                component(0),
                component(1),
                component(2),
                component(3),
                component(4),
                component(5),
            ],
        }
    }

    pub(crate) fn hinge(&self, time: &TimeElements, count: usize) -> Vec<HingeMoment> {
        self.hinge
            .iter()
            .map(|[aerodynamic, inertial]| HingeMoment {
                aerodynamic: Self::series(time, aerodynamic, count),
                inertial: Self::series(time, inertial, count),
            })
            .collect()
    }

    pub(crate) fn hub(&self, rotor: &Rotor, time: &TimeElements) -> SixLoads {
        let count = rotor.discretisation().load_harmonics;
        let blade = self.root(time, count + 1);
        let blades: Vec<SixLoads> = (0..rotor.model().blades).map(|_| blade.clone()).collect();
        hub_loads(&blades, count)
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
    orbit: &PeriodicSolution,
    absolute: f64,
) -> Result<(OrbitSamples, Revolution), ResponseError> {
    let mass = rotor.mass();
    let inverse =
        mass.clone().cholesky().ok_or(ResponseError::MassMatrix { modes: mass.nrows() })?;
    let (mut samples, mut forces) = (orbit.samples.clone(), orbit.force.clone());
    let mut last = None;
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
        let revolution = system.revolution(&samples)?;
        if left * moves.amax() <= enough {
            return Ok((samples, revolution));
        }
        system.residual_of(&revolution, &samples, &mut forces);
        last = Some(revolution);
    }
    let revolution = match last {
        Some(revolution) => revolution,
        None => system.revolution(&samples)?,
    };
    Ok((samples, revolution))
}
