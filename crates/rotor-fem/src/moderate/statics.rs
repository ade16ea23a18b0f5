//! Static deflection of the rotating blade: Newton's method with load steps.

use faer::Mat;
use faer::linalg::solvers::Solve;
use nalgebra::{DMatrix, DVector};

use super::element::Imposed;
use super::{ModerateModel, NodalMotion, PitchMotion};
use crate::beam::assembly::{dof_kind, restrict};
use crate::error::check_parameters;
use crate::{FemError, ModeKind};

/// How the static deflection is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticSettings {
    /// Largest force out of balance over the largest force of an element or load, above 0.
    pub tolerance: f64,
    /// Newton steps in one load step, 2 or more.
    pub iterations: usize,
    /// Smallest load step, as a part of the whole load, above 0.
    pub smallest_step: f64,
}

impl Default for StaticSettings {
    /// 1e-9 after at most 25 Newton steps; load steps down to 1/512.
    fn default() -> Self {
        Self { tolerance: 1e-9, iterations: 25, smallest_step: 1.0 / 512.0 }
    }
}

/// The blade at rest in the rotating frame under dead loads.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticState {
    /// Displacements over all degrees of freedom.
    pub dof: DVector<f64>,
    /// Root pitch, rad.
    pub pitch_rad: f64,
    /// Part of load and squared rotor speed that is carried: 1 when the solution is complete.
    pub load_factor: f64,
    /// Newton steps in all load steps.
    pub iterations: usize,
    /// Force out of balance over the largest force.
    pub residual: f64,
}

/// Why one load step failed.
struct Stuck {
    iterations: usize,
    residual: f64,
}

impl ModerateModel {
    /// Static deflection under a dead load, at the blade's own pitch and rotor speed.
    ///
    /// Load and squared rotor speed are raised together. The whole is tried at once; a load step that
    /// does not converge is halved.
    ///
    /// # Errors
    /// [`FemError::DofCount`] for a load that is not over all degrees of freedom,
    /// [`FemError::Parameter`] for a setting out of range or a load that is not finite,
    /// [`FemError::NoStaticState`] with the last state found when the load steps become too small.
    pub fn static_state(
        &self,
        load: &DVector<f64>,
        settings: &StaticSettings,
    ) -> Result<StaticState, FemError> {
        if load.len() != self.size() {
            let (found, expected) = (load.len(), self.size());
            return Err(FemError::DofCount { field: "load", found, expected });
        }
        check(load, settings)?;
        let mut state = StaticState {
            dof: DVector::zeros(self.size()),
            pitch_rad: self.own_pitch().angle_rad,
            load_factor: 0.0,
            iterations: 0,
            residual: 0.0,
        };
        let mut step = 1.0_f64;
        while state.load_factor < 1.0 {
            let target = (state.load_factor + step).min(1.0);
            match self.load_step(&state, load, target, settings) {
                Ok(next) => state = next,
                Err(stuck) => {
                    state.iterations += stuck.iterations;
                    step *= 0.5;
                    if step < settings.smallest_step {
                        return Err(FemError::NoStaticState {
                            iterations: state.iterations,
                            residual: stuck.residual,
                            tolerance: settings.tolerance,
                            load_factor: state.load_factor,
                            last: Box::new(state),
                        });
                    }
                }
            }
        }
        Ok(state)
    }

