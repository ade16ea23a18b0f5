//! A mass on a spring with Bouc-Wen hysteresis.

use crate::check::{check_not_negative, check_positive, check_that, check_within};
use crate::{HysteresisLaw, PreisachError, StartState, VoltageRange};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The numbers of a [`HystereticOscillator`], as they are written to files.
///
/// | symbol | relation to `m x'' + c x' + k x + z = u`, `z' = alpha x' - beta (gamma abs(x') z + delta x' abs(z))` |
/// |---|---|
/// | `w` | `sqrt((k + alpha) / m)` |
/// | `zeta` | `c / (2 sqrt((k + alpha) m))` |
/// | `gain` | `1 / (k + alpha)` |
/// | `s` | `alpha / (k + alpha)` |
/// | `a`, `b` | `beta (gamma + delta)`, `beta (gamma - delta)` |
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OscillatorParameters {
    /// Voltages it may see, V.
    pub range_volt: VoltageRange,
    /// Output over voltage at small amplitude, slowly, deg/V, `> 0`.
    pub gain_deg_per_volt: f64,
    /// Undamped natural frequency at small amplitude, `w / 2 pi`, Hz, `> 0`.
    pub frequency_hz: f64,
    /// Damping ratio of the viscous part `zeta`, 0.001 to 2.
    pub damping_ratio: f64,
    /// Share `s` of the stiffness at small amplitude that is hysteretic, 0 to 0.99.
    pub hysteretic_share: f64,
    /// Fall `a` of the hysteretic stiffness per motion away from its middle, 1/deg; negative where it rises; `>= -b`.
    pub loading_per_deg: f64,
    /// Rise `b` of the hysteretic stiffness per motion back to its middle, 1/deg, `>= 0`.
    pub unloading_per_deg: f64,
    /// Output at rest in the middle of the range, deg.
    #[serde(default)]
    pub offset_deg: f64,
}

/// A mass, a damper and a spring, part of whose force is a Bouc-Wen hysteresis of the motion: it stands in the loop,
/// not before it.
///
/// ```text
/// x'' + 2 zeta w x' + w^2 [ (1 - s) x + s h ] = w^2 gain (u - u_mid),   delta = offset + x
/// dh/dx = 1 - a |h|  away from h = 0,   1 + b |h|  back to it
/// ```
/// Linear with frequency `w` and gain `gain` at small amplitude; softer and damped at large, stiffer where `a < 0`.
///
/// Checked when built: `b >= 0` and `a + b >= 0`, so that every closed path takes energy; `s <= 0.99`, so that a held
/// voltage has one place of rest.
///
/// Integration: the voltage straight between two samples; classical Runge-Kutta in steps of at most a tenth of
/// `1 / w`, of fourth order while the motion keeps its direction and of second order where it turns. A step so long
/// that all motion dies out leads to the place of rest, exactly.
///
/// Assumes: exponent 1. Not modelled: minor loops do not close, as is known of Bouc-Wen hysteresis.
/// Source: Y.-K. Wen, *Method for random vibration of hysteretic systems*, Journal of the Engineering Mechanics
/// Division 102 (1976); in these letters J. P. Noël, M. Schoukens, *Hysteretic benchmark with a dynamic nonlinearity*,
/// Workshop on Nonlinear System Identification Benchmarks (2016).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "OscillatorParameters", into = "OscillatorParameters")]
pub struct HystereticOscillator {
    parameters: OscillatorParameters,
}

stored_as_parameters!(HystereticOscillator, OscillatorParameters);

/// Place, rate and hysteretic part of an oscillator, and the voltage they belong to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OscillatorMemory {
    x_deg: f64,
    rate_deg_per_s: f64,
    hysteretic_deg: f64,
    voltage_volt: f64,
}

/// Longest step of the integration, over `1 / w`.
const LONGEST: f64 = 0.1;
/// Decay times of the slowest motion after which nothing is left of it.
const DIED_OUT: f64 = 40.0;
/// Halvings that find a place of rest to the last digit.
const HALVINGS: usize = 80;

impl HystereticOscillator {
    /// The oscillator of the given numbers.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`], [`PreisachError::NotFinite`].
    pub fn new(parameters: OscillatorParameters) -> Result<Self, PreisachError> {
        let p = &parameters;
        check_positive("gain_deg_per_volt", p.gain_deg_per_volt)?;
        check_positive("frequency_hz", p.frequency_hz)?;
        check_within("damping_ratio", p.damping_ratio, 0.001..=2.0)?;
        check_within("hysteretic_share", p.hysteretic_share, 0.0..=0.99)?;
        check_not_negative("unloading_per_deg", p.unloading_per_deg)?;
        let (a, b) = (p.loading_per_deg, p.unloading_per_deg);
        let takes = a.is_finite() && a + b >= 0.0;
        let expected = "a finite number, at least minus unloading_per_deg";
        check_that(takes, "loading_per_deg", a, expected)?;
        check_that(p.offset_deg.is_finite(), "offset_deg", p.offset_deg, "a finite number")?;
        Ok(Self { parameters })
    }

    /// Its numbers.
    pub fn parameters(&self) -> &OscillatorParameters {
        &self.parameters
    }

    /// Motion at small amplitude that a held voltage asks for, deg.
    fn asked_deg(&self, voltage_volt: f64) -> f64 {
        let p = &self.parameters;
        p.gain_deg_per_volt * (voltage_volt - p.range_volt.middle_volt())
    }

