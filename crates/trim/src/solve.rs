//! Newton's method on the trim equations around the periodic rotor response.

use crate::TrimError;
use crate::balance::{ATTITUDE_LIMIT, Balance, TrimTarget};
use crate::vehicle::Attitude;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_response::{
    Condition, Controls, ResponseError, ResponseTolerances, RotorSolution, RotorSolver, StateChange,
};
use rotor_wake::{FlightState, InflowModel, momentum_inflow};
use std::sync::Arc;

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
    /// How residuals and response answer the unknowns, kept for a nearby trim; none if it was not needed.
    pub slope: Option<TrimSlope>,
}

/// How residuals and response answer the unknowns of a trim: three pitch controls, and in level flight shaft tilt, bank (rad)
/// and tail thrust (`m0 Omega^2 R^2`).
#[derive(Debug, Clone)]
pub struct TrimSlope {
    /// Jacobian of the residuals.
    pub residuals: DMatrix<f64>,
    /// Change of motion and inflow per unit of each unknown.
    responses: Vec<StateChange>,
}

impl TrimSlope {
    /// The same for a response in another kind of inflow; none for one of another blade or other points of time.
    fn for_response(self, response: &RotorSolution) -> Option<Self> {
        let each = self.responses.into_iter().map(|change| change.for_response(response));
        Some(Self { responses: each.collect::<Option<_>>()?, ..self })
    }

    /// The response after a step, as the slope has it.
    fn predicted(
        &self,
        from: &RotorSolution,
        step: &DVector<f64>,
    ) -> Result<RotorSolution, ResponseError> {
        let Some((first, others)) = self.responses.split_first() else { return Ok(from.clone()) };
        let mut change = first.clone();
        change.scale(step[0]);
        for (other, part) in others.iter().zip(step.iter().skip(1)) {
            change.add(other, *part);
        }
        from.clone().moved_blade(&change)
    }

    /// Broyden's update: the slope that has what a step has led to, and changes least.
    fn update(
        &mut self,
        step: &DVector<f64>,
        [from, to]: [&Iterate; 2],
        predicted: &RotorSolution,
    ) {
        let share = step / step.norm_squared();
        let expected = &from.1 + &self.residuals * step;
        self.residuals += (&to.1 - expected) * share.transpose();
        let missed = StateChange::between(predicted, &to.0);
        for (response, share) in self.responses.iter_mut().zip(&share) {
            response.add(&missed, *share);
        }
    }
}

/// Step of the finite-difference Jacobian, rad (and weights for the tail thrust).
const JACOBIAN_STEP: f64 = 1e-4;
/// Mismatch of the inflow at most, over the tolerance of the trim: the thrust answers about twenty times as much, and what the
/// inflow leaves open must not keep the balance from closing.
const INFLOW_SHARE: f64 = 0.01;
/// Weak residual of the orbit and mismatch of the inflow of a column of the Jacobian: a ten-thousandth of its step.
const COLUMN_PERIODICITY: f64 = 1e-9;
const COLUMN_INFLOW: f64 = 1e-8;
/// Pitch angles beyond which the linear section model means nothing, rad.
const PITCH_LIMIT: f64 = 0.6;
/// Shaft tilt at which a trim starts at most, rad: a larger one is approached by the steps.
const LARGEST_FIRST_TILT: f64 = 0.4;
/// Damping over critical that leads an undamped rotor to its collective.
const HELPING_DAMPING: f64 = 0.02;
/// Halvings of a step that does not lower the residuals.
const LARGEST_HALVINGS: i32 = 6;
/// A step of which no larger part stays within the limits leads out of reach.
const LEAST_PART: f64 = 1e-3;

/// Mean lift coefficient that no aerofoil gives: attached sections that are asked for more are past stall.
const LARGEST_LIFT_COEFFICIENT: f64 = 1.5;
/// Share of the thrust asked for below which sections that were to give it have stalled.
const STALLED_SHARE: f64 = 0.98;
/// Iterations over which a search that gains next to nothing stands still, and what it gains.
const STANDSTILL: (usize, f64) = (4, 0.1);