    /// Newton's method at one load factor; one further step polishes the solution.
    fn load_step(
        &self,
        from: &StaticState,
        load: &DVector<f64>,
        load_factor: f64,
        settings: &StaticSettings,
    ) -> Result<StaticState, Stuck> {
        let imposed = self.imposed(PitchMotion::steady(from.pitch_rad), load_factor.sqrt());
        let applied = load * load_factor;
        let mut motion = NodalMotion::steady(from.dof.clone());
        self.pull_taut(&mut motion, &imposed, &applied);
        let mut best: Option<(DVector<f64>, f64)> = None;
        let mut last = f64::INFINITY;
        for iteration in 0..settings.iterations {
            let (force, largest) = self.force_at(&motion, &imposed);
            let gap = self.on_free(&(&applied - force));
            let scale = largest.max(applied.amax());
            let residual = if scale > 0.0 { gap.amax() / scale } else { 0.0 };
            if !residual.is_finite() {
                return Err(Stuck { iterations: iteration, residual: last });
            }
            last = residual;
            let done = |(dof, residual)| StaticState {
                dof,
                load_factor,
                residual,
                pitch_rad: from.pitch_rad,
                iterations: from.iterations + iteration,
            };
            match best.take() {
                // the polishing step did not help
                Some(found) if residual >= found.1 => return Ok(done(found)),
                Some(_) => return Ok(done((motion.value, residual))),
                None if scale == 0.0 => return Ok(done((motion.value, 0.0))),
                None if residual <= settings.tolerance => {
                    best = Some((motion.value.clone(), residual));
                }
                None => {}
            }
            let tangent = self.tangents_at(&motion, &imposed).stiffness;
            let step = self.to_all(&solve(&restrict(&tangent, self.free()), &gap));
            self.advance(&mut motion.value, &step);
        }
        best.map_or(Err(Stuck { iterations: settings.iterations, residual: last }), |found| {
            let (dof, residual) = found;
            let iterations = from.iterations + settings.iterations;
            Ok(StaticState { dof, load_factor, residual, pitch_rad: from.pitch_rad, iterations })
        })
    }

    /// Moves the axial degrees of freedom into balance, the others held; they are linear then.
    ///
    /// Without the tension that this brings, a hinged blade has no stiffness and the first Newton step
    /// goes astray.
    fn pull_taut(&self, motion: &mut NodalMotion, imposed: &Imposed, applied: &DVector<f64>) {
        let axial: Vec<usize> =
            self.free().iter().copied().filter(|&i| dof_kind(i) == ModeKind::Axial).collect();
        let about = self.tangents_at(motion, imposed);
        let gap = DVector::from_fn(axial.len(), |k, _| applied[axial[k]] - about.force[axial[k]]);
        let step = solve(&restrict(&about.stiffness, &axial), &gap);
        for (&i, value) in axial.iter().zip(step.iter()) {
            motion.value[i] += value;
        }
    }

    /// The entries of the free degrees of freedom.
    pub(crate) fn on_free(&self, all: &DVector<f64>) -> DVector<f64> {
        DVector::from_iterator(self.free().len(), self.free().iter().map(|&i| all[i]))
    }

    /// Over all degrees of freedom, zero where the root holds.
    pub(crate) fn to_all(&self, free: &DVector<f64>) -> DVector<f64> {
        let mut all = DVector::zeros(self.size());
        for (&i, value) in self.free().iter().zip(free.iter()) {
            all[i] = *value;
        }
        all
    }
}

fn check(load: &DVector<f64>, settings: &StaticSettings) -> Result<(), FemError> {
    let finite = load.iter().copied().find(|f| !f.is_finite());
    let number = settings.iterations as f64;
    let small = f64::MIN_POSITIVE..=1.0;
    check_parameters([
        ("load", finite.unwrap_or(0.0), finite.is_none(), "finite forces"),
        ("tolerance", settings.tolerance, small.contains(&settings.tolerance), "0 to 1, not 0"),
        ("iterations", number, settings.iterations >= 2, "2 or more Newton steps"),
        (
            "smallest_step",
            settings.smallest_step,
            small.contains(&settings.smallest_step),
            "0 to 1, not 0: a part of the whole load",
        ),
    ])
}

/// Solves a dense system by LU factors with partial pivoting.
pub(crate) fn solve(matrix: &DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    let size = right.len();
    let lu = Mat::from_fn(size, size, |i, j| matrix[(i, j)]).partial_piv_lu();
    let column = lu.solve(Mat::from_fn(size, 1, |i, _| right[i]));
    DVector::from_fn(size, |i, _| column[(i, 0)])
}
