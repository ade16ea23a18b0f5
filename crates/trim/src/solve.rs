//! Newton's method on the trim equations around the periodic rotor response.

use crate::TrimError;
use crate::vehicle::{Attitude, Vehicle, equilibrium, fuselage_drag};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_response::{Condition, Controls, RotorSolution, RotorSolver};
use rotor_wake::{FlightState, InflowModel, momentum_inflow};

/// What the rotor is trimmed to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrimTarget {
    /// Level flight of the whole helicopter: six equations for the three controls, shaft tilt, bank
    /// and tail rotor thrust.
    Propulsive {
        /// Weight as `C_W / sigma`.
        weight_ct_sigma: f64,
        /// The helicopter.
        vehicle: Vehicle,
    },
    /// Wind-tunnel (moment) trim: thrust and zero hub moments for the three controls at a given
    /// shaft tilt.
    WindTunnel {
        /// Thrust as `C_T / sigma`.
        ct_sigma: f64,
        /// Shaft tilt, rad, forward positive.
        shaft_tilt_rad: f64,
    },
    /// Controls and shaft tilt are given; nothing is solved but the response.
    Prescribed {
        /// The controls.
        controls: Controls,
        /// Shaft tilt, rad, forward positive.
        shaft_tilt_rad: f64,
    },
}

/// Tolerances of the trim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrimSettings {
    /// Largest residual force (moment) over the weight (weight times R).
    pub tolerance: f64,
    /// Newton iterations allowed.
    pub max_iterations: usize,
}

impl Default for TrimSettings {
    fn default() -> Self {
        Self { tolerance: 1e-9, max_iterations: 40 }
    }
}

/// A trimmed rotor.
#[derive(Debug, Clone)]
pub struct TrimSolution {
    /// Pitch controls.
    pub controls: Controls,
    /// Attitude and tail rotor; bank and tail thrust are zero unless the trim is propulsive.
    pub attitude: Attitude,
    /// Flight state of the rotor.
    pub flight: FlightState,
    /// The rotor response in trim.
    pub rotor: RotorSolution,
    /// Largest trim residual over the weight; zero for prescribed controls.
    pub residual: f64,
    /// Residual of every Newton iteration.
    pub residual_history: Vec<f64>,
    /// Newton iterations.
    pub iterations: usize,
    /// Last Jacobian of the trim residuals, kept for a nearby trim; none if none was needed.
    pub jacobian: Option<DMatrix<f64>>,
}

/// Step of the finite-difference Jacobian, rad (and weights for the tail thrust).
const JACOBIAN_STEP: f64 = 1e-4;
/// Pitch angles beyond which the linear section model means nothing, rad.
const PITCH_LIMIT: f64 = 0.6;
/// Shaft tilt and bank beyond which level flight is not meant, rad.
const ATTITUDE_LIMIT: f64 = 0.8;

/// Shaft tilt at which a trim starts at most, rad: a larger one is approached by the steps.
const LARGEST_FIRST_TILT: f64 = 0.4;
/// Halvings of a step that does not lower the residuals.
const LARGEST_HALVINGS: i32 = 6;
/// A step of which no larger part stays within the limits leads out of reach.
const LEAST_PART: f64 = 1e-3;

/// A step that lowers the residuals, with the response and the residuals after it.
type Descent = (DVector<f64>, (RotorSolution, DVector<f64>));

const VARIABLES: [&str; 6] = ["theta0", "theta1c", "theta1s", "shaft tilt", "bank", "tail thrust"];

/// Trims the rotor at one advance ratio with given flap motions (none: flaps at rest).
///
/// Newton's method with a finite-difference Jacobian kept by Broyden's update and renewed when it
/// stops paying. A step that raises the residuals is halved; one that leads beyond the range of a
/// control stops at its limit, and out of reach is what still points beyond it from there.
///
/// # Errors
/// [`TrimError::Parameter`] for a bad target, [`TrimError::OutOfReach`],
/// [`TrimError::NotConverged`] and [`TrimError::Singular`] with the residual history, and the
/// errors of the response.
pub fn trim(
    solver: &mut RotorSolver,
    inflow: &dyn InflowModel,
    advance_ratio: f64,
    target: &TrimTarget,
    settings: &TrimSettings,
    start: Option<&TrimSolution>,
) -> Result<TrimSolution, TrimError> {
    let problem = Problem::new(solver, inflow, advance_ratio, target)?;
    problem.solve(solver, settings, start)
}

