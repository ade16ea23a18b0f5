//! The periodic response of a rotor: blade motion, inflow and hub loads together.

use crate::loads::power::PowerBalance;
use crate::loads::wrenches::SixLoads;
use crate::response::hinge::HingeMoment;
use crate::response::revolution::{Lifting, RevolutionLoads, SETTLED, series};
use crate::response::rotor::up;
use crate::response::system::PointInput;
use crate::response::wake_loading::{loading, mean_lift};
use crate::sections::air::FlapAngle;
use crate::sections::flight_air::{FlightAir, POINTS_TOGETHER};
use crate::{Condition, ResponseError, Rotor};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_fem::{
    Anderson, Orbit, OrbitBound, OrbitSamples, PeriodicError, PeriodicSettings, PeriodicSolver,
    TimeElements,
};
use rotor_wake::{InducedInflow, InflowModel, RotorLoading};
use std::sync::Arc;

/// The Newton matrix leaves the lag states out, so chord steps contract slowly with any matrix: a new
/// one, thirty times the cost of a step, pays only when they hardly contract at all.
const REFRESH_CONTRACTION: f64 = 0.8;

/// Steps of the inflow that Anderson's acceleration remembers.
const INFLOW_STEPS_KEPT: usize = 16;
/// Residual of the orbit over the last change of the inflow, to which it is solved while the inflow is still on its
/// way: a thrust that is off by as much moves the inflow by a tenth of it.
const ORBIT_SHARE: f64 = 0.003;
/// Residual of the first orbit over that of the start: what it leaves open would mislead the steps of the inflow.
const ORBIT_AT_FIRST: f64 = 0.03;
/// Residual to which it is solved before any change of the inflow is known.
const FIRST_ORBIT: f64 = 1e-6;
/// Change of the inflow over its tolerance from which the next orbit is likely to be the last.
const NEARLY_SETTLED: f64 = 1e3;
/// Iterations of the orbit allowed to sections that may stall, whose loads have kinks.
const STALL_ITERATIONS: usize = 200;

/// Tolerances of the response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResponseTolerances {
    /// Largest weak residual of the periodic orbit, generalised force in rotor units.
    pub periodicity: f64,
    /// Largest change of an inflow parameter between iterations, tip speed.
    pub inflow: f64,
    /// Iterations allowed for the inflow.
    pub inflow_iterations: usize,
    /// Residual of the linear equations of a linearised response over their right-hand side; its inflow settles to ten
    /// times as much of the largest change.
    pub linear: f64,
}

impl Default for ResponseTolerances {
    fn default() -> Self {
        Self { periodicity: 1e-11, inflow: 1e-10, inflow_iterations: 60, linear: 1e-5 }
    }
}

/// How well a solution satisfies its equations, and what it cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResponseResiduals {
    /// Largest weak residual of the periodic orbit, generalised force in rotor units.
    pub periodicity: f64,
    /// Mismatch between the inflow used and the inflow the loads call for, tip speed.
    pub inflow: f64,
    /// Newton and chord iterations over all inflow iterations.
    pub response_iterations: usize,
    /// Newton matrices made.
    pub factorisations: usize,
    /// Inflow iterations.
    pub inflow_iterations: usize,
}

/// A converged rotor.
#[derive(Debug, Clone)]
pub struct RotorSolution {
    /// Modal motion over the revolution, order flap, lag, torsion; tip value of each shape is 1.
    pub orbit: Orbit,
    /// Harmonics of every modal coordinate.
    pub modal: Vec<HarmonicSeries>,
    /// Induced inflow.
    pub inflow: InducedInflow,
    /// Lift and circulation at every point and lifting station.
    pub(crate) lifting: Vec<Vec<Lifting>>,
    /// Modal accelerations that satisfy the equations of motion at every point.
    pub(crate) accelerations: DMatrix<f64>,
    /// Thrust coefficient `C_T`, of the air alone: the weight of the blades, if there is gravity, is a
    /// load on the hub but no thrust.
    pub thrust_coefficient: f64,
    /// Root loads of the blade, rotating frame.
    pub root: SixLoads,
    /// Hub loads, fixed frame, all blades.
    pub hub: SixLoads,
    /// Hinge moments of each flap, root to tip.
    pub hinge: Vec<HingeMoment>,
    /// Mean power of one blade.
    pub power: PowerBalance,
    /// Residuals and iterations.
    pub residuals: ResponseResiduals,
}

