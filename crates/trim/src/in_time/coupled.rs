//! One azimuth step of blades and wake together.
//!
//! ```text
//! blades:  lambda at the end of the step (unknown), cubic in time through the three steps before  ->  Gamma(lambda)
//! wake:    lambda = A Gamma + lambda_0,    u_t = B Gamma + u_0           at the end of the step, of its geometry there
//! Newton:  (I - A S) dlambda = A Gamma + lambda_0 - lambda,              S = dGamma/dlambda of sections in still blades
//! ```
//! The trailers that leave a blade are so much of its own inflow that the step has to be implicit in the circulation: taken
//! from the step before, the downwash of narrow panels runs away from the lift.

use crate::{TrimError, WakeTrim};
use nalgebra::{DMatrix, DVector};
use rotor_base::HarmonicSeries;
use rotor_response::{
    BladePanels, BladesInTime, Condition, Instant, InstantDrive, ResponseError, RotorInTime,
    RotorSolver,
};
use rotor_wake::{FeltNow, WakeInTime};
use std::collections::VecDeque;

/// Change of the inflow that shows how the circulation answers, tip speed.
const SLOPE_STEP: f64 = 1e-4;
/// Iterations of a step with the slopes that are known, after which they are found anew.
const KEPT_ITERATIONS: usize = 8;
/// Steps of the wake whose inflow the next one is interpolated from.
const REMEMBERED: usize = 3;

/// How blades and wake are marched together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InTimeSettings {
    /// Steps of the blades per revolution, at least: so many that a whole number of them makes a step of the wake.
    pub blade_steps_per_revolution: usize,
    /// Largest mismatch of inflow and circulation at the end of a step, tip speed.
    pub inflow_tolerance: f64,
    /// Iterations of a step allowed.
    pub iterations: usize,
}

impl Default for InTimeSettings {
    fn default() -> Self {
        Self { blade_steps_per_revolution: 288, inflow_tolerance: 1e-7, iterations: 20 }
    }
}

/// Induced velocities at the panels of all blades, blade by blade, down through the disk and along it, tip speed.
type Velocities = [DVector<f64>; 2];

/// Blades and wake on their way through time.
#[derive(Debug, Clone)]
pub struct CoupledInTime {
    rotor: RotorInTime,
    panels: BladePanels,
    wake: WakeInTime,
    blades: BladesInTime,
    settings: InTimeSettings,
    /// Steps of the blades in one of the wake.
    blade_steps: usize,
    /// Inflow at the end of the last steps, the newest first.
    inflow: VecDeque<Velocities>,
    /// `S` of a blade by its azimuth step, once known.
    slopes: Vec<Option<DMatrix<f64>>>,
    /// Steps of the wake so far.
    steps: usize,
}

/// Angle, rate and acceleration (rad by azimuth) of every flap of a blade, at its azimuth (rad) and after so many radians in all.
pub type FlapMotion<'a> = dyn Fn(usize, f64, f64) -> Vec<[f64; 3]> + Sync + 'a;

impl CoupledInTime {
    /// Starts the rotor of a solver from its trim in a periodic wake, settled or not, flaps at rest.
    ///
    /// # Errors
    /// Those of [`RotorInTime::new`] and [`WakeInTime::new`].
    pub fn new(
        solver: &RotorSolver,
        begun: &WakeTrim,
        settings: InTimeSettings,
    ) -> Result<Self, TrimError> {
        let wake = begun.wake.clone();
        let azimuths = wake.settings().azimuths;
        let flaps = solver.rotor().model().flaps.len();
        let blade_steps = settings.blade_steps_per_revolution.div_ceil(azimuths).max(1);
        let rotor = RotorInTime::new(solver, azimuths * blade_steps)?;
        let panels = BladePanels::new(rotor.rotor(), rotor.lifting_stations(), wake.rotor());
        let condition = Condition {
            flight: begun.trim.flight,
            bank_rad: begun.trim.attitude.roll_rad,
            controls: begun.trim.controls,
            flap_angles_rad: vec![HarmonicSeries::default(); flaps],
        };
        let blades = rotor.start(&begun.trim.rotor, &condition)?;
        let middles = wake.rotor().stations();
        let before = |age: usize| -> Velocities {
            let of_blades: Vec<[f64; 2]> = (0..wake.rotor().blades())
                .flat_map(|blade| {
                    let azimuth = rotor.azimuth_rad(0, blade);
                    let back = age as f64 * std::f64::consts::TAU / azimuths as f64;
                    begun.trim.rotor.inflow.velocities(azimuth - back, &middles)
                })
                .collect();
            [0, 1].map(|c| DVector::from_iterator(of_blades.len(), of_blades.iter().map(|v| v[c])))
        };
        let inflow = (0..REMEMBERED).map(before).collect();
        let slopes = vec![None; azimuths];
        let wake = WakeInTime::new(wake, &begun.moving_of_the_wake())?;
        Ok(Self { rotor, panels, wake, blades, settings, blade_steps, inflow, slopes, steps: 0 })
    }

