//! Errors between command and terminal voltage.

use crate::filters::{Lag, SecondOrder, delay, each};

/// What an amplifier does to the command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Amplifier {
    /// `V = (1 + g) u`, about 0 V.
    Gain(f64),
    /// `V = u + z`; V.
    Zero(f64),
    /// Two poles, 95 and 5 % of the delay at low frequency; s.
    Lag(f64),
    /// A current that runs out softly: `V' = S tanh((u - V)/0.5 V)`; `S` in V/s.
    Slew(f64),
    /// Hyperbolic knees towards two asymptotes; V.
    Clip { low_volt: f64, high_volt: f64 },
    /// A second-order output stage.
    SecondOrder { frequency_hz: f64, damping_ratio: f64 },
    /// A pure delay; s.
    Delay(f64),
}

/// Error at which the loop of a slow amplifier asks for most of its current, V.
const LOOP_VOLT: f64 = 0.5;

/// Width of a knee, V.
const KNEE_VOLT: f64 = 1.5;

impl Amplifier {
    /// Turns a command into the terminal voltage, V.
    pub(crate) fn apply(self, dt_s: f64, signal: &mut [f64]) {
        let rest = signal[0];
        match self {
            Self::Gain(gain) => each(signal, |u| *u *= 1.0 + gain),
            Self::Zero(zero_volt) => each(signal, |u| *u += zero_volt),
            Self::Lag(tau_s) => {
                for share in [0.95, 0.05] {
                    let mut lag = Lag::new(share * tau_s, dt_s, rest);
                    each(signal, |u| *u = lag.step(*u));
                }
            }
            Self::Slew(slew_volt_per_s) => slew(slew_volt_per_s, dt_s, signal),
            Self::Clip { low_volt, high_volt } => {
                for u in signal {
                    *u += knee(low_volt - *u) - knee(*u - high_volt);
                }
            }
            Self::SecondOrder { frequency_hz, damping_ratio } => {
                let mut stage = SecondOrder::new(frequency_hz, damping_ratio, dt_s, rest);
                each(signal, |u| *u = stage.step(*u));
            }
            Self::Delay(delay_s) => delay(signal, delay_s / dt_s),
        }
    }
}

/// What a soft limit cuts off at a distance beyond it, V: a hyperbola.
fn knee(over_volt: f64) -> f64 {
    0.5 * (over_volt + over_volt.hypot(KNEE_VOLT))
}

/// Implicit steps of the error `E = u - V`: `E + S dt tanh(E/e) = E0 + du`. Exact at full current and at rest on a ramp;
/// what lies between is over within 0.1 ms.
fn slew(slew_volt_per_s: f64, dt_s: f64, signal: &mut [f64]) {
    let reach = slew_volt_per_s * dt_s;
    let (mut error, mut from) = (0.0_f64, signal[0]);
    for u in signal {
        let goal = error + *u - from;
        from = *u;
        let size = goal.abs();
        let mut root = (size - reach).max(size / (1.0 + reach / LOOP_VOLT));
        for _ in 0..20 {
            let bend = (root / LOOP_VOLT).tanh();
            let slope = 1.0 + reach / LOOP_VOLT * (1.0 - bend * bend);
            let step = (root + reach * bend - size) / slope;
            root = (root - step).clamp(0.0, size);
            if step.abs() < 1e-9 {
                break;
            }
        }
        error = goal.signum() * root;
        *u -= error;
    }
}
