//! Periodic orbits of `M q'' + f(q, q', q'', psi) = 0` by Newton's method on the whole revolution.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::error::check_parameters;
use crate::periodic::acceleration::Anderson;
use crate::periodic::krylov;
use crate::periodic::newton_matrix::Factorisation;
use crate::periodic::renewal::{Renewal, Verdict};
use crate::{FemError, Orbit, OrbitSamples, PeriodicError, PeriodicSystem, TimeElements};

/// Steps of a careful search in which the best residual has to fall, and to what part of it: one that does not
/// goes nowhere.
const STANDSTILL: (usize, f64) = (30, 0.5);
/// Change of the orbit, largest entry, over which a careful search takes the derivative of the residual.
const SLOPE_STEP: f64 = 1e-6;
/// Halvings of a step that makes the residual grow.
const MAX_HALVINGS: i32 = 6;

/// Settings of the [`PeriodicSolver`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodicSettings {
    /// Bound on the residual norm, in generalised force (rotor units).
    pub tolerance: f64,
    /// Largest number of steps; one of a careful search costs up to thirty evaluations of the residual.
    pub max_iterations: usize,
    /// The kept factorisation is renewed when a step leaves more than this fraction of the residual.
    pub refresh_contraction: f64,
    /// Number of earlier chord steps that Anderson's acceleration mixes, at most 10; 0 for plain steps.
    pub mixing_depth: usize,
}

impl Default for PeriodicSettings {
    fn default() -> Self {
        Self { tolerance: 1e-11, max_iterations: 60, refresh_contraction: 0.3, mixing_depth: 5 }
    }
}

/// A converged periodic orbit, with what its system has seen there.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicSolution<T = ()> {
    /// The orbit.
    pub orbit: Orbit,
    /// The orbit at all Gauss points.
    pub samples: OrbitSamples,
    /// `f` of the system there, shape `dof x points`.
    pub force: DMatrix<f64>,
    /// What the system has told of the orbit beside its residual.
    pub seen: T,
    /// Largest weak residual over its test function's integral: the generalised force left over.
    pub residual_norm: f64,
    /// Residual norm at the start and after every step.
    pub residual_history: Vec<f64>,
    /// Steps taken.
    pub iterations: usize,
    /// Newton matrices factorised during this solve.
    pub factorisations: usize,
}

/// One orbit with its weak residual.
pub(crate) struct Iterate<T> {
    pub(crate) orbit: Orbit,
    samples: OrbitSamples,
    /// `f` at all points, shape `dof x points`.
    pub(crate) force: DMatrix<f64>,
    seen: T,
    /// Weak residual over the nodes' integral weights, shape `dof x nodes`.
    pub(crate) residual: DMatrix<f64>,
    norm: f64,
}

/// Whether a search that is careful since a step has stopped gaining.
fn stands_still(history: &[f64], careful_from: Option<usize>) -> bool {
    let (steps, part) = STANDSTILL;
    let best = |residuals: &[f64]| residuals.iter().copied().fold(f64::INFINITY, f64::min);
    let before = history.len().saturating_sub(steps);
    careful_from.is_some_and(|from| from <= before)
        && best(&history[before..]) > part * best(&history[..before])
}

/// Newton's method on a whole revolution, with a factorisation that outlives a solve.
///
/// ```text
/// integral( -N_a' M q' + N_a f ) dpsi = 0   for every node a
/// ```
/// The Newton matrix is factorised once and used for chord steps, also in later solves, until a step
/// contracts the residual too little. When chord steps stall, the search goes back to the best orbit and
/// turns careful: it takes Newton steps with the true derivative of the residual along each direction, for the tangent of a system
/// may be incomplete, shortens them until the residual falls, and ends where thirty of them do not halve it. The sequence of
/// solves is therefore part of the result at the level of the tolerance: use one solver per thread, or a new one for every solve.
///
/// Assumes: a constant symmetric mass matrix; period 2 pi.
/// Not modelled: stability of the orbit, which is for [`Floquet`](crate::Floquet).
#[derive(Debug, Clone)]
pub struct PeriodicSolver {
    time: TimeElements,
    settings: PeriodicSettings,
    /// Shared by clones until one makes its own.
    pub(crate) factorisation: Option<Arc<Factorisation>>,
}

