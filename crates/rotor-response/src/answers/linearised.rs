//! How the hub loads answer to small flap motions about a converged orbit.

use crate::answers::changes::{StateChange, WakeDrive};
use crate::answers::settling::{Answer, INFLOW_ROUNDS, Settling, independent};
use crate::loads::wrenches::{SixLoads, added};
use crate::response::evaluated::Work;
use crate::response::hinge::HingeMoment;
use crate::response::revolution::RevolutionLoads;
use crate::response::rotor::up;
use crate::response::system::{PointInput, ResponseSystem};
use crate::response::wake_loading::loading;
use crate::sections::air::FlapAngle;
use crate::{Condition, ResponseError, RotorSolution, RotorSolver};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_fem::{Orbit, OrbitSamples, PeriodicSolver, PeriodicSystem};
use rotor_wake::{InducedInflow, InflowModel, RotorLoading};

/// What the inflow does while the flaps move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InflowState {
    /// It stays as in the orbit: the wake is frozen.
    Frozen,
    /// It settles anew on the loading, as in [`RotorSolver::solve`]: on thrust and moments, or, in a free
    /// wake, on the circulation.
    Settled,
}

/// One motion of all flaps, rad, trailing edge down positive: the direction of a derivative.
pub type FlapDirection = Vec<HarmonicSeries>;

/// What is moved: the direction of a derivative.
#[derive(Debug, Clone, PartialEq)]
pub enum Disturbance {
    /// All flaps.
    Flaps(FlapDirection),
    /// Pitch at the root of all blades beside the controls, each blade at its own azimuth, rad.
    RootPitch(HarmonicSeries),
    /// The inflow, by its parameters, tip speed: a part of it that does not come from the loading.
    Inflow(Vec<f64>),
}

/// Derivative of the hub loads along one direction of flaps, root pitch or inflow.
#[derive(Debug, Clone, PartialEq)]
pub struct HubSensitivity {
    /// Change of the hub loads per unit of the direction, fixed frame, all blades.
    pub hub: SixLoads,
    /// Change of the thrust coefficient.
    pub thrust_coefficient: f64,
    /// Change of the hinge moment of every flap, air and inertia together.
    pub hinge: Vec<HarmonicSeries>,
    /// Change of what moves the wake; none unless the inflow settles on a circulation.
    pub drive: Option<WakeDrive>,
    /// Change of the orbit and of the inflow.
    pub state: StateChange,
}

/// Derivatives along several directions, and what they cost.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LinearisedRotor {
    /// One derivative per direction.
    pub sensitivities: Vec<HubSensitivity>,
    /// The same with the inflow held.
    pub held: Vec<HubSensitivity>,
    /// Largest residual left by a linear equation, over its right-hand side.
    pub relative_residual: f64,
    /// Evaluations of the whole revolution.
    pub evaluations: usize,
    /// Newton matrices made; none where the orbit's own was kept.
    pub factorisations: usize,
}

/// Size of an angle and of the inflow in one-sided differences; the motion of the blade is of the
/// same size. The loads are close to linear in all of them.
const ANGLE_DIFFERENCE_RAD: f64 = 1e-5;
const INFLOW_DIFFERENCE: f64 = 1e-6;
/// Relative change of thrust for the slope of the inflow.
const THRUST_DIFFERENCE: f64 = 1e-5;

/// A load with a direction: the points of the revolution before and after a small change.
struct Direction {
    points: Vec<PointInput>,
    size: f64,
    /// Change of the inflow parameters.
    inflow: Vec<f64>,
    /// The direction itself at every point, if it is one of the flaps.
    flaps: Option<Vec<Vec<FlapAngle>>>,
}

/// The orbit about which is linearised.
struct Base<'a> {
    solver: &'a RotorSolver,
    /// The motion of the time elements, which satisfies the weak equations.
    orbit: OrbitSamples,
    /// The same with accelerations that satisfy the equations of motion at each azimuth.
    settled: OrbitSamples,
    /// `f` of the orbit at all points.
    forces: DMatrix<f64>,
    /// What `f` is without loads of the air and of the flaps.
    bare: DMatrix<f64>,
    rest: Answer,
    condition: &'a Condition,
    about: &'a RotorSolution,
    /// The inflow model, if the inflow follows the loading.
    followed: Option<&'a dyn InflowModel>,
}