/// How far the inflow that the loads ask for is from the inflow used, tip speed.
struct Mismatch {
    change: Vec<f64>,
    size: f64,
}

/// The way to the inflow that agrees with its loads.
struct InflowSearch {
    anderson: Anderson,
    previous: Option<(Vec<f64>, f64)>,
    /// Whether what the loads ask for has moved at the last parameters: two changes then tell nothing of each other.
    has_moved: bool,
}

impl InflowSearch {
    fn new() -> Self {
        Self { anderson: Anderson::new(INFLOW_STEPS_KEPT), previous: None, has_moved: false }
    }

    /// The next parameters from those used and the change that the loads ask for.
    fn next(&mut self, model: &dyn InflowModel, used: &[f64], change: Vec<f64>) -> Vec<f64> {
        if let Some(step) = model.improved_step(&change) {
            let column = |v: &[f64]| DMatrix::from_column_slice(v.len(), 1, v);
            return self.anderson.propose(&column(used), &column(&step)).as_slice().to_vec();
        }
        let relaxation = match &self.previous {
            Some((_, before)) if self.has_moved => *before,
            previous => irons_tuck(previous.as_ref(), &change),
        };
        self.has_moved = false;
        let next = used.iter().zip(&change).map(|(u, c)| u + relaxation * c).collect();
        self.previous = Some((change, relaxation));
        next
    }
}

/// Solves one rotor at one advance ratio, keeping the factorised Newton matrix between solutions.
#[derive(Debug, Clone)]
pub struct RotorSolver {
    pub(crate) rotor: Arc<Rotor>,
    pub(crate) air: Arc<FlightAir>,
    pub(crate) time: TimeElements,
    pub(crate) solver: PeriodicSolver,
    tolerances: ResponseTolerances,
    pub(crate) advance_ratio: f64,
    /// Pitch at the root beside the controls, rad.
    root_pitch_rad: HarmonicSeries,
}

impl RotorSolver {
    /// Prepares the section aerodynamics of one advance ratio.
    ///
    /// # Errors
    /// Problems of the time elements or of the section model at the local Mach numbers.
    pub fn new(
        rotor: Arc<Rotor>,
        advance_ratio: f64,
        tolerances: ResponseTolerances,
    ) -> Result<Self, ResponseError> {
        let d = rotor.discretisation;
        let time = TimeElements::new(d.time_elements, d.time_order, d.time_gauss_points)?;
        let air = FlightAir::new(rotor.model(), rotor.blade(), &time, advance_ratio)?;
        let settings = PeriodicSettings {
            tolerance: tolerances.periodicity,
            refresh_contraction: REFRESH_CONTRACTION,
            max_iterations: if rotor.model().nonlinear.is_linear() { 60 } else { STALL_ITERATIONS },
            ..PeriodicSettings::default()
        };
        let solver = PeriodicSolver::new(time.clone(), settings)?;
        let (air, root_pitch_rad) = (Arc::new(air), HarmonicSeries::default());
        Ok(Self { rotor, air, time, solver, tolerances, advance_ratio, root_pitch_rad })
    }

    /// The rotor.
    pub fn rotor(&self) -> &Rotor {
        &self.rotor
    }

    /// The rotor, to be shared.
    pub fn shared_rotor(&self) -> &Arc<Rotor> {
        &self.rotor
    }

