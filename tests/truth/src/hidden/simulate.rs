//! One run of one actuator: from the command to the records.

use super::base::{BaseActuator, creep};
use super::design::{BIAS_VOLT, Fitting, Plan};
use super::effect::Physics;
use super::mechanics::Mechanics;
use crate::error::TruthError;
use crate::relaxation::Relaxation;
use crate::stage::Stage;

/// Stiffness of the actuator, N/um.
pub const STIFFNESS_NEWTON_PER_UM: f64 = 1.1;

/// A run at the rate of its record, without noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Exact {
    /// Command, V.
    pub command_volt: Vec<f64>,
    /// Terminal voltage, V.
    pub amplifier_volt: Vec<f64>,
    /// Temperature above that of the rest, K.
    pub rise_kelvin: Vec<f64>,
    /// Force of the load and of fitted springs, N.
    pub load_newton: Vec<f64>,
    /// Displacement, um.
    pub displacement_um: Vec<f64>,
}

/// A run whose command and hysteresis have been computed: effects behind them can be tried on it.
#[derive(Debug, Clone)]
pub struct Prepared<'a> {
    base: &'a BaseActuator,
    plan: &'a Plan,
    key: u64,
    dt_s: f64,
    substeps: usize,
    command_volt: Vec<f64>,
    motion_um: Vec<f64>,
}

/// Rate of integration for a record rate, Hz: at least four times finer, 8 kHz from 1 kHz on.
pub fn internal_rate_hz(rate_hz: u32) -> u32 {
    match rate_hz {
        0..200 => 20 * rate_hz,
        200..1000 => 4000,
        _ => 8000,
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a duration times a rate is a small positive number"
)]
fn samples(plan: &Plan) -> usize {
    (plan.waveform.duration_s() * f64::from(plan.rate_hz) + 1e-6).floor() as usize + 1
}

impl<'a> Prepared<'a> {
    /// Command and hysteresis of a run, integrated `finer` times finer than [`internal_rate_hz`].
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for parameters out of range.
    pub fn new(
        base: &'a BaseActuator,
        plan: &'a Plan,
        key: u64,
        finer: u32,
    ) -> Result<Self, TruthError> {
        let internal_hz = finer * internal_rate_hz(plan.rate_hz);
        let substeps = (internal_hz / plan.rate_hz) as usize;
        let dt_s = 1.0 / f64::from(internal_hz);
        let count = (samples(plan) - 1) * substeps + 1;
        let command_volt = plan.waveform.sample(BIAS_VOLT, dt_s, count);
        let motion_um = base.hysteresis(&command_volt)?;
        Ok(Self { base, plan, key, dt_s, substeps, command_volt, motion_um })
    }

    /// The run with hidden effects, each in its place of the chain.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for parameters out of range.
    pub fn with(&self, effects: &[&Physics]) -> Result<Exact, TruthError> {
        let dt_s = self.dt_s;
        let mut voltage = self.command_volt.clone();
        let mut rise = vec![0.0; voltage.len()];
        let mut amplified = false;
        for effect in effects {
            if let Physics::Amplifier(amplifier) = effect {
                amplifier.apply(dt_s, &mut voltage);
                amplified = true;
            }
        }
        let mut y =
            if amplified { self.base.hysteresis(&voltage)? } else { self.motion_um.clone() };
        for effect in effects {
            if let Physics::Ceramic(ceramic) = effect {
                ceramic.apply(dt_s, &voltage, &mut y);
                rise = ceramic.temperature_rise(dt_s, &voltage);
            }
        }
        self.base.relax(dt_s, &mut y)?;
        for effect in effects {
            if let Physics::Relaxation(parameters) = effect {
                let mut stage = Relaxation::new(parameters.clone())?;
                stage.settle(y[0]);
                for x in &mut y {
                    *x = stage.step(*x, dt_s);
                }
            }
        }
        self.base.creep(dt_s, &mut y);
        for effect in effects {
            if let Physics::Creep(elements) = effect {
                creep(elements, dt_s, &mut y);
            }
        }
        let load = self.mechanics(effects, &mut y);
        if self.plan.fitting != Fitting::Laser {
            for effect in effects {
                if let Physics::Sensor(sensor) = effect {
                    sensor.apply(dt_s, self.key, &mut y);
                }
            }
        }
        let thin = |v: &[f64]| v.iter().step_by(self.substeps).copied().collect();
        Ok(Exact {
            command_volt: thin(&self.command_volt),
            amplifier_volt: thin(&voltage),
            rise_kelvin: thin(&rise),
            load_newton: thin(&load),
            displacement_um: thin(&y),
        })
    }

    /// Lever, loads and fittings; returns the force on the actuator, N.
    fn mechanics(&self, effects: &[&Physics], y: &mut [f64]) -> Vec<f64> {
        let found = effects.iter().filter_map(|effect| match effect {
            Physics::Mechanics(mechanics) => Some(*mechanics),
            _ => None,
        });
        let mut load = None;
        for mechanics in found {
            match (mechanics, self.plan.fitting) {
                (Mechanics::Backlash { .. }, Fitting::Preload) => {}
                (Mechanics::Friction { width_um }, Fitting::Preload) => {
                    Mechanics::Friction { width_um: 1.5 * width_um }.apply(self.dt_s, y);
                }
                (Mechanics::Load { .. }, _) => load = Some(mechanics),
                (other, _) => other.apply(self.dt_s, y),
            }
        }
        let spring = if let Fitting::Spring(ratio) = self.plan.fitting { ratio } else { 0.0 };
        // A spring beside a load: the actuator with the spring is a softer motion on a stiffer base.
        for x in y.iter_mut() {
            *x /= 1.0 + spring;
        }
        if let Some(Mechanics::Load { ratio }) = load {
            Mechanics::Load { ratio: ratio / (1.0 + spring) }.apply(self.dt_s, y);
        }
        let ratio = |x: f64| spring + load.map_or(0.0, |load| load.load_ratio(x));
        y.iter().map(|x| STIFFNESS_NEWTON_PER_UM * ratio(*x) * x).collect()
    }
}