/// The linear equations and what they cost so far.
struct Linear {
    orbits: PeriodicSolver,
    work: LinearisedRotor,
}

impl RotorSolver {
    /// Derivatives of the hub loads along directions of flap motion, about a converged orbit with the
    /// pilot controls held.
    ///
    /// ```text
    /// R(q, delta, lambda) = 0   =>   dq = -(dR/dq)^-1 ( dR/ddelta ddelta + dR/dlambda dlambda )
    /// dZ = dZ/dq dq + dZ/ddelta ddelta + dZ/dlambda dlambda
    /// settled:  (I - G) dlambda = g'(loading) dloading|frozen,    G = g' dloading/dlambda
    /// ```
    /// The implicit function theorem on the time elements: one set of linear equations with the exact
    /// Jacobian, the kept Newton matrix as preconditioner ([`rotor_fem::PeriodicSolver::linear_response`]). A settled
    /// inflow costs one more right-hand side where it follows the thrust, and a few rounds of generalised
    /// conjugate residuals over its parameters where it follows the circulation of a free wake. Directions may
    /// hold any harmonics: the motion of an ideal actuator or the one-sided difference of a hysteretic one.
    ///
    /// | argument | meaning |
    /// |---|---|
    /// | `condition`, `about` | flight, controls and flap motion of the orbit; its solution |
    /// | `directions` | flap motions, one series per flap |
    /// | `inflow` | frozen or settled |
    ///
    /// # Errors
    /// [`ResponseError::FlapMotions`] for a direction with another number of flaps; the errors of the
    /// linear equations and of the inflow model; [`ResponseError::InflowNotConverged`] if its changes do not
    /// settle.
    pub fn linearised(
        &mut self,
        (condition, about): (&Condition, &RotorSolution),
        inflow_model: &dyn InflowModel,
        directions: &[FlapDirection],
        inflow: InflowState,
    ) -> Result<LinearisedRotor, ResponseError> {
        let along: Vec<Disturbance> = directions.iter().cloned().map(Disturbance::Flaps).collect();
        self.linearised_along((condition, about), inflow_model, &along, inflow)
    }

    /// The same along directions of flaps, root pitch or inflow. The inflow of a direction is added to what the loading asks for,
    /// which a settled inflow follows as it moves.
    ///
    /// # Errors
    /// As [`Self::linearised`]; [`ResponseError::Wake`] for an inflow of another number of parameters.
    pub fn linearised_along(
        &mut self,
        (condition, about): (&Condition, &RotorSolution),
        inflow_model: &dyn InflowModel,
        directions: &[Disturbance],
        inflow: InflowState,
    ) -> Result<LinearisedRotor, ResponseError> {
        self.check_flaps(&condition.flap_angles_rad)?;
        for direction in directions {
            if let Disturbance::Flaps(motions) = direction {
                self.check_flaps(motions)?;
            }
        }
        // a first guess of how the inflow answers, exact where it follows the thrust
        let seed = match inflow {
            InflowState::Frozen => None,
            InflowState::Settled => Some(inflow_slope(condition, inflow_model, about)?),
        };
        let mut changes = directions
            .par_iter()
            .map(|direction| match direction {
                Disturbance::Flaps(motions) => {
                    Ok(self.moved_flaps(condition, &about.inflow, motions))
                }
                Disturbance::RootPitch(along) => {
                    Ok(self.moved_root_pitch(condition, &about.inflow, along))
                }
                Disturbance::Inflow(change) => self.moved_inflow(condition, &about.inflow, change),
            })
            .collect::<Result<Vec<Direction>, ResponseError>>()?;
        let seed = seed.filter(|slope| slope.iter().any(|v| *v != 0.0));
        if let Some(slope) = &seed {
            changes.push(self.moved_inflow(condition, &about.inflow, slope)?);
        }
        let followed = (inflow == InflowState::Settled).then_some(inflow_model);
        let base = Base::new(self, condition, about, followed)?;
        let work = LinearisedRotor { evaluations: 1, ..LinearisedRotor::default() };
        let mut linear = Linear { orbits: self.solver.clone(), work };
        let mut answers = base.answers(&mut linear, &changes)?;
        let held = self.sensitivities(&answers[..directions.len()]);
        if let Some(model) = followed {
            let seed = seed.and_then(|slope| Some((slope, answers.pop()?)));
            base.settle(&mut linear, model, seed, &mut answers)?;
        }
        Ok(LinearisedRotor { sensitivities: self.sensitivities(&answers), held, ..linear.work })
    }