/// Mean lift coefficient of the blades at a thrust, `6 (C_T / sigma) / (1 + 3 mu^2 / 2)`.
///
/// Source: W. Johnson, Helicopter Theory (1980), section 5-3, mean of the square of the tangential speed.
pub fn mean_lift_coefficient(ct_sigma: f64, advance_ratio: f64) -> f64 {
    6.0 * ct_sigma / (1.0 + 1.5 * advance_ratio * advance_ratio)
}

/// Responses without a periodic motion after which a search among sections that stall gives up.
const MOST_LOST: usize = 8;

/// Whether sections that stall have left the blade without a periodic motion.
fn is_lost(error: &TrimError) -> bool {
    matches!(
        error,
        TrimError::Response(
            ResponseError::PeriodicStall(_) | ResponseError::StallNotPeriodic { .. }
        )
    )
}

/// What a search has seen.
#[derive(Debug, Default)]
struct Progress {
    /// Responses that had no periodic motion for stall.
    lost: usize,
    /// Largest residual of every iterate.
    history: Vec<f64>,
    /// Largest thrust of an iterate, as `C_T / sigma`, and its collective.
    reached: f64,
    theta0_deg: f64,
    /// Collective of the last iterate.
    last_theta0_rad: f64,
}

impl Progress {
    fn note(&mut self, (rotor, residual): &Iterate, solidity: f64, theta0_rad: f64) {
        self.history.push(residual.amax());
        self.last_theta0_rad = theta0_rad;
        let ct_sigma = rotor.thrust_coefficient / solidity;
        if ct_sigma > self.reached {
            (self.reached, self.theta0_deg) = (ct_sigma, theta0_rad.to_degrees());
        }
    }

    fn stands_still(&self) -> bool {
        let (span, gain) = STANDSTILL;
        let Some(earlier) = self.history.len().checked_sub(span + 1) else { return false };
        self.history.last().is_some_and(|now| *now > (1.0 - gain) * self.history[earlier])
    }
}

/// A response, and the trim residuals that it leaves over the weight.
type Iterate = (RotorSolution, DVector<f64>);

/// Where a step begins.
struct Base<'a> {
    x: &'a DVector<f64>,
    current: &'a Iterate,
    slope: &'a TrimSlope,
}

/// A step that was gone, where it led, and the response that was predicted there.
struct Gone {
    step: DVector<f64>,
    reached: Iterate,
    predicted: RotorSolution,
}

const VARIABLES: [&str; 6] = ["theta0", "theta1c", "theta1s", "shaft tilt", "bank", "tail thrust"];

/// Trims the rotor at one advance ratio with given flap motions (none: flaps at rest).
///
/// Newton's method on controls, motion and inflow together: each column of the Jacobian, by differences, holds the change of the
/// response too, so that a step leads to its residuals and to the response where it starts. Broyden's update keeps all
/// three; the Jacobian is renewed when it stops paying. A step that raises the residuals is halved; one that leads beyond the range of a
/// control stops at its limit, and out of reach is what still points beyond it from there.
///
/// # Errors
/// [`TrimError::Parameter`] for a bad target, [`TrimError::Stalled`] and [`TrimError::BeyondStall`] for a
/// thrust that the sections do not give, [`TrimError::OutOfReach`], [`TrimError::NotConverged`] and [`TrimError::Singular`] with the residual history, and the
/// errors of the response.
pub fn trim(
    solver: &mut RotorSolver,
    inflow: &dyn InflowModel,
    advance_ratio: f64,
    target: &TrimTarget,
    settings: &TrimSettings,
    start: Option<&TrimSolution>,
) -> Result<TrimSolution, TrimError> {
    let balance = Balance::new(solver, advance_ratio, target)?;
    let flaps = solver.rotor().model().flaps.len();
    let problem = Problem { inflow, balance, flaps };
    let damped = if start.is_none() { problem.damped(solver, settings)? } else { None };
    problem.solve(solver, settings, start.or(damped.as_ref()))
}

/// Largest size of one of the first five unknowns, rad.
fn limit(unknown: usize) -> f64 {
    if unknown < 3 { PITCH_LIMIT } else { ATTITUDE_LIMIT }
}

/// The search for balance at one advance ratio.
struct Problem<'a> {
    inflow: &'a dyn InflowModel,
    balance: Balance,
    flaps: usize,
}