/// How far an orbit on the way to another one is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitBound {
    /// Largest weak residual, generalised force.
    pub residual: f64,
    /// Largest weak residual over that of the start, if it is less; infinite: whatever the start leaves.
    pub of_first: f64,
    /// Residual that is exact enough whatever the start leaves, generalised force.
    pub exact: f64,
}

impl PeriodicSolver {
    /// A solver on a time mesh.
    ///
    /// # Errors
    /// [`FemError::Parameter`] for a tolerance or contraction that is not positive, no iteration,
    /// or a mixing depth above 10.
    pub fn new(time: TimeElements, settings: PeriodicSettings) -> Result<Self, FemError> {
        let PeriodicSettings { tolerance, max_iterations, refresh_contraction, mixing_depth } =
            settings;
        let between = refresh_contraction > 0.0 && refresh_contraction < 1.0;
        check_parameters([
            (
                "orbit solver tolerance",
                tolerance,
                tolerance > 0.0 && tolerance.is_finite(),
                "a positive number",
            ),
            (
                "orbit solver refresh_contraction",
                refresh_contraction,
                between,
                "a number between 0 and 1",
            ),
            (
                "orbit solver max_iterations",
                max_iterations as f64,
                max_iterations > 0,
                "1 iteration or more",
            ),
            ("orbit solver mixing_depth", mixing_depth as f64, mixing_depth <= 10, "0 to 10"),
        ])?;
        Ok(Self { time, settings, factorisation: None })
    }

    /// The same solver with the Newton matrix that another one keeps, for a system near that of the other.
    #[must_use]
    pub fn with_matrix_of(&self, other: &Self) -> Self {
        Self { factorisation: other.factorisation.clone(), ..self.clone() }
    }

    /// The time mesh.
    pub fn time(&self) -> &TimeElements {
        &self.time
    }

    /// The settings.
    pub fn settings(&self) -> &PeriodicSettings {
        &self.settings
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
    ) -> Result<PeriodicSolution<S::Seen>, PeriodicError<S::Error>> {
        let exact = self.settings.tolerance;
        let bound = OrbitBound { residual: exact, of_first: f64::INFINITY, exact };
        self.solve_to(bound, system, start)
    }

