//! The inflow settled on the loading that its own change brings, to first order.
//!
//! ```text
//! (I - G) dlambda = dlambda_wanted,      G = change of the wanted inflow per change of the inflow
//! ```
//! `G` is never formed: every direction of the inflow costs one set of linear equations of the blade. All
//! right-hand sides share the directions, by the method of generalised conjugate residuals, as in
//! [`rotor_fem::PeriodicSolver::linear_response`].

use crate::answers::changes::{StateChange, WakeDrive, add};
use crate::loads::wrenches::{SixLoads, added};
use rotor_base::HarmonicSeries;

/// Change of the inflow that a linearised response leaves, over the largest that any direction asks for and over the
/// relative residual of its linear equations.
const INFLOW_SHARE: f64 = 10.0;
/// Rounds of inflow directions allowed.
pub(crate) const INFLOW_ROUNDS: usize = 40;
/// A direction of which only this part is new holds nothing new: far above what the linear equations of the
/// blade leave.
const DEPENDENT: f64 = 1e-3;

/// Part of a direction that must be new for it to be asked for beside the others of a round; the next round
/// takes up what is left.
const INDEPENDENT: f64 = 0.03;

/// Hub loads, hinge moments, what moves a wake, and the parameters of the inflow that goes with them; or changes of
/// these.
#[derive(Debug, Clone)]
pub(crate) struct Answer {
    pub(crate) hub: SixLoads,
    pub(crate) hinge: Vec<HarmonicSeries>,
    pub(crate) drive: Option<WakeDrive>,
    pub(crate) state: StateChange,
    pub(crate) wanted: Vec<f64>,
}

impl Answer {
    /// `self += factor other`.
    pub(crate) fn add(&mut self, other: &Self, factor: f64) {
        self.add_loads(other, factor);
        add(&mut self.wanted, factor, &other.wanted);
    }

    /// The same of all but the inflow.
    fn add_loads(&mut self, other: &Self, factor: f64) {
        let mine = self.hub.components.iter_mut().chain(&mut self.hinge);
        for (value, part) in mine.zip(other.hub.components.iter().chain(&other.hinge)) {
            *value = added(value, part, factor);
        }
        if let (Some(drive), Some(other)) = (&mut self.drive, &other.drive) {
            drive.add(other, factor);
        }
        self.state.add(&other.state, factor);
    }

    /// `self *= factor`.
    pub(crate) fn scale(&mut self, factor: f64) {
        for value in self.hub.components.iter_mut().chain(&mut self.hinge) {
            *value = added(&HarmonicSeries::zero(value.harmonics.len()), value, factor);
        }
        if let Some(drive) = &mut self.drive {
            drive.scale(factor);
        }
        self.state.orbit.nodal *= factor;
        self.state.accelerations *= factor;
        self.state.inflow.iter_mut().for_each(|value| *value *= factor);
        for value in &mut self.wanted {
            *value *= factor;
        }
    }
}

/// A direction of the inflow, what it leaves of itself, and its loads.
struct Followed {
    image: Vec<f64>,
    answer: Answer,
}

/// The inflow changes still asked for, by direction of the flaps.
pub(crate) struct Settling {
    left: Vec<Vec<f64>>,
    size: f64,
    /// Change left, over that size, with which it is content.
    pub(crate) tolerance: f64,
    basis: Vec<Followed>,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// The vectors that are not near a combination of those before them.
pub(crate) fn independent(vectors: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut units: Vec<Vec<f64>> = Vec::new();
    let mut kept = Vec::new();
    for vector in vectors {
        let whole = norm(&vector);
        let mut rest = vector.clone();
        for _ in 0..2 {
            for unit in &units {
                let along = dot(&rest, unit);
                add(&mut rest, -along, unit);
            }
        }
        let size = norm(&rest);
        if size > INDEPENDENT * whole {
            units.push(rest.into_iter().map(|value| value / size).collect());
            kept.push(vector);
        }
    }
    kept
}

impl Settling {
    /// For the answers with the inflow held, of linear equations that leave a relative residual.
    pub(crate) fn new(answers: &[Answer], residual: f64) -> Self {
        let left: Vec<Vec<f64>> = answers.iter().map(|answer| answer.wanted.clone()).collect();
        let size = left.iter().map(|wanted| norm(wanted)).fold(0.0, f64::max);
        Self { left, size, tolerance: INFLOW_SHARE * residual, basis: Vec::new() }
    }

    /// Largest change left, over the largest asked for.
    pub(crate) fn worst(&self) -> f64 {
        if self.size == 0.0 {
            return 0.0;
        }
        self.left.iter().map(|left| norm(left) / self.size).fold(0.0, f64::max)
    }

    /// The changes that are not settled yet.
    pub(crate) fn open(&self) -> Vec<Vec<f64>> {
        let limit = self.tolerance * self.size;
        self.left.iter().filter(|left| norm(left) > limit).cloned().collect()
    }

    /// Lets the inflow follow along one more direction, whose answer is known.
    pub(crate) fn follow(
        &mut self,
        direction: Vec<f64>,
        mut answer: Answer,
        answers: &mut [Answer],
    ) {
        let mut image = direction;
        add(&mut image, -1.0, &answer.wanted);
        let whole = norm(&image);
        // twice is enough to be orthogonal to rounding
        for _ in 0..2 {
            for known in &self.basis {
                let along = dot(&image, &known.image);
                add(&mut image, -along, &known.image);
                answer.add_loads(&known.answer, -along);
            }
        }
        let size = norm(&image);
        if size <= DEPENDENT * whole {
            return;
        }
        for value in &mut image {
            *value /= size;
        }
        answer.scale(1.0 / size);
        for (left, loads) in self.left.iter_mut().zip(answers) {
            let along = dot(left, &image);
            add(left, -along, &image);
            loads.add_loads(&answer, along);
        }
        self.basis.push(Followed { image, answer });
    }
}
