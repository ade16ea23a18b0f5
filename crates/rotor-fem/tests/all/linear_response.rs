//! The response of an orbit to small changes of load.

#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use crate::linear;

use linear::{LinearCoefficients, LinearPeriodic};
use nalgebra::{DMatrix, DVector};
use rotor_fem::{
    LocalTangent, Orbit, OrbitMemory, OrbitSamples, PeriodicError, PeriodicSettings,
    PeriodicSolution, PeriodicSolver, PeriodicSystem, TimeElements,
};
use std::convert::Infallible;

const DOF: usize = 2;

fn coefficients(psi: f64) -> LinearCoefficients {
    LinearCoefficients {
        damping: DMatrix::from_row_slice(2, 2, &[0.4, 0.1 * psi.sin(), -0.1, 0.3]),
        stiffness: DMatrix::from_row_slice(2, 2, &[1.4 + 0.3 * psi.cos(), 0.1, 0.2, 12.0]),
        load: DVector::from_vec(vec![psi.sin() + 0.2, (2.0 * psi).cos()]),
    }
}

/// The linear system plus a memory of the first displacement over the whole revolution that the
/// tangent does not know: `f_2 += 0.02 (q_1(psi) - mean q_1)^3 + 0.2 mean q_1`.
struct WithMemory<S>(S);

impl<S: PeriodicSystem<Error = Infallible>> PeriodicSystem for WithMemory<S> {
    type Error = Infallible;
    type Seen = ();
    type Work = S::Work;

    fn dof(&self) -> usize {
        self.0.dof()
    }

    fn mass(&self) -> &DMatrix<f64> {
        self.0.mass()
    }

    fn residual(
        &self,
        orbit: &OrbitSamples,
        work: &mut S::Work,
        out: &mut DMatrix<f64>,
    ) -> Result<(), Infallible> {
        self.0.residual(orbit, work, out)?;
        let mean = orbit.q.row(0).mean();
        for i in 0..out.ncols() {
            out[(1, i)] += 0.02 * (orbit.q[(0, i)] - mean).powi(3) + 0.2 * mean;
        }
        Ok(())
    }

    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Infallible> {
        self.0.tangents(orbit)
    }
}

/// A load that is added to the system's own with a factor.
struct WithLoad<'a, S>(&'a S, &'a DMatrix<f64>, f64);

impl<S: PeriodicSystem<Error = Infallible>> PeriodicSystem for WithLoad<'_, S> {
    type Error = Infallible;
    type Seen = ();
    type Work = S::Work;

    fn dof(&self) -> usize {
        self.0.dof()
    }

    fn mass(&self) -> &DMatrix<f64> {
        self.0.mass()
    }

    fn residual(
        &self,
        orbit: &OrbitSamples,
        work: &mut S::Work,
        out: &mut DMatrix<f64>,
    ) -> Result<(), Infallible> {
        self.0.residual(orbit, work, out)?;
        *out += self.1 * self.2;
        Ok(())
    }

    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Infallible> {
        self.0.tangents(orbit)
    }
}

fn solver() -> PeriodicSolver {
    let time = TimeElements::new(8, 5, 8).unwrap();
    PeriodicSolver::new(time, PeriodicSettings { tolerance: 1e-13, ..PeriodicSettings::default() })
        .unwrap()
}

fn loads(time: &TimeElements) -> Vec<DMatrix<f64>> {
    (1..=3)
        .map(|n| {
            DMatrix::from_fn(DOF, time.points().len(), |i, p| {
                (f64::from(n) * time.points()[p] + i as f64).cos()
            })
        })
        .collect()
}

#[test]
fn it_is_the_difference_of_two_orbits() {
    let system = WithMemory(LinearPeriodic::new(
        DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 0.01]),
        coefficients,
    ));
    let mut solver = solver();
    let PeriodicSolution { orbit, force, .. } =
        solver.solve(&system, &Orbit::zero(solver.time(), DOF)).unwrap();
    let time = solver.time().clone();
    let loads = loads(&time);
    let found = solver.linear_response(&system, &orbit, &force, &loads, 1e-9).unwrap();
    assert!(found.relative_residual <= 1e-9);
    assert_eq!(found.factorisations, 0, "the matrix of the solution serves");
    for (load, change) in loads.iter().zip(&found.changes) {
        let step = 1e-4;
        let mut moved = |factor: f64| {
            let orbit = solver.solve(&WithLoad(&system, load, factor), &orbit).unwrap();
            orbit.samples.q
        };
        let exact = (moved(step) - moved(-step)) / (2.0 * step);
        let off = (&change.sample(&time).q - &exact).amax() / exact.amax();
        assert!(off < 1e-6, "{off:e}");
    }
}