/// Largest force (moment) left over the weight (weight times R) by another response at the controls
/// and attitude of a trim: with the flaps at work the trim is not what it was. Zero for prescribed
/// controls, which ask for no balance.
///
/// # Errors
/// [`TrimError::Parameter`] for a bad target.
pub fn imbalance(
    solver: &RotorSolver,
    inflow: &dyn InflowModel,
    target: &TrimTarget,
    trimmed: &TrimSolution,
    response: &RotorSolution,
) -> Result<f64, TrimError> {
    let problem = Problem::new(solver, inflow, trimmed.flight.advance_ratio, target)?;
    let residual = problem.residual(response, &trimmed.attitude);
    Ok(if residual.is_empty() { 0.0 } else { residual.amax() })
}

/// Trim equations at one advance ratio.
struct Problem<'a> {
    inflow: &'a dyn InflowModel,
    advance_ratio: f64,
    target: TrimTarget,
    weight: f64,
    thrust_coefficient: f64,
    density_chord: f64,
    chord: f64,
    flaps: usize,
    unknowns: usize,
}

impl<'a> Problem<'a> {
    fn new(
        solver: &RotorSolver,
        inflow: &'a dyn InflowModel,
        advance_ratio: f64,
        target: &TrimTarget,
    ) -> Result<Self, TrimError> {
        let model = solver.rotor().model();
        let (loading, unknowns, tilt) = match target {
            TrimTarget::Propulsive { weight_ct_sigma, vehicle } => {
                vehicle.validate()?;
                (*weight_ct_sigma, 6, 0.0)
            }
            TrimTarget::WindTunnel { ct_sigma, shaft_tilt_rad } => (*ct_sigma, 3, *shaft_tilt_rad),
            TrimTarget::Prescribed { shaft_tilt_rad, .. } => (0.07, 0, *shaft_tilt_rad),
        };
        if !(loading > 0.0 && loading <= 0.5) {
            let (field, expected) = ("ct_sigma", "more than 0 and at most 0.5");
            return Err(TrimError::Parameter { field, value: loading, expected });
        }
        if !(-ATTITUDE_LIMIT..=ATTITUDE_LIMIT).contains(&tilt) {
            let (field, expected) = ("shaft_tilt_rad", "-0.8 to 0.8 rad");
            return Err(TrimError::Parameter { field, value: tilt, expected });
        }
        if !(0.0..=0.5).contains(&advance_ratio) {
            let (field, expected) = ("advance_ratio", "0 to 0.5");
            return Err(TrimError::Parameter { field, value: advance_ratio, expected });
        }
        Ok(Self {
            inflow,
            advance_ratio,
            target: *target,
            weight: model.thrust_of_loading(loading),
            thrust_coefficient: model.thrust_coefficient(model.thrust_of_loading(loading)),
            density_chord: model.density_chord(),
            chord: model.chord,
            flaps: model.flaps.len(),
            unknowns,
        })
    }

    /// Starting values: the controls of a rigid blade under momentum inflow, the tilt that balances the
    /// drag, a torque guess.
    fn first_guess(&self, solver: &RotorSolver) -> DVector<f64> {
        let mu = self.advance_ratio;
        let tilt = match self.target {
            TrimTarget::Propulsive { .. } => (self.drag(0.0) / self.weight).min(LARGEST_FIRST_TILT),
            TrimTarget::WindTunnel { shaft_tilt_rad, .. }
            | TrimTarget::Prescribed { shaft_tilt_rad, .. } => shaft_tilt_rad,
        };
        let flight = FlightState { advance_ratio: mu, shaft_tilt_rad: tilt };
        let hover = (0.5 * self.thrust_coefficient).sqrt();
        let induced = momentum_inflow(&flight, self.thrust_coefficient).unwrap_or(hover);
        let lambda = flight.normal_inflow() + induced;
        let c = solver.rotor().rigid_blade_controls(mu, lambda, self.weight).unwrap_or_default();
        let pitch = [c.theta0_rad, c.theta1c_rad, c.theta1s_rad]
            .map(|angle| angle.clamp(-PITCH_LIMIT, PITCH_LIMIT));
        let guess = [pitch[0], pitch[1], pitch[2], tilt, -0.03, 0.03 * self.weight];
        DVector::from_column_slice(&guess[..self.unknowns])
    }

    fn drag(&self, shaft_tilt_rad: f64) -> f64 {
        match &self.target {
            TrimTarget::Propulsive { vehicle, .. } => fuselage_drag(
                self.density_chord,
                self.chord,
                vehicle.drag_area,
                self.advance_ratio,
                shaft_tilt_rad,
            ),
            _ => 0.0,
        }
    }

