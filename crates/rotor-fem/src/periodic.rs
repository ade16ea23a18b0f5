//! Periodic orbits of `M q'' + f(q, q', q'', psi) = 0` by Newton's method on the whole revolution.

use nalgebra::DMatrix;

use crate::acceleration::Anderson;
use crate::newton_matrix::{Factorisation, NewtonMatrixError};
use crate::{FemError, Orbit, OrbitSamples, TimeElements};

/// Growth of the residual that a step with a fresh tangent may cause before it is shortened.
const ALLOWED_GROWTH: f64 = 2.0;
/// Halvings of a step that makes the residual grow.
const MAX_HALVINGS: usize = 6;

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
    fn residual(&self, orbit: &OrbitSamples, out: &mut DMatrix<f64>) -> Result<(), Self::Error>;

    /// Approximate local linearisation of `f` at every point, used for the Newton matrix only.
    ///
    /// # Errors
    /// Whatever the system's physics refuses.
    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Self::Error>;
}

/// How chord steps are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Acceleration {
    /// Plain chord steps.
    None,
    /// Anderson mixing of the last `depth` steps.
    Anderson {
        /// Number of earlier steps that are mixed, 1 to 10.
        depth: usize,
    },
}

/// Settings of the [`PeriodicSolver`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodicSettings {
    /// Bound on the residual norm, in generalised force (rotor units).
    pub tolerance: f64,
    /// Largest number of residual evaluations beyond the first.
    pub max_iterations: usize,
    /// The kept factorisation is renewed when a step leaves more than this fraction of the residual.
    pub refresh_contraction: f64,
    /// How chord steps are combined.
    pub acceleration: Acceleration,
}

impl Default for PeriodicSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-11,
            max_iterations: 60,
            refresh_contraction: 0.3,
            acceleration: Acceleration::Anderson { depth: 3 },
        }
    }
}

/// A converged periodic orbit.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicSolution {
    /// The orbit.
    pub orbit: Orbit,
    /// The orbit at all Gauss points.
    pub samples: OrbitSamples,
    /// Largest weak residual over its test function's integral: the generalised force left over.
    pub residual_norm: f64,
    /// Residual norm at the start and after every step.
    pub residual_history: Vec<f64>,
    /// Steps taken.
    pub iterations: usize,
    /// Newton matrices factorised during this solve.
    pub factorisations: usize,
}

/// Why no periodic orbit was found; `E` is the system's own error.
///
/// Apart from [`FemError`] because it carries the caller's error type.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PeriodicError<E: std::error::Error + 'static> {
    /// Start orbit, mass matrix or tangents do not fit the system.
    #[error("{what}: found {found}, expected {expected}")]
    Shape {
        /// What does not fit.
        what: &'static str,
        /// Size found.
        found: usize,
        /// Size expected.
        expected: usize,
    },
    /// The mass matrix is not symmetric with a positive diagonal.
    #[error(
        "mass matrix entry ({row}, {column}) is {value}: expected finite and symmetric, with a \
         positive diagonal"
    )]
    Mass {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The value found.
        value: f64,
    },
    /// The system's physics refused an orbit.
    #[error("the system refused the orbit of iteration {iteration}: {source}")]
    System {
        /// Iteration, 0 for the start.
        iteration: usize,
        /// The system's error.
        source: E,
    },
    /// A residual or tangent is not a finite number.
    #[error(
        "the residual of degree of freedom {dof} is not a finite number at azimuth {azimuth_rad} rad \
         in iteration {iteration}: the system diverges or has bad data; start nearer to the solution"
    )]
    NotFinite {
        /// Iteration, 0 for the start.
        iteration: usize,
        /// Degree of freedom, from 0.
        dof: usize,
        /// Azimuth, rad.
        azimuth_rad: f64,
        /// Last orbit with a finite residual.
        best: Box<Orbit>,
    },
    /// A mode is in resonance without damping: the orbit is not determined.
    #[error(
        "degree of freedom {dof} resonates at {per_rev} per rev without damping: the smallest dynamic \
         stiffness of the revolution is {dynamic_stiffness:e} per unit mass (rotor speed squared), not \
         distinguishable from zero with a time discretisation error of {resolution:e}; give the mode \
         damping or move its frequency off the integer"
    )]
    Resonance {
        /// Degree of freedom that dominates the undetermined motion, from 0.
        dof: usize,
        /// Harmonic that dominates the undetermined motion, per rev.
        per_rev: usize,
        /// Smallest dynamic stiffness per unit mass, rotor speed squared.
        dynamic_stiffness: f64,
        /// Error of the time elements in the square of that harmonic.
        resolution: f64,
    },
    /// The residual did not fall below the tolerance.
    #[error(
        "no periodic orbit after {iterations} iterations: residual {residual:e}, tolerance \
         {tolerance:e} (best {}); start nearer, add damping, or raise max_iterations; history: {}",
        .history.iter().copied().fold(f64::INFINITY, f64::min), show(.history)
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Residual norm of the last orbit.
        residual: f64,
        /// Tolerance asked for.
        tolerance: f64,
        /// Residual norm at the start and after every step.
        history: Vec<f64>,
        /// The orbit with the smallest residual.
        best: Box<Orbit>,
    },
}