#[test]
fn forces_of_the_wrong_shape_are_refused() {
    let system = LinearPeriodic::new(DMatrix::identity(DOF, DOF), coefficients);
    let mut solver = solver();
    let orbit = solver.solve(&system, &Orbit::zero(solver.time(), DOF)).unwrap().orbit;
    let loads = loads(solver.time());
    let wrong = DMatrix::zeros(DOF, 3);
    let refused = solver.linear_response(&system, &orbit, &wrong, &loads, 1e-9);
    assert!(matches!(refused, Err(PeriodicError::Shape { .. })));
}

#[test]
fn a_load_of_the_wrong_shape_is_refused_and_none_costs_nothing() {
    let system = LinearPeriodic::new(DMatrix::identity(DOF, DOF), coefficients);
    let mut solver = solver();
    let PeriodicSolution { orbit, force, .. } =
        solver.solve(&system, &Orbit::zero(solver.time(), DOF)).unwrap();
    let wrong = [DMatrix::zeros(DOF, 3)];
    let refused = solver.linear_response(&system, &orbit, &force, &wrong, 1e-6);
    assert!(matches!(refused, Err(PeriodicError::Shape { .. })));
    let still = [DMatrix::zeros(DOF, solver.time().points().len())];
    let found = solver.linear_response(&system, &orbit, &force, &still, 1e-6).unwrap();
    assert!(found.changes[0].sample(solver.time()).q.amax() < f64::MIN_POSITIVE);
    assert_eq!(found.evaluations, 0);
}

/// A linear memory, `f_2 += 3 mean q_1`, which the Newton matrix may be told of.
struct Remembering<S> {
    local: S,
    told: bool,
}

const MEMORY: f64 = 3.0;

impl<S: PeriodicSystem<Error = Infallible>> PeriodicSystem for Remembering<S> {
    type Error = Infallible;
    type Seen = ();
    type Work = S::Work;

    fn dof(&self) -> usize {
        self.local.dof()
    }

    fn mass(&self) -> &DMatrix<f64> {
        self.local.mass()
    }

    fn residual(
        &self,
        orbit: &OrbitSamples,
        work: &mut S::Work,
        out: &mut DMatrix<f64>,
    ) -> Result<(), Infallible> {
        self.local.residual(orbit, work, out)?;
        let mean = orbit.q.row(0).mean();
        for i in 0..out.ncols() {
            out[(1, i)] += MEMORY * mean;
        }
        Ok(())
    }

    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Infallible> {
        self.local.tangents(orbit)
    }

    fn memory(&self, orbit: &OrbitSamples) -> Result<Option<OrbitMemory>, Infallible> {
        let points = orbit.q.ncols();
        let mut memory = OrbitMemory::zero(DOF, points);
        for now in 0..points {
            for then in 0..points {
                memory.dq[(now * DOF + 1, then * DOF)] = MEMORY / points as f64;
            }
        }
        Ok(self.told.then_some(memory))
    }
}

#[test]
fn a_newton_matrix_that_knows_the_memory_needs_one_step() {
    let [known, unknown] = [true, false].map(|told| {
        let local = LinearPeriodic::new(DMatrix::identity(DOF, DOF), coefficients);
        let system = Remembering { local, told };
        let mut solver = solver();
        let found = solver.solve(&system, &Orbit::zero(solver.time(), DOF)).unwrap();
        let history = &found.residual_history;
        (history[1] / history[0], found.orbit.sample(solver.time()).q)
    });
    // the equations are linear
    assert!(known.0 < 1e-10, "{:e}", known.0);
    assert!(unknown.0 > 1e-3, "{:e}", unknown.0);
    assert!((known.1 - unknown.1).amax() < 1e-11);
}

#[test]
fn a_memory_of_the_wrong_shape_is_refused() {
    struct Misshapen(LinearPeriodic<fn(f64) -> LinearCoefficients>);
    impl PeriodicSystem for Misshapen {
        type Error = Infallible;
        type Seen = ();
        type Work = ();

        fn dof(&self) -> usize {
            DOF
        }

        fn mass(&self) -> &DMatrix<f64> {
            self.0.mass()
        }

        fn residual(
            &self,
            orbit: &OrbitSamples,
            (): &mut (),
            out: &mut DMatrix<f64>,
        ) -> Result<(), Infallible> {
            self.0.residual(orbit, &mut (), out)
        }

        fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Infallible> {
            self.0.tangents(orbit)
        }

        fn memory(&self, _: &OrbitSamples) -> Result<Option<OrbitMemory>, Infallible> {
            Ok(Some(OrbitMemory::zero(DOF, 3)))
        }
    }
    let local: fn(f64) -> LinearCoefficients = coefficients;
    let system = Misshapen(LinearPeriodic::new(DMatrix::identity(DOF, DOF), local));
    let mut solver = solver();
    let found = solver.solve(&system, &Orbit::zero(solver.time(), DOF));
    assert!(matches!(found, Err(PeriodicError::Shape { .. })), "{found:?}");
}
