//! Free motion of the undamped rotating blade in a vacuum, step by step.

use nalgebra::{DMatrix, DVector};
use rotor_fem::{ModerateModel, NodalMotion, PitchMotion};

/// Momentum out of balance at which a step is done, over the largest momentum.
const TOLERANCE: f64 = 1e-13;
/// Residual that is taken when round-off keeps it from falling to [`TOLERANCE`].
const ROUND_OFF: f64 = 1e-9;
/// Iterations of a step.
const ITERATIONS: usize = 30;

/// Displacements and momenta over all degrees of freedom.
pub(crate) struct MotionState {
    dof: DVector<f64>,
    momentum: DVector<f64>,
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
pub(crate) struct FreeMotion<'a> {
    model: &'a ModerateModel,
    pitch: PitchMotion,
    /// Time step, rad of azimuth at nominal speed.
    time_step: f64,
}

impl<'a> FreeMotion<'a> {
    /// At the blade's own pitch and speed.
    pub(crate) fn new(model: &'a ModerateModel, time_step: f64) -> Self {
        Self { model, pitch: model.own_pitch(), time_step }
    }

    /// The state of given displacements at rest in the rotating frame.
    pub(crate) fn at_rest(&self, dof: DVector<f64>) -> MotionState {
        let [momentum, _] = self.model.momentum(&NodalMotion::steady(dof.clone()), self.pitch);
        MotionState { dof, momentum }
    }

    fn on_free(&self, all: &DVector<f64>) -> DVector<f64> {
        let free = self.model.free();
        DVector::from_iterator(free.len(), free.iter().map(|&i| all[i]))
    }

    fn to_all(&self, free: &DVector<f64>) -> DVector<f64> {
        let mut all = DVector::zeros(self.model.size());
        for (&i, value) in self.model.free().iter().zip(free.iter()) {
            all[i] = *value;
        }
        all
    }

    fn part(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        matrix.select_rows(self.model.free()).select_columns(self.model.free())
    }

    /// The conserved energy: `p . r - L`, that is strain energy plus kinetic energy of the motion in the
    /// rotating frame less that of the rotation; none for a singular mass matrix.
    pub(crate) fn energy(&self, state: &MotionState) -> Option<f64> {
        let mut motion = NodalMotion::steady(state.dof.clone());
        let about = self.model.tangents(&motion, self.pitch);
        let [rest, _] = self.model.momentum(&motion, self.pitch);
        let gap = self.on_free(&(&state.momentum - rest));
        motion.rate = self.to_all(&self.part(&about.mass).lu().solve(&gap)?);
        let [kinetic, strain] = self.model.energies(&motion, self.pitch);
        let free = self.model.free();
        let free_power: f64 = free.iter().map(|&i| state.momentum[i] * motion.rate[i]).sum();
        Some(free_power - kinetic + strain)
    }

    /// One step; none if its equations were not solved.
    pub(crate) fn step(&self, state: &MotionState) -> Option<MotionState> {
        let (model, h) = (self.model, self.time_step);
        let at = |end: &DVector<f64>| NodalMotion {
            value: (&state.dof + end) * 0.5,
            rate: (end - &state.dof) / h,
            acceleration: DVector::zeros(model.size()),
        };
        let mut end = state.dof.clone();
        let about = model.tangents(&at(&end), self.pitch);
        let matrix = self.part(&about.mass) / h
            + self.part(&about.damping) * 0.5
            + self.part(&about.stiffness) * (0.25 * h);
        let factor = matrix.lu();
        let scale = state.momentum.amax().max(f64::MIN_POSITIVE);
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let [momentum, gradient] = model.momentum(&at(&end), self.pitch);
            let gap = self.on_free(&(&state.momentum - &momentum + &gradient * (0.5 * h)));
            let residual = gap.amax() / scale;
            if residual <= TOLERANCE || (residual <= ROUND_OFF && residual >= 0.5 * before) {
                return Some(MotionState { dof: end, momentum: momentum + gradient * (0.5 * h) });
            }
            before = residual;
            end += self.to_all(&factor.solve(&gap)?);
        }
        None
    }
}