    /// Derivatives as they are given out.
    fn sensitivities(&self, answers: &[Answer]) -> Vec<HubSensitivity> {
        let model = self.rotor.model();
        let of = |answer: &Answer| HubSensitivity {
            thrust_coefficient: model.thrust_coefficient(answer.hub.components[2].mean),
            hub: answer.hub.clone(),
            hinge: answer.hinge.clone(),
            drive: answer.drive.clone(),
            state: answer.state.clone(),
        };
        answers.iter().map(of).collect()
    }

    /// The condition with the flaps moved a little along a direction.
    fn moved_flaps(
        &self,
        condition: &Condition,
        inflow: &InducedInflow,
        direction: &[HarmonicSeries],
    ) -> Direction {
        let largest = direction.iter().map(largest_angle).fold(0.0, f64::max);
        let size = if largest > 0.0 { ANGLE_DIFFERENCE_RAD / largest } else { 1.0 };
        let flap_angles_rad = condition
            .flap_angles_rad
            .iter()
            .zip(direction)
            .map(|(angle, along)| added(angle, along, size))
            .collect();
        let moved = Condition { flap_angles_rad, ..condition.clone() };
        let at = |azimuth: &f64| direction.iter().map(|f| f.value_and_rates(*azimuth)).collect();
        let flaps = Some(self.time.points().iter().map(at).collect());
        let points = self.point_inputs(&moved, inflow);
        Direction { points, size, inflow: vec![0.0; inflow.parameters().len()], flaps }
    }

    /// The condition with the pitch at the root moved a little along a series.
    fn moved_root_pitch(
        &self,
        condition: &Condition,
        inflow: &InducedInflow,
        along: &HarmonicSeries,
    ) -> Direction {
        let largest = largest_angle(along);
        let size = if largest > 0.0 { ANGLE_DIFFERENCE_RAD / largest } else { 1.0 };
        let moved = self.with_root_pitch(added(self.root_pitch_rad(), along, size));
        let points = moved.point_inputs(condition, inflow);
        Direction { points, size, inflow: vec![0.0; inflow.parameters().len()], flaps: None }
    }

    /// The condition with the inflow moved a little along a change of its parameters.
    fn moved_inflow(
        &self,
        condition: &Condition,
        inflow: &InducedInflow,
        slope: &[f64],
    ) -> Result<Direction, ResponseError> {
        let largest = slope.iter().fold(0.0_f64, |m, v| v.abs().max(m));
        let size = if largest > 0.0 { INFLOW_DIFFERENCE / largest } else { 1.0 };
        let parameters: Vec<f64> =
            inflow.parameters().iter().zip(slope).map(|(p, s)| p + size * s).collect();
        let moved = inflow.with_parameters(&parameters)?;
        let points = self.point_inputs(condition, &moved);
        Ok(Direction { points, size, inflow: slope.to_vec(), flaps: None })
    }
}

impl<'a> Base<'a> {
    fn new(
        solver: &'a RotorSolver,
        condition: &'a Condition,
        about: &'a RotorSolution,
        followed: Option<&'a dyn InflowModel>,
    ) -> Result<Self, ResponseError> {
        let orbit = about.orbit.sample(&solver.time);
        let points = solver.point_inputs(condition, &about.inflow);
        let system = solver.rotor.system(&solver.air, points);
        let settled = OrbitSamples { qdd: about.accelerations.clone(), ..orbit.clone() };
        let (rest, (forces, bare)) = rayon::join(
            || answer(solver, condition, followed, &system, &settled),
            || {
                let mut forces = DMatrix::zeros(system.dof(), orbit.q.ncols());
                let evaluated = system.residual(&orbit, &mut Work::default(), &mut forces);
                (evaluated.map(|_| forces), system.unloaded(&orbit))
            },
        );
        let (rest, forces, bare) = (rest?, forces?, bare?);
        Ok(Self { solver, orbit, settled, forces, bare, rest, condition, about, followed })
    }