    /// The same with a residual bound of its own, for an orbit that is on the way to another one.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn solve_to<S: PeriodicSystem>(
        &mut self,
        bound: OrbitBound,
        system: &S,
        start: &Orbit,
    ) -> Result<PeriodicSolution<S::Seen>, PeriodicError<S::Error>> {
        self.check(system, start)?;
        let work = &mut S::Work::default();
        let mut state = self.evaluate(system, work, start.clone(), (0, start))?;
        let of_first = (bound.of_first * state.norm).max(bound.exact);
        let tolerance = bound.residual.min(of_first);
        let mut history = vec![state.norm];
        let mut best = (state.norm, state.orbit.clone());
        let mut mixing = Anderson::new(self.settings.mixing_depth);
        let mut renewal = Renewal::new(self.settings.refresh_contraction);
        let mut careful_from = None;
        while state.norm > tolerance {
            let iteration = history.len();
            if iteration > self.settings.max_iterations || stands_still(&history, careful_from) {
                return Err(PeriodicError::NotConverged {
                    iterations: iteration - 1,
                    residual: state.norm,
                    tolerance,
                    history,
                    best: Box::new(best.1),
                });
            }
            let kept = self.factorisation.take().filter(|f| f.dof() == system.dof());
            let factorisation = if let Some(kept) = kept {
                kept
            } else {
                renewal.renewed();
                mixing.clear();
                Arc::new(self.factorise(system, &state, iteration - 1)?)
            };
            let step = match careful_from {
                None => factorisation.solve(&state.residual),
                Some(_) => self.true_step(system, work, (&state, &factorisation), iteration)?,
            };
            let proposal = mixing.propose(&state.orbit.nodal, &step);
            let next = self.evaluate(system, work, Orbit { nodal: proposal }, (iteration, &best.1));
            let growth = match &next {
                Ok(next) => next.norm / state.norm,
                Err(PeriodicError::NotFinite { .. }) => f64::INFINITY,
                Err(_) => 0.0,
            };
            state = match renewal.judge(growth) {
                Verdict::Accept => {
                    self.factorisation = renewal.keeps().then_some(factorisation);
                    let next = next?;
                    system.recycle(state.seen, work);
                    next
                }
                Verdict::Shorten => {
                    self.factorisation = renewal.keeps().then_some(factorisation);
                    self.shorten(system, work, (&state, &step), iteration)?
                }
                // the matrix is dropped; the better of the two orbits gets a new one
                Verdict::Renew => match next {
                    Ok(next) if next.norm < state.norm => next,
                    _ => state,
                },
            };
            history.push(state.norm);
            let improved = state.norm < best.0;
            if improved {
                best = (state.norm, state.orbit.clone());
            }
            if renewal.stalls(improved) {
                state = self.evaluate(system, work, best.1.clone(), (iteration, &best.1))?;
                self.factorisation = None;
                mixing = Anderson::new(0);
                careful_from = Some(history.len());
            }
        }
        Ok(PeriodicSolution {
            orbit: state.orbit,
            samples: state.samples,
            force: state.force,
            seen: state.seen,
            residual_norm: state.norm,
            iterations: history.len() - 1,
            residual_history: history,
            factorisations: renewal.factorisations,
        })
    }

    /// Largest weak residual that an orbit leaves, in generalised force (rotor units).
    ///
    /// # Errors
    /// As [`Self::solve`], but for convergence.
    pub fn residual_norm<S: PeriodicSystem>(
        &self,
        system: &S,
        orbit: &Orbit,
    ) -> Result<f64, PeriodicError<S::Error>> {
        self.check(system, orbit)?;
        let mut work = S::Work::default();
        Ok(self.evaluate(system, &mut work, orbit.clone(), (0, orbit))?.norm)
    }

    /// What the accelerations lack for the equations of motion to hold at each azimuth, seen from the
    /// Newton matrix that is kept.
    ///
    /// ```text
    /// dq'' = -(M + df/dq'')^-1 (M q'' + f)
    /// ```
    /// `unbalanced` is `M q'' + f`, shape `dof x points`. None without a kept matrix of that size. `f`
    /// depends on the accelerations weakly; adding the answer and asking again converges the faster the
    /// nearer the orbit is to that of the matrix.
    pub fn lacking_accelerations(&self, unbalanced: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let kept = self.factorisation.as_ref().filter(|f| f.dof() == unbalanced.nrows())?;
        let mut lacking = unbalanced.clone();
        for point in 0..unbalanced.ncols() {
            let mut column = unbalanced.column(point).into_owned();
            if !kept.acceleration(point, &mut column) {
                return None;
            }
            lacking.set_column(point, &column);
        }
        Some(lacking)
    }

    /// Refuses a system or start that does not fit.
    pub(crate) fn check<S: PeriodicSystem>(
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
    pub(crate) fn evaluate<S: PeriodicSystem>(
        &self,
        system: &S,
        work: &mut S::Work,
        orbit: Orbit,
        (iteration, best): (usize, &Orbit),
    ) -> Result<Iterate<S::Seen>, PeriodicError<S::Error>> {
        let time = &self.time;
        let samples = orbit.sample(time);
        let mut force = DMatrix::zeros(system.dof(), time.points().len());
        let seen = system
            .residual(&samples, work, &mut force)
            .map_err(|source| PeriodicError::System { iteration, source })?;
        self.weigh(system, (orbit, samples, force), (iteration, best), seen)
    }

    /// The weak residual of an orbit whose forces at all points are known.
    pub(crate) fn weigh<S: PeriodicSystem, T>(
        &self,
        system: &S,
        (orbit, samples, force): (Orbit, OrbitSamples, DMatrix<f64>),
        (iteration, best): (usize, &Orbit),
        seen: T,
    ) -> Result<Iterate<T>, PeriodicError<S::Error>> {
        let time = &self.time;
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
        let residual = self.weak(&momentum, &force);
        if let Some(entry) = residual.iter().position(|r| !r.is_finite()) {
            return Err(not_finite(entry, time.node_azimuths_rad()[entry / system.dof()]));
        }
        let norm = residual.amax();
        Ok(Iterate { orbit, samples, force, seen, residual, norm })
    }

    /// `integral( -N_a' p + N_a f ) dpsi` over the integral of `N_a`, for momenta `p` and forces `f` at
    /// all points.
    pub(crate) fn weak(&self, momentum: &DMatrix<f64>, force: &DMatrix<f64>) -> DMatrix<f64> {
        let time = &self.time;
        let mut residual = DMatrix::zeros(force.nrows(), time.unknowns_per_dof());
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
        residual
    }

    /// A new Newton matrix at an orbit.
    pub(crate) fn factorise<S: PeriodicSystem, T>(
        &self,
        system: &S,
        state: &Iterate<T>,
        iteration: usize,
    ) -> Result<Factorisation, PeriodicError<S::Error>> {
        let refused = |source| PeriodicError::System { iteration, source };
        let tangents = system.tangents(&state.samples).map_err(refused)?;
        let memory = system.memory(&state.samples).map_err(refused)?;
        let (dof, azimuths) = (system.dof(), self.time.points());
        if tangents.len() != azimuths.len() {
            let (found, expected) = (tangents.len(), azimuths.len());
            let what = "tangents of the revolution";
            return Err(PeriodicError::Shape { what, found, expected });
        }
        // every matrix with its order and the point of its first row
        let local = tangents.iter().enumerate().flat_map(|(point, tangent)| {
            [&tangent.dq, &tangent.dqd, &tangent.dqdd]
                .map(|matrix| (matrix, dof, point, "entries of a tangent"))
        });
        let whole = memory
            .iter()
            .flat_map(|memory| [&memory.dq, &memory.dqd])
            .map(|matrix| (matrix, dof * azimuths.len(), 0, "entries of the memory of an orbit"));
        for (matrix, size, point, what) in local.chain(whole) {
            if matrix.shape() != (size, size) {
                let (found, expected) = (matrix.len(), size * size);
                return Err(PeriodicError::Shape { what, found, expected });
            }
            if let Some(entry) = matrix.as_slice().iter().position(|v| !v.is_finite()) {
                let row = entry % size;
                return Err(PeriodicError::NotFinite {
                    iteration,
                    dof: row % dof,
                    azimuth_rad: azimuths[point + row / dof],
                    best: Box::new(state.orbit.clone()),
                });
            }
        }
        Factorisation::new(&self.time, system.mass(), &tangents, memory.as_ref())
    }

    /// The Newton step with the true derivative of the residual.
    fn true_step<S: PeriodicSystem>(
        &self,
        system: &S,
        work: &mut S::Work,
        (state, factorisation): (&Iterate<S::Seen>, &Factorisation),
        iteration: usize,
    ) -> Result<DMatrix<f64>, PeriodicError<S::Error>> {
        let nearly = factorisation.solve(&state.residual);
        krylov::solve(&nearly, |direction| {
            let way = SLOPE_STEP / direction.amax();
            let nodal = &state.orbit.nodal + direction * way;
            let moved = self.evaluate(system, work, Orbit { nodal }, (iteration, &state.orbit))?;
            // the step from a residual is that to lower it
            Ok(-factorisation.solve(&((moved.residual - &state.residual) / way)))
        })
    }

    /// The longest halved Newton step that keeps the residual from growing, or the best one tried.
    fn shorten<S: PeriodicSystem>(
        &self,
        system: &S,
        work: &mut S::Work,
        (state, step): (&Iterate<S::Seen>, &DMatrix<f64>),
        iteration: usize,
    ) -> Result<Iterate<S::Seen>, PeriodicError<S::Error>> {
        let mut trial = |halving: i32| {
            let nodal = &state.orbit.nodal + step * 0.5_f64.powi(halving);
            self.evaluate(system, work, Orbit { nodal }, (iteration, &state.orbit))
        };
        let mut best = trial(0);
        for halving in 1..=MAX_HALVINGS {
            match &best {
                Ok(found) if found.norm >= state.norm => {}
                Err(PeriodicError::NotFinite { .. }) => {}
                _ => break,
            }
            best = match (best, trial(halving)) {
                (Ok(best), Ok(next)) if next.norm >= best.norm => Ok(best),
                (Ok(best), Err(PeriodicError::NotFinite { .. })) => Ok(best),
                (_, next) => next,
            };
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::stands_still;

    /// A careful search may be slow, but not without end: thirty steps have to halve the residual.
    #[test]
    fn a_search_that_gains_nothing_ends() {
        let slow: Vec<f64> = (0..60).map(|k| 0.97_f64.powi(k)).collect();
        let stuck: Vec<f64> = (0..60).map(|k| 0.5 + 0.01 * f64::from(k % 7)).collect();
        assert!(!stands_still(&slow, Some(0)) && !stands_still(&stuck, None));
        assert!(stands_still(&stuck, Some(20)), "careful for forty steps");
        assert!(!stands_still(&stuck, Some(40)), "careful for twenty");
    }
}
