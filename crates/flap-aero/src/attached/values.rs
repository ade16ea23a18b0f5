//! Validated numbers of a section: Mach number, flap chord, hinge position.

use crate::AeroError;

/// Smallest Mach number the noncirculatory loads are formed with.
///
/// Toward Mach 0 they become an impulse (`4/M` for a time proportional to `M`); below this value
/// they are those of Mach 0.05, and [`ModelRemarks::mach_floored`](crate::ModelRemarks::mach_floored) says so. The circulatory loads
/// keep the true Mach number.
pub const MIN_NONCIRCULATORY_MACH: f64 = 0.05;

/// Mach number of the free stream, 0 to [`Mach::MAX`].
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Mach(f64);

impl Mach {
    /// Incompressible flow.
    pub const ZERO: Self = Self(0.0);

    /// Largest Mach number accepted. Linear theory has lost the truth well before (about 0.7 on a
    /// section at incidence); beyond, `1 / beta` grows without bound.
    pub const MAX: f64 = 0.95;

    /// A Mach number.
    ///
    /// # Errors
    /// [`AeroError::MachOutOfRange`] unless `0 <= mach <= 0.95`.
    pub fn new(mach: f64) -> Result<Self, AeroError> {
        if (0.0..=Self::MAX).contains(&mach) {
            Ok(Self(mach))
        } else {
            Err(AeroError::MachOutOfRange { mach, limit: Self::MAX })
        }
    }

    /// The Mach number of a speed ratio of either sign, held below `limit`: for the advancing tip
    /// of a rotor, where linear theory is used beyond its range on purpose, and for reverse flow.
    ///
    /// # Errors
    /// [`AeroError::MachOutOfRange`] if `speed_ratio` is not finite or `limit` is no Mach number.
    pub fn limited(speed_ratio: f64, limit: f64) -> Result<Self, AeroError> {
        if !speed_ratio.is_finite() {
            return Err(AeroError::MachOutOfRange { mach: speed_ratio, limit });
        }
        Self::new(limit).map(|Self(limit)| Self(speed_ratio.abs().min(limit)))
    }

    /// A Mach number held within a range of Mach numbers.
    pub(crate) fn within(mach: Self, low: f64, high: f64) -> Self {
        Self(mach.0.clamp(low, high))
    }

    /// The number.
    pub fn value(self) -> f64 {
        self.0
    }

    /// Prandtl-Glauert factor `beta = sqrt(1 - M^2)`.
    pub fn beta(self) -> f64 {
        (1.0 - self.0 * self.0).sqrt()
    }
}

/// Chord of a plain trailing-edge flap over the section's chord, `E`; 0 means no flap.
///
/// The flap's leading edge is its hinge: no aerodynamic balance, sealed gap.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct FlapChord(f64);

impl FlapChord {
    /// A section without flap.
    pub const NONE: Self = Self(0.0);

    /// A flap chord ratio.
    ///
    /// # Errors
    /// [`AeroError::FlapChordOutOfRange`] unless `0 <= ratio < 1`.
    pub fn new(ratio: f64) -> Result<Self, AeroError> {
        if (0.0..1.0).contains(&ratio) {
            Ok(Self(ratio))
        } else {
            Err(AeroError::FlapChordOutOfRange { ratio })
        }
    }

    /// The ratio `E`.
    pub fn ratio(self) -> f64 {
        self.0
    }

    /// Whether there is no flap.
    pub fn is_none(self) -> bool {
        self.0 <= 0.0
    }

    /// Where the hinge is, `e = 1 - 2 E`.
    pub fn hinge(self) -> HingePosition {
        HingePosition(1.0 - 2.0 * self.0)
    }
}

/// Position of the flap hinge `e` in semichords aft of mid-chord, -1 to 1.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct HingePosition(f64);

impl HingePosition {
    /// A hinge position.
    ///
    /// # Errors
    /// [`AeroError::HingeOutOfRange`] unless `-1 <= semichords <= 1`.
    pub fn new(semichords: f64) -> Result<Self, AeroError> {
        if (-1.0..=1.0).contains(&semichords) {
            Ok(Self(semichords))
        } else {
            Err(AeroError::HingeOutOfRange { semichords })
        }
    }

    /// Semichords aft of mid-chord.
    pub fn semichords(self) -> f64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn values_outside_their_range_are_refused() {
        for bad in [-0.1, 0.951, f64::NAN, f64::INFINITY] {
            assert!(matches!(Mach::new(bad), Err(AeroError::MachOutOfRange { .. })), "{bad}");
        }
        for bad in [-0.1, 1.0, f64::NAN] {
            assert!(matches!(FlapChord::new(bad), Err(AeroError::FlapChordOutOfRange { .. })));
        }
        for bad in [-1.1, 1.1, f64::NAN] {
            assert!(matches!(HingePosition::new(bad), Err(AeroError::HingeOutOfRange { .. })));
        }
    }

    #[test]
    fn local_mach_numbers_are_limited_and_never_silently_nan() {
        assert_relative_eq!(Mach::limited(-0.3, 0.9).unwrap().value(), 0.3);
        assert_relative_eq!(Mach::limited(1.2, 0.9).unwrap().value(), 0.9);
        assert!(Mach::limited(f64::NAN, 0.9).is_err());
        assert!(Mach::limited(0.3, 1.5).is_err());
    }

    #[test]
    fn hinge_of_a_fifth_chord_flap() {
        let flap = FlapChord::new(0.2).unwrap();
        assert_relative_eq!(flap.hinge().semichords(), 0.6, max_relative = 1e-15);
        assert!(!flap.is_none());
        assert!(FlapChord::NONE.is_none());
        assert_relative_eq!(Mach::new(0.6).unwrap().beta(), 0.8, max_relative = 1e-15);
    }
}