    /// The same solver with other tolerances.
    #[must_use]
    pub fn with_tolerances(&self, tolerances: ResponseTolerances) -> Self {
        Self { tolerances, ..self.clone() }
    }

    /// The same solver with the Newton matrix that the solver of a rotor nearby keeps, on the same time elements.
    #[must_use]
    pub fn with_matrix_of(&self, other: &Self) -> Self {
        Self { solver: self.solver.with_matrix_of(&other.solver), ..self.clone() }
    }

    /// The same solver with pitch at the root of all blades beside the controls: higher harmonic control, rad, nose up
    /// positive, each blade at its own azimuth.
    #[must_use]
    pub fn with_root_pitch(&self, root_pitch_rad: HarmonicSeries) -> Self {
        Self { root_pitch_rad, ..self.clone() }
    }

    /// Pitch at the root beside the controls, rad.
    pub fn root_pitch_rad(&self) -> &HarmonicSeries {
        &self.root_pitch_rad
    }

    /// The tolerances.
    pub fn tolerances(&self) -> ResponseTolerances {
        self.tolerances
    }

    /// Periodic response with the inflow settled on the thrust it carries.
    ///
    /// `start` is a solution nearby (or none: the undeformed blade and the inflow of zero thrust).
    ///
    /// # Errors
    /// [`ResponseError::FlapMotions`], [`ResponseError::Parameter`] for an advance ratio other than
    /// the solver's; [`ResponseError::Periodic`], [`ResponseError::PeriodicStall`] and
    /// [`ResponseError::InflowNotConverged`] with what was reached.
    pub fn solve(
        &mut self,
        condition: &Condition,
        inflow_model: &dyn InflowModel,
        start: Option<&RotorSolution>,
    ) -> Result<RotorSolution, ResponseError> {
        let (mut orbit, mut inflow) = self.begin(condition, inflow_model, start)?;
        let (mut iterations, mut factorisations) = (0, 0);
        let mut search = InflowSearch::new();
        let mut last = (f64::INFINITY, 0.0);
        let (rotor, air) = (Arc::clone(&self.rotor), Arc::clone(&self.air));
        // sections that stall may have more than one orbit: their way is left alone
        let is_linear = rotor.model().nonlinear.is_linear();
        let may_be_rough = inflow_model.follows_loading() && is_linear;
        let exact = self.tolerances.periodicity;
        let mut orbit_tolerance = if may_be_rough { FIRST_ORBIT.max(exact) } else { exact };
        // what the sums over the blade add to the thrust of the lift: known again where the inflow seems settled
        let mut added =
            start.map_or(0.0, |s| s.thrust_coefficient - self.lift_coefficient(&s.lifting));
        for inflow_iteration in 1..=self.tolerances.inflow_iterations {
            let system = rotor.system(&air, self.point_inputs(condition, &inflow));
            let of_first = if inflow_iteration == 1 { ORBIT_AT_FIRST } else { f64::INFINITY };
            let bound = OrbitBound { residual: orbit_tolerance, of_first, exact };
            let solved = self.solver.solve_to(bound, &system, &orbit);
            let solution = solved.map_err(Self::orbit_error(&rotor))?;
            iterations += solution.iterations;
            factorisations += solution.factorisations;
            let is_exact = solution.residual_norm <= exact;
            let periodicity = solution.residual_norm;
            let (reached, lifting) = (solution.orbit, solution.seen.lifting());
            let of_lift = self.lift_coefficient(&lifting);
            let wanted = |thrust_coefficient: f64| {
                self.wanted(condition, inflow_model, (&lifting, thrust_coefficient), &inflow)
            };
            let mut mismatch = wanted(of_lift + added)?;
            if !is_linear || mismatch.size <= self.tolerances.inflow && is_exact {
                let found = (solution.samples, solution.force, solution.seen);
                let loads = RevolutionLoads::new(&rotor, &self.solver, &system, found, SETTLED)?;
                let hub = loads.hub(&rotor, &self.time);
                let up = hub.components[2].mean + rotor.blades_weight() * up(condition)[2];
                let thrust_coefficient = rotor.model().thrust_coefficient(up);
                search.has_moved = is_linear;
                added = thrust_coefficient - of_lift;
                // a circulation does not ask for the thrust
                if inflow_model.circulation_grid().is_none() {
                    mismatch = wanted(thrust_coefficient)?;
                }
                if mismatch.size <= self.tolerances.inflow && is_exact {
                    let count = rotor.discretisation.load_harmonics;
                    return Ok(RotorSolution {
                        modal: self.modal_harmonics(&reached.sample(&self.time)),
                        orbit: reached,
                        thrust_coefficient,
                        root: loads.root(&self.time, count),
                        hinge: loads.hinge(&self.time, count),
                        lifting: loads.lifting,
                        accelerations: loads.accelerations,
                        power: loads.power,
                        inflow,
                        hub,
                        residuals: ResponseResiduals {
                            periodicity,
                            inflow: mismatch.size,
                            response_iterations: iterations,
                            factorisations,
                            inflow_iterations: inflow_iteration,
                        },
                    });
                }
            }
            last = (mismatch.size, of_lift + added);
            orbit = reached;
            orbit_tolerance =
                if may_be_rough && mismatch.size > NEARLY_SETTLED * self.tolerances.inflow {
                    (ORBIT_SHARE * mismatch.size).clamp(exact, FIRST_ORBIT.max(exact))
                } else {
                    exact
                };
            let next = search.next(inflow_model, &inflow.parameters(), mismatch.change);
            inflow = inflow.with_parameters(&next)?;
        }
        Err(ResponseError::InflowNotConverged {
            iterations: self.tolerances.inflow_iterations,
            change: last.0,
            tolerance: self.tolerances.inflow,
            thrust_coefficient: last.1,
        })
    }

