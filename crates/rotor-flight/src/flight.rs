//! The loop along a flight.

use crate::flaps::{FlapTurn, HARMONICS};
use crate::pilot::Pilot;
use crate::{FlapMarch, FlightError, FlightState, Guidance, RotorPath};
use hhc_control::{
    ControlLayout, Cost, CycleController, RelaxedController, RelaxedSettings, TMatrix,
};
use preisach_dyn::ActuatorModel;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_study::HUB_OUTPUTS;
use serde::Serialize;

/// Revolutions that settle flaps and bias before T is identified.
const SETTLED_REV: usize = 12;

/// A flap that stops at a time and stays where it is stuck, on every blade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlapFailure {
    /// Which one, from 0.
    pub flap: usize,
    /// When, s.
    pub time_s: f64,
    /// Angle at which it stays, deg.
    pub stuck_deg: f64,
    /// Whether the controller is told at the end of that cycle.
    pub is_told: bool,
}

/// One flight: rotor, actuators, schedule and loop.
#[derive(Debug, Clone)]
pub struct Flight<'a> {
    /// The rotor along its path.
    pub path: &'a RotorPath,
    /// The actuator of every flap.
    pub model: &'a ActuatorModel,
    /// Flaps and harmonics of the control.
    pub layout: ControlLayout,
    /// Revolutions per second of the actuators' time.
    pub actuator_rev_hz: f64,
    /// Bias at the start, V.
    pub bias_volt: f64,
    /// Revolutions per second of the rotor.
    pub rotor_rev_hz: f64,
    /// Advance ratio against time (s), linear in between and held beyond the ends.
    pub advance_ratio: Vec<(f64, f64)>,
    /// Part of the step of the thrust that is made, 0 to 1, against time (s), likewise; empty for none.
    pub thrust_share: Vec<(f64, f64)>,
    /// Length of the flight, s.
    pub duration_s: f64,
    /// Standard deviation of the noise of a load in one revolution, over the root mean square of the loads without control
    /// at the start.
    pub noise_share: f64,
    /// Of the noise.
    pub seed: u64,
    /// A flap that fails.
    pub failure: Option<FlapFailure>,
    /// Revolutions of a cycle that settle, and those of the analyser's window, 1 or more.
    pub cycle_rev: [usize; 2],
    /// Voltage by which T is identified at every knot, V, above 0.
    pub step_volt: f64,
    /// Weights and limits of the controller.
    pub settings: RelaxedSettings,
}

/// One cycle of a flight: what its window has seen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlightPoint {
    /// End of the cycle, s.
    pub time_s: f64,
    /// Advance ratio there.
    pub advance_ratio: f64,
    /// Part of the step of the thrust that is made there, 0 to 1.
    pub thrust_share: f64,
    /// `J` of the loads without noise.
    pub cost: f64,
    /// `J / J0`: over that without control in the same state.
    pub cost_ratio: f64,
    /// Loads without noise, cosine and sine of six at the blade number per rev, nondimensional.
    pub loads: [f64; HUB_OUTPUTS],
    /// The same without control.
    pub loads_at_rest: [f64; HUB_OUTPUTS],
    /// The control that acted, V.
    pub control_volt: Vec<f64>,
    /// Whether a limit of an amplitude bound when it was chosen.
    pub is_limited: bool,
    /// Amplitudes of every flap at 1, 2 ... 12 per rev in the last revolution, deg.
    pub flap_deg: Vec<Vec<f64>>,
    /// Lowest and highest voltage of every flap in the cycle.
    pub volt: Vec<[f64; 2]>,
    /// Part of the samples of all flaps whose voltage was held at an end of the range, 0 to 1.
    pub held_share: f64,
    /// Mean power that the actuators of one blade give in the last revolution, none taken back, W.
    pub power_watt: f64,
}

/// A value against time, linear in between and held beyond the ends; 0 of no points.
fn at_time(points: &[(f64, f64)], time_s: f64) -> f64 {
    let after = points.partition_point(|(time, _)| *time < time_s);
    match (points.get(after.wrapping_sub(1)), points.get(after)) {
        (Some((t0, from)), Some((t1, to))) => from + (to - from) * (time_s - t0) / (t1 - t0),
        (Some((_, held)), None) | (None, Some((_, held))) => *held,
        (None, None) => 0.0,
    }
}

