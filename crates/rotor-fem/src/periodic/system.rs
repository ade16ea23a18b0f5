//! What a periodic system must tell its solver.

use nalgebra::DMatrix;

use crate::{OrbitMemory, OrbitSamples};

/// Linearisation of `f` at one azimuth, all matrices of shape `dof x dof`.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalTangent {
    /// Derivative with respect to the displacements.
    pub dq: DMatrix<f64>,
    /// Derivative with respect to the rates.
    pub dqd: DMatrix<f64>,
    /// Derivative with respect to the second derivatives; zero if `f` does not depend on them.
    pub dqdd: DMatrix<f64>,
}

impl LocalTangent {
    /// The tangent of a load that does not depend on the motion.
    pub fn zero(dof: usize) -> Self {
        let zero = DMatrix::zeros(dof, dof);
        Self { dq: zero.clone(), dqd: zero.clone(), dqdd: zero }
    }
}

/// A system with period 2 pi in azimuth, in rotor units (derivatives are per rad of azimuth).
///
/// ```text
/// M q'' + f(q, q', q'', psi) = 0
/// ```
pub trait PeriodicSystem: Sync {
    /// The error of the system's own physics.
    type Error: std::error::Error + 'static;

    /// What it tells of an orbit beside the residual, such as the loads it has found on the way; `()` for nothing.
    type Seen: Send;

    /// Arrays that its residual works in, kept from one evaluation to the next; `()` for none.
    type Work: Default + Send;

    /// Number of degrees of freedom.
    fn dof(&self) -> usize;

    /// The constant, symmetric mass matrix; integrated by parts in the weak form.
    fn mass(&self) -> &DMatrix<f64>;

    /// The rest of the residual at all points of the revolution at once: column `i` of `out` (shape
    /// `dof x points`, zero on entry) becomes `f` at `orbit.azimuth_rad[i]`.
    ///
    /// Seeing the whole revolution, a system with memory (aerodynamic lag states) can make its own
    /// states periodic here. `f` may depend weakly on the second derivatives.
    ///
    /// # Errors
    /// Whatever the system's physics refuses.
    fn residual(
        &self,
        orbit: &OrbitSamples,
        work: &mut Self::Work,
        out: &mut DMatrix<f64>,
    ) -> Result<Self::Seen, Self::Error>;

    /// Takes back what it has told of an orbit that is no longer wanted, for its arrays to be used again.
    fn recycle(&self, seen: Self::Seen, work: &mut Self::Work) {
        let _ = (seen, work);
    }

    /// Approximate local linearisation of `f` at every point, used for the Newton matrix only.
    ///
    /// # Errors
    /// Whatever the system's physics refuses.
    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Self::Error>;

    /// What the tangents leave out of the Newton matrix because it sees the whole revolution. A system
    /// whose memory is missing here still converges to the same orbit, as long as that memory is weak.
    ///
    /// # Errors
    /// Whatever the system's physics refuses.
    fn memory(&self, orbit: &OrbitSamples) -> Result<Option<OrbitMemory>, Self::Error> {
        let _ = orbit;
        Ok(None)
    }
}
