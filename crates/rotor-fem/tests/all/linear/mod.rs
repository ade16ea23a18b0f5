//! Linear equations with periodic coefficients, the simplest system.

use std::convert::Infallible;

use nalgebra::{DMatrix, DVector};

use rotor_fem::{LocalTangent, OrbitSamples, PeriodicSystem};

/// Coefficients of a linear system at one azimuth, rotor units.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LinearCoefficients {
    /// Damping matrix, `dof x dof`.
    pub(crate) damping: DMatrix<f64>,
    /// Stiffness matrix, `dof x dof`.
    pub(crate) stiffness: DMatrix<f64>,
    /// Load, `dof`.
    pub(crate) load: DVector<f64>,
}

/// A linear system with periodic coefficients.
///
/// ```text
/// M q'' + C(psi) q' + K(psi) q = F(psi)
/// ```
/// `coefficients` gives C, K and F at an azimuth in rad; the tangent is exact, so one Newton step
/// solves it.
#[derive(Debug, Clone)]
pub(crate) struct LinearPeriodic<F> {
    mass: DMatrix<f64>,
    coefficients: F,
}

impl<F: Fn(f64) -> LinearCoefficients + Sync> LinearPeriodic<F> {
    /// A system of mass matrix `mass`, whose order is the number of degrees of freedom.
    pub(crate) fn new(mass: DMatrix<f64>, coefficients: F) -> Self {
        Self { mass, coefficients }
    }
}

impl<F: Fn(f64) -> LinearCoefficients + Sync> PeriodicSystem for LinearPeriodic<F> {
    type Error = Infallible;
    type Seen = ();
    type Work = ();

    fn dof(&self) -> usize {
        self.mass.nrows()
    }

    fn mass(&self) -> &DMatrix<f64> {
        &self.mass
    }

    fn residual(
        &self,
        orbit: &OrbitSamples,
        (): &mut (),
        out: &mut DMatrix<f64>,
    ) -> Result<(), Infallible> {
        for (i, &psi) in orbit.azimuth_rad.iter().enumerate() {
            let c = (self.coefficients)(psi);
            let force = &c.damping * orbit.qd.column(i) + &c.stiffness * orbit.q.column(i) - c.load;
            out.set_column(i, &force);
        }
        Ok(())
    }

    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Infallible> {
        let tangent = |&psi: &f64| {
            let c = (self.coefficients)(psi);
            let dqdd = DMatrix::zeros(self.dof(), self.dof());
            LocalTangent { dq: c.stiffness, dqd: c.damping, dqdd }
        };
        Ok(orbit.azimuth_rad.iter().map(tangent).collect())
    }
}
