//! What drives all blades at an instant, and what they do there.

use crate::Condition;
use nalgebra::DMatrix;

/// What air, pilot and flaps do at one instant. Blades count from the one at azimuth 0 at the start.
#[derive(Clone, Copy)]
pub struct InstantDrive<'a> {
    /// Flight and controls; its flap angles are not used.
    pub condition: &'a Condition,
    /// Induced velocity of a blade at every lifting station ([`RotorInTime::lifting_stations`](super::RotorInTime::lifting_stations)):
    /// down through the disk, and in its plane from the leading to the trailing edge, tip speed.
    pub induced: &'a (dyn Fn(usize) -> Vec<[f64; 2]> + Sync),
    /// Angle, rate and acceleration of every flap of a blade, rad by azimuth.
    pub flap_rad: &'a (dyn Fn(usize) -> Vec<[f64; 3]> + Sync),
}

/// All blades at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Instant {
    /// Steps since the start.
    pub step: usize,
    /// Azimuth of every blade, rad, `0..2 pi`.
    pub azimuths_rad: Vec<f64>,
    /// Forces and moments of all blades on the hub, fixed axes: `F_x, F_y, F_z` in `m0 Omega^2 R^2`, `M_x, M_y, M_z` in
    /// `m0 Omega^2 R^3`.
    pub hub: [f64; 6],
    /// The same of every blade in the axes that turn with it.
    pub roots: Vec<[f64; 6]>,
    /// Bound circulation at the lifting stations, `Omega R^2`: shape `stations x blades`.
    pub circulation: DMatrix<f64>,
    /// Iterations of the step that led here.
    pub iterations: usize,
}