/// The last few residuals, for a message.
fn show(history: &[f64]) -> String {
    let tail = &history[history.len().saturating_sub(6)..];
    let shown: Vec<String> = tail.iter().map(|r| format!("{r:.1e}")).collect();
    shown.join(" ")
}

/// One orbit with its weak residual.
struct Iterate {
    orbit: Orbit,
    samples: OrbitSamples,
    /// Weak residual over the nodes' integral weights, shape `dof x nodes`.
    residual: DMatrix<f64>,
    norm: f64,
}

/// Newton's method on a whole revolution, with a factorisation that outlives a solve.
///
/// ```text
/// integral( -N_a' M q' + N_a f ) dpsi = 0   for every node a
/// ```
/// The Newton matrix is factorised once and used for chord steps, also in later solves, until a step
/// contracts the residual too little. The sequence of solves is therefore part of the result at the
/// level of the tolerance: use one solver per thread, or [`forget_factorisation`] between solves.
///
/// Assumes: a constant symmetric mass matrix; period 2 pi.
/// Not modelled: stability of the orbit.
///
/// [`forget_factorisation`]: Self::forget_factorisation
#[derive(Debug, Clone)]
pub struct PeriodicSolver {
    time: TimeElements,
    settings: PeriodicSettings,
    factorisation: Option<Factorisation>,
}

impl PeriodicSolver {
    /// A solver on a time mesh.
    ///
    /// # Errors
    /// [`FemError::SolverSetting`] for a tolerance or contraction that is not positive, no iteration,
    /// or a mixing depth outside 1 to 10.
    pub fn new(time: TimeElements, settings: PeriodicSettings) -> Result<Self, FemError> {
        let bad = |name, value, expected| Err(FemError::SolverSetting { name, value, expected });
        if !(settings.tolerance > 0.0 && settings.tolerance.is_finite()) {
            return bad("tolerance", settings.tolerance, "a positive number");
        }
        if !(settings.refresh_contraction > 0.0 && settings.refresh_contraction < 1.0) {
            return bad("refresh_contraction", settings.refresh_contraction, "between 0 and 1");
        }
        if settings.max_iterations == 0 {
            return bad("max_iterations", 0.0, "at least 1");
        }
        if let Acceleration::Anderson { depth } = settings.acceleration
            && !(1..=10).contains(&depth)
        {
            return bad("acceleration depth", depth as f64, "1 to 10");
        }
        Ok(Self { time, settings, factorisation: None })
    }

    /// The time mesh.
    pub fn time(&self) -> &TimeElements {
        &self.time
    }

    /// The settings.
    pub fn settings(&self) -> &PeriodicSettings {
        &self.settings
    }

    /// Drops the kept factorisation: the next solve starts with a new Newton matrix.
    pub fn forget_factorisation(&mut self) {
        self.factorisation = None;
    }