    /// Changes along several directions, solved together, the inflow held or moved as they say.
    fn answers(
        &self,
        linear: &mut Linear,
        changes: &[Direction],
    ) -> Result<Vec<Answer>, ResponseError> {
        let loads = changes
            .par_iter()
            .map(|change| self.load_change(change))
            .collect::<Result<Vec<_>, ResponseError>>()?;
        let points = self.solver.point_inputs(self.condition, &self.about.inflow);
        let response = linear
            .orbits
            .linear_response(
                &self.system(points),
                &self.about.orbit,
                &self.forces,
                &loads,
                self.solver.tolerances().linear,
            )
            .map_err(RotorSolver::orbit_error(&self.solver.rotor))?;
        let motions = response.changes.iter().zip(&response.force_changes);
        let found = changes
            .iter()
            .zip(motions)
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|(change, (motion, force))| self.change(&linear.orbits, change, motion, force))
            .collect::<Result<Vec<_>, ResponseError>>()?;
        let work = &mut linear.work;
        work.evaluations += loads.len() + response.evaluations + found.len();
        work.factorisations += response.factorisations;
        work.relative_residual = work.relative_residual.max(response.relative_residual);
        Ok(found)
    }

    /// Lets the inflow follow the changes of the loading, its own included.
    fn settle(
        &self,
        linear: &mut Linear,
        model: &dyn InflowModel,
        seed: Option<(Vec<f64>, Answer)>,
        answers: &mut [Answer],
    ) -> Result<(), ResponseError> {
        let mut settling = Settling::new(answers, self.solver.tolerances().linear);
        if let Some((slope, answer)) = seed {
            settling.follow(slope, answer, answers);
        }
        for _ in 0..INFLOW_ROUNDS {
            let open = settling.open();
            if open.is_empty() {
                return Ok(());
            }
            let steps: Vec<Vec<f64>> =
                open.into_iter().map(|left| model.improved_step(&left).unwrap_or(left)).collect();
            let steps = independent(steps);
            let moved = steps
                .iter()
                .map(|step| self.solver.moved_inflow(self.condition, &self.about.inflow, step))
                .collect::<Result<Vec<_>, ResponseError>>()?;
            let found = self.answers(linear, &moved)?;
            for (step, answer) in steps.into_iter().zip(found) {
                settling.follow(step, answer, answers);
            }
        }
        Err(ResponseError::InflowNotConverged {
            iterations: INFLOW_ROUNDS,
            change: settling.worst(),
            tolerance: settling.tolerance,
            thrust_coefficient: self.about.thrust_coefficient,
        })
    }

    fn system(&self, points: Vec<PointInput>) -> ResponseSystem<'_> {
        self.solver.rotor.system(&self.solver.air, points)
    }

    /// `df/dp` at all points, the motion held: in closed form along the flaps, else by a difference.
    fn load_change(&self, change: &Direction) -> Result<DMatrix<f64>, ResponseError> {
        let system = self.system(change.points.clone());
        if let Some(flaps) = &change.flaps
            && let Some(slope) = system.flap_slope(&self.orbit, &self.bare, flaps)?
        {
            return Ok(slope);
        }
        let mut forces = DMatrix::zeros(self.forces.nrows(), self.forces.ncols());
        system.residual(&self.orbit, &mut Work::default(), &mut forces)?;
        Ok((forces - &self.forces) / change.size)
    }

    /// Changes per unit of the direction, for a motion and the change of `f` at all points that goes with it.
    ///
    /// ```text
    /// dq'' += -(M + df/dq'')^-1 (M dq'' + df)
    /// ```
    /// turns the accelerations of the time elements into those that satisfy the equations of motion at each
    /// azimuth; apparent mass is a hundredth of the blade's, and that of the Newton matrix a hundredth off.
    fn change(
        &self,
        orbits: &PeriodicSolver,
        change: &Direction,
        motion: &Orbit,
        force: &DMatrix<f64>,
    ) -> Result<Answer, ResponseError> {
        let (orbit, inflow) = (motion.clone(), change.inflow.clone());
        let mut motion = motion.sample(&self.solver.time);
        let mass = &self.solver.rotor.mass;
        if let Some(lacking) = orbits.lacking_accelerations(&(mass * &motion.qdd + force)) {
            motion.qdd += lacking;
        }
        let state = StateChange { orbit, accelerations: motion.qdd.clone(), inflow };
        // the points were made for `change.size`; the motion goes with it
        motion.q = &self.settled.q + motion.q * change.size;
        motion.qd = &self.settled.qd + motion.qd * change.size;
        motion.qdd = &self.settled.qdd + motion.qdd * change.size;
        let system = self.system(change.points.clone());
        let mut answer = answer(self.solver, self.condition, self.followed, &system, &motion)?;
        answer.add(&self.rest, -1.0);
        answer.scale(1.0 / change.size);
        answer.state = state;
        Ok(answer)
    }
}

