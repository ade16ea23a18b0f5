//! Flap angle from measured displacement.

use serde::{Deserialize, Serialize};

/// How the flap angle follows from the measured displacement.
///
/// ```text
/// delta = deg_per_um (x - zero_um)
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Equivalent flap angle per displacement, deg/um.
    pub deg_per_um: f64,
    /// Displacement at zero flap angle, um.
    pub zero_um: f64,
}

impl Calibration {
    /// Displacement that belongs to a flap angle, um.
    pub fn displacement_um(&self, output_deg: f64) -> f64 {
        output_deg / self.deg_per_um + self.zero_um
    }

    /// Flap angle that belongs to a displacement, deg.
    pub fn output_deg(&self, displacement_um: f64) -> f64 {
        self.deg_per_um * (displacement_um - self.zero_um)
    }

    /// Load along the actuator that a hinge moment means, N.
    ///
    /// ```text
    /// F dx = M d(delta)   =>   F = M deg_per_um (pi / 180) 1e6
    /// ```
    /// `hinge_moment_newton_metre` is positive against a growing flap angle; the load is then positive
    /// against a growing displacement. Assumes a linkage without loss.
    pub fn load_newton(&self, hinge_moment_newton_metre: f64) -> f64 {
        hinge_moment_newton_metre * self.deg_per_um.to_radians() * 1e6
    }
}
