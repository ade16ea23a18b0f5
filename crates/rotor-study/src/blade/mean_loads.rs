//! Mean loads of the trimmed rotor on its hub, and what the shaft gives it.

use crate::loads::Setting;
use serde::Serialize;

/// Mean loads of all blades on the hub without control, fixed shaft axes (X aft, Y to starboard, Z up), about the
/// rotor centre; with gravity the weight of the blades is among them.
///
/// ```text
/// Q = -M_Z,   P = Omega Q,   C_Q / sigma = C_P / sigma = 6 pi Q / (gamma N_b)   (Q over m0 Omega^2 R^3)
/// ```
/// With the couplings `Full` the couple of the air stands along the straight blade: the torque lacks what pitch damping takes
/// of the turn `Omega w_x` of a coned blade, under 0.1 % of it in the paper's case.
///
/// All follow from `hub` and the case.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct MeanLoads {
    /// `FX FY FZ` over `m0 Omega^2 R^2`, `MX MY MZ` over `m0 Omega^2 R^3`.
    pub hub: [f64; 6],
    /// `FX FY FZ`.
    #[serde(rename = "hub_force_N")]
    pub hub_force_newton: [f64; 3],
    /// `MX MY MZ`.
    #[serde(rename = "hub_moment_N_m")]
    pub hub_moment_newton_metre: [f64; 3],
    /// Torque of the shaft on the rotor, positive where it drives.
    #[serde(rename = "shaft_torque_N_m")]
    pub shaft_torque_newton_metre: f64,
    /// Power of the shaft.
    #[serde(rename = "shaft_power_W")]
    pub shaft_power_watt: f64,
    /// Torque coefficient over solidity, which is the power coefficient over solidity.
    pub cq_sigma: f64,
}

impl MeanLoads {
    /// Of the six mean loads in rotor units.
    pub fn new(hub: [f64; 6], setting: &Setting) -> Self {
        let (scales, [fx, fy, fz, mx, my, mz]) = (&setting.scales, hub);
        let shaft_torque_newton_metre = -mz * scales.moment_newton_metre();
        Self {
            hub,
            hub_force_newton: [fx, fy, fz].map(|force| force * scales.force_newton()),
            hub_moment_newton_metre: [mx, my, mz].map(|m| m * scales.moment_newton_metre()),
            shaft_torque_newton_metre,
            shaft_power_watt: shaft_torque_newton_metre * scales.omega_rad_s(),
            cq_sigma: -mz * setting.torque_coefficient_over_solidity,
        }
    }

    /// Two lines for people.
    pub fn text(&self) -> [String; 2] {
        // a tenth of a newton, without the sign of a zero
        let tenths = |value: f64| format!("{:.1}", (10.0 * value).round() / 10.0 + 0.0);
        let three = |values: [f64; 3]| values.map(tenths).join(", ");
        [
            format!(
                "FX, FY, FZ {} N; MX, MY, MZ {} N m (aft, starboard, up)",
                three(self.hub_force_newton),
                three(self.hub_moment_newton_metre)
            ),
            format!(
                "shaft torque {:.1} N m, power {:.1} kW without radial drag, C_Q/sigma {:.6}",
                self.shaft_torque_newton_metre,
                1e-3 * self.shaft_power_watt,
                self.cq_sigma
            ),
        ]
    }
}