    /// The periodic orbit of a system, from a start orbit on this solver's mesh.
    ///
    /// # Errors
    /// [`PeriodicError`]: a start or matrix of the wrong size, the system's own error, a number that is
    /// not finite, an undamped resonance, or no convergence (with history and best orbit).
    pub fn solve<S: PeriodicSystem>(
        &mut self,
        system: &S,
        start: &Orbit,
    ) -> Result<PeriodicSolution, PeriodicError<S::Error>> {
        self.check(system, start)?;
        let limit = self.settings.refresh_contraction;
        let mut factorisations = 0;
        let mut state = self.evaluate(system, start.clone(), 0, start)?;
        let mut history = vec![state.norm];
        let mut best = (state.norm, state.orbit.clone());
        let mut mixing = Anderson::new(match self.settings.acceleration {
            Acceleration::None => 0,
            Acceleration::Anderson { depth } => depth,
        });
        // steps since the matrix was renewed, and steps a renewed matrix is given before the next
        let (mut age, mut patience) = (usize::MAX, 1);
        while state.norm > self.settings.tolerance {
            let iteration = history.len();
            if iteration > self.settings.max_iterations {
                return Err(PeriodicError::NotConverged {
                    iterations: iteration - 1,
                    residual: state.norm,
                    tolerance: self.settings.tolerance,
                    history,
                    best: Box::new(best.1),
                });
            }
            let kept = self.factorisation.take().filter(|f| f.dof() == system.dof());
            let factorisation = if let Some(kept) = kept {
                kept
            } else {
                (age, factorisations) = (0, factorisations + 1);
                mixing.clear();
                self.factorise(system, &state, iteration - 1)?
            };
            let step = factorisation.solve(&state.residual);
            let fresh = age == 0;
            let proposal = mixing.propose(&state.orbit.nodal, &step);
            let next = self.evaluate(system, Orbit { nodal: proposal }, iteration, &best.1);
            let poor = match &next {
                Ok(next) => next.norm > limit * state.norm,
                Err(PeriodicError::NotFinite { .. }) => true,
                Err(_) => false,
            };
            let grown = poor && !matches!(&next, Ok(n) if n.norm <= ALLOWED_GROWTH * state.norm);
            if poor && (age >= patience || (grown && !fresh)) {
                // the tangent has aged: renew it at the better of the two orbits
                if let Ok(next) = next
                    && next.norm < state.norm
                {
                    state = next;
                }
                history.push(state.norm);
                patience = if age == usize::MAX { patience } else { 2 * patience };
            } else {
                let next = if grown {
                    mixing.clear();
                    self.shorten(system, &state, &step, iteration)?
                } else {
                    next?
                };
                if fresh && !poor {
                    patience = 3;
                }
                age = age.saturating_add(1);
                state = next;
                history.push(state.norm);
                self.factorisation = Some(factorisation);
            }
            if state.norm < best.0 {
                best = (state.norm, state.orbit.clone());
            }
        }
        Ok(PeriodicSolution {
            orbit: state.orbit,
            samples: state.samples,
            residual_norm: state.norm,
            iterations: history.len() - 1,
            residual_history: history,
            factorisations,
        })
    }

    /// Refuses a system or start that does not fit.
    fn check<S: PeriodicSystem>(
        &self,
        system: &S,
        start: &Orbit,
    ) -> Result<(), PeriodicError<S::Error>> {
        let (dof, mass) = (system.dof(), system.mass());
        let sizes = [
            ("rows of the mass matrix", mass.nrows(), dof),
            ("columns of the mass matrix", mass.ncols(), dof),
            ("degrees of freedom of the start orbit", start.dof(), dof),
            ("time nodes of the start orbit", start.nodal.ncols(), self.time.unknowns_per_dof()),
        ];
        for (what, found, expected) in sizes {
            if found != expected {
                return Err(PeriodicError::Shape { what, found, expected });
            }
        }
        let scale = mass.amax();
        for row in 0..dof {
            for column in 0..dof {
                let value = mass[(row, column)];
                let skew = (value - mass[(column, row)]).abs();
                let sound = value.is_finite() && skew <= 1e-12 * scale;
                if !sound || (row == column && value <= 0.0) {
                    return Err(PeriodicError::Mass { row, column, value });
                }
            }
        }
        Ok(())
    }