impl Flight<'_> {
    fn check(&self) -> Result<(), FlightError> {
        for (what, value) in [
            ("length of the flight (s)", self.duration_s),
            ("revolutions per second of the rotor", self.rotor_rev_hz),
            ("step of T (V)", self.step_volt),
            ("window of the analyser (revolutions)", self.cycle_rev[1] as f64),
            ("points of the schedule", self.advance_ratio.len() as f64),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(FlightError::OutOfRange { what, value, expected: "above 0" });
            }
        }
        Ok(())
    }

    fn flaps(&self) -> Result<FlapMarch<'_>, FlightError> {
        FlapMarch::new(self.model, &self.layout, self.actuator_rev_hz, self.bias_volt)
    }

    /// Where the rotor is at a time, s.
    pub fn state_at(&self, time_s: f64) -> FlightState {
        FlightState {
            advance_ratio: at_time(&self.advance_ratio, time_s),
            thrust_share: at_time(&self.thrust_share, time_s),
        }
    }

    /// What the flaps do under a step of each control up and down, settled.
    ///
    /// # Errors
    /// [`FlightError::Actuator`], [`FlightError::Control`].
    fn steps(&self) -> Result<Vec<[Vec<HarmonicSeries>; 2]>, FlightError> {
        let settled = |control: usize, step_volt: f64| {
            let mut control_volt = self.layout.zero();
            control_volt[control] = step_volt;
            let mut flaps = self.flaps()?;
            for _ in 1..SETTLED_REV {
                flaps.revolve(&control_volt)?;
            }
            Ok::<_, FlightError>(motions(&flaps.revolve(&control_volt)?))
        };
        let both =
            |control| Ok([settled(control, self.step_volt)?, settled(control, -self.step_volt)?]);
        (0..self.layout.len()).into_par_iter().map(both).collect()
    }

    /// T in a state about zero control, 1/V, by central differences over settled [`Self::steps`].
    ///
    /// # Errors
    /// [`FlightError::Response`], [`FlightError::Control`].
    fn t_in(
        &self,
        state: FlightState,
        steps: &[[Vec<HarmonicSeries>; 2]],
    ) -> Result<TMatrix, FlightError> {
        let column = |[up, down]: &[Vec<HarmonicSeries>; 2]| {
            let (up, down) = (self.path.loads(state, up)?, self.path.loads(state, down)?);
            let slope = |(up, down): (&f64, f64)| (up - down) / (2.0 * self.step_volt);
            Ok(up.iter().zip(down).map(slope).collect())
        };
        let columns = steps.iter().map(column).collect::<Result<Vec<Vec<f64>>, FlightError>>()?;
        Ok(TMatrix::from_columns(&columns)?)
    }

    /// T in a state about zero control, 1/V.
    ///
    /// # Errors
    /// [`FlightError`] of actuators and rotor.
    pub fn identify(&self, state: FlightState) -> Result<TMatrix, FlightError> {
        self.t_in(state, &self.steps()?)
    }

    /// The controller at zero control; `start` are the loads there.
    fn pilot(&self, guidance: &Guidance, start: &[f64]) -> Result<Pilot, FlightError> {
        let relaxed = RelaxedController::new(&self.layout, start.len(), self.settings.clone())?;
        let first = || self.identify(self.state_at(0.0));
        Ok(match guidance {
            Guidance::Fixed => Pilot::Fixed(Box::new(relaxed), first()?),
            Guidance::Scheduled => {
                let steps = self.steps()?;
                let columns = self.path.advance_ratios().iter().map(|&advance_ratio| {
                    let state = FlightState { advance_ratio, thrust_share: 0.0 };
                    Ok(self.t_in(state, &steps)?.columns())
                });
                let columns = columns.collect::<Result<Vec<_>, FlightError>>()?;
                Pilot::Scheduled(Box::new(relaxed), columns)
            }
            Guidance::Adaptive(settings) => {
                let cycle = CycleController::new(relaxed, settings, &first()?, start)?;
                Pilot::Adaptive(Box::new(cycle))
            }
        })
    }
}

fn motions(turns: &[FlapTurn]) -> Vec<HarmonicSeries> {
    turns.iter().map(|turn| turn.flap_deg.clone()).collect()
}

/// What flies: flaps and the noise of what is measured.
struct Flown<'a> {
    flight: &'a Flight<'a>,
    flaps: FlapMarch<'a>,
    weights: Vec<f64>,
    /// Standard deviation of a load in one revolution.
    noise: f64,
    random: ChaCha8Rng,
    revolutions: usize,
}

