//! What a flight is: rotor, actuators, schedule, and T along it.

use crate::blades::of_order;
use crate::{FlapMarch, FlapTurn, FlightError, FlightState, RotorPath};
use hhc_control::{ControlLayout, RelaxedSettings, TMatrix};
use preisach_dyn::ActuatorModel;
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_case::Bias;
use rotor_case::HandedSet;
use rotor_study::HUB_OUTPUTS;
use std::sync::Arc;

/// Revolutions that settle flaps and bias before T is identified.
const SETTLED_REV: usize = 12;

/// A flap that stops at a time where it is stuck, or goes on weakly, on every blade or on one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlapFailure {
    /// Which one, from 0.
    pub flap: usize,
    /// When, s.
    pub time_s: f64,
    /// Angle at which it stays, deg.
    pub stuck_deg: f64,
    /// Part of its motion that it keeps about that angle, 0 to 1; 0 for a flap that stands.
    pub kept_share: f64,
    /// Whether the controller is told at the end of that cycle; it then leaves the flap out on every blade.
    pub is_told: bool,
    /// Whether it fails on the first blade alone; the path must know that flap ([`RotorPath::with_blades`]).
    pub is_on_one_blade: bool,
}

/// A flap with an actuator of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnActuator {
    /// Which one, from 0.
    pub flap: usize,
    /// Of which blade, from 0, the path must then know that flap ([`RotorPath::with_blades`]); none for every blade that has none
    /// of its own there.
    pub blade: Option<usize>,
    /// The actuator.
    pub model: Arc<ActuatorModel>,
    /// Whether the T that controllers are given knows it. That T is of blades alike: an actuator of one blade is in none.
    pub is_told: bool,
}

/// One flight: rotor, actuators, schedule and loop.
#[derive(Debug, Clone)]
pub struct Flight<'a> {
    /// The rotor along its path.
    pub path: &'a RotorPath,
    /// The actuator of every flap that has none of its own.
    pub model: &'a ActuatorModel,
    /// Actuators of single flaps.
    pub own_actuators: Vec<OwnActuator>,
    /// Flaps and harmonics of the control.
    pub layout: ControlLayout,
    /// Revolutions per second of the actuators' time.
    pub actuator_rev_hz: f64,
    /// Bias: that of the start, led by the mean flap angle, or one that is held.
    pub bias: Bias,
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
    /// T that is handed in for the controllers; none for that of the rotor.
    pub handed_t: Option<HandedSet>,
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
    pub(crate) fn check(&self) -> Result<(), FlightError> {
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

    /// The flaps of blades alike, or of one blade (from 0), with the actuators that they have or, for T, those that are told.
    pub(crate) fn flaps(
        &self,
        blade: Option<usize>,
        of_told: bool,
    ) -> Result<FlapMarch<'_>, FlightError> {
        let own = |flap: usize, blade: Option<usize>| {
            let mut known = self.own_actuators.iter().filter(|own| own.is_told || !of_told);
            known.find(|own| own.flap == flap && own.blade == blade)
        };
        let model = |flap: usize| {
            let of_blade = blade.and_then(|_| own(flap, blade));
            of_blade.or_else(|| own(flap, None)).map_or(self.model, |own| &*own.model)
        };
        let models = (0..self.layout.flaps()).map(model).collect();
        FlapMarch::of_each(models, &self.layout, self.actuator_rev_hz, self.bias)
    }

    /// Hub loads at the blade number per rev in a state, flaps at rest, every blade as it is.
    pub(crate) fn rest(&self, state: FlightState) -> Result<[f64; HUB_OUTPUTS], FlightError> {
        let mut loads = self.path.loads(state, &[])?;
        let others = self.path.own_blade_loads(state, &[], &[])?;
        for (load, other) in loads.iter_mut().zip(&others[of_order(self.path.blades())]) {
            *load += other;
        }
        Ok(loads)
    }

    /// Standard deviation of a load in one revolution, from the loads without control at the start.
    pub(crate) fn noise(&self, start: &[f64]) -> f64 {
        self.noise_share * (start.iter().map(|z| z * z).sum::<f64>() / start.len() as f64).sqrt()
    }

    /// Where the rotor is at a time, s.
    pub fn state_at(&self, time_s: f64) -> FlightState {
        FlightState {
            advance_ratio: at_time(&self.advance_ratio, time_s),
            thrust_share: at_time(&self.thrust_share, time_s),
        }
    }

    /// What the flaps do under a step of each control up and down, settled, with the actuators that are told; nothing where T is
    /// handed in.
    ///
    /// # Errors
    /// [`FlightError::Actuator`], [`FlightError::Control`].
    pub(crate) fn steps(&self) -> Result<Vec<[Vec<HarmonicSeries>; 2]>, FlightError> {
        if self.handed_t.is_some() { Ok(Vec::new()) } else { self.steps_of(true) }
    }

    /// The same whatever is handed in, and with all actuators, told or not.
    ///
    /// # Errors
    /// As [`Self::steps`].
    pub(crate) fn own_steps(&self) -> Result<Vec<[Vec<HarmonicSeries>; 2]>, FlightError> {
        self.steps_of(false)
    }

    fn steps_of(&self, of_told: bool) -> Result<Vec<[Vec<HarmonicSeries>; 2]>, FlightError> {
        let settled = |control: usize, step_volt: f64| {
            let mut control_volt = self.layout.zero();
            control_volt[control] = step_volt;
            let mut flaps = self.flaps(None, of_told)?;
            for _ in 1..SETTLED_REV {
                flaps.revolve(&control_volt)?;
            }
            Ok::<_, FlightError>(motions(&flaps.revolve(&control_volt)?))
        };
        let both =
            |control| Ok([settled(control, self.step_volt)?, settled(control, -self.step_volt)?]);
        (0..self.layout.len()).into_par_iter().map(both).collect()
    }

    /// T in a state about zero control, 1/V, by central differences over settled [`Self::steps`]; that which is handed in, if it
    /// is.
    ///
    /// # Errors
    /// [`FlightError::Response`], [`FlightError::Control`].
    pub(crate) fn t_in(
        &self,
        state: FlightState,
        steps: &[[Vec<HarmonicSeries>; 2]],
    ) -> Result<TMatrix, FlightError> {
        if let Some(handed) = &self.handed_t {
            return Ok(handed.at(state.advance_ratio)?);
        }
        self.own_t_in(state, steps)
    }

    /// T of rotor and actuators in a state, by central differences over settled [`Self::own_steps`].
    ///
    /// # Errors
    /// As [`Self::t_in`].
    pub(crate) fn own_t_in(
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
}

/// Motions of all flaps in a revolution, deg.
pub(crate) fn motions(turns: &[FlapTurn]) -> Vec<HarmonicSeries> {
    turns.iter().map(|turn| turn.flap_deg.clone()).collect()
}
