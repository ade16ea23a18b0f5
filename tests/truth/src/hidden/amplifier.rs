//! Hidden effects of the amplifier: they turn the command into another terminal voltage.

use super::design::BIAS_VOLT;
use crate::stage::first_order_hold;

/// An amplifier that is not ideal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amplifier {
    /// `tau(V) V' + V = u`, `tau = tau_0 (1 + 0.1 (V - bias)/85 V)`: the capacitance of a ceramic grows
    /// with its bias field.
    Lag {
        /// `tau_0`, s.
        tau_s: f64,
    },
    /// `V' = S s((u - V)/(T S))`, `s(x) = x/(1 + |x|^4)^(1/4)`, `T` = 20 us: a loop that follows within
    /// microseconds until its current runs out, softly.
    CurrentLimit {
        /// `S`, V/s.
        slew_volt_per_s: f64,
    },
    /// Both ends bent over a knee of 1.5 V: `V = u - w ln(1 + e^((u - high)/w)) + w ln(1 + e^((low - u)/w))`.
    Saturation {
        /// Lower asymptote, V.
        low_volt: f64,
        /// Upper asymptote, V.
        high_volt: f64,
    },
}

/// Time constant of the amplifier's loop, s.
const LOOP_S: f64 = 2e-5;

/// Width of the knee of saturation, V.
const KNEE_VOLT: f64 = 1.5;

impl Amplifier {
    /// Turns a command into the terminal voltage, V.
    pub fn apply(self, dt_s: f64, signal: &mut [f64]) {
        match self {
            Self::Lag { tau_s } => {
                let (mut from, mut voltage) = (signal[0], signal[0]);
                for u in signal {
                    let tau = |v: f64| tau_s * (1.0 + 0.1 * (v - BIAS_VOLT) / 85.0);
                    let predicted = first_order_hold(voltage, from, *u, dt_s, tau(voltage));
                    let middle = tau(0.5 * (voltage + predicted));
                    voltage = first_order_hold(voltage, from, *u, dt_s, middle);
                    from = *u;
                    *u = voltage;
                }
            }
            Self::CurrentLimit { slew_volt_per_s } => {
                let mut voltage = signal[0];
                for u in signal {
                    voltage = limited(voltage, *u, dt_s, slew_volt_per_s);
                    *u = voltage;
                }
            }
            Self::Saturation { low_volt, high_volt } => {
                for u in signal {
                    let over = KNEE_VOLT * softplus((*u - high_volt) / KNEE_VOLT);
                    let under = KNEE_VOLT * softplus((low_volt - *u) / KNEE_VOLT);
                    *u += under - over;
                }
            }
        }
    }
}

/// One implicit Euler step of the soft limit: the error `e = u - V` solves `e + dt S s(e/(T S)) = e0`.
///
/// The left side grows with `e`, steeper than 1: Newton from the unlimited solution, kept inside the
/// interval that holds the root.
fn limited(voltage: f64, command: f64, dt_s: f64, slew: f64) -> f64 {
    let gap = (command - voltage).abs();
    let scale = LOOP_S * slew;
    let mut error = gap / (1.0 + dt_s / LOOP_S);
    for _ in 0..20 {
        let x = error / scale;
        let root = (1.0 + x * x * x * x).sqrt().sqrt();
        let value = error + dt_s * slew * x / root - gap;
        let slope = 1.0 + dt_s / LOOP_S / (root * (1.0 + x * x * x * x));
        let next = (error - value / slope).clamp(0.0, gap);
        let done = (next - error).abs() <= 1e-10 * (gap + scale);
        error = next;
        if done {
            break;
        }
    }
    command - (command - voltage).signum() * error
}

/// `ln(1 + e^x)` without overflow.
pub(super) fn softplus(x: f64) -> f64 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}
