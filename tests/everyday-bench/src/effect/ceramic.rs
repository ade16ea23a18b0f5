//! Errors in the ceramic and in how its motion follows.

use crate::draw::Draw;
use crate::filters::Lag;
use crate::runs::BIAS_VOLT;

/// What happens in the ceramic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Ceramic {
    /// Losses heat it and the motion grows: `T' = (rise p - T)/tau`, `p = |V'| |V - bias|` over that of 75 V at 20 Hz
    /// (mean); motion times `1 + c T`.
    Heating { time_constant_s: f64, per_kelvin: f64, rise_kelvin: f64 },
    /// Below a threshold domains turn back at once and return over 120 V of travel above the bias: a share
    /// `strength (1 - exp(-(threshold - V)/10 V))` of the motion is lost.
    Depolarisation { threshold_volt: f64, strength: f64 },
    /// The motion follows late: two lags (60 and 40 %, 0.7 and 1.45 of `tau`), longer where it is extended (25 % at
    /// 200 um).
    Late { tau_s: f64 },
    /// Nine Kelvin-Voigt elements from 20 ms on, half a decade apart; growth per decade as a share of the motion.
    Creep { per_decade: f64, key: u64 },
}

impl Ceramic {
    /// Turns the motion (um) under a terminal voltage (V) into that with the error.
    pub(crate) fn apply(self, dt_s: f64, terminal_volt: &[f64], motion_um: &mut [f64]) {
        match self {
            Self::Heating { per_kelvin, .. } => {
                let rise = self.rise_kelvin(dt_s, terminal_volt);
                for (x, kelvin) in motion_um.iter_mut().zip(rise) {
                    *x *= 1.0 + per_kelvin * kelvin;
                }
            }
            Self::Depolarisation { threshold_volt, strength } => {
                let (mut lost, mut from) = (0.0_f64, terminal_volt[0]);
                for (x, volt) in motion_um.iter_mut().zip(terminal_volt) {
                    let below = (threshold_volt - volt).max(0.0);
                    lost = lost.max(strength * (1.0 - (-below / 10.0).exp()));
                    if *volt > BIAS_VOLT {
                        lost *= (-(volt - from).abs() / 120.0).exp();
                    }
                    from = *volt;
                    *x *= 1.0 - lost;
                }
            }
            Self::Late { tau_s } => {
                let rest = motion_um[0];
                let mut lags = [(0.6, 0.7), (0.4, 1.45)]
                    .map(|(share, factor)| (share, factor * tau_s, Lag::new(tau_s, dt_s, rest)));
                for x in motion_um {
                    let mut late = 0.0;
                    for (share, tau_s, lag) in &mut lags {
                        let slower = (1.0 + 0.25 * lag.output() / 200.0).clamp(0.3, 2.0);
                        *lag = lag.retuned(*tau_s * slower, dt_s);
                        late += *share * lag.step(*x);
                    }
                    *x = late;
                }
            }
            Self::Creep { per_decade, key } => {
                let mut draw = Draw::new("creep", &[key]);
                let shares = [0; 9].map(|_| draw.uniform(0.85, 1.15));
                let mean = shares.iter().sum::<f64>() / 9.0;
                let rest = motion_um[0];
                let mut tau_s = 0.02;
                let mut elements = shares.map(|share| {
                    let element = (0.5 * per_decade * share / mean, Lag::new(tau_s, dt_s, rest));
                    tau_s *= 10.0_f64.sqrt();
                    element
                });
                for x in motion_um {
                    let crept = |(share, lag): &mut (f64, Lag)| *share * lag.step(*x);
                    *x += elements.iter_mut().map(crept).sum::<f64>();
                }
            }
        }
    }

    /// Temperature above the rest, K; zero without heating.
    pub(crate) fn rise_kelvin(self, dt_s: f64, terminal_volt: &[f64]) -> Vec<f64> {
        let Self::Heating { time_constant_s, rise_kelvin, .. } = self else {
            return vec![0.0; terminal_volt.len()];
        };
        // mean of |V'| |V - bias| of a sine of 75 V at 20 Hz: 2 f A^2
        let full = 2.0 * 20.0 * 75.0 * 75.0;
        let keep = (-dt_s / time_constant_s).exp();
        let (mut kelvin, mut from) = (0.0, terminal_volt[0]);
        let one = |volt: &f64| {
            let loss = (volt - from).abs() / dt_s * (0.5 * (volt + from) - BIAS_VOLT).abs();
            from = *volt;
            let target = rise_kelvin * loss / full;
            kelvin = target + (kelvin - target) * keep;
            kelvin
        };
        terminal_volt.iter().map(one).collect()
    }
}