    fn state(&self, x: &DVector<f64>) -> (Controls, Attitude) {
        match self.target {
            TrimTarget::Prescribed { controls, shaft_tilt_rad } => {
                (controls, Attitude { shaft_tilt_rad, ..Attitude::default() })
            }
            TrimTarget::WindTunnel { shaft_tilt_rad, .. } => (
                Controls { theta0_rad: x[0], theta1c_rad: x[1], theta1s_rad: x[2] },
                Attitude { shaft_tilt_rad, ..Attitude::default() },
            ),
            TrimTarget::Propulsive { .. } => (
                Controls { theta0_rad: x[0], theta1c_rad: x[1], theta1s_rad: x[2] },
                Attitude { shaft_tilt_rad: x[3], roll_rad: x[4], tail_thrust: x[5] },
            ),
        }
    }

    /// Rotor response and trim residuals over the weight.
    fn evaluate(
        &self,
        solver: &mut RotorSolver,
        x: &DVector<f64>,
        start: Option<&RotorSolution>,
    ) -> Result<(RotorSolution, DVector<f64>), TrimError> {
        let (controls, attitude) = self.state(x);
        let flight = FlightState {
            advance_ratio: self.advance_ratio,
            shaft_tilt_rad: attitude.shaft_tilt_rad,
        };
        let flap_angles_rad = vec![HarmonicSeries::default(); self.flaps];
        let condition = Condition { flight, controls, flap_angles_rad };
        let rotor = solver.solve(&condition, self.inflow, start)?;
        let residual = self.residual(&rotor, &attitude);
        Ok((rotor, residual))
    }

    /// Trim residuals over the weight of a response at an attitude; empty for prescribed controls.
    fn residual(&self, rotor: &RotorSolution, attitude: &Attitude) -> DVector<f64> {
        let mean = rotor.hub.mean();
        let residual = match &self.target {
            TrimTarget::Prescribed { .. } => vec![],
            TrimTarget::WindTunnel { .. } => vec![mean[2] - self.weight, mean[3], mean[4]],
            TrimTarget::Propulsive { vehicle, .. } => {
                let drag = self.drag(attitude.shaft_tilt_rad);
                equilibrium(mean, attitude, vehicle, self.weight, drag).to_vec()
            }
        };
        DVector::from_vec(residual) / self.weight
    }

    /// Columns are independent and computed in parallel from the same starting point.
    fn jacobian(
        &self,
        solver: &RotorSolver,
        x: &DVector<f64>,
        base: &(RotorSolution, DVector<f64>),
    ) -> Result<DMatrix<f64>, TrimError> {
        let columns = (0..self.unknowns)
            .into_par_iter()
            .map(|j| {
                let mut moved = x.clone();
                moved[j] += JACOBIAN_STEP;
                let (_, residual) = self.evaluate(&mut solver.clone(), &moved, Some(&base.0))?;
                Ok((residual - &base.1) / JACOBIAN_STEP)
            })
            .collect::<Result<Vec<DVector<f64>>, TrimError>>()?;
        Ok(DMatrix::from_columns(&columns))
    }

    /// The part of a step, at most 1, after which the first unknown meets its limit, and which.
    fn part_within_limits(x: &DVector<f64>, step: &DVector<f64>) -> (f64, usize) {
        let ratios = x.iter().zip(step).enumerate().take(5).map(|(j, (&value, &change))| {
            let limit = if j < 3 { PITCH_LIMIT } else { ATTITUDE_LIMIT };
            let room = (limit - value * change.signum()).max(0.0);
            (if change == 0.0 { f64::INFINITY } else { room / change.abs() }, j)
        });
        ratios.fold((1.0, 0), |least, ratio| if ratio.0 < least.0 { ratio } else { least })
    }

