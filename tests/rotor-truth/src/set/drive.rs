//! From voltages to the motion of the flaps.
//!
//! The actuator with hysteresis is a sum of plays, whose lag grows with amplitude, and a relaxation behind them:
//!
//! ```text
//! y = a x + int_0^R P_r[x] dr,     T dy_f/dpsi = y - y_f
//! P_r[x](t) = max(x - r, min(x + r, P_r[x](t-)))
//! ```
//! Source of the operators: Brokate and Sprekels, Hysteresis and Phase Transitions (1996), 2.3. Their share and the time of
//! relaxation are set so that the fundamental at the middle amplitude and harmonic has the lag asked for and the stroke of the
//! ideal actuator.

use crate::physics::fourier::{Pair, harmonic_of};
use std::f64::consts::TAU;

/// Gain of the ideal actuator, deg/V: 10 deg at 85 V.
pub const GAIN_DEG_PER_VOLT: f64 = 10.0 / 85.0;
/// Samples of a revolution in the plays.
const SAMPLES: usize = 1440;
/// Number of plays.
const PLAYS: u32 = 60;
/// Largest threshold, V.
const LARGEST_VOLT: f64 = 60.0;
/// Largest lag that plays give here, deg.
const LAG_OF_PLAYS_DEG: f64 = 17.0;

/// Voltage of one flap: harmonics.
pub type Voltage = Vec<(usize, Pair)>;

/// Hysteresis of an actuator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hysteresis {
    /// Share of the direct way.
    direct: f64,
    /// Density of the plays, 1/V.
    density: f64,
    /// Time of relaxation, rad of azimuth.
    relaxation_rad: f64,
}

/// An actuator of a flap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Actuator {
    /// Motion over the stated one.
    pub gain: f64,
    /// Hysteresis, if any.
    pub hysteresis: Option<Hysteresis>,
    /// Half of the freeplay of the hinge, deg.
    pub freeplay_deg: f64,
}

impl Default for Actuator {
    fn default() -> Self {
        Self { gain: 1.0, hysteresis: None, freeplay_deg: 0.0 }
    }
}

fn sampled(voltage: &Voltage) -> Vec<f64> {
    (0..SAMPLES)
        .map(|k| {
            let psi = TAU * k as f64 / SAMPLES as f64;
            voltage
                .iter()
                .map(|(n, own)| {
                    let (sin, cos) = (*n as f64 * psi).sin_cos();
                    own.cosine * cos + own.sine * sin
                })
                .sum()
        })
        .collect()
}

impl Hysteresis {
    /// A lag of the fundamental at a middle amplitude and harmonic.
    pub fn of_lag(lag_deg: f64, middle_volt: f64, harmonic: usize) -> Self {
        let by_plays = (0.5 * lag_deg).min(LAG_OF_PLAYS_DEG);
        let relaxation_rad = (lag_deg - by_plays).to_radians().tan() / harmonic as f64;
        let drive: Voltage = vec![(harmonic, Pair { cosine: middle_volt, sine: 0.0 })];
        let answer = |own: &Self| {
            let all = own.motion_volt(&drive);
            all.iter().find(|own| own.0 == harmonic).map_or(Pair::default(), |own| own.1)
        };
        let (mut low, mut high) = (0.0, 1.0);
        let mut own = Self { direct: 1.0, density: 0.0, relaxation_rad };
        for _ in 0..60 {
            let share = 0.5 * (low + high);
            own.direct = 1.0 - share;
            own.density = share / (0.5 * middle_volt);
            let found = answer(&own);
            let lag = found.sine.atan2(found.cosine).to_degrees();
            if lag < lag_deg { low = share } else { high = share }
        }
        let found = answer(&own);
        let scale = middle_volt / found.cosine.hypot(found.sine);
        Self { direct: own.direct * scale, density: own.density * scale, relaxation_rad }
    }

    /// Harmonics of the motion, in volts of the ideal actuator, without mean.
    fn motion_volt(&self, voltage: &Voltage) -> Voltage {
        let x = sampled(voltage);
        let width = LARGEST_VOLT / f64::from(PLAYS);
        let mut y: Vec<f64> = x.iter().map(|own| self.direct * own).collect();
        for play in 0..PLAYS {
            let r = (f64::from(play) + 0.5) * width;
            let mut state = 0.0_f64;
            // the first revolution settles it
            for pass in 0..2 {
                for (x, y) in x.iter().zip(&mut y) {
                    state = state.min(x + r).max(x - r);
                    if pass == 1 {
                        *y += self.density * width * state;
                    }
                }
            }
        }
        (1..=10)
            .map(|n| {
                let own = harmonic_of(&y, n);
                let tan = n as f64 * self.relaxation_rad;
                (n, own.later(tan.atan()).times(1.0 / (1.0 + tan * tan).sqrt()))
            })
            .collect()
    }
}

impl Actuator {
    /// Motion of a flap, harmonics in deg.
    pub fn motion_deg(&self, voltage: &Voltage) -> Voltage {
        let moved = match &self.hysteresis {
            Some(own) => own.motion_volt(voltage),
            None => voltage.clone(),
        };
        let scale = |own: &Voltage| -> Voltage {
            own.iter().map(|(n, own)| (*n, own.times(self.gain * GAIN_DEG_PER_VOLT))).collect()
        };
        let moved = scale(&moved);
        if self.freeplay_deg > 0.0 {
            let gap = self.freeplay_deg;
            let y: Vec<f64> =
                sampled(&moved).iter().map(|own| own - own.clamp(-gap, gap)).collect();
            return (1..=10).map(|n| (n, harmonic_of(&y, n))).collect();
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lag_is_the_one_asked_for_and_grows_with_amplitude() {
        for lag in [20.0, 32.0, 45.0] {
            let own = Actuator {
                hysteresis: Some(Hysteresis::of_lag(lag, 20.0, 3)),
                ..Actuator::default()
            };
            let at = |volt: f64| {
                let drive: Voltage = vec![(3, Pair { cosine: volt, sine: 0.0 })];
                let all = own.motion_deg(&drive);
                let third = all.iter().find(|own| own.0 == 3).map_or(Pair::default(), |own| own.1);
                (third.sine.atan2(third.cosine).to_degrees(), third.cosine.hypot(third.sine) / volt)
            };
            let (middle, gain) = at(20.0);
            assert!((middle - lag).abs() < 0.1, "{middle} {lag}");
            assert!((gain / GAIN_DEG_PER_VOLT - 1.0).abs() < 1e-6);
            assert!(at(10.0).0 < middle - 1.0 && at(32.0).0 > middle + 0.5);
        }
    }
}
