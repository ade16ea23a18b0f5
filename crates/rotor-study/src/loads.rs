//! Hub loads, their cost `J_Z` and what the figures of a case share.

use hhc_control::reduction_percent;
use rotor_base::RotorScales;
use rotor_case::{ActuatorValues, Case, ControlValues, LoadScaleChoice};
use rotor_response::RotorModel;
use serde::{Deserialize, Serialize};

/// Six hub loads at one harmonic, `[cosine, sine]`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct HubLoads {
    /// Longitudinal force, aft positive.
    pub fx: [f64; 2],
    /// Lateral force, starboard positive.
    pub fy: [f64; 2],
    /// Vertical force, up positive.
    pub fz: [f64; 2],
    /// Moment about the aft axis.
    pub mx: [f64; 2],
    /// Moment about the starboard axis.
    pub my: [f64; 2],
    /// Moment about the upward axis.
    pub mz: [f64; 2],
}

impl HubLoads {
    /// Names of the loads, in the order of [`Self::amplitudes`].
    pub const NAMES: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

    /// From cosine and sine parts `fx_c fx_s fy_c ... mz_s`.
    pub fn from_parts(parts: [f64; 12]) -> Self {
        let pair = |k: usize| [parts[2 * k], parts[2 * k + 1]];
        Self { fx: pair(0), fy: pair(1), fz: pair(2), mx: pair(3), my: pair(4), mz: pair(5) }
    }

    /// Cosine and sine parts `fx_c fx_s fy_c ... mz_s`.
    pub fn parts(&self) -> [f64; 12] {
        let pairs = [self.fx, self.fy, self.fz, self.mx, self.my, self.mz];
        std::array::from_fn(|k| pairs[k / 2][k % 2])
    }

    /// Amplitudes of the six loads.
    pub fn amplitudes(&self) -> [f64; 6] {
        [self.fx, self.fy, self.fz, self.mx, self.my, self.mz].map(|[c, s]| c.hypot(s))
    }
}

/// What every figure of a result shares: loads without control, what the case asks of the control, units.
#[derive(Debug, Clone)]
pub struct Setting {
    /// Hub loads without control.
    pub baseline: [f64; 12],
    /// What the case asks of the control, weights included.
    pub control: ControlValues,
    /// Flap amplitude of the ideal actuator at full-scale voltage, deg.
    pub ideal_amplitude_deg: f64,
    /// What the case says of the actuator.
    pub actuator: ActuatorValues,
    /// Blades.
    pub blades: usize,
    /// Arm of the pitch link about the pitch axis, m; none where the case gives none.
    pub pitch_link_arm_m: Option<f64>,
    /// Units of the rotor.
    pub scales: RotorScales,
    /// `C_Q / sigma` of a torque of `m0 Omega^2 R^3`.
    pub torque_coefficient_over_solidity: f64,
}

/// Largest hub load that is none, `m0 Omega^2 R^2` and `m0 Omega^2 R^3`: the thrust is of order `1e-2`, a hovering rotor
/// whose cyclic pitch balances the tail rotor keeps up to `4e-8`, one at an advance ratio of 0.05 has `1e-5`.
const NO_LOAD: f64 = 1e-7;

impl Setting {
    /// Of a validated case.
    pub fn of_case(case: &Case, baseline: &HubLoads) -> Self {
        Self {
            baseline: baseline.parts(),
            control: case.control.clone(),
            ideal_amplitude_deg: case.actuator.ideal_amplitude_deg,
            actuator: case.actuator.clone(),
            blades: case.rotor.blades,
            pitch_link_arm_m: case.rotor.pitch_link_arm_r.map(|arm| arm * case.rotor.radius_m),
            scales: case.scales(),
            torque_coefficient_over_solidity: torque_over_solidity(&case.rotor_model()),
        }
    }

    /// Whether there is nothing to reduce: every load without control is rounding.
    pub fn is_still(&self) -> bool {
        is_still(&self.baseline)
    }

    /// `100 (1 - J_Z / J_Z0)`, 0 where there is nothing to reduce.
    pub fn reduction_percent(&self, before: f64, after: f64) -> f64 {
        if self.is_still() { 0.0 } else { reduction_percent(before, after) }
    }

    /// Weight of each load, order `FX FY FZ MX MY MZ`: those of the case, over the squared amplitude without
    /// control if it asks for that.
    pub fn load_weights(&self) -> [f64; 6] {
        let w = &self.control.load_weights;
        let mut weights = [w.fx, w.fy, w.fz, w.mx, w.my, w.mz];
        if self.control.load_scale == LoadScaleChoice::Baseline {
            for (weight, z) in weights.iter_mut().zip(self.baseline.chunks_exact(2)) {
                let square = z[0] * z[0] + z[1] * z[1];
                // a load that is none cannot be measured by itself
                *weight = if square > NO_LOAD * NO_LOAD { *weight / square } else { *weight };
            }
        }
        weights
    }
}

/// `C_Q / sigma` of a torque of `m0 Omega^2 R^3`, with `rho c R / m0 = gamma / (6 pi)` and the thrust-weighted
/// chord `c_T` of the solidity: `6 pi c / (gamma N_b c_T)`.
fn torque_over_solidity(model: &RotorModel) -> f64 {
    let rectangular = 6.0 * std::f64::consts::PI / (model.lock_number * model.blades as f64);
    rectangular * (model.chord / model.thrust_weighted_chord())
}

/// Whether every hub load is rounding.
pub fn is_still(baseline: &[f64; 12]) -> bool {
    baseline.iter().all(|load| load.abs() <= NO_LOAD)
}

/// `J_Z` of a hub load vector.
pub fn loads_cost(weights: &[f64; 6], loads: &[f64; 12]) -> f64 {
    loads.chunks_exact(2).zip(weights).map(|(z, w)| w * (z[0] * z[0] + z[1] * z[1])).sum()
}