impl Problem<'_> {
    /// Starting values: the controls of a rigid blade under momentum inflow, the tilt that balances the
    /// drag, a torque guess.
    fn first_guess(&self, solver: &RotorSolver) -> DVector<f64> {
        let balance = &self.balance;
        let mu = balance.advance_ratio;
        let tilt = match balance.target {
            TrimTarget::Propulsive { .. } => {
                (balance.airframe(0.0).drag / balance.weight).min(LARGEST_FIRST_TILT)
            }
            TrimTarget::WindTunnel { shaft_tilt_rad, .. }
            | TrimTarget::Prescribed { shaft_tilt_rad, .. } => shaft_tilt_rad,
        };
        let flight = balance.flight(tilt);
        let hover = (0.5 * balance.thrust_coefficient).sqrt();
        let induced = momentum_inflow(&flight, balance.thrust_coefficient).unwrap_or(hover);
        let lambda = flight.normal_inflow() + induced;
        let c = solver.rotor().rigid_blade_controls(mu, lambda, balance.weight).unwrap_or_default();
        let pitch = [c.theta0_rad, c.theta1c_rad, c.theta1s_rad]
            .map(|angle| angle.clamp(-PITCH_LIMIT, PITCH_LIMIT));
        let guess = [pitch[0], pitch[1], pitch[2], tilt, -0.03, 0.03 * balance.weight];
        DVector::from_column_slice(&guess[..balance.unknowns])
    }

    /// Rotor response and trim residuals over the weight.
    fn evaluate(
        &self,
        solver: &mut RotorSolver,
        x: &DVector<f64>,
        start: Option<&RotorSolution>,
    ) -> Result<Iterate, TrimError> {
        let (controls, attitude) = self.balance.state(x);
        let condition = Condition {
            flight: self.balance.flight(attitude.shaft_tilt_rad),
            bank_rad: attitude.roll_rad,
            controls,
            flap_angles_rad: vec![HarmonicSeries::default(); self.flaps],
        };
        let found = solver.solve(&condition, self.inflow, start);
        let rotor =
            found.map_err(|error| solver.rotor().blame_resonance(controls.theta0_rad, error))?;
        let residual = self.balance.residual(&rotor, &attitude);
        Ok((rotor, residual))
    }

    /// The same after a step: from where it is predicted to lead or, where nothing is found from there, from where it began.
    /// Sections that stall may have more than one orbit: theirs is followed from where it was.
    fn after(
        &self,
        solver: &mut RotorSolver,
        x: &DVector<f64>,
        before: &RotorSolution,
        predicted: &RotorSolution,
    ) -> Result<Iterate, TrimError> {
        if !solver.rotor().model().nonlinear.is_linear() {
            return self.evaluate(solver, x, Some(before));
        }
        let found = self.evaluate(solver, x, Some(predicted));
        found.or_else(|_| self.evaluate(solver, x, Some(before)))
    }

    /// Columns are independent and computed in parallel from the same starting point.
    fn slope(
        &self,
        solver: &RotorSolver,
        x: &DVector<f64>,
        base: &Iterate,
    ) -> Result<TrimSlope, TrimError> {
        let exact = solver.tolerances();
        let enough = ResponseTolerances {
            periodicity: exact.periodicity.max(COLUMN_PERIODICITY),
            inflow: exact.inflow.max(COLUMN_INFLOW),
            ..exact
        };
        let columns = (0..self.balance.unknowns)
            .into_par_iter()
            .map(|j| {
                let mut moved = x.clone();
                moved[j] += JACOBIAN_STEP;
                let mut solver = solver.with_tolerances(enough);
                let (response, residual) = self.evaluate(&mut solver, &moved, Some(&base.0))?;
                let mut change = StateChange::between(&base.0, &response);
                change.scale(1.0 / JACOBIAN_STEP);
                Ok(((residual - &base.1) / JACOBIAN_STEP, change))
            })
            .collect::<Result<Vec<(DVector<f64>, StateChange)>, TrimError>>()?;
        let (columns, responses): (Vec<_>, Vec<_>) = columns.into_iter().unzip();
        Ok(TrimSlope { residuals: DMatrix::from_columns(&columns), responses })
    }

    /// The part of a step, at most 1, after which the first unknown meets its limit, and which.
    fn part_within_limits(x: &DVector<f64>, step: &DVector<f64>) -> (f64, usize) {
        let ratios = x.iter().zip(step).enumerate().take(5).map(|(j, (&value, &change))| {
            let room = (limit(j) - value * change.signum()).max(0.0);
            (if change == 0.0 { f64::INFINITY } else { room / change.abs() }, j)
        });
        ratios.fold((1.0, 0), |least, ratio| if ratio.0 < least.0 { ratio } else { least })
    }

    /// A rough trim of the rotor with damped modes, where an undamped one may be at a harmonic: only the
    /// collective in flight says whether it is.
    fn damped(
        &self,
        solver: &RotorSolver,
        settings: &TrimSettings,
    ) -> Result<Option<TrimSolution>, TrimError> {
        let rotor = solver.rotor();
        let theta0 = self.balance.state(&self.first_guess(solver)).0.theta0_rad;
        if self.balance.unknowns == 0 {
            rotor.refuse_resonance(theta0)?;
        }
        if !rotor.nearly_resonates(theta0) {
            return Ok(None);
        }
        let damped = Arc::new(rotor.with_modal_damping(HELPING_DAMPING));
        let mut helper = RotorSolver::new(damped, self.balance.advance_ratio, solver.tolerances())?
            .with_root_pitch(solver.root_pitch_rad().clone());
        let settings = TrimSettings { tolerance: settings.tolerance.max(1e-4), ..*settings };
        let Ok(found) = self.solve(&mut helper, &settings, None) else { return Ok(None) };
        rotor.refuse_resonance_in_flight(found.controls.theta0_rad, &found.rotor)?;
        Ok(Some(found))
    }

    /// The search for balance; a failure of sections that gave less than the thrust asked for is their stall.
    fn solve(
        &self,
        solver: &mut RotorSolver,
        settings: &TrimSettings,
        start: Option<&TrimSolution>,
    ) -> Result<TrimSolution, TrimError> {
        let mut progress = Progress::default();
        let exact = solver.tolerances();
        // given controls have no balance to close
        if self.balance.unknowns > 0 && solver.rotor().model().nonlinear.is_linear() {
            let inflow = exact.inflow.min(INFLOW_SHARE * settings.tolerance);
            *solver = solver.with_tolerances(ResponseTolerances { inflow, ..exact });
        }
        let found = self.search(solver, settings, start, &mut progress);
        *solver = solver.with_tolerances(exact);
        let model = solver.rotor().model();
        let (solidity, given) = (model.solidity(), self.balance.unknowns == 0);
        let stalls = !model.nonlinear.is_linear();
        let wanted = self.balance.thrust_coefficient / solidity;
        match found {
            Ok(trimmed) => {
                let wanted =
                    if given { trimmed.rotor.thrust_coefficient / solidity } else { wanted };
                let lift_coefficient =
                    mean_lift_coefficient(wanted.abs(), self.balance.advance_ratio);
                if stalls || lift_coefficient <= LARGEST_LIFT_COEFFICIENT {
                    return Ok(trimmed);
                }
                let (largest, history) = (LARGEST_LIFT_COEFFICIENT, trimmed.residual_history);
                Err(TrimError::BeyondStall { wanted, lift_coefficient, largest, history })
            }
            Err(TrimError::Response(
                cause @ (ResponseError::PeriodicStall(_) | ResponseError::StallNotPeriodic { .. }),
            )) if given => {
                let theta0_deg = progress.last_theta0_rad.to_degrees();
                Err(TrimError::StalledControls { theta0_deg, cause: Box::new(cause) })
            }
            Err(cause) if stalls && !given && progress.reached < STALLED_SHARE * wanted => {
                Err(TrimError::Stalled {
                    wanted,
                    reached: progress.reached,
                    theta0_deg: progress.theta0_deg,
                    history: progress.history,
                    cause: Box::new(cause),
                })
            }
            Err(
                cause @ (TrimError::OutOfReach { .. }
                | TrimError::NoDescent { .. }
                | TrimError::NotConverged { .. }),
            ) => {
                let resonance = solver.rotor().likely_resonance(progress.last_theta0_rad);
                Err(resonance.map_or(cause, TrimError::Response))
            }
            Err(cause) => Err(cause),
        }
    }

    /// Newton's method.
    fn search(
        &self,
        solver: &mut RotorSolver,
        settings: &TrimSettings,
        start: Option<&TrimSolution>,
        progress: &mut Progress,
    ) -> Result<TrimSolution, TrimError> {
        let theta0_rad = |x: &DVector<f64>| self.balance.state(x).0.theta0_rad;
        let mut x = start.map_or_else(
            || self.first_guess(solver),
            |s| self.balance.unknowns_of(&s.controls, &s.attitude),
        );
        progress.last_theta0_rad = theta0_rad(&x);
        let mut current = self.evaluate(solver, &x, start.map(|s| &s.rotor))?;
        let solidity = solver.rotor().model().solidity();
        let stalls = !solver.rotor().model().nonlinear.is_linear();
        progress.note(&current, solidity, theta0_rad(&x));
        let mut slope = start.and_then(|s| s.slope.clone());
        slope = slope.filter(|slope| slope.residuals.nrows() == self.balance.unknowns);
        for iteration in 0..=settings.max_iterations {
            let residual = current.1.amax();
            if self.balance.unknowns == 0 || residual <= settings.tolerance {
                solver.rotor().refuse_resonance_in_flight(theta0_rad(&x), &current.0)?;
                let (controls, attitude) = self.balance.state(&x);
                return Ok(TrimSolution {
                    controls,
                    attitude,
                    flight: self.balance.flight(attitude.shaft_tilt_rad),
                    rotor: current.0,
                    residual,
                    residual_history: progress.history.clone(),
                    iterations: iteration,
                    slope,
                });
            }
            let kept = slope.take().and_then(|kept| kept.for_response(&current.0));
            let (mut known, fresh) = match kept {
                Some(kept) => (kept, false),
                None => (self.slope(solver, &x, &current)?, true),
            };
            let Some(step) = known.residuals.clone().lu().solve(&current.1).map(|step| -step)
            else {
                if !fresh {
                    continue;
                }
                return Err(TrimError::Singular { iteration, residual });
            };
            // a Newton step far from trim may not turn a control by more than 0.2 rad
            let largest = step.iter().take(5).fold(0.0_f64, |m, s| m.max(s.abs()));
            let step = step * (0.2 / largest.max(0.2));
            let (part, limited) = Self::part_within_limits(&x, &step);
            if part < LEAST_PART {
                if !fresh {
                    continue;
                }
                return Err(TrimError::OutOfReach {
                    variable: VARIABLES[limited],
                    value_deg: x[limited].to_degrees(),
                    limit_deg: limit(limited).to_degrees().round(),
                    iteration,
                    residual,
                    history: progress.history.clone(),
                });
            }
            let theta0_deg = theta0_rad(&x).to_degrees();
            let no_descent = |progress: &Progress| TrimError::NoDescent {
                iteration,
                residual,
                history: progress.history.clone(),
                theta0_deg,
            };
            if stalls && progress.stands_still() {
                return Err(no_descent(progress));
            }
            let base = Base { x: &x, current: &current, slope: &known };
            let found = self.descend(solver, &base, &(step * part), progress)?;
            let Some(Gone { step, reached, predicted }) = found else {
                if !fresh {
                    continue;
                }
                return Err(no_descent(progress));
            };
            let gained = reached.1.amax() <= 0.3 * residual;
            // a slope that stopped paying is computed anew
            known.update(&step, [&current, &reached], &predicted);
            slope = (gained || fresh).then_some(known);
            x += &step;
            current = reached;
            progress.note(&current, solidity, theta0_rad(&x));
        }
        Err(TrimError::NotConverged {
            iterations: settings.max_iterations,
            residual: current.1.amax(),
            tolerance: settings.tolerance,
            history: progress.history.clone(),
            theta0_deg: theta0_rad(&x).to_degrees(),
        })
    }

    /// The longest of the step, its half, its quarter... that lowers the norm of the residuals;
    /// none if no part does. A part at which the rotor has no periodic response is too long too,
    /// unless none has one, or sections that stall have lost it time and again: that is the response's error.
    fn descend(
        &self,
        solver: &mut RotorSolver,
        base: &Base<'_>,
        step: &DVector<f64>,
        progress: &mut Progress,
    ) -> Result<Option<Gone>, TrimError> {
        let Base { x, current, slope } = base;
        let norm = current.1.norm();
        let mut failure = None;
        for halvings in 0..=LARGEST_HALVINGS {
            let step = step * 0.5_f64.powi(halvings);
            let predicted = slope.predicted(&current.0, &step);
            let predicted = predicted.unwrap_or_else(|_| current.0.clone());
            match self.after(solver, &(*x + &step), &current.0, &predicted) {
                Ok(reached) if reached.1.norm() < norm => {
                    return Ok(Some(Gone { step, reached, predicted }));
                }
                Ok(_) => failure = None,
                Err(error) => {
                    progress.lost += usize::from(is_lost(&error));
                    if progress.lost >= MOST_LOST {
                        return Err(error);
                    }
                    failure = Some(error);
                }
            }
        }
        failure.map_or(Ok(None), Err)
    }
}