/// Loads, hinge moments and the inflow they ask for, of a motion.
fn answer(
    solver: &RotorSolver,
    condition: &Condition,
    followed: Option<&dyn InflowModel>,
    system: &ResponseSystem<'_>,
    samples: &OrbitSamples,
) -> Result<Answer, ResponseError> {
    let RotorSolver { rotor, time, .. } = solver;
    let loads = RevolutionLoads::of(rotor, time, system, samples, &system.revolution(samples)?);
    let hub = loads.hub(rotor, time);
    let count = rotor.discretisation.load_harmonics;
    let hinge = loads.hinge(time, count).iter().map(HingeMoment::total).collect();
    let (mut wanted, mut drive) = (Vec::new(), None);
    if let Some(model) = followed {
        let lift = hub.components[2].mean + rotor.blades_weight() * up(condition)[2];
        let ct = rotor.model().thrust_coefficient(lift);
        let loading = loading(rotor, time, &loads.lifting, ct, model.circulation_grid())?;
        wanted = model.induced(&condition.flight, &loading)?.parameters();
        drive = loading.circulation.map(|circulation| WakeDrive {
            circulation: circulation.values().to_vec(),
            modal: solver.modal_harmonics(samples),
        });
    }
    let (orbit, accelerations) = (Orbit::zero(time, 0), DMatrix::zeros(0, 0));
    let state = StateChange { orbit, accelerations, inflow: Vec::new() };
    Ok(Answer { hub, hinge, drive, state, wanted })
}

/// Change of the inflow parameters with the thrust coefficient, by central differences.
fn inflow_slope(
    condition: &Condition,
    model: &dyn InflowModel,
    about: &RotorSolution,
) -> Result<Vec<f64>, ResponseError> {
    let ct = about.thrust_coefficient;
    let step = THRUST_DIFFERENCE * ct.abs().max(1e-6);
    let at = |ct: f64| -> Result<Vec<f64>, ResponseError> {
        let loading = RotorLoading::from_thrust_coefficient(ct);
        Ok(model.induced(&condition.flight, &loading)?.parameters())
    };
    let (above, below) = (at(ct + step)?, at(ct - step)?);
    Ok(above.iter().zip(&below).map(|(a, b)| (a - b) / (2.0 * step)).collect())
}

