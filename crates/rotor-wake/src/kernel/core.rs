//! The viscous core of a vortex.

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// What keeps the velocity finite at a vortex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum CoreModel {
    /// Vatistas's profile with n = 2 on the distance to the line of each segment: what the free wakes of
    /// the literature use. The speed of a curved filament is not Kelvin's: the cut-off acts at about
    /// the root of core radius times radius of curvature.
    #[default]
    Vatistas,
    /// Rosenhead and Moore's cut-off, with the curvature of a filament between neighbouring segments
    /// ([`arc_velocity`](crate::arc_velocity)): a ring travels at Kelvin's speed.
    #[serde(rename = "Corrected")]
    RosenheadMoore,
}

impl CoreModel {
    /// Cut-off length of the Rosenhead-Moore model over the radius of a core of uniform vorticity:
    /// `e^(-3/4)`.
    pub fn cut_off_ratio() -> f64 {
        (-0.75_f64).exp()
    }

    /// Velocity at a distance from an infinite straight line of unit circulation.
    ///
    /// ```text
    /// Vatistas: h / (2 pi sqrt(h^4 + r_c^4)),      Rosenhead-Moore: h / (2 pi (h^2 + delta^2))
    /// ```
    pub(crate) fn of_a_straight_line(self, distance: f64, core_radius: f64) -> f64 {
        let square = distance * distance;
        let regularised = match self {
            Self::Vatistas => square.hypot(core_radius * core_radius),
            Self::RosenheadMoore => square + (core_radius * Self::cut_off_ratio()).powi(2),
        };
        distance / (2.0 * PI * regularised)
    }
}
