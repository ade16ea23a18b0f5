//! Root loads and hinge moments over the revolution, summed from the motion and its loads.

use crate::air::SectionLoads;
use crate::hinge::HingeMoment;
use crate::loads::{
    SixLoads, hub_loads, moderate_root_loads, root_curvature_moments, root_loads, root_moments,
};
use crate::power::{AxialMotion, PowerBalance, power};
use crate::structure::{BladeState, SpanLoads};
use crate::system::ResponseSystem;
use crate::wake_coupling::Lifting;
use crate::{ResponseError, RootBending, Rotor};
use nalgebra::DMatrix;
use rotor_base::HarmonicSeries;
use rotor_fem::{ModalMotion, OrbitSamples, PeriodicSystem, TimeElements};
use std::f64::consts::TAU;

/// Iterations of the accelerations.
const ACCELERATION_ITERATIONS: usize = 30;

/// Quadrature weights of the time points that sum to 1.
pub(crate) fn unit_weights(time: &TimeElements) -> Vec<f64> {
    time.weights().iter().map(|w| w / TAU).collect()
}

/// Root loads and hinge moments at every azimuth point.
pub(crate) struct RevolutionLoads {
    /// Aerodynamic lift and circulation at the lifting stations, by point.
    pub(crate) lifting: Vec<Vec<Lifting>>,
    root: Vec<[f64; 6]>,
    /// Aerodynamic and inertial hinge moment of each flap.
    hinge: Vec<[Vec<f64>; 2]>,
    /// Moments of flap, lag and torsion at the root, by force summation and by curvature.
    bending: [[Vec<f64>; 2]; 3],
    pub(crate) power: PowerBalance,
    /// The accelerations that went into the sums.
    pub(crate) accelerations: DMatrix<f64>,
}

impl RevolutionLoads {
    /// Force summation with accelerations that satisfy the equations of motion at each azimuth.
    pub(crate) fn new(
        rotor: &Rotor,
        time: &TimeElements,
        system: &ResponseSystem<'_>,
        samples: &OrbitSamples,
    ) -> Result<Self, ResponseError> {
        let mut samples = samples.clone();
        settle_accelerations(rotor, time, system, (&mut samples, 1e-14))?;
        Self::summed(rotor, time, system, &samples)
    }

    /// Force summation of a motion as it is.
    pub(crate) fn summed(
        rotor: &Rotor,
        time: &TimeElements,
        system: &ResponseSystem<'_>,
        samples: &OrbitSamples,
    ) -> Result<Self, ResponseError> {
        let revolution = system.revolution(samples)?;
        let (blade, couplings) = (rotor.blade(), rotor.model().couplings);
        let first = system.air.first_station();
        let mut root = Vec::with_capacity(revolution.motions.len());
        let mut hinge = vec![[Vec::new(), Vec::new()]; rotor.model().flaps.len()];
        let mut bending = [(); 3].map(|()| [Vec::new(), Vec::new()]);
        let mut loads = SpanLoads::default();
        let mut balance = PowerBalance::default();
        let weights = unit_weights(time);
        let mut lifting = Vec::with_capacity(revolution.motions.len());
        for (p, motion) in revolution.motions.iter().enumerate() {
            let sections = &revolution.sections[p];
            lifting.push(sections.iter().map(Lifting::of).collect());
            system.span_loads(p, motion, sections, &mut loads);
            let aerodynamic = aerodynamic_loads(blade.grid.len(), first, sections);
            let pitch = system.points[p].air.pitch;
            let state = BladeState { motion, pitch, loads: &loads };
            let column = |m: &DMatrix<f64>| -> Vec<f64> { m.column(p).iter().copied().collect() };
            let [q, qd, qdd] = [&samples.q, &samples.qd, &samples.qdd].map(column);
            let (at_root, axial) = if let Some(modal) = &blade.modal {
                let coordinates = ModalMotion { value: &q, rate: &qd, acceleration: &qdd };
                let found = modal.loads(coordinates, pitch.into());
                let at_root = moderate_root_loads(blade, state, &found);
                (at_root, AxialMotion::condensed(blade, state, found))
            } else {
                let axial = AxialMotion::inextensional(blade, couplings, state, &aerodynamic);
                (root_loads(blade, state, &aerodynamic), axial)
            };
            root.push(at_root);
            let damped = qd.iter().zip(rotor.damping()).map(|(rate, c)| c * rate * rate).sum();
            balance.add(weights[p], &power(blade, state, &axial, damped, at_root[5]));
            let summed = root_moments(blade, couplings, state);
            let curved = root_curvature_moments(blade, couplings, &q, pitch.angle);
            for (history, (force, curvature)) in
                bending.iter_mut().zip(summed.into_iter().zip(curved))
            {
                history[0].push(force);
                history[1].push(curvature);
            }
            let moments = system.hinge_moments(p, motion, sections);
            for (k, history) in hinge.iter_mut().enumerate() {
                for (part, moment) in history.iter_mut().zip(&moments) {
                    part.push(moment[k]);
                }
            }
        }
        let accelerations = samples.qdd.clone();
        Ok(Self { lifting, root, hinge, bending, power: balance, accelerations })
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

    /// Moments of flap, lag and torsion at the root, in two ways.
    pub(crate) fn root_bending(&self, time: &TimeElements, count: usize) -> [RootBending; 3] {
        self.bending.each_ref().map(|[forces, curvature]| RootBending {
            force_summation: Self::series(time, forces, count),
            curvature: Self::series(time, curvature, count),
        })
    }

    pub(crate) fn hub(&self, rotor: &Rotor, time: &TimeElements) -> SixLoads {
        let count = rotor.discretisation().load_harmonics;
        let blade = self.root(time, count + 1);
        let blades: Vec<SixLoads> = (0..rotor.model().blades).map(|_| blade.clone()).collect();
        hub_loads(&blades, count)
    }
}

/// Accelerations that satisfy the equations of motion at each azimuth, and the evaluations they took.
///
/// The orbit gives positions and rates; the accelerations follow from
/// `q'' = -M^-1 f(q, q', q'', psi)`, iterated because apparent mass makes `f` depend weakly on
/// them, until they move by no more than `absolute` and 1e-13 of the largest.
pub(crate) fn settle_accelerations(
    rotor: &Rotor,
    time: &TimeElements,
    system: &ResponseSystem<'_>,
    (samples, absolute): (&mut OrbitSamples, f64),
) -> Result<usize, ResponseError> {
    let inverse = rotor
        .mass()
        .clone()
        .cholesky()
        .ok_or(ResponseError::MassMatrix { modes: rotor.mass().nrows() })?;
    let mut forces = DMatrix::zeros(system.dof(), time.points().len());
    for evaluation in 1..=ACCELERATION_ITERATIONS {
        system.residual(samples, &mut forces)?;
        let accelerations = -inverse.solve(&forces);
        let moved = (&accelerations - &samples.qdd).amax();
        samples.qdd = accelerations;
        if moved <= absolute + 1e-13 * samples.qdd.amax() {
            return Ok(evaluation);
        }
    }
    Ok(ACCELERATION_ITERATIONS)
}

/// Aerodynamic forces alone at all stations.
fn aerodynamic_loads(stations: usize, first: usize, sections: &[SectionLoads]) -> SpanLoads {
    let mut out = SpanLoads::default();
    out.clear(stations);
    for (s, load) in sections.iter().enumerate() {
        out.fz[first + s] = load.fz;
        out.fy[first + s] = load.fy;
        out.moment[first + s] = load.moment;
    }
    out
}
