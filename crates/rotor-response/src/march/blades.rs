//! The equations of motion of all blades, step by step.
//!
//! ```text
//! M q'' + f(q, q', q'', psi, x) = 0                               at the end of every step
//! q1 = q0 + h q0' + (h^2/4) (q0'' + q1''),    q1' = q0' + (h/2) (q0'' + q1'')
//! ```
//! the rule of constant mean acceleration: of second order, without numerical damping. Section states `x` follow by
//! the recurrence of `sections::flight_air::passing`. The blades of an instant stand side by side, as the azimuth points of a
//! revolution do in the periodic response.
//!
//! Source: N. M. Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67, with beta = 1/4, gamma = 1/2.

use crate::march::instant::{Instant, InstantDrive};
use crate::response::evaluated::{Revolution, Work};
use crate::response::revolution::PointLoads;
use crate::response::system::ResponseSystem;
use crate::sections::air::SectionFlow;
use crate::sections::flight_air::{FlightAir, LagSteps, Lags, PassingLags};
use crate::structure::equations::SpanLoads;
use crate::{Condition, ResponseError, Rotor, RotorSolution, RotorSolver};
use nalgebra::{DMatrix, Dyn, LU};
use rayon::prelude::*;
use rotor_base::{HarmonicSeries, rotating_to_fixed};
use rotor_fem::OrbitSamples;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Step of the differences of the Newton matrix; only the speed of convergence depends on it.
const TANGENT_STEP: f64 = 1e-5;
/// Change of the accelerations at which a step has settled, `Omega^2 R`, and over their largest.
const SETTLED: [f64; 2] = [1e-13, 1e-11];
/// Revolutions of a periodic motion along which section states are brought before a march begins.
const STARTING: usize = 3;
/// Iterations of a step with the kept Newton matrices, after which these are made anew; and in all.
const KEPT_ITERATIONS: usize = 8;
const MOST_ITERATIONS: usize = 30;

/// A rotor whose blades are marched in time at one advance ratio.
#[derive(Debug, Clone)]
pub struct RotorInTime {
    rotor: Arc<Rotor>,
    advance_ratio: f64,
    steps: usize,
    /// By instant up to the blade spacing: there each blade has come to the place of the one before it.
    airs: Vec<FlightAir>,
    root_pitch_rad: HarmonicSeries,
}

/// Newton matrices of the blades at one instant, in the order of their azimuths.
type Matrices = Arc<Vec<LU<f64, Dyn, Dyn>>>;

/// All blades on their way through time.
#[derive(Debug, Clone)]
pub struct BladesInTime {
    /// Coordinates, rates, accelerations, shape `modes x blades`, in the order of the azimuths.
    samples: OrbitSamples,
    lags: Vec<PassingLags>,
    instant: Instant,
    newton: Vec<Option<Matrices>>,
}

impl BladesInTime {
    /// The present instant.
    pub fn instant(&self) -> &Instant {
        &self.instant
    }

    /// Modal coordinates of a blade, in the order flap, lag, torsion; tip value of each shape is 1. Blades are counted round.
    pub fn coordinates(&self, blade: usize) -> &[f64] {
        let place = self.place_of(blade);
        self.samples.at(place)[0]
    }

    /// Where in the order of the azimuths a blade is.
    fn place_of(&self, blade: usize) -> usize {
        let (blades, per_spacing) = (self.blades(), self.newton.len());
        (blade + self.instant.step / per_spacing) % blades
    }

    fn blades(&self) -> usize {
        self.samples.q.ncols()
    }

    /// Gives every blade the place of the one behind it: after one spacing the last one is the first.
    fn turn(&mut self) {
        let dof = self.samples.q.nrows();
        let OrbitSamples { q, qd, qdd, .. } = &mut self.samples;
        for part in [q, qd, qdd] {
            part.as_mut_slice().rotate_right(dof);
        }
        for lags in &mut self.lags {
            lags.turn();
        }
    }
}

impl RotorInTime {
    /// The rotor of a solver at its advance ratio, with its pitch at the root, and section aerodynamics at every instant of a grid
    /// of so many steps per revolution, a multiple of the blades.
    ///
    /// # Errors
    /// [`ResponseError::Parameter`] for steps that are no multiple of the blades, and for sections that stall dynamically;
    /// problems of the section model.
    pub fn new(solver: &RotorSolver, steps_per_revolution: usize) -> Result<Self, ResponseError> {
        let (rotor, advance_ratio) = (Arc::clone(solver.shared_rotor()), solver.advance_ratio);
        let (model, blades) = (rotor.model(), rotor.model().blades);
        let refuse = |field, value, expected| ResponseError::Parameter { field, value, expected };
        if model.nonlinear.dynamic_stall.is_some() {
            let expected = "off: sections that stall dynamically are not marched with the blades";
            return Err(refuse("dynamic_stall", 1.0, expected));
        }
        let steps = steps_per_revolution;
        if !(8..=7200).contains(&steps) || !steps.is_multiple_of(blades) {
            let expected = "8 to 7200 and a multiple of the number of blades";
            return Err(refuse("steps_per_revolution", steps as f64, expected));
        }
        let spacing = steps / blades;
        let airs = (0..spacing)
            .into_par_iter()
            .map(|k| {
                let azimuths: Vec<f64> = azimuths(k, steps, blades).collect();
                FlightAir::at_instant(rotor.model(), rotor.blade(), &azimuths, advance_ratio)
            })
            .collect::<Result<Vec<_>, ResponseError>>()?;
        let root_pitch_rad = solver.root_pitch_rad().clone();
        Ok(Self { rotor, advance_ratio, steps, airs, root_pitch_rad })
    }