impl Flown<'_> {
    fn time_s(&self) -> f64 {
        self.revolutions as f64 / self.flight.rotor_rev_hz
    }

    fn cost(&self, loads: &[f64]) -> f64 {
        Cost::of(loads, &self.weights, &[], 0.0).loads
    }

    /// One cycle under a control: what it was, and the loads that were measured.
    fn cycle(&mut self, pilot: &Pilot) -> Result<(FlightPoint, [f64; HUB_OUTPUTS]), FlightError> {
        let flight = self.flight;
        let [settling, window] = flight.cycle_rev;
        let (mut loads, mut measured) = ([0.0; HUB_OUTPUTS], [0.0; HUB_OUTPUTS]);
        let mut volt = vec![[f64::INFINITY, f64::NEG_INFINITY]; flight.layout.flaps()];
        let (mut motion, mut held_share) = (Vec::new(), 0.0);
        for rev in 0..settling + window {
            self.revolutions += 1;
            let turns = self.flaps.revolve(pilot.control_volt())?;
            for (turn, volt) in turns.iter().zip(&mut volt) {
                *volt = [volt[0].min(turn.volt[0]), volt[1].max(turn.volt[1])];
                held_share += turn.held_share / (turns.len() * (settling + window)) as f64;
            }
            motion = motions(&turns);
            if let Some(failed) = flight.failure.filter(|failure| self.time_s() > failure.time_s)
                && let Some(flap) = motion.get_mut(failed.flap)
            {
                *flap = HarmonicSeries { mean: failed.stuck_deg, ..HarmonicSeries::zero(0) };
            }
            if rev < settling {
                continue;
            }
            let found = flight.path.loads(flight.state_at(self.time_s()), &motion)?;
            for ((load, seen), found) in loads.iter_mut().zip(&mut measured).zip(found) {
                let draw: f64 = StandardNormal.sample(&mut self.random);
                *load += found / window as f64;
                *seen += (found + self.noise * draw) / window as f64;
            }
        }
        let (time_s, state) = (self.time_s(), flight.state_at(self.time_s()));
        let (cost, loads_at_rest) = (self.cost(&loads), flight.path.loads(state, &[])?);
        let amplitudes = |flap: &HarmonicSeries| {
            (1..=HARMONICS as usize).map(|n| flap.harmonic(n).amplitude()).collect()
        };
        let point = FlightPoint {
            time_s,
            advance_ratio: state.advance_ratio,
            thrust_share: state.thrust_share,
            cost,
            cost_ratio: cost / self.cost(&loads_at_rest),
            loads,
            loads_at_rest,
            control_volt: pilot.control_volt().to_vec(),
            is_limited: pilot.is_limited(),
            flap_deg: motion.iter().map(amplitudes).collect(),
            volt,
            held_share,
            power_watt: flight.path.power_watt(state, &motion)?,
        };
        Ok((point, measured))
    }
}

/// Flies one flight; a point for every cycle.
///
/// # Errors
/// [`FlightError`]: lengths and rates that are not positive, actuators, rotor, controller.
pub fn fly(flight: &Flight<'_>, guidance: &Guidance) -> Result<Vec<FlightPoint>, FlightError> {
    flight.check()?;
    let start = flight.path.loads(flight.state_at(0.0), &[])?;
    let rms = (start.iter().map(|z| z * z).sum::<f64>() / start.len() as f64).sqrt();
    let mut pilot = flight.pilot(guidance, &start)?;
    let mut flown = Flown {
        flight,
        flaps: flight.flaps()?,
        weights: flight.settings.load_weights.diagonal(HUB_OUTPUTS)?,
        noise: flight.noise_share * rms,
        random: ChaCha8Rng::seed_from_u64(flight.seed),
        revolutions: 0,
    };
    let (mut points, mut failure) = (Vec::new(), flight.failure);
    loop {
        let (point, measured) = flown.cycle(&pilot)?;
        let (time_s, advance_ratio) = (point.time_s, point.advance_ratio);
        points.push(point);
        if time_s >= flight.duration_s {
            return Ok(points);
        }
        if let Some(failed) = failure.filter(|failure| time_s > failure.time_s) {
            failure = None;
            if failed.is_told {
                pilot.lose_flap(failed.flap)?;
            }
        }
        pilot.step(flight.path, advance_ratio, &measured)?;
    }
}