    /// How far the inflow that a loading asks for is from the inflow used.
    fn wanted(
        &self,
        condition: &Condition,
        model: &dyn InflowModel,
        (lifting, thrust_coefficient): (&[Vec<Lifting>], f64),
        used: &InducedInflow,
    ) -> Result<Mismatch, ResponseError> {
        let grid = model.circulation_grid();
        let loading = loading(&self.rotor, &self.time, lifting, thrust_coefficient, grid)?;
        let wanted = model.induced(&condition.flight, &loading)?;
        let change: Vec<f64> =
            wanted.parameters().iter().zip(used.parameters()).map(|(a, b)| a - b).collect();
        let size = change.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        Ok(Mismatch { change, size })
    }

    /// Thrust coefficient of the lift alone, as if it stood along the shaft.
    fn lift_coefficient(&self, lifting: &[Vec<Lifting>]) -> f64 {
        let model = self.rotor.model();
        let lift = mean_lift(&self.rotor, &self.time, lifting);
        model.thrust_coefficient(model.blades as f64 * lift)
    }

    /// Largest weak residual that the motion of a solution leaves in another condition, its inflow held:
    /// generalised force in rotor units.
    ///
    /// # Errors
    /// As [`solve`](Self::solve), but for convergence.
    pub fn periodicity(
        &self,
        condition: &Condition,
        solution: &RotorSolution,
    ) -> Result<f64, ResponseError> {
        self.check_condition(condition)?;
        let points = self.point_inputs(condition, &solution.inflow);
        let system = self.rotor.system(&self.air, points);
        let left = self.solver.residual_norm(&system, &solution.orbit);
        left.map_err(Self::orbit_error(&self.rotor))
    }