    /// The rotor.
    pub fn rotor(&self) -> &Rotor {
        &self.rotor
    }

    /// Steps per revolution.
    pub fn steps_per_revolution(&self) -> usize {
        self.steps
    }

    /// Stations whose sections carry loads of the air, unit `R`.
    pub fn lifting_stations(&self) -> &[f64] {
        &self.rotor.blade().grid().x()[self.airs[0].first_station..]
    }

    /// All blades where a periodic solution has them. Section states are brought along its motion for three revolutions, in
    /// which those of flow from the leading edge forget that they began settled.
    ///
    /// # Errors
    /// [`ResponseError::Parameter`] for a flight at another advance ratio; [`ResponseError::FlapMotions`].
    pub fn start(
        &self,
        solution: &RotorSolution,
        condition: &Condition,
    ) -> Result<BladesInTime, ResponseError> {
        self.check(condition)?;
        let (given, expected) = (condition.flap_angles_rad.len(), self.rotor.model().flaps.len());
        if given != expected {
            return Err(ResponseError::FlapMotions { given, expected });
        }
        let spacing = self.airs.len();
        let mut lags = self.airs[0].settled_lags(&self.periodic_flows(0, solution, condition)?);
        for step in 1..=STARTING * self.steps {
            if step.is_multiple_of(spacing) {
                lags.iter_mut().for_each(PassingLags::turn);
            }
            let air = &self.airs[step % spacing];
            let steps = air.lag_steps(&lags, TAU / self.steps as f64);
            lags = air.passed(&steps, &self.periodic_flows(step, solution, condition)?);
        }
        // after whole revolutions every blade is where it was
        let samples = self.periodic_samples(0, solution);
        let system = self.periodic_system(0, solution, condition)?;
        let steps = self.airs[0].lag_steps(&lags, 0.0);
        let lags_now = Some(Lags::Passing(&steps));
        let revolution = system.evaluate(&samples, lags_now, &mut Work::default(), None)?;
        let instant = self.instant(0, &system, &samples, &revolution, 0);
        Ok(BladesInTime { samples, lags, instant, newton: vec![None; spacing] })
    }

    /// Motion of all blades on the orbit of a periodic solution.
    fn periodic_samples(&self, step: usize, solution: &RotorSolution) -> OrbitSamples {
        let (dof, blades) = (self.rotor.mass.nrows(), self.rotor.model().blades);
        let azimuth_rad: Vec<f64> = azimuths(step % self.airs.len(), self.steps, blades).collect();
        let of = |part: usize| {
            DMatrix::from_fn(dof, blades, |j, p| {
                solution.modal[j].value_and_rates(azimuth_rad[p])[part]
            })
        };
        let [q, qd, qdd] = [0, 1, 2].map(of);
        OrbitSamples { azimuth_rad, q, qd, qdd }
    }

