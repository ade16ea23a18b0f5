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
    /// `V' = S s((u - V)/e)`, `s(x) = x/(1 + x^4)^(1/4)`, `e` = 0.2 V: a loop that follows within
    /// microseconds until its current runs out, softly.
    CurrentLimit {
        /// `S`, V/s.
        slew_volt_per_s: f64,
    },
    /// Both ends bent over a knee: `V = u - w ln(1 + e^((u - high)/w)) + w ln(1 + e^((low - u)/w))`.
    Saturation {
        /// Lower asymptote, V.
        low_volt: f64,
        /// Upper asymptote, V.
        high_volt: f64,
        /// Width of the knee `w`, V.
        knee_volt: f64,
    },
}

/// Error at which the amplifier's loop asks for all its current, V.
const LOOP_VOLT: f64 = 0.2;

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
            Self::Saturation { low_volt, high_volt, knee_volt } => {
                for u in signal {
                    let over = knee_volt * softplus((*u - high_volt) / knee_volt);
                    let under = knee_volt * softplus((low_volt - *u) / knee_volt);
                    *u += under - over;
                }
            }
        }
    }
}

/// One implicit Euler step of the soft limit: the error `E` after it solves `E + dt S s(E/e) = E0`.
///
/// The left side grows with `E`, at least as fast as `E` itself: Newton from the solution without limit,
/// kept inside the interval that holds the root.
fn limited(voltage: f64, command: f64, dt_s: f64, slew: f64) -> f64 {
    let gap = (command - voltage).abs();
    let reach = dt_s * slew;
    let mut error = gap / (1.0 + reach / LOOP_VOLT);
    for _ in 0..20 {
        let x = error / LOOP_VOLT;
        let root = (1.0 + x * x * x * x).sqrt().sqrt();
        let value = error + reach * x / root - gap;
        let slope = 1.0 + reach / LOOP_VOLT / (root * (1.0 + x * x * x * x));
        let next = (error - value / slope).clamp(0.0, gap);
        let done = (next - error).abs() <= 1e-10 * (gap + LOOP_VOLT);
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
