//! The families of blade motion.

use std::fmt;

/// The family a mode belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ModeKind {
    /// Bending out of the plane of rotation, displacement w (up).
    Flap,
    /// Bending in the plane of rotation, displacement v (toward the leading edge).
    Lag,
    /// Elastic twist phi (nose up).
    Torsion,
    /// Stretching, displacement u (outboard).
    Axial,
}

impl ModeKind {
    /// All families, in the order in which mode sets list them.
    pub const ALL: [Self; 4] = [Self::Flap, Self::Lag, Self::Torsion, Self::Axial];
}

impl fmt::Display for ModeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Flap => "flap",
            Self::Lag => "lag",
            Self::Torsion => "torsion",
            Self::Axial => "axial",
        })
    }
}

/// One value for each family of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PerFamily<T> {
    /// Flap.
    pub flap: T,
    /// Lag.
    pub lag: T,
    /// Torsion.
    pub torsion: T,
    /// Axial.
    pub axial: T,
}

impl<T: Copy> PerFamily<T> {
    /// The value of one family.
    pub fn of(&self, kind: ModeKind) -> T {
        match kind {
            ModeKind::Flap => self.flap,
            ModeKind::Lag => self.lag,
            ModeKind::Torsion => self.torsion,
            ModeKind::Axial => self.axial,
        }
    }
}
