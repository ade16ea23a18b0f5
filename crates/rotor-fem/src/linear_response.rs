//! How a converged orbit answers to small changes of its loads: the implicit function theorem.

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::{Orbit, PeriodicError, PeriodicSolver, PeriodicSystem};

/// Size of a displacement in the differences that apply the exact Jacobian: far above rounding, far
/// below where the second derivatives show.
const DIFFERENCE: f64 = 3e-7;
/// A direction whose image is this small against the new ones holds nothing new.
const DEPENDENT: f64 = 1e-10;

/// Changes of an orbit, one for each change of load.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearResponse {
    /// Change of the orbit per unit of each load.
    pub changes: Vec<Orbit>,
    /// Largest residual left by a linear equation, over its right-hand side.
    pub relative_residual: f64,
    /// Residuals of the system evaluated.
    pub evaluations: usize,
    /// Newton matrices made: none if the one kept by the solver was used.
    pub factorisations: usize,
}

impl PeriodicSolver {
    /// Changes of a converged orbit for small changes of the load `f`.
    ///
    /// ```text
    /// R(q, p) = 0     =>     dq/dp = -(dR/dq)^-1 dR/dp
    /// ```
    /// The Newton matrix kept from the solution of the orbit may leave terms out (the lag states of the
    /// air, which see the whole revolution), so it is the preconditioner only; the exact Jacobian is
    /// applied by differences of the residual. All right-hand sides are solved together by the method
    /// of generalised conjugate residuals: every direction serves them all, and the directions of one
    /// round are independent and evaluated in parallel.
    ///
    /// `load_changes` holds one matrix `df/dp`, shape `dof x points`, for each parameter; a solution is
    /// accepted when the largest relative residual is at most `tolerance`, a number such as 1e-6.
    ///
    /// # Errors
    /// As [`PeriodicSolver::solve`]; [`PeriodicError::NotConverged`] with the relative residuals if the
    /// rounds allowed by the settings are used up.
    ///
    /// Source: S. Eisenstat, H. Elman, M. Schultz, *Variational iterative methods for nonsymmetric
    /// systems of linear equations*, SIAM J. Numer. Anal. 20 (1983); the block form is ours.
    pub fn linear_response<S: PeriodicSystem>(
        &mut self,
        system: &S,
        orbit: &Orbit,
        load_changes: &[DMatrix<f64>],
        tolerance: f64,
    ) -> Result<LinearResponse, PeriodicError<S::Error>>
    where
        S::Error: Send,
    {
        self.check(system, orbit)?;
        let (dof, points) = (system.dof(), self.time().points().len());
        for load in load_changes {
            if load.shape() != (dof, points) {
                let (found, expected) = (load.len(), dof * points);
                let what = "entries of a change of load";
                return Err(PeriodicError::Shape { what, found, expected });
            }
        }
        let base = self.evaluate(system, orbit.clone(), 0, orbit)?;
        let kept = self.factorisation.take().filter(|f| f.dof() == dof);
        let factorisations = usize::from(kept.is_none());
        let matrix = match kept {
            Some(kept) => kept,
            None => self.factorise(system, &base, 0)?,
        };
        // residuals are measured as accelerations: a light mode counts as much as a heavy one
        let mass: Vec<f64> = (0..dof).map(|i| system.mass()[(i, i)]).collect();
        let product = |a: &DMatrix<f64>, b: &DMatrix<f64>| -> f64 {
            a.iter().zip(b).enumerate().map(|(k, (x, y))| x * y / mass[k % dof].powi(2)).sum()
        };
        let still = DMatrix::zeros(dof, points);
        let mut left: Vec<DMatrix<f64>> =
            load_changes.iter().map(|load| -self.weak(&still, load)).collect();
        let sizes: Vec<f64> = left.iter().map(|r| product(r, r).sqrt()).collect();
        let share = |left: &[DMatrix<f64>]| -> Vec<f64> {
            let pairs = left.iter().zip(&sizes);
            pairs.map(|(r, s)| if *s > 0.0 { product(r, r).sqrt() / s } else { 0.0 }).collect()
        };
        let mut changes = vec![DMatrix::zeros(dof, self.time().unknowns_per_dof()); left.len()];
        let mut basis: Vec<(DMatrix<f64>, DMatrix<f64>)> = Vec::new();
        let (mut evaluations, mut history) = (1, Vec::new());
        loop {
            let shares = share(&left);
            let worst = shares.iter().fold(0.0_f64, |m, v| if *v > m { *v } else { m });
            history.push(worst);
            if worst <= tolerance {
                self.factorisation = Some(matrix);
                return Ok(LinearResponse {
                    changes: changes.into_iter().map(|nodal| Orbit { nodal }).collect(),
                    relative_residual: worst,
                    evaluations,
                    factorisations,
                });
            }
            if history.len() > self.settings().max_iterations || !worst.is_finite() {
                return Err(PeriodicError::NotConverged {
                    iterations: history.len() - 1,
                    residual: worst,
                    tolerance,
                    history,
                    best: Box::new(orbit.clone()),
                });
            }
            let open = || left.iter().zip(&shares).filter(|(_, share)| **share > tolerance);
            let directions: Vec<DMatrix<f64>> = open()
                .map(|(r, _)| {
                    let step = -matrix.solve(r);
                    let size = step.amax();
                    if size > 0.0 { step / size } else { step }
                })
                .collect();
            let this = &*self;
            let images = directions
                .par_iter()
                .map(|direction| {
                    let nodal = &orbit.nodal + direction * DIFFERENCE;
                    let moved = this.evaluate(system, Orbit { nodal }, 0, orbit)?;
                    Ok((moved.residual - &base.residual) / DIFFERENCE)
                })
                .collect::<Result<Vec<_>, PeriodicError<S::Error>>>()?;
            evaluations += images.len();
            for (mut direction, mut image) in directions.into_iter().zip(images) {
                let whole = product(&image, &image).sqrt();
                // twice is enough to be orthogonal to rounding
                for _ in 0..2 {
                    for (d, w) in &basis {
                        let along = product(&image, w);
                        image -= w * along;
                        direction -= d * along;
                    }
                }
                let size = product(&image, &image).sqrt();
                if size <= DEPENDENT * whole {
                    continue;
                }
                image /= size;
                direction /= size;
                for (r, change) in left.iter_mut().zip(&mut changes) {
                    let along = product(r, &image);
                    *r -= &image * along;
                    *change += &direction * along;
                }
                basis.push((direction, image));
            }
        }
    }
}