    fn solve(
        &self,
        solver: &mut RotorSolver,
        settings: &TrimSettings,
        start: Option<&TrimSolution>,
    ) -> Result<TrimSolution, TrimError> {
        let mut x = start.map_or_else(|| self.first_guess(solver), |s| self.unknowns_of(s));
        let mut current = self.evaluate(solver, &x, start.map(|s| &s.rotor))?;
        let mut history = vec![current.1.amax()];
        let mut jacobian: Option<DMatrix<f64>> =
            start.and_then(|s| s.jacobian.clone()).filter(|j| j.nrows() == self.unknowns);
        for iteration in 0..=settings.max_iterations {
            let residual = current.1.amax();
            if self.unknowns == 0 || residual <= settings.tolerance {
                return Ok(self.finish(&x, current, (history, iteration), jacobian));
            }
            let (matrix, fresh) = match jacobian.take() {
                Some(kept) => (kept, false),
                None => (self.jacobian(solver, &x, &current)?, true),
            };
            let singular = || TrimError::Singular { iteration, residual };
            let step = -matrix.clone().lu().solve(&current.1).ok_or_else(singular)?;
            // a Newton step far from trim may not turn a control by more than 0.2 rad
            let largest = step.iter().take(5).fold(0.0_f64, |m, s| m.max(s.abs()));
            let step = step * (0.2 / largest.max(0.2));
            let (part, limited) = Self::part_within_limits(&x, &step);
            if part < LEAST_PART {
                if !fresh {
                    continue;
                }
                return Err(Self::out_of_reach(limited, x[limited], iteration, history));
            }
            let Some((step, new)) = self.descend(solver, &x, &(step * part), &current)? else {
                if !fresh {
                    continue;
                }
                let theta0_deg = self.state(&x).0.theta0_rad.to_degrees();
                return Err(TrimError::NoDescent { iteration, residual, history, theta0_deg });
            };
            let gained = new.1.amax() <= 0.3 * residual;
            // Broyden's rank-one update; a matrix that stopped paying is computed anew
            let predicted = &current.1 + &matrix * &step;
            let updated = &matrix + (&new.1 - predicted) * step.transpose() / step.norm_squared();
            jacobian = (gained || fresh).then_some(updated);
            x += &step;
            current = new;
            history.push(current.1.amax());
        }
        Err(TrimError::NotConverged {
            iterations: settings.max_iterations,
            residual: current.1.amax(),
            tolerance: settings.tolerance,
            history,
            theta0_deg: self.state(&x).0.theta0_rad.to_degrees(),
        })
    }

    /// The longest of the step, its half, its quarter... that lowers the norm of the residuals;
    /// none if no part does. A part at which the rotor has no periodic response is too long too,
    /// unless none has one: that is the response's error.
    fn descend(
        &self,
        solver: &mut RotorSolver,
        x: &DVector<f64>,
        step: &DVector<f64>,
        current: &(RotorSolution, DVector<f64>),
    ) -> Result<Option<Descent>, TrimError> {
        let norm = current.1.norm();
        let mut failure = None;
        for halvings in 0..=LARGEST_HALVINGS {
            let step = step * 0.5_f64.powi(halvings);
            match self.evaluate(solver, &(x + &step), Some(&current.0)) {
                Ok(new) if new.1.norm() < norm => return Ok(Some((step, new))),
                Ok(_) => failure = None,
                Err(error) => failure = Some(error),
            }
        }
        failure.map_or(Ok(None), Err)
    }

    fn out_of_reach(limited: usize, value: f64, iteration: usize, history: Vec<f64>) -> TrimError {
        let limit: f64 = if limited < 3 { PITCH_LIMIT } else { ATTITUDE_LIMIT };
        TrimError::OutOfReach {
            variable: VARIABLES[limited],
            value_deg: value.to_degrees(),
            limit_deg: limit.to_degrees().round(),
            iteration,
            residual: history.last().copied().unwrap_or(f64::NAN),
            history,
        }
    }

    fn unknowns_of(&self, solution: &TrimSolution) -> DVector<f64> {
        let (c, a) = (&solution.controls, &solution.attitude);
        let all = [
            c.theta0_rad,
            c.theta1c_rad,
            c.theta1s_rad,
            a.shaft_tilt_rad,
            a.roll_rad,
            a.tail_thrust,
        ];
        DVector::from_column_slice(&all[..self.unknowns])
    }

    fn finish(
        &self,
        x: &DVector<f64>,
        (rotor, residual): (RotorSolution, DVector<f64>),
        (residual_history, iterations): (Vec<f64>, usize),
        jacobian: Option<DMatrix<f64>>,
    ) -> TrimSolution {
        let (controls, attitude) = self.state(x);
        let flight = FlightState {
            advance_ratio: self.advance_ratio,
            shaft_tilt_rad: attitude.shaft_tilt_rad,
        };
        let residual = if self.unknowns == 0 { 0.0 } else { residual.amax() };
        TrimSolution {
            controls,
            attitude,
            flight,
            rotor,
            residual,
            residual_history,
            iterations,
            jacobian,
        }
    }
}