    fn periodic_system(
        &self,
        step: usize,
        solution: &RotorSolution,
        condition: &Condition,
    ) -> Result<ResponseSystem<'_>, ResponseError> {
        let stations = self.lifting_stations();
        let flaps = &condition.flap_angles_rad;
        self.system(
            step,
            &InstantDrive {
                condition,
                induced: &|blade| {
                    solution.inflow.velocities(self.azimuth_rad(step, blade), stations)
                },
                flap_rad: &|blade| {
                    let azimuth = self.azimuth_rad(step, blade);
                    flaps.iter().map(|flap| flap.value_and_rates(azimuth)).collect()
                },
            },
        )
    }

    fn periodic_flows(
        &self,
        step: usize,
        solution: &RotorSolution,
        condition: &Condition,
    ) -> Result<Vec<Vec<SectionFlow>>, ResponseError> {
        let system = self.periodic_system(step, solution, condition)?;
        Ok(flows(&system, &self.periodic_samples(step, solution)))
    }

    /// Pitch at the root of a blade at an azimuth (rad), rad.
    pub(super) fn root_rad(&self, condition: &Condition, azimuth_rad: f64) -> f64 {
        condition.controls.root_pitch(&self.root_pitch_rad, azimuth_rad).angle_rad
    }

    /// Azimuth of a blade after so many steps, rad, `0..2 pi`.
    pub fn azimuth_rad(&self, step: usize, blade: usize) -> f64 {
        TAU * ((step + blade * self.airs.len()) % self.steps) as f64 / self.steps as f64
    }

    /// One step on, to an instant that `drive` describes. The accelerations are sought from those of `near`, the end of the same
    /// step under another drive, or else from those before.
    ///
    /// # Errors
    /// [`ResponseError::Parameter`] for a flight at another advance ratio; [`ResponseError::StepNotConverged`].
    pub fn step(
        &self,
        before: &BladesInTime,
        drive: &InstantDrive<'_>,
        near: Option<&BladesInTime>,
    ) -> Result<BladesInTime, ResponseError> {
        self.check(drive.condition)?;
        let step = before.instant.step + 1;
        let mut now = before.clone();
        let at = step % self.airs.len();
        if at == 0 {
            now.turn();
        }
        now.samples.azimuth_rad = azimuths(at, self.steps, self.rotor.model().blades).collect();
        let air = &self.airs[at];
        let h = TAU / self.steps as f64;
        let lag_steps = air.lag_steps(&now.lags, h);
        let system = self.system(step, drive)?;
        let near = near.map(|near| &near.samples.qdd);
        let (revolution, iterations) = self.settle(&system, &mut now, &lag_steps, (step, near))?;
        now.lags = air.passed(&lag_steps, &flows(&system, &now.samples));
        now.instant = self.instant(step, &system, &now.samples, &revolution, iterations);
        Ok(now)
    }

    fn check(&self, condition: &Condition) -> Result<(), ResponseError> {
        let value = condition.flight.advance_ratio;
        if (value - self.advance_ratio).abs() > 1e-12 {
            let expected = "the advance ratio the blades are marched at";
            return Err(ResponseError::Parameter { field: "advance_ratio", value, expected });
        }
        Ok(())
    }

    /// The equations of all blades at the instant of a step.
    ///
    /// # Errors
    /// [`ResponseError::FlapMotions`] and [`ResponseError::Parameter`] for a drive of another number of flaps or stations.
    fn system(
        &self,
        step: usize,
        drive: &InstantDrive<'_>,
    ) -> Result<ResponseSystem<'_>, ResponseError> {
        let (blades, at) = (self.rotor.model().blades, step % self.airs.len());
        let turned = step / self.airs.len();
        let (flaps, stations) = (self.rotor.model().flaps.len(), self.lifting_stations().len());
        let point = |(place, azimuth): (usize, f64)| {
            let blade = blade_at(place, turned, blades);
            let (induced, flap) = ((drive.induced)(blade), (drive.flap_rad)(blade));
            if flap.len() != flaps {
                return Err(ResponseError::FlapMotions { given: flap.len(), expected: flaps });
            }
            if induced.len() != stations {
                let expected = "a pair of velocities for every lifting station";
                let (field, value) = ("induced", induced.len() as f64);
                return Err(ResponseError::Parameter { field, value, expected });
            }
            let (condition, root) = (drive.condition, &self.root_pitch_rad);
            Ok(self.rotor.point_input(root, condition, azimuth, &induced, flap))
        };
        let points = azimuths(at, self.steps, blades).enumerate().map(point);
        Ok(self.rotor.system(&self.airs[at], points.collect::<Result<_, _>>()?))
    }

    /// Finds the accelerations at the end of a step; `now` holds the motion at its start.
    fn settle(
        &self,
        system: &ResponseSystem<'_>,
        now: &mut BladesInTime,
        lag_steps: &[LagSteps],
        (step, near): (usize, Option<&DMatrix<f64>>),
    ) -> Result<(Revolution, usize), ResponseError> {
        let (h, at) = (TAU / self.steps as f64, step % self.airs.len());
        let start = now.samples.clone();
        let end = |accelerations: &DMatrix<f64>| {
            let sum = &start.qdd + accelerations;
            OrbitSamples {
                azimuth_rad: start.azimuth_rad.clone(),
                q: &start.q + &start.qd * h + &sum * (0.25 * h * h),
                qd: &start.qd + sum * (0.5 * h),
                qdd: accelerations.clone(),
            }
        };
        now.samples = end(near.unwrap_or(&start.qdd));
        let lags = Some(Lags::Passing(lag_steps));
        let mut work = Work::default();
        let mut left = DMatrix::zeros(start.q.nrows(), start.q.ncols());
        let mut unbalanced = |samples: &OrbitSamples, left: &mut DMatrix<f64>| {
            let revolution = system.evaluate(samples, lags, &mut work, Some(left))?;
            left.gemm(1.0, system.mass, &samples.qdd, 1.0);
            Ok::<_, ResponseError>(revolution)
        };
        let (mut change, mut tolerance, mut iterations) = (f64::INFINITY, 0.0, 0);
        for iteration in 1..=MOST_ITERATIONS {
            iterations = iteration;
            let revolution = unbalanced(&now.samples, &mut left)?;
            let last = change <= tolerance;
            if last {
                return Ok((revolution, iteration));
            }
            if iteration == KEPT_ITERATIONS {
                now.newton[at] = None;
            }
            let matrices = if let Some(matrices) = &now.newton[at] {
                Arc::clone(matrices)
            } else {
                let slope = |j: usize| {
                    let mut moved = now.samples.qdd.clone();
                    moved.row_mut(j).add_scalar_mut(TANGENT_STEP);
                    let mut other = left.clone();
                    unbalanced(&end(&moved), &mut other)?;
                    Ok((other - &left) / TANGENT_STEP)
                };
                let columns = (0..start.q.nrows())
                    .map(slope)
                    .collect::<Result<Vec<DMatrix<f64>>, ResponseError>>()?;
                let made = Arc::new(matrices_of(&columns));
                now.newton[at] = Some(Arc::clone(&made));
                made
            };
            change = 0.0;
            for (p, matrix) in matrices.iter().enumerate() {
                let mut moves = left.column(p).clone_owned();
                if !matrix.solve_mut(&mut moves) {
                    return Err(ResponseError::MassMatrix { modes: start.q.nrows() });
                }
                change = change.max(moves.amax());
                now.samples.qdd.column_mut(p).axpy(-1.0, &moves, 1.0);
            }
            now.samples = end(&now.samples.qdd);
            tolerance = SETTLED[0] + SETTLED[1] * now.samples.qdd.amax();
            if !change.is_finite() {
                break;
            }
        }
        let (revolution, part) = (step / self.steps, step % self.steps);
        Err(ResponseError::StepNotConverged {
            azimuth_deg: 360.0 * part as f64 / self.steps as f64,
            revolution,
            change,
            tolerance,
            iterations,
        })
    }

    /// What all blades do at an instant.
    fn instant(
        &self,
        step: usize,
        system: &ResponseSystem<'_>,
        samples: &OrbitSamples,
        revolution: &Revolution,
        iterations: usize,
    ) -> Instant {
        let blades = samples.q.ncols();
        let turned = step / self.airs.len();
        let mut loads = SpanLoads::default();
        let mut instant = Instant {
            step,
            azimuths_rad: vec![0.0; blades],
            hub: [0.0; 6],
            roots: vec![[0.0; 6]; blades],
            circulation: DMatrix::zeros(self.lifting_stations().len(), blades),
            iterations,
        };
        for p in 0..blades {
            let (blade, azimuth) = (blade_at(p, turned, blades), samples.azimuth_rad[p]);
            let root =
                PointLoads::new(&self.rotor, system, samples, revolution, p, &mut loads).root;
            let [fx, fy, fz, mx, my, mz] = root;
            let force = rotating_to_fixed(azimuth, [fx, fy, fz]);
            let moment = rotating_to_fixed(azimuth, [mx, my, mz]);
            for (sum, part) in instant.hub.iter_mut().zip(force.into_iter().chain(moment)) {
                *sum += part;
            }
            instant.roots[blade] = root;
            instant.azimuths_rad[blade] = azimuth;
            for (s, section) in revolution.at(p).enumerate() {
                instant.circulation[(s, blade)] = section.circulation;
            }
        }
        instant
    }
}

/// The Newton matrix of every blade from the change of all residuals with each acceleration.
fn matrices_of(columns: &[DMatrix<f64>]) -> Vec<LU<f64, Dyn, Dyn>> {
    let (dof, blades) = (columns.len(), columns.first().map_or(0, DMatrix::ncols));
    let of_blade = |p: usize| DMatrix::from_fn(dof, dof, |i, j| columns[j][(i, p)]).lu();
    (0..blades).map(of_blade).collect()
}

/// Azimuths of all blades, in their order, at an instant within the blade spacing.
fn azimuths(at: usize, steps: usize, blades: usize) -> impl Iterator<Item = f64> {
    (0..blades).map(move |p| TAU * (at + p * (steps / blades)) as f64 / steps as f64)
}

/// The blade that has a place in the order of the azimuths after so many blade spacings.
fn blade_at(place: usize, turned: usize, blades: usize) -> usize {
    (place + blades - turned % blades) % blades
}

/// Flows at the lifting stations by blade, in the order of the azimuths.
fn flows(system: &ResponseSystem<'_>, samples: &OrbitSamples) -> Vec<Vec<SectionFlow>> {
    (0..samples.q.ncols()).map(|p| system.flows(p, &system.motion(samples, p))).collect()
}
