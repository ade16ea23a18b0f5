//! Displacement of one section.

use super::inertia::MOTION_VARIABLES;
use super::strain::STRAIN_VARIABLES;

/// Displacement of a section with its radial derivatives: of a mode, or of the state the modes are about.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SectionShape {
    /// `v`, `v_x`, `v_xx`, toward the leading edge.
    pub lag: [f64; 3],
    /// `w`, `w_x`, `w_xx`, up.
    pub flap: [f64; 3],
    /// `phi`, `phi_x`, nose up.
    pub twist: [f64; 2],
}

impl SectionShape {
    /// Motion variables without the axial one, in their order after it.
    pub(super) fn motion(&self) -> [f64; MOTION_VARIABLES - 1] {
        [self.lag[0], self.flap[0], self.lag[1], self.flap[1], self.twist[0]]
    }

    /// Strain variables without the axial one, in their order after it.
    pub(super) fn strain(&self) -> [f64; STRAIN_VARIABLES - 1] {
        let [_, v_x, v_xx] = self.lag;
        let [_, w_x, w_xx] = self.flap;
        [v_x, w_x, v_xx, w_xx, self.twist[0], self.twist[1]]
    }
}