    /// Orbit and inflow that a solution begins with, the condition being one of this solver.
    fn begin(
        &self,
        condition: &Condition,
        inflow_model: &dyn InflowModel,
        start: Option<&RotorSolution>,
    ) -> Result<(Orbit, InducedInflow), ResponseError> {
        self.check_condition(condition)?;
        let dof = self.rotor.mass.nrows();
        let orbit = start.map_or_else(|| Orbit::zero(&self.time, dof), |s| s.orbit.clone());
        let inflow =
            inflow_model.induced(&condition.flight, &RotorLoading::from_thrust_coefficient(0.0))?;
        // a start with another kind of inflow gives its motion only
        let known = start.and_then(|s| inflow.with_parameters(&s.inflow.parameters()).ok());
        Ok((orbit, known.unwrap_or(inflow)))
    }

    /// Refuses a condition that the solver was not prepared for.
    fn check_condition(&self, condition: &Condition) -> Result<(), ResponseError> {
        self.check_flaps(&condition.flap_angles_rad)?;
        let mu = condition.flight.advance_ratio;
        if (mu - self.advance_ratio).abs() > 1e-12 {
            return Err(ResponseError::Parameter {
                field: "advance_ratio",
                value: mu,
                expected: "the advance ratio the solver was prepared for",
            });
        }
        Ok(())
    }

    /// Refuses another number of flap motions than the blade has flaps.
    pub(crate) fn check_flaps(&self, motions: &[HarmonicSeries]) -> Result<(), ResponseError> {
        let (given, expected) = (motions.len(), self.rotor.model().flaps.len());
        if given == expected { Ok(()) } else { Err(ResponseError::FlapMotions { given, expected }) }
    }

    /// Why an orbit was not found; sections that may stall are the likely reason.
    pub(crate) fn orbit_error(
        rotor: &Rotor,
    ) -> impl Fn(PeriodicError<ResponseError>) -> ResponseError + use<> {
        let stalls = !rotor.model().nonlinear.is_linear();
        move |error| match error {
            PeriodicError::System { source, .. } => source,
            other @ (PeriodicError::NotConverged { .. } | PeriodicError::NotFinite { .. })
                if stalls =>
            {
                ResponseError::PeriodicStall(Box::new(other))
            }
            other => ResponseError::Periodic(Box::new(other)),
        }
    }

    /// Azimuth, pitch, inflow and flap angles at every point.
    pub(crate) fn point_inputs(
        &self,
        condition: &Condition,
        inflow: &InducedInflow,
    ) -> Vec<PointInput> {
        let first = self.air.first_station;
        let stations = &self.rotor.blade().grid.x()[first..];
        self.time
            .points()
            .par_iter()
            .with_min_len(POINTS_TOGETHER)
            .map(|&azimuth| {
                let flaps = condition.flap_angles_rad.iter();
                let flap: Vec<FlapAngle> = flaps.map(|f| f.value_and_rates(azimuth)).collect();
                let induced = inflow.velocities(azimuth, stations);
                self.rotor.point_input(&self.root_pitch_rad, condition, azimuth, &induced, flap)
            })
            .collect()
    }

    pub(crate) fn modal_harmonics(&self, samples: &OrbitSamples) -> Vec<HarmonicSeries> {
        let count = self.rotor.discretisation.load_harmonics;
        let rows = samples.q.row_iter();
        rows.map(|row| series(&self.time, row.iter().copied(), count)).collect()
    }
}

/// Irons and Tuck's relaxation factor of a fixed-point iteration (the vector form of Aitken's and the
/// secant method): exact in one step for a scalar linear map.
///
/// Source: B. Irons, R. Tuck, Int. J. Numer. Methods Eng. 1 (1969) 275.
fn irons_tuck(previous: Option<&(Vec<f64>, f64)>, change: &[f64]) -> f64 {
    let Some((before, relaxation)) = previous else { return 1.0 };
    let (mut num, mut den) = (0.0, 0.0);
    for (new, old) in change.iter().zip(before) {
        num += old * (new - old);
        den += (new - old) * (new - old);
    }
    if den > 0.0 { (-relaxation * num / den).clamp(0.05, 3.0) } else { 1.0 }
}