    /// The weak residual of an orbit.
    fn evaluate<S: PeriodicSystem>(
        &self,
        system: &S,
        orbit: Orbit,
        iteration: usize,
        best: &Orbit,
    ) -> Result<Iterate, PeriodicError<S::Error>> {
        let time = &self.time;
        let samples = orbit.sample(time);
        let mut force = DMatrix::zeros(system.dof(), time.points().len());
        system
            .residual(&samples, &mut force)
            .map_err(|source| PeriodicError::System { iteration, source })?;
        let expected = (system.dof(), time.points().len());
        if force.shape() != expected {
            let (found, expected) = (force.len(), expected.0 * expected.1);
            return Err(PeriodicError::Shape { what: "entries of the residual", found, expected });
        }
        let not_finite = |entry: usize, azimuth_rad: f64| PeriodicError::NotFinite {
            iteration,
            dof: entry % system.dof(),
            azimuth_rad,
            best: Box::new(best.clone()),
        };
        if let Some(entry) = force.iter().position(|f| !f.is_finite()) {
            return Err(not_finite(entry, time.points()[entry / system.dof()]));
        }
        let momentum = system.mass() * &samples.qd;
        let mut residual = DMatrix::zeros(system.dof(), time.unknowns_per_dof());
        for e in 0..time.elements() {
            for g in 0..time.gauss_per_element() {
                let point = e * time.gauss_per_element() + g;
                let weight = time.weights()[point];
                for (a, [n, d, _]) in time.shapes(g).iter().enumerate() {
                    let mut column = residual.column_mut(time.node(e, a));
                    column.axpy(-weight * d, &momentum.column(point), 1.0);
                    column.axpy(weight * n, &force.column(point), 1.0);
                }
            }
        }
        for (mut column, weight) in residual.column_iter_mut().zip(time.node_weights()) {
            column /= *weight;
        }
        if let Some(entry) = residual.iter().position(|r| !r.is_finite()) {
            return Err(not_finite(entry, time.node_azimuths_rad()[entry / system.dof()]));
        }
        let norm = residual.amax();
        Ok(Iterate { orbit, samples, residual, norm })
    }

    /// A new Newton matrix at an orbit.
    fn factorise<S: PeriodicSystem>(
        &self,
        system: &S,
        state: &Iterate,
        iteration: usize,
    ) -> Result<Factorisation, PeriodicError<S::Error>> {
        let tangents = system
            .tangents(&state.samples)
            .map_err(|source| PeriodicError::System { iteration, source })?;
        Factorisation::new(&self.time, system.mass(), &tangents).map_err(|error| match error {
            NewtonMatrixError::Shape { what, found, expected } => {
                PeriodicError::Shape { what, found, expected }
            }
            NewtonMatrixError::NotFinite { dof, point } => PeriodicError::NotFinite {
                iteration,
                dof,
                azimuth_rad: self.time.points()[point],
                best: Box::new(state.orbit.clone()),
            },
            NewtonMatrixError::Resonance { dof, per_rev, dynamic_stiffness, resolution } => {
                PeriodicError::Resonance { dof, per_rev, dynamic_stiffness, resolution }
            }
        })
    }

    /// The longest halved Newton step that keeps the residual from growing, or the best one tried.
    fn shorten<S: PeriodicSystem>(
        &self,
        system: &S,
        state: &Iterate,
        step: &DMatrix<f64>,
        iteration: usize,
    ) -> Result<Iterate, PeriodicError<S::Error>> {
        let mut shortest = None;
        let mut failure = None;
        for halving in 0..=MAX_HALVINGS {
            let factor = 0.5_f64.powi(i32::try_from(halving).unwrap_or(i32::MAX));
            let nodal = &state.orbit.nodal + step * factor;
            match self.evaluate(system, Orbit { nodal }, iteration, &state.orbit) {
                Ok(trial) if trial.norm < state.norm => return Ok(trial),
                Ok(trial) => {
                    if shortest.as_ref().is_none_or(|best: &Iterate| trial.norm < best.norm) {
                        shortest = Some(trial);
                    }
                }
                Err(error @ PeriodicError::NotFinite { .. }) => failure = Some(error),
                Err(error) => return Err(error),
            }
        }
        match (shortest, failure) {
            (Some(trial), _) => Ok(trial),
            (None, Some(error)) => Err(error),
            (None, None) => Err(PeriodicError::NotConverged {
                iterations: iteration,
                residual: state.norm,
                tolerance: self.settings.tolerance,
                history: vec![state.norm],
                best: Box::new(state.orbit.clone()),
            }),
        }
    }
}
