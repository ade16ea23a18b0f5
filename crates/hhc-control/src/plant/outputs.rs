//! What a rotor plant measures: the loads of the hub, and beside them the weighted power of its actuators.
//!
//! ```text
//! Z = [Z_hub, Z_power],   J = Z_hub' W Z_hub + Z_power' Z_power,   Z_power = g u   (cosine and sine of each pair)
//! ```
//! The weight of the power is in its gains `g`, so its weight in the cost is 1.

use crate::LoadWeights;

/// Hub loads in a measurement: cosine and sine of six.
pub const HUB_OUTPUTS: usize = 12;

/// The weighted power of the actuators as outputs, two for each pair of the layout; none without a weight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PowerOutputs {
    /// What turns the voltage of a pair into the square root of its weighted power, per V.
    gains_per_volt: Vec<f64>,
}

impl PowerOutputs {
    /// From the gain of every pair, per V; empty without a weight.
    pub fn new(gains_per_volt: Vec<f64>) -> Self {
        Self { gains_per_volt }
    }

    /// The gain of every pair, per V.
    pub fn gains_per_volt(&self) -> &[f64] {
        &self.gains_per_volt
    }

    /// Their number.
    pub fn count(&self) -> usize {
        2 * self.gains_per_volt.len()
    }

    /// The outputs at a control vector, V.
    pub fn at(&self, control_volt: &[f64]) -> Vec<f64> {
        let pairs = control_volt.chunks_exact(2).zip(&self.gains_per_volt);
        pairs.flat_map(|(u, gain)| [gain * u[0], gain * u[1]]).collect()
    }

    /// Their change with one control, per V.
    pub fn along(&self, control: usize) -> Vec<f64> {
        let gain = |k: usize| if k == control { self.gains_per_volt[k / 2] } else { 0.0 };
        (0..self.count()).map(gain).collect()
    }

    /// Their part in the cost at a control vector, V.
    pub fn cost(&self, control_volt: &[f64]) -> f64 {
        let pairs = control_volt.chunks_exact(2).zip(&self.gains_per_volt);
        pairs.map(|(u, gain)| gain * gain * (u[0] * u[0] + u[1] * u[1])).fold(0.0, |sum, j| sum + j)
    }
}

/// The hub loads in a measurement; zero where it is shorter.
pub fn hub_outputs(outputs: &[f64]) -> [f64; HUB_OUTPUTS] {
    std::array::from_fn(|k| outputs.get(k).copied().unwrap_or_default())
}

/// Weights of so many outputs, from those of the hub loads (order `FX FY FZ MX MY MZ`).
pub fn output_weights(load_weights: &[f64; 6], outputs: usize) -> LoadWeights {
    let hub = load_weights.iter().flat_map(|w| [*w, *w]);
    let power = std::iter::repeat_n(1.0, outputs.saturating_sub(HUB_OUTPUTS));
    LoadWeights::Diagonal(hub.chain(power).collect())
}