    /// The wake.
    pub fn wake(&self) -> &WakeInTime {
        &self.wake
    }

    /// Number of blades.
    pub fn blade_count(&self) -> usize {
        self.rotor.rotor().model().blades
    }

    /// Azimuth steps of the wake per revolution.
    pub fn steps_per_revolution(&self) -> usize {
        self.rotor.steps_per_revolution() / self.blade_steps
    }

    /// Steps of the blades per revolution.
    pub fn blade_steps_per_revolution(&self) -> usize {
        self.rotor.steps_per_revolution()
    }

    /// Mean over all panels of all blades by area of the inflow they feel now, tip speed.
    pub fn mean_inflow(&self) -> f64 {
        self.wake.mean_over_blades(&self.inflow[0][0])
    }

    /// One azimuth step of the wake under controls and flap motions; returns the instants of the blades on the way.
    ///
    /// # Errors
    /// [`TrimError::Response`] of a step of the blades, [`ResponseError::InflowInTime`] where circulation and inflow do not
    /// agree, [`rotor_wake::WakeError::WakeLost`]; what is kept is the end of the step before.
    pub fn step(
        &mut self,
        condition: &Condition,
        flaps: &FlapMotion<'_>,
    ) -> Result<Vec<Instant>, TrimError> {
        let first = &self.inflow[0];
        let guess = [0, 1].map(|c| &first[c] * 2.0 - &self.inflow[1][c]);
        let mut way = self.march(&guess, condition, flaps, &[])?;
        let places = self.panels.places(&self.rotor, end_of(&way, &self.blades), condition);
        let mut wake = self.wake.clone();
        wake.move_on(condition.flight, places).map_err(ResponseError::Wake)?;
        let felt = wake.felt();
        let mut inflow = guess;
        let (mut last, mut iterations) = (f64::INFINITY, 0);
        for iteration in 1..=self.settings.iterations {
            iterations = iteration;
            if iteration == KEPT_ITERATIONS {
                self.slopes.fill(None);
            }
            if iteration > 1 {
                way = self.march(&inflow, condition, flaps, &way)?;
            }
            let circulation = self.panels.circulation(end_of(&way, &self.blades));
            let wanted = felt.velocities(&circulation);
            let left = [0, 1].map(|c| &wanted[c] - &inflow[c]);
            last = left.iter().map(DVector::amax).fold(0.0, f64::max);
            if last <= self.settings.inflow_tolerance {
                wake.put_circulation(&circulation).map_err(ResponseError::Wake)?;
                self.wake = wake;
                let instants = way.iter().map(|blades| blades.instant().clone()).collect();
                self.blades = way.pop().unwrap_or_else(|| self.blades.clone());
                self.inflow.pop_back();
                self.inflow.push_front(wanted);
                self.steps += 1;
                return Ok(instants);
            }
            let slopes = self.slopes_at(&way, &inflow, condition, flaps)?;
            let moves = newton(&felt, &slopes, &left);
            for (value, change) in inflow.iter_mut().zip(moves) {
                *value += change;
            }
            if !inflow.iter().all(|of| of.iter().all(|v| v.is_finite())) {
                break;
            }
        }
        let tolerance = self.settings.inflow_tolerance;
        let failed = ResponseError::InflowInTime { iterations, change: last, tolerance };
        Err(TrimError::Response(failed))
    }