/// Largest force (moment) left over the weight (weight times R) by another response at the controls
/// and attitude of a trim: with the flaps at work the trim is not what it was. Zero for prescribed
/// controls, which ask for no balance.
///
/// # Errors
/// [`TrimError::Parameter`] for a bad target.
pub fn imbalance(
    solver: &RotorSolver,
    target: &TrimTarget,
    trimmed: &TrimSolution,
    response: &RotorSolution,
) -> Result<f64, TrimError> {
    let problem = Balance::new(solver, trimmed.flight.advance_ratio, target)?;
    Ok(problem.residual(response, &trimmed.attitude).amax())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vehicle;
    use rotor_fem::{BladeProperties, BladeSpec};
    use rotor_response::{Couplings, Discretisation, Rotor, RotorModel};
    use rotor_wake::LinearInflow;

    /// Where a step of every unknown is predicted to lead, the response is; Broyden's update then knows it.
    #[test]
    fn a_step_leads_to_the_response_that_is_predicted() {
        let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
        let few =
            Discretisation { modes: [2, 1, 1], time_elements: 4, ..Discretisation::default() };
        let model = RotorModel::table_1(Couplings::Full);
        let rotor = Arc::new(Rotor::new(model, &blade, few).unwrap());
        let mut solver = RotorSolver::new(rotor, 0.3, ResponseTolerances::default()).unwrap();
        let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
        let settings = TrimSettings::default();
        let inflow = LinearInflow::Drees;
        let found = trim(&mut solver, &inflow, 0.3, &target, &settings, None).unwrap();
        let balance = Balance::new(&solver, 0.3, &target).unwrap();
        let problem = Problem { inflow: &inflow, balance, flaps: 0 };
        let x = problem.balance.unknowns_of(&found.controls, &found.attitude);
        let base = problem.evaluate(&mut solver, &x, Some(&found.rotor)).unwrap();
        let mut slope = problem.slope(&solver, &x, &base).unwrap();
        let step = DVector::from_vec(vec![0.01, -0.01, 0.01, 0.01, 0.005, 0.001]);
        let predicted = slope.predicted(&base.0, &step).unwrap();
        let reached = problem.evaluate(&mut solver, &(&x + &step), Some(&base.0)).unwrap();
        let off = |from: &RotorSolution, to: &RotorSolution| {
            let inflow = from.inflow.parameters().into_iter().zip(to.inflow.parameters());
            let inflow: f64 = inflow.map(|(a, b)| (a - b).powi(2)).sum();
            (&from.orbit.nodal - &to.orbit.nodal).norm() + inflow.sqrt()
        };
        let (missed, moved) = (off(&predicted, &reached.0), off(&base.0, &reached.0));
        println!("predicted off by {:.1e} of the way", missed / moved);
        assert!(missed < 0.05 * moved, "{missed} {moved}");
        slope.update(&step, [&base, &reached], &predicted);
        let known = slope.predicted(&base.0, &step).unwrap();
        assert!(off(&known, &reached.0) < 1e-10 * moved);
        let apart = (&base.1 + &slope.residuals * &step - &reached.1).norm();
        assert!(apart < 1e-12, "{apart}");
        // a slope of another blade is of no use
        let more = Discretisation { modes: [3, 1, 1], ..few };
        let rotor = Rotor::new(RotorModel::table_1(Couplings::Full), &blade, more).unwrap();
        let mut other = RotorSolver::new(Arc::new(rotor), 0.3, solver.tolerances()).unwrap();
        let other = problem.evaluate(&mut other, &x, None).unwrap();
        assert!(slope.for_response(&other.0).is_none());
    }
}
