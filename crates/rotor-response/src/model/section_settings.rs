//! What of the sections goes beyond attached linear theory.

use flap_aero::{AirfoilSpan, Mach, StallAirfoil, StallParameters};
use std::sync::Arc;

/// What the camber of sections adds to linear theory: incidences count from that of zero lift, and a moment is left there. Both
/// act in the air along the chord, whichever way it goes. Nothing by default; aerofoil tables hold their own.
///
/// Source: thin-aerofoil theory (Glauert, The Elements of Aerofoil and Airscrew Theory, 1926).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Camber {
    /// Incidence of zero lift, nose up, rad; below 0 of sections that are convex above.
    pub zero_lift_rad: f64,
    /// Moment about the quarter chord at zero lift, nose up, over `q c^2`.
    pub moment: f64,
}

/// How sections stall dynamically.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DynamicStall {
    /// Leishman and Beddoes with the constants of an aerofoil at the local Mach number.
    Of(StallAirfoil),
    /// Leishman and Beddoes with the same constants at every Mach number.
    Constant(StallParameters),
}

impl DynamicStall {
    /// The constants at a Mach number.
    pub(crate) fn parameters(&self, mach: Mach) -> StallParameters {
        match self {
            Self::Of(airfoil) => airfoil.parameters(mach),
            Self::Constant(parameters) => *parameters,
        }
    }
}

/// What of a rotor's sections goes beyond attached linear theory. Nothing by default.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NonlinearSections {
    /// Aerofoil tables along the span, stations in radius R. They take the place of the static lift
    /// and moment of the attached model and of the rotor's profile drag coefficient. `None`: the
    /// attached model's own.
    pub airfoils: Option<Arc<AirfoilSpan>>,
    /// Dynamic stall. `None`: the sections stall no more than their tables do.
    pub dynamic_stall: Option<DynamicStall>,
}

impl NonlinearSections {
    /// Whether the sections are those of attached linear theory.
    pub fn is_linear(&self) -> bool {
        self.airfoils.is_none() && self.dynamic_stall.is_none()
    }
}