    /// `S` of all blades at the end of the step, from their state and the inflow that led there.
    fn slopes_at(
        &mut self,
        way: &[BladesInTime],
        inflow: &Velocities,
        condition: &Condition,
        flaps: &FlapMotion<'_>,
    ) -> Result<Vec<DMatrix<f64>>, TrimError> {
        let azimuths = self.slopes.len();
        let count = self.wake.began_with().rotor().blades();
        let at: Vec<usize> = (0..count)
            .map(|blade| (self.steps + 1 + blade * azimuths / count) % azimuths)
            .collect();
        if at.iter().any(|azimuth| self.slopes[*azimuth].is_none()) {
            let moved = [inflow[0].add_scalar(SLOPE_STEP), inflow[1].clone()];
            let other = self.march(&moved, condition, flaps, way)?;
            let [now, other] =
                [way, &other].map(|way| &end_of(way, &self.blades).instant().circulation);
            let of_stations = (other - now) / SLOPE_STEP;
            for (blade, azimuth) in at.iter().enumerate() {
                let slope = self.panels.slope(of_stations.column(blade).as_slice());
                self.slopes[*azimuth].get_or_insert(slope);
            }
        }
        Ok(at.iter().filter_map(|azimuth| self.slopes[*azimuth].clone()).collect())
    }

    /// The blades on their way over one step of the wake for an inflow at its end, near those of another one.
    fn march(
        &self,
        end: &Velocities,
        condition: &Condition,
        flaps: &FlapMotion<'_>,
        near: &[BladesInTime],
    ) -> Result<Vec<BladesInTime>, TrimError> {
        let (count, panels) = (self.blade_steps, self.panels.count());
        let mut way: Vec<BladesInTime> = Vec::with_capacity(count);
        let per_radian = self.rotor.steps_per_revolution() as f64 / std::f64::consts::TAU;
        for part in 1..=count {
            let now = self.between(end, part as f64 / count as f64);
            let before = way.last().unwrap_or(&self.blades);
            let step = before.instant().step + 1;
            let induced = |blade: usize| {
                let range = blade * panels..(blade + 1) * panels;
                let [down, along] = now.each_ref().map(|of| &of.as_slice()[range.clone()]);
                self.panels.at_stations([down, along])
            };
            let flap_rad = |blade: usize| {
                flaps(blade, self.rotor.azimuth_rad(step, blade), step as f64 / per_radian)
            };
            let drive = InstantDrive { condition, induced: &induced, flap_rad: &flap_rad };
            way.push(self.rotor.step(before, &drive, near.get(part - 1))?);
        }
        Ok(way)
    }

    /// Inflow at a part of the step: the cubic through its end and the three steps before.
    fn between(&self, end: &Velocities, part: f64) -> Velocities {
        let places = [1.0, 0.0, -1.0, -2.0];
        let weight = |k: usize| -> f64 {
            let others = (0..places.len()).filter(|j| *j != k);
            others.map(|j| (part - places[j]) / (places[k] - places[j])).product()
        };
        [0, 1].map(|c| {
            let before = self.inflow.iter().enumerate();
            before.fold(&end[c] * weight(0), |sum, (k, of)| sum + &of[c] * weight(k + 1))
        })
    }
}

/// The blades at the end of a way that sets out from others.
fn end_of<'a>(way: &'a [BladesInTime], before: &'a BladesInTime) -> &'a BladesInTime {
    way.last().unwrap_or(before)
}

/// Newton's step of the inflow, down and along, where the circulation answers to the downwash alone.
fn newton(felt: &FeltNow, slopes: &[DMatrix<f64>], [left, along]: &Velocities) -> Velocities {
    let [a, b] = &felt.of_circulation;
    let mut matrix = DMatrix::identity(a.nrows(), a.ncols());
    let mut first = 0;
    for slope in slopes {
        let count = slope.ncols();
        let answer = a.columns(first, count) * slope;
        let mut columns = matrix.columns_mut(first, count);
        columns -= answer;
        first += count;
    }
    // singular only where the blades would answer their own downwash in full: then a plain step
    let down = matrix.lu().solve(left).unwrap_or_else(|| left.clone());
    let mut circulation = DVector::zeros(down.len());
    first = 0;
    for slope in slopes {
        let of_blade = slope * down.rows(first, slope.nrows());
        circulation.rows_mut(first, slope.nrows()).copy_from(&of_blade);
        first += slope.nrows();
    }
    [down, along + b * circulation]
}
