//! How a converged orbit answers to small changes of its loads: the implicit function theorem.

use std::sync::Arc;

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::periodic::solver::Iterate;
use crate::{Orbit, PeriodicError, PeriodicSolver, PeriodicSystem};

/// Size of a displacement in the differences that apply the exact Jacobian: far above rounding, far
/// below where the second derivatives show.
const DIFFERENCE: f64 = 3e-7;
/// A direction of whose image only this part is new holds nothing new: far above the noise of the
/// differences, which would be taken for an image otherwise. Right-hand sides that depend on each other bring such
/// directions.
const DEPENDENT: f64 = 1e-3;
/// Right-hand sides that one thread solves at once: the same for any number of threads, so that rounding is.
const SOLVED_TOGETHER: usize = 3;

/// `sum += factor part`.
fn add(sum: &mut DMatrix<f64>, factor: f64, part: &DMatrix<f64>) {
    sum.zip_apply(part, |value, part| *value += factor * part);
}

/// A direction of the orbit and what it brings: change of `f`, and weak residual as accelerations.
struct Known {
    direction: DMatrix<f64>,
    force: DMatrix<f64>,
    image: DMatrix<f64>,
}

impl Known {
    /// `self += factor other`.
    fn add(&mut self, factor: f64, other: &Self) {
        add(&mut self.direction, factor, &other.direction);
        add(&mut self.force, factor, &other.force);
        add(&mut self.image, factor, &other.image);
    }

    /// What is new in it, to an image of unit size; none if that is nothing.
    fn beyond(mut self, basis: &[Self]) -> Option<Self> {
        let whole = self.image.norm();
        // twice is enough to be orthogonal to rounding
        for _ in 0..2 {
            for known in basis {
                let along = self.image.dot(&known.image);
                self.add(-along, known);
            }
        }
        let size = self.image.norm();
        if size <= DEPENDENT * whole {
            return None;
        }
        self.scale(1.0 / size);
        Some(self)
    }

    fn scale(&mut self, factor: f64) {
        self.direction *= factor;
        self.force *= factor;
        self.image *= factor;
    }
}

/// Changes of an orbit, one for each change of load.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearResponse {
    /// Change of the orbit per unit of each load.
    pub changes: Vec<Orbit>,
    /// Change of `f` at all points that goes with it, the change of load included; shape `dof x points`.
    pub force_changes: Vec<DMatrix<f64>>,
    /// Largest residual left by a linear equation, over its right-hand side.
    pub relative_residual: f64,
    /// Residuals of the system evaluated.
    pub evaluations: usize,
    /// Newton matrices made: none if the one kept by the solver was used.
    pub factorisations: usize,
}

impl PeriodicSolver {
    /// What directions of an orbit bring, by differences of the system.
    fn images<S: PeriodicSystem>(
        &self,
        system: &S,
        orbit: &Orbit,
        base: &Iterate<()>,
        directions: Vec<DMatrix<f64>>,
    ) -> Result<Vec<Known>, PeriodicError<S::Error>>
    where
        S::Error: Send,
    {
        let image = |work: &mut S::Work, direction: DMatrix<f64>| {
            let nodal = &orbit.nodal + &direction * DIFFERENCE;
            let moved = self.evaluate(system, work, Orbit { nodal }, (0, orbit))?;
            Ok(Known {
                direction,
                force: (moved.force - &base.force) / DIFFERENCE,
                image: (moved.residual - &base.residual) / DIFFERENCE,
            })
        };
        directions.into_par_iter().map_init(S::Work::default, image).collect()
    }

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
    /// `force` is `f` of the orbit at all points, as [`PeriodicSystem::residual`] gives it for [`Orbit::sample`],
    /// shape `dof x points`. `load_changes` holds one matrix `df/dp`, shape `dof x points`, for each parameter; a solution is
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
        force: &DMatrix<f64>,
        load_changes: &[DMatrix<f64>],
        tolerance: f64,
    ) -> Result<LinearResponse, PeriodicError<S::Error>>
    where
        S::Error: Send,
    {
        self.check(system, orbit)?;
        let samples = orbit.sample(self.time());
        let base = &self.weigh(system, (orbit.clone(), samples, force.clone()), (0, orbit), ())?;
        let (dof, points) = (system.dof(), self.time().points().len());
        for load in load_changes {
            if load.shape() != (dof, points) {
                let (found, expected) = (load.len(), dof * points);
                let what = "entries of a change of load";
                return Err(PeriodicError::Shape { what, found, expected });
            }
        }
        let kept = self.factorisation.take().filter(|f| f.dof() == dof);
        let factorisations = usize::from(kept.is_none());
        let matrix = match kept {
            Some(kept) => kept,
            None => Arc::new(self.factorise(system, base, 0)?),
        };
        // residuals are measured as accelerations: a light mode counts as much as a heavy one
        let mass = system.mass().diagonal();
        let as_accelerations = |mut residual: DMatrix<f64>| {
            residual.column_iter_mut().for_each(|mut column| column.component_div_assign(&mass));
            residual
        };
        let as_residual = |mut accelerations: DMatrix<f64>| {
            let columns = accelerations.column_iter_mut();
            columns.for_each(|mut column| column.component_mul_assign(&mass));
            accelerations
        };
        let still = DMatrix::zeros(dof, points);
        let mut left: Vec<DMatrix<f64>> =
            load_changes.iter().map(|load| as_accelerations(-self.weak(&still, load))).collect();
        let sizes: Vec<f64> = left.iter().map(DMatrix::norm).collect();
        let share = |left: &[DMatrix<f64>]| -> Vec<f64> {
            let pairs = left.iter().zip(&sizes);
            pairs.map(|(r, s)| if *s > 0.0 { r.norm() / s } else { 0.0 }).collect()
        };
        let mut changes = vec![DMatrix::zeros(dof, self.time().unknowns_per_dof()); left.len()];
        let mut force_changes = load_changes.to_vec();
        let mut basis: Vec<Known> = Vec::new();
        let (mut evaluations, mut history) = (0, Vec::new());
        loop {
            let shares = share(&left);
            let worst = shares.iter().fold(0.0_f64, |m, v| if *v > m { *v } else { m });
            history.push(worst);
            if worst <= tolerance {
                self.factorisation = Some(matrix);
                return Ok(LinearResponse {
                    changes: changes.into_iter().map(|nodal| Orbit { nodal }).collect(),
                    force_changes,
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
            let open = left.iter().zip(&shares).filter(|(_, share)| **share > tolerance);
            let open: Vec<DMatrix<f64>> = open.map(|(r, _)| as_residual(r.clone())).collect();
            let directions: Vec<DMatrix<f64>> = open
                .par_chunks(SOLVED_TOGETHER)
                .flat_map(|some| matrix.solve_all(some))
                .map(|step| {
                    let size = step.amax();
                    if size > 0.0 { -step / size } else { -step }
                })
                .collect();
            let found = self.images(system, orbit, base, directions)?;
            evaluations += found.len();
            for mut new in found {
                new.image = as_accelerations(new.image);
                let Some(new) = new.beyond(&basis) else { continue };
                let changed = changes.iter_mut().zip(&mut force_changes);
                for (r, (change, force)) in left.iter_mut().zip(changed) {
                    let along = r.dot(&new.image);
                    add(r, -along, &new.image);
                    add(change, along, &new.direction);
                    add(force, along, &new.force);
                }
                basis.push(new);
            }
        }
    }
}
