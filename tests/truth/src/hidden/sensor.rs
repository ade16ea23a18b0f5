//! Hidden effects of the displacement sensor and its cable.

use std::f64::consts::TAU;

use super::draw::{Draw, Purpose};
use crate::stage::HeldLag;

/// A sensor that is not ideal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sensor {
    /// Two real poles: 0.8 and 0.2 of the delay at low frequency.
    Filter {
        /// Delay at low frequency, s.
        tau_s: f64,
    },
    /// A static error, odd with an even part, zero at rest.
    Nonlinearity {
        /// Largest deviation over +-250 um, um.
        amplitude_um: f64,
    },
    /// A delay that jitters by 2 % within seconds.
    Delay {
        /// Mean delay, s.
        delay_s: f64,
    },
    /// Mains with 12 % of its third harmonic; its phase belongs to the run.
    Hum {
        /// Amplitude of the fundamental, um.
        amplitude_um: f64,
        /// Frequency, Hz.
        frequency_hz: f64,
    },
    /// Jumps at random times, 1.5 a second, to a level drawn anew.
    Jumps {
        /// Deviation of the levels, um.
        deviation_um: f64,
    },
    /// Four times a second the last value is held.
    Dropout {
        /// Mean time of a hold, s.
        hold_s: f64,
    },
    /// A delay that swells and ebbs between 10 and 190 % of its mean at 0.8 Hz.
    BreathingDelay {
        /// Mean delay, s.
        delay_s: f64,
    },
}

/// Range over which the amplitude of a nonlinearity is stated, um.
const RANGE_UM: f64 = 250.0;

impl Sensor {
    /// Turns displacement into what the sensor shows, um; `key` names the run.
    pub fn apply(self, dt_s: f64, key: u64, signal: &mut [f64]) {
        let mut draw = Draw::new(Purpose::Run, &[key]);
        match self {
            Self::Filter { tau_s } => {
                for share in [0.8, 0.2] {
                    let lag = HeldLag::new(dt_s, share * tau_s);
                    let (mut state, mut from) = (signal[0], signal[0]);
                    for x in signal.iter_mut() {
                        state = lag.step(state, from, *x);
                        from = *x;
                        *x = state;
                    }
                }
            }
            Self::Nonlinearity { amplitude_um } => {
                let scale = amplitude_um / largest_of_shape();
                for x in signal {
                    *x += scale * shape(*x / RANGE_UM);
                }
            }
            Self::Delay { delay_s } => {
                let phase = draw.uniform(0.0, TAU);
                delayed(signal, dt_s, |t| {
                    delay_s * (1.0 + 0.02 * 2.0_f64.sqrt() * (TAU * 1.3 * t + phase).sin())
                });
            }
            Self::Hum { amplitude_um, frequency_hz } => {
                let (first, third) = (draw.uniform(0.0, TAU), draw.uniform(0.0, TAU));
                for (i, x) in signal.iter_mut().enumerate() {
                    let angle = TAU * frequency_hz * dt_s * i as f64;
                    *x +=
                        amplitude_um * ((angle + first).sin() + 0.12 * (3.0 * angle + third).sin());
                }
            }
            Self::Jumps { deviation_um } => {
                let mut level = 0.0;
                let mut next_s = draw.waiting_s(1.5);
                for (i, x) in signal.iter_mut().enumerate() {
                    if i as f64 * dt_s >= next_s {
                        level = deviation_um * draw.normal();
                        next_s += draw.waiting_s(1.5);
                    }
                    *x += level;
                }
            }
            Self::Dropout { hold_s } => {
                let mut begin_s = draw.waiting_s(4.0);
                let mut end_s = begin_s + hold_s * draw.uniform(0.5, 1.5);
                let (mut held, mut before) = (signal[0], signal[0]);
                for (i, x) in signal.iter_mut().enumerate() {
                    let t = i as f64 * dt_s;
                    if t >= end_s {
                        begin_s = end_s + draw.waiting_s(4.0);
                        end_s = begin_s + hold_s * draw.uniform(0.5, 1.5);
                    }
                    if t >= begin_s {
                        if t - begin_s < dt_s {
                            held = *x + (before - *x) * (t - begin_s) / dt_s;
                        }
                        before = *x;
                        *x = held;
                    } else {
                        before = *x;
                    }
                }
            }
            Self::BreathingDelay { delay_s } => {
                let phase = draw.uniform(0.0, TAU);
                delayed(signal, dt_s, |t| delay_s * (1.0 + 0.9 * (TAU * 0.8 * t + phase).sin()));
            }
        }
    }
}

/// Shape of the nonlinearity over `x` = -1..1.
fn shape(x: f64) -> f64 {
    (x * x * x - x) + 0.06 * (TAU * x).sin() + 0.1 * x * x
}

fn largest_of_shape() -> f64 {
    (-500..=500).map(|i| shape(f64::from(i) / 500.0).abs()).fold(0.0, f64::max)
}

/// `y(t) = x(t - T(t))`, cubic between samples, the first sample before the beginning.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a sample number between 0 and the length of the record"
)]
fn delayed(signal: &mut [f64], dt_s: f64, delay_s: impl Fn(f64) -> f64) {
    let input = signal.to_vec();
    let at = |i: usize| input[i.min(input.len() - 1)];
    for (i, y) in signal.iter_mut().enumerate() {
        let position = i as f64 - delay_s(i as f64 * dt_s) / dt_s;
        if position <= 0.0 {
            *y = input[0];
            continue;
        }
        let below = position.floor() as usize;
        let s = position - below as f64;
        let points = [at(below.saturating_sub(1)), at(below), at(below + 1), at(below + 2)];
        let weights = [
            -s * (s - 1.0) * (s - 2.0) / 6.0,
            (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0,
            -(s + 1.0) * s * (s - 2.0) / 2.0,
            (s + 1.0) * s * (s - 1.0) / 6.0,
        ];
        *y = points.iter().zip(weights).map(|(p, w)| p * w).sum();
    }
}
