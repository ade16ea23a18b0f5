//! One run of one bench: from the command to what the instruments would show without noise.

use crate::actuator::Actuator;
use crate::effect::{Mechanics, Moment, Physics};
use crate::runs::Run;

/// A run at the rate of its record, without noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Command, V.
    pub command_volt: Vec<f64>,
    /// What the voltage monitor shows, V.
    pub monitor_volt: Vec<f64>,
    /// Temperature above the rest, K.
    pub rise_kelvin: Vec<f64>,
    /// Force on the actuator, N.
    pub load_newton: Vec<f64>,
    /// What the displacement sensor shows, um.
    pub displacement_um: Vec<f64>,
}

/// Least rate of integration, Hz.
const LEAST_RATE_HZ: u32 = 4000;

/// Least number of steps for a sample.
const LEAST_STEPS: u32 = 8;

/// A run whose command and undisturbed motion are known.
#[derive(Debug, Clone)]
pub(crate) struct Prepared<'a> {
    actuator: &'a Actuator,
    seed: u64,
    place: (usize, usize),
    dt_s: f64,
    steps: usize,
    command_volt: Vec<f64>,
    motion_um: Vec<f64>,
}

impl<'a> Prepared<'a> {
    /// Run number `place.0` of `place.1` of a session, integrated `finer` times finer than usual.
    pub(crate) fn new(
        (actuator, seed): (&'a Actuator, u64),
        run: &Run,
        place: (usize, usize),
        finer: u32,
    ) -> Self {
        let steps = finer * LEAST_STEPS.max(LEAST_RATE_HZ.div_ceil(run.rate_hz));
        let dt_s = 1.0 / f64::from(run.rate_hz * steps);
        let steps = steps as usize;
        let command_volt = run.command_volt(dt_s, (run.samples() - 1) * steps + 1);
        let motion_um = actuator.motion_um(&command_volt);
        Self { actuator, seed, place, dt_s, steps, command_volt, motion_um }
    }

    /// The run with what is hidden, each in its place of the chain.
    pub(crate) fn with(&self, hidden: &[Physics]) -> Trace {
        let dt_s = self.dt_s;
        let mut volt = self.command_volt.clone();
        let mut amplified = false;
        for physics in hidden {
            if let Physics::Amplifier(amplifier) = physics {
                amplifier.apply(dt_s, &mut volt);
                amplified = true;
            }
        }
        let mut y = if amplified { self.actuator.motion_um(&volt) } else { self.motion_um.clone() };
        self.actuator.relax(dt_s, &mut y);
        let mut rise = vec![0.0; y.len()];
        for physics in hidden {
            if let Physics::Ceramic(ceramic) = physics {
                ceramic.apply(dt_s, &volt, &mut y);
                rise = ceramic.rise_kelvin(dt_s, &volt);
            }
        }
        let load = self.mechanics(hidden, &mut y);
        let (number, runs) = self.place;
        let at = Moment { dt_s, command_volt: &self.command_volt, seed: self.seed, number, runs };
        let (mut gain, mut zero_volt) = (1.0, 0.0);
        for physics in hidden {
            match physics {
                Physics::Sensor(sensor) => sensor.apply(at, &mut y),
                Physics::Monitor { gain: own, zero_volt: zero } => {
                    gain += own;
                    zero_volt += zero;
                }
                _ => {}
            }
        }
        let thin = |v: &[f64]| v.iter().step_by(self.steps).copied().collect::<Vec<f64>>();
        Trace {
            command_volt: thin(&self.command_volt),
            monitor_volt: thin(&volt).iter().map(|v| gain * v + zero_volt).collect(),
            rise_kelvin: thin(&rise),
            load_newton: thin(&load),
            displacement_um: thin(&y),
        }
    }

    /// Motion of the target (um, in place), and the force on the actuator (N).
    fn mechanics(&self, hidden: &[Physics], y: &mut [f64]) -> Vec<f64> {
        let found = hidden.iter().filter_map(|physics| match physics {
            Physics::Mechanics(mechanics) => Some(*mechanics),
            _ => None,
        });
        let all: Vec<Mechanics> = found.collect();
        for mechanics in &all {
            mechanics.apply(self.dt_s, y);
        }
        let force = |x: &f64| all.iter().map(|mechanics| mechanics.force_um(*x)).sum::<f64>();
        y.iter().map(|x| self.actuator.stiffness_newton_per_um * force(x)).collect()
    }
}
