//! Free motion of the undamped rotating blade in a vacuum, step by step.

use nalgebra::DVector;

use super::statics::solve;
use super::{ModerateModel, NodalMotion, PitchMotion};
use crate::FemError;
use crate::beam::assembly::restrict;

/// Momentum out of balance at which a step is done, over the largest momentum.
const TOLERANCE: f64 = 1e-13;
/// Residual that is taken when round-off keeps it from falling to [`TOLERANCE`].
const ROUND_OFF: f64 = 1e-9;
/// Iterations of a step.
const ITERATIONS: usize = 30;

/// Displacements and momenta over all degrees of freedom.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionState {
    /// Displacements.
    pub dof: DVector<f64>,
    /// Momenta, the derivative of the kinetic energy in the rates.
    pub momentum: DVector<f64>,
}

/// Steps the free motion at constant rotation and pitch with the variational midpoint rule.
///
/// ```text
/// q = (q0 + q1) / 2,  r = (q1 - q0) / h:   p0 = L_r - h/2 L_q,   p1 = L_r + h/2 L_q
/// ```
/// with L the kinetic less the strain energy. The rule is symplectic and of second order: the energy
/// error neither grows nor is it zero, it stays within a band that falls with h^2.
///
/// Source: J. E. Marsden, M. West, Acta Numerica 10 (2001) 357, section 2.3.
#[derive(Debug, Clone)]
pub struct FreeMotion<'a> {
    model: &'a ModerateModel,
    pitch: PitchMotion,
    time_step: f64,
    steps: usize,
}

impl<'a> FreeMotion<'a> {
    /// At the blade's own pitch and speed; time step in rad of azimuth at nominal speed.
    ///
    /// # Errors
    /// [`FemError::Parameter`] unless the time step is finite and above zero.
    pub fn new(model: &'a ModerateModel, time_step: f64) -> Result<Self, FemError> {
        if !(time_step.is_finite() && time_step > 0.0) {
            let expected = "a finite number above zero, rad";
            return Err(FemError::Parameter { field: "time_step", value: time_step, expected });
        }
        Ok(Self { model, pitch: model.own_pitch(), time_step, steps: 0 })
    }

    /// The state of given displacements at rest in the rotating frame.
    pub fn at_rest(&self, dof: DVector<f64>) -> MotionState {
        let imposed = self.model.imposed(self.pitch, 1.0);
        let [momentum, _] = self.model.momentum(&NodalMotion::steady(dof.clone()), &imposed);
        MotionState { dof, momentum }
    }

    /// The conserved energy: `p . r - L`, that is strain energy plus kinetic energy of the motion in the
    /// rotating frame less that of the rotation.
    pub fn energy(&self, state: &MotionState) -> f64 {
        let imposed = self.model.imposed(self.pitch, 1.0);
        let mut motion = NodalMotion::steady(state.dof.clone());
        let about = self.model.tangents_at(&motion, &imposed);
        let [rest, _] = self.model.momentum(&motion, &imposed);
        let gap = self.model.on_free(&(&state.momentum - rest));
        let mass = restrict(&about.mass, self.model.free());
        motion.rate = self.model.to_all(&solve(&mass, &gap));
        let [kinetic, strain] = self.model.energies(&motion, self.pitch);
        let free_power: f64 =
            self.model.free().iter().map(|&i| state.momentum[i] * motion.rate[i]).sum();
        free_power - kinetic + strain
    }

    /// One step.
    ///
    /// # Errors
    /// [`FemError::FreeMotionStep`] if its equations were not solved.
    pub fn step(&mut self, state: &MotionState) -> Result<MotionState, FemError> {
        self.steps += 1;
        let (model, h) = (self.model, self.time_step);
        let imposed = model.imposed(self.pitch, 1.0);
        let at = |end: &DVector<f64>| NodalMotion {
            value: (&state.dof + end) * 0.5,
            rate: (end - &state.dof) / h,
            acceleration: DVector::zeros(model.size()),
        };
        let mut end = state.dof.clone();
        let about = model.tangents_at(&at(&end), &imposed);
        let free = model.free();
        let part = |matrix| restrict(matrix, free);
        let matrix = part(&about.mass) / h
            + part(&about.damping) * 0.5
            + part(&about.stiffness) * (0.25 * h);
        let factor = matrix.lu();
        let scale = state.momentum.amax().max(f64::MIN_POSITIVE);
        let (mut residual, mut before) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..ITERATIONS {
            let [momentum, gradient] = model.momentum(&at(&end), &imposed);
            let gap = model.on_free(&(&state.momentum - &momentum + &gradient * (0.5 * h)));
            residual = gap.amax() / scale;
            let settled = residual <= ROUND_OFF && residual >= 0.5 * before;
            if residual <= TOLERANCE || settled {
                let momentum = momentum + gradient * (0.5 * h);
                return Ok(MotionState { dof: end, momentum });
            }
            before = residual;
            let Some(step) = factor.solve(&gap) else { break };
            model.advance(&mut end, &model.to_all(&step));
            if !end.iter().all(|x| x.is_finite()) {
                break;
            }
        }
        Err(FemError::FreeMotionStep {
            step: self.steps,
            iterations: ITERATIONS,
            residual,
            time_step: h,
        })
    }
}