/// A bound on the angle of a series.
fn largest_angle(series: &HarmonicSeries) -> f64 {
    series.mean.abs() + series.harmonics.iter().map(rotor_base::Harmonic::amplitude).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Compressibility, Controls, Couplings, Discretisation, FlapMass, NonlinearSections,
        ResponseTolerances, ReverseFlow, Rotor, RotorModel, SectionOffsets, TrailingEdgeFlap,
    };
    use flap_aero::{AirfoilSpan, AttachedFlowModel, C81Airfoil, C81Table, FlapEffectiveness};
    use rotor_base::Harmonic;
    use rotor_fem::{BladeProperties, BladeSpec};
    use rotor_wake::{FlightState, LinearInflow};
    use std::sync::Arc;

    fn model(
        couplings: Couplings,
        airfoils: Option<Arc<AirfoilSpan>>,
        tip_loss: f64,
        flap_start: f64,
    ) -> RotorModel {
        RotorModel {
            blades: 4,
            chord: 0.055,
            planform: crate::Planform::default(),
            lock_number: 5.2,
            drag_coefficient: 0.01,
            camber: crate::Camber::default(),
            root_cutout: 0.2,
            modal_damping: 0.005,
            lag_damper: 0.0,
            couplings,
            section_model: AttachedFlowModel::Calibrated,
            compressibility: Compressibility::LocalMach { tip_mach: 0.58 },
            reverse_flow: ReverseFlow::default(),
            flaps: vec![TrailingEdgeFlap {
                start: flap_start,
                end: flap_start + 0.1,
                chord_fraction: 0.25,
                mass_fraction: 0.1,
                cg_fraction: 0.2,
                gyration_fraction: None,
                mass: FlapMass::PartOfBlade,
                effectiveness: FlapEffectiveness::new(0.78, 1.0, 0.9).unwrap(),
            }],
            nonlinear: NonlinearSections { airfoils, dynamic_stall: None },
            tip_loss,
            gravity: 0.0,
            offsets: SectionOffsets::default(),
        }
    }

    fn stalling_table() -> Arc<AirfoilSpan> {
        let angles: Vec<f64> = (-36..=36).map(|i| 5.0 * f64::from(i)).collect();
        let table = |f: fn(f64) -> f64| {
            let values = angles.iter().map(|a| f(a.to_radians())).collect();
            C81Table::new(vec![0.0], angles.clone(), values).unwrap()
        };
        let airfoil = C81Airfoil {
            name: "PLATE".into(),
            lift: table(|a| 2.5 * (2.0 * a).sin()),
            drag: table(|a| 0.01 + 1.5 * a.sin().powi(2)),
            moment: table(|a| -0.1 * a.sin()),
        };
        Arc::new(AirfoilSpan::new(vec![(0.0, airfoil)]).unwrap())
    }

    /// The closed slope of the residual along the flaps against central differences.
    #[test]
    fn slopes_along_the_flaps_are_those_of_differences() {
        let moderate = Couplings::Moderate(rotor_fem::TorsionTerms::default());
        for (couplings, airfoils, tip_loss, flap_start) in [
            (Couplings::Full, None, 1.0, 0.7),
            (Couplings::Full, None, 0.75, 0.7),
            (moderate, None, 1.0, 0.7),
            (Couplings::Full, Some(stalling_table()), 1.0, 0.7),
            // a flap in reverse flow
            (Couplings::Full, None, 1.0, 0.22),
        ] {
            let blade = BladeProperties::new(BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 1000.0));
            let d = Discretisation {
                blade_elements: 5,
                modes: [2, 1, 1],
                load_harmonics: 8,
                ..Discretisation::default()
            };
            let model =
                RotorModel { gravity: 0.003, ..model(couplings, airfoils, tip_loss, flap_start) };
            let rotor = Rotor::new(model, &blade.unwrap(), d).unwrap();
            let mut solver =
                RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default()).unwrap();
            let mut direction = vec![HarmonicSeries::zero(3)];
            direction[0].mean = 0.3;
            direction[0].set_harmonic(3, Harmonic { cosine: 1.0, sine: -0.4 });
            let condition = Condition {
                flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.08 },
                controls: Controls { theta0_rad: 0.14, theta1c_rad: 0.02, theta1s_rad: -0.07 },
                flap_angles_rad: vec![added(&HarmonicSeries::zero(3), &direction[0], 0.02)],
                bank_rad: 0.0,
            };
            let inflow = LinearInflow::Prescribed { induced_inflow: 0.01 };
            let about = solver.solve(&condition, &inflow, None).unwrap();
            let base = Base::new(&solver, &condition, &about, None).unwrap();
            let forces = |by: f64| {
                let flap_angles_rad = vec![added(&condition.flap_angles_rad[0], &direction[0], by)];
                let moved = Condition { flap_angles_rad, ..condition.clone() };
                let system = base.system(solver.point_inputs(&moved, &about.inflow));
                let mut out = base.forces.clone();
                system.residual(&base.orbit, &mut Work::default(), &mut out).unwrap();
                out
            };
            let difference = (forces(0.1) - forces(-0.1)) / 0.2;
            let change = solver.moved_flaps(&condition, &about.inflow, &direction);
            let slope = base.load_change(&change).unwrap();
            let off = (&slope - &difference).amax() / difference.amax();
            println!("{couplings:?}: {off:.1e}");
            assert!(off <= 1e-8, "{couplings:?}: {off:e}");
            // and it was the closed slope that was compared
            let system = base.system(change.points.clone());
            assert!(
                system
                    .flap_slope(&base.orbit, &base.bare, &change.flaps.unwrap())
                    .unwrap()
                    .is_some()
            );
        }
    }
}
