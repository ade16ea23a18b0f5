//! Hidden effects of the ceramic: they change what the hysteresis gives.

use super::amplifier::softplus;

/// A ceramic whose properties do not stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ceramic {
    /// Losses warm the ceramic, warmth raises its gain.
    ///
    /// ```text
    /// tau dT' = Theta (V'/V'_n)^2 - dT,   h -> h (1 + a dT (1 - a dT/2)) + 0.01 um/K dT
    /// ```
    Heating {
        /// Thermal time constant `tau`, s.
        time_constant_s: f64,
        /// Gain per kelvin `a`, 1/K.
        coefficient_per_kelvin: f64,
        /// Temperature rise `Theta` in the end at the rms voltage rate of 75 V at 20 Hz, K.
        rise_kelvin: f64,
    },
    /// Below a threshold the ceramic loses polarisation for good, and gains less besides.
    ///
    /// ```text
    /// p' = - r x e p,   e = ln(1 + exp((threshold - V)/3 V)),   p(0) = 1
    /// h -> p h - 40 um (1 - p) + 3 x e,   r = 2 1/s
    /// ```
    Depolarisation {
        /// The threshold, V.
        threshold_volt: f64,
        /// Strength `x`.
        strength: f64,
    },
}

/// Rms voltage rate of a sine of 75 V at 20 Hz, V/s.
const NOMINAL_RATE_VOLT_PER_S: f64 = 6664.0;

impl Ceramic {
    /// Turns the output of the hysteresis into that of the changed ceramic, um.
    pub fn apply(self, dt_s: f64, voltage_volt: &[f64], signal: &mut [f64]) {
        match self {
            Self::Heating { coefficient_per_kelvin: a, .. } => {
                for (h, rise) in signal.iter_mut().zip(self.temperature_rise(dt_s, voltage_volt)) {
                    *h = *h * (1.0 + a * rise * (1.0 - 0.5 * a * rise)) + 0.01 * rise;
                }
            }
            Self::Depolarisation { threshold_volt, strength } => {
                let mut polarisation = 1.0;
                for (h, v) in signal.iter_mut().zip(voltage_volt) {
                    let excess = softplus((threshold_volt - v) / 3.0);
                    polarisation *= (-2.0 * strength * excess * dt_s).exp();
                    *h = polarisation * *h - 40.0 * (1.0 - polarisation) + 3.0 * strength * excess;
                }
            }
        }
    }

    /// Temperature above that of the rest, K, sample by sample; zero where nothing warms.
    pub fn temperature_rise(self, dt_s: f64, voltage_volt: &[f64]) -> Vec<f64> {
        let Self::Heating { time_constant_s, rise_kelvin, .. } = self else {
            return vec![0.0; voltage_volt.len()];
        };
        let decay = (-dt_s / time_constant_s).exp();
        let (mut rise, mut from) = (0.0, voltage_volt[0]);
        voltage_volt
            .iter()
            .map(|v| {
                let rate = (v - from) / dt_s / NOMINAL_RATE_VOLT_PER_S;
                let end = rise_kelvin * rate * rate;
                rise = end + (rise - end) * decay;
                from = *v;
                rise
            })
            .collect()
    }
}
