//! Errors of the displacement sensor and its line.

use std::f64::consts::TAU;

use crate::draw::Draw;
use crate::filters::{Lag, delay, each};
use crate::runs::{BIAS_VOLT, FULL_VOLT};

/// What a sensor does to the displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Sensor {
    /// Two poles, 75 and 25 % of the delay at low frequency; s.
    Filter(f64),
    /// A pure delay; s.
    Delay(f64),
    /// Reading `x + a s(x/250 um)`, `s` a hyperbolic sine less its chord with a share of a parabola, largest value 1.
    Bent(f64),
    /// Reading `x + a (x/250 um)^3`; um.
    Cubic(f64),
    /// Mains with harmonics, the phase of each run its own.
    Hum { amplitude_um: f64, frequency_hz: f64 },
    /// 50 Hz as large as the deviation of the command from the bias; um at 85 V.
    HumWithCommand(f64),
    /// Reading `(1 + g) x`.
    Gain(f64),
    /// Reading `x + z`; um.
    Zero(f64),
    /// A zero of its own in each run, rising over the session; um at its end.
    WanderingZero(f64),
    /// A gain that goes from run to run, from 0 to `g` at the end of the session.
    WanderingGain(f64),
    /// A drift in one of the runs alone; um.
    Drift(f64),
}

/// What a sensor has to know of the run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'a> {
    /// Step, s.
    pub(crate) dt_s: f64,
    /// Command, V.
    pub(crate) command_volt: &'a [f64],
    /// Seed of the actuator.
    pub(crate) seed: u64,
    /// Number of the run in its session, and how many there are.
    pub(crate) number: usize,
    pub(crate) runs: usize,
}

/// Scale of the characteristics, um.
const SCALE_UM: f64 = 250.0;

impl Sensor {
    /// Turns displacement into the reading, um.
    pub(crate) fn apply(self, at: Moment<'_>, signal: &mut [f64]) {
        let mut draw = Draw::new("sensor", &[at.seed, at.number as u64]);
        let session = at.number as f64 / (at.runs.max(2) - 1) as f64;
        let dt_s = at.dt_s;
        match self {
            Self::Filter(tau_s) => {
                for share in [0.75, 0.25] {
                    let mut lag = Lag::new(share * tau_s, dt_s, signal[0]);
                    each(signal, |x| *x = lag.step(*x));
                }
            }
            Self::Delay(delay_s) => delay(signal, delay_s / dt_s),
            Self::Bent(amplitude_um) => {
                let largest =
                    (-100..=100).map(|i| bent(0.01 * f64::from(i)).abs()).fold(0.0, f64::max);
                each(signal, |x| *x += amplitude_um / largest * bent(*x / SCALE_UM));
            }
            Self::Cubic(size_um) => {
                each(signal, |x| *x += size_um * (*x / SCALE_UM).powi(3));
            }
            Self::Hum { amplitude_um, frequency_hz } => {
                let lines = [(1.0, 1.0), (2.0, 0.06), (3.0, 0.15), (5.0, 0.05)]
                    .map(|(order, height)| (order, height, draw.uniform(0.0, TAU)));
                for (i, x) in signal.iter_mut().enumerate() {
                    let angle = TAU * frequency_hz * dt_s * i as f64;
                    let line = |(order, height, phase)| height * f64::sin(order * angle + phase);
                    *x += amplitude_um * lines.into_iter().map(line).sum::<f64>();
                }
            }
            Self::HumWithCommand(amplitude_um) => {
                let phase = draw.uniform(0.0, TAU);
                for (i, (x, u)) in signal.iter_mut().zip(at.command_volt).enumerate() {
                    let size = amplitude_um * (u - BIAS_VOLT).abs() / FULL_VOLT;
                    *x += size * (TAU * 50.0 * dt_s * i as f64 + phase).sin();
                }
            }
            Self::Gain(gain) => each(signal, |x| *x *= 1.0 + gain),
            Self::Zero(zero_um) => each(signal, |x| *x += zero_um),
            Self::WanderingZero(size_um) => {
                let zero_um = size_um * (session + 0.35 * draw.normal());
                each(signal, |x| *x += zero_um);
            }
            Self::WanderingGain(gain) => {
                each(signal, |x| *x *= 1.0 + gain * session);
            }
            Self::Drift(size_um) => {
                // one of the first seven: the zero input and the repeated run stay clean
                let struck = Draw::new("struck", &[at.seed]).below(7.min(at.runs));
                if struck == at.number {
                    let tau_s = 0.4 * dt_s * signal.len() as f64;
                    let bend = |i: usize| 1.0 - (-(i as f64) * dt_s / tau_s).exp();
                    signal.iter_mut().enumerate().for_each(|(i, x)| *x += size_um * bend(i));
                }
            }
        }
    }
}

/// The shape of a bent characteristic over -1..1.
fn bent(x: f64) -> f64 {
    (2.2 * x).sinh() / 2.2_f64.sinh() - x + 0.08 * x * x
}