    /// The hysteretic part after a motion without turning.
    fn moved_deg(&self, hysteretic_deg: f64, motion_deg: f64) -> f64 {
        let p = &self.parameters;
        let (sign, length) = (1.0_f64.copysign(motion_deg), motion_deg.abs());
        let h = sign * hysteretic_deg;
        let to_zero = if h >= 0.0 {
            0.0
        } else if p.unloading_per_deg == 0.0 {
            -h
        } else {
            (-p.unloading_per_deg * h).ln_1p() / p.unloading_per_deg
        };
        if length < to_zero {
            return sign * along(h, length, p.unloading_per_deg);
        }
        sign * along(h.max(0.0), length - to_zero, p.loading_per_deg)
    }

    /// Takes the memory to where a voltage holds it, slowly, without turning.
    fn settle(&self, memory: &mut OscillatorMemory, voltage_volt: f64) -> f64 {
        let p = &self.parameters;
        let share = p.hysteretic_share;
        let asked_deg = self.asked_deg(voltage_volt);
        let left = |motion: f64| {
            let hysteretic = self.moved_deg(memory.hysteretic_deg, motion);
            asked_deg - (1.0 - share) * (memory.x_deg + motion) - share * hysteretic
        };
        // the spring without hysteresis is the softest: the way is no longer than it would go
        let (mut near, mut far) = (0.0, left(0.0) / (1.0 - share));
        let rising = far > 0.0;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if (left(middle) > 0.0) == rising { near = middle } else { far = middle }
        }
        let motion = 0.5 * (near + far);
        memory.hysteretic_deg = self.moved_deg(memory.hysteretic_deg, motion);
        memory.x_deg += motion;
        memory.rate_deg_per_s = 0.0;
        memory.voltage_volt = voltage_volt;
        p.offset_deg + memory.x_deg
    }

    /// Place, rate and hysteretic part: how fast each changes where the spring is asked for a motion, 1/s.
    #[inline]
    fn slope(&self, [x, rate, hysteretic]: [f64; 3], asked_deg: f64, omega: f64) -> [f64; 3] {
        let p = &self.parameters;
        let s = p.hysteretic_share;
        let pull = asked_deg - (1.0 - s) * x - s * hysteretic;
        let size = hysteretic.abs();
        let away = rate * hysteretic >= 0.0;
        let stiffness =
            if away { 1.0 - p.loading_per_deg * size } else { 1.0 + p.unloading_per_deg * size };
        let acceleration = omega * (omega * pull - 2.0 * p.damping_ratio * rate);
        [rate, acceleration, rate * stiffness]
    }

    fn marched(&self, memory: &mut OscillatorMemory, voltage_volt: f64, time_step_s: f64) -> f64 {
        let p = &self.parameters;
        let omega = TAU * p.frequency_hz;
        // a rate decays no slower than this, over or under critical damping
        if omega * time_step_s * p.damping_ratio.min(0.25) > DIED_OUT {
            return self.settle(memory, voltage_volt);
        }
        let fastest = omega * f64::max(1.0, 2.0 * p.damping_ratio);
        let count = (fastest * time_step_s / LONGEST).ceil().max(1.0);
        let step_s = time_step_s / count;
        let (mut asked, to) = (self.asked_deg(memory.voltage_volt), self.asked_deg(voltage_volt));
        let half = 0.5 * (to - asked) / count;
        let mut y = [memory.x_deg, memory.rate_deg_per_s, memory.hysteretic_deg];
        let beside = |y: [f64; 3], k: [f64; 3], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
        let mut done = 0.0;
        while done < count {
            let a = self.slope(y, asked, omega);
            let b = self.slope(beside(y, a, 0.5 * step_s), asked + half, omega);
            let c = self.slope(beside(y, b, 0.5 * step_s), asked + half, omega);
            let d = self.slope(beside(y, c, step_s), asked + 2.0 * half, omega);
            for i in 0..3 {
                y[i] += step_s / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
            }
            asked += 2.0 * half;
            done += 1.0;
        }
        [memory.x_deg, memory.rate_deg_per_s, memory.hysteretic_deg] = y;
        memory.voltage_volt = voltage_volt;
        p.offset_deg + memory.x_deg
    }
}

/// `h` after a length along `dh/dx = 1 - rate h`.
fn along(h: f64, length: f64, rate: f64) -> f64 {
    if rate == 0.0 { h + length } else { h - (1.0 - rate * h) * (-rate * length).exp_m1() / rate }
}

impl HysteresisLaw for HystereticOscillator {
    type Memory = OscillatorMemory;

    /// At rest there is no hysteretic force: where motion of falling amplitude about the voltage ends.
    fn start(&self, voltage_volt: f64, state: StartState) -> (OscillatorMemory, f64) {
        let range = self.parameters.range_volt;
        let at_volt = if state == StartState::Rest { voltage_volt } else { range.middle_volt() };
        let x_deg = self.asked_deg(at_volt) / (1.0 - self.parameters.hysteretic_share);
        let (rate_deg_per_s, hysteretic_deg) = (0.0, 0.0);
        let memory =
            OscillatorMemory { x_deg, rate_deg_per_s, hysteretic_deg, voltage_volt: at_volt };
        state.led(memory, range, voltage_volt, |m, volt| self.settle(m, volt))
    }

    fn step(&self, memory: &mut OscillatorMemory, voltage_volt: f64, time_step_s: f64) -> f64 {
        self.marched(memory, voltage_volt, time_step_s)
    }

    fn check_memory(&self, memory: &OscillatorMemory) -> Result<(), PreisachError> {
        let OscillatorMemory { x_deg, rate_deg_per_s, hysteretic_deg, voltage_volt } = *memory;
        let numbers = [x_deg, rate_deg_per_s, hysteretic_deg, voltage_volt];
        if numbers.iter().all(|number| number.is_finite()) {
            Ok(())
        } else {
            Err(PreisachError::MemoryOfAnotherLaw { expected: "Bouc-Wen oscillator" })
        }
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.parameters.offset_deg += shift_deg;
        self
    }
}
