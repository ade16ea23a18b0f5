//! How the root of the blade is held.

use crate::FemError;
use crate::beam::shape::JOINT_DOF;
use crate::error::check_parameters;
use serde::{Deserialize, Serialize};

/// How one rotation of the blade's root is held.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Joint {
    /// Held fast.
    #[default]
    Locked,
    /// Free to turn.
    Free,
    /// Free against a spring; stiffness over m0 Omega^2 R^3 (moment per rad).
    Spring {
        /// Stiffness.
        stiffness: f64,
    },
}

impl Joint {
    /// Stiffness of the spring, 0 of a free joint, none if the joint is locked.
    pub fn stiffness(&self) -> Option<f64> {
        match *self {
            Self::Locked => None,
            Self::Free => Some(0.0),
            Self::Spring { stiffness } => Some(stiffness),
        }
    }

    /// Whether the joint turns without a spring.
    pub fn is_free(&self) -> bool {
        self.stiffness() == Some(0.0)
    }
}

/// How the root of the blade is held: three rotations at the root offset. Displacements are held fast.
///
/// Flap and lag turn in the axes of the rotating frame: the hinges lie inboard of the pitch bearing.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RootSupport {
    /// Flap hinge, slope `w_x`.
    pub flap: Joint,
    /// Lag hinge, slope `v_x`.
    pub lag: Joint,
    /// Pitch bearing, twist phi: the spring is the pitch link with the control system.
    #[serde(rename = "pitch")]
    pub feather: Joint,
}

impl RootSupport {
    /// No displacement, no slope, no twist.
    pub const CLAMPED: Self =
        Self { flap: Joint::Locked, lag: Joint::Locked, feather: Joint::Locked };
    /// Coincident flap and lag hinges without springs; no twist.
    pub const HINGED: Self = Self { flap: Joint::Free, lag: Joint::Free, feather: Joint::Locked };

    /// Places of the three rotations among the degrees of freedom of the root joint, in the order
    /// of [`Self::joints`].
    pub(crate) const PLACES: [usize; 3] = [2, 4, 5];

    /// The joints of lag, flap and feather.
    pub(crate) fn joints(&self) -> [Joint; 3] {
        [self.lag, self.flap, self.feather]
    }

    /// Stiffness on the slopes `v_x`, `w_x` and the twist; zero where a joint is locked.
    pub fn springs(&self) -> [f64; 3] {
        self.joints().map(|joint| joint.stiffness().unwrap_or(0.0))
    }

    /// Degrees of freedom that the root leaves free of `size`, ascending.
    pub(crate) fn free_dof(&self, size: usize) -> Vec<usize> {
        let rotations = Self::PLACES.into_iter().zip(self.joints());
        let loose = rotations.filter(|(_, joint)| *joint != Joint::Locked).map(|(place, _)| place);
        loose.chain(JOINT_DOF..size).collect()
    }

    /// Refuses a spring that is negative or not finite.
    pub(crate) fn check(&self) -> Result<(), FemError> {
        let springs = [
            ("root.flap.stiffness", self.flap),
            ("root.lag.stiffness", self.lag),
            ("root.feather.stiffness", self.feather),
        ];
        check_parameters(springs.map(|(field, joint)| {
            let value = joint.stiffness().unwrap_or(0.0);
            let expected = "a finite number not below zero (moment per rad over m0 Omega^2 R^3)";
            (field, value, value.is_finite() && value >= 0.0, expected)
        }))
    }
}
