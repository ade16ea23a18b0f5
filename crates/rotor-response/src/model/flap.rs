//! A trailing-edge flap and its inertia.

use crate::ResponseError;
use crate::error::check;
use crate::model::flap_inertia::FlapBody;
use flap_aero::FlapEffectiveness;
use serde::{Deserialize, Serialize};

/// Whether the mass of a flap is contained in that of the blade.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum FlapMass {
    /// Contained: the flap at rest is blade; only what its angle adds is a load of its own, to first
    /// order at zero pitch.
    #[default]
    PartOfBlade,
    /// Beside it: the blade is heavier by the flap over the span of the flap, and every inertial load of
    /// the flap off the elastic axis acts on the blade, exact in the angles.
    AddedToBlade,
}

/// A trailing-edge flap.
///
/// Lengths in radius R or chord as named; the hinge is at the flap's leading edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrailingEdgeFlap {
    /// Inboard edge, radius R.
    pub start: f64,
    /// Outboard edge, radius R.
    pub end: f64,
    /// Flap chord over blade chord, 0.05 to 0.5.
    pub chord_fraction: f64,
    /// Flap mass per length over the reference mass per length `m0`.
    pub mass_fraction: f64,
    /// Distance of the flap's centre of gravity behind its hinge over the flap chord, -1 (a balance
    /// mass ahead) to 1 (the trailing edge).
    pub cg_fraction: f64,
    /// Radius of gyration about the hinge over the flap chord, `sqrt(I_hinge / m_f) / c_f`, at least
    /// the size of `cg_fraction`; none for a uniform thin rod about its centre of gravity,
    /// `I_cg = m_f c_f^2 / 12`.
    pub gyration_fraction: Option<f64>,
    /// Whether the blade's mass contains the flap's.
    pub mass: FlapMass,
    /// How much of thin-aerofoil theory's flap it is, in lift, moment and hinge moment.
    pub effectiveness: FlapEffectiveness,
}

/// Inertia of a flap per length in rotor units: mass `m0`, length R.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FlapInertia {
    /// First moment about the hinge, `m_f X_f`.
    pub(crate) first_moment: f64,
    /// `m_f (d + X_f) X_f`, with `d` the distance of the hinge behind the elastic axis.
    pub(crate) arm_moment: f64,
    /// Moment of inertia about the flap's centre of gravity, `m_f c_f^2 / 12` if none is given.
    pub(crate) own: f64,
    /// Whether these are the only loads, or `body` makes all of them.
    pub(crate) mass: FlapMass,
    /// The flap as a body.
    pub(crate) body: FlapBody,
}

impl TrailingEdgeFlap {
    /// The two flaps of the paper's case: Table 1, their span assumed.
    ///
    /// Source: S. R. Viswamurthy, R. Ganguli, Table 1.
    pub fn paper_case() -> [Self; 2] {
        [(0.70, 0.75), (0.80, 0.85)].map(|(start, end)| Self {
            start,
            end,
            chord_fraction: 0.2,
            mass_fraction: 0.1,
            cg_fraction: 0.2,
            gyration_fraction: None,
            mass: FlapMass::PartOfBlade,
            effectiveness: FlapEffectiveness::IDEAL,
        })
    }

    /// Checks its proportions.
    pub(crate) fn validate(&self) -> Result<(), ResponseError> {
        let (chord, mass, cg) = (self.chord_fraction, self.mass_fraction, self.cg_fraction);
        let beyond = "-1 to 1 flap chord: 1 is the trailing edge";
        let least = "abs(cg_fraction) to 1 flap chord: it is about the hinge";
        let ranges = [
            ("flap chord_fraction", chord, 0.05..=0.5, "0.05 to 0.5 of the chord"),
            ("flap mass_fraction", mass, 0.0..=1.0, "0 to 1 of m0"),
            ("flap cg_fraction", cg, -1.0..=1.0, beyond),
        ];
        let gyration =
            self.gyration_fraction.map(|k| ("flap gyration_fraction", k, cg.abs()..=1.0, least));
        ranges.into_iter().chain(gyration).try_for_each(|(field, value, range, expected)| {
            check(field, value, range.contains(&value), expected)
        })
    }

    /// Inertia per length for a blade chord `c/R` and an elastic axis `behind` the quarter chord.
    ///
    /// Source: design values of Viswamurthy and Ganguli, Table 1; the flap's own inertia is that of a
    /// uniform thin rod, `m_f c_f^2 / 12`, unless given (assumption).
    pub(crate) fn inertia(&self, chord: f64, behind: f64) -> FlapInertia {
        let flap_chord = self.chord_fraction * chord;
        let cg = self.cg_fraction * flap_chord;
        let hinge = (0.75 - self.chord_fraction) * chord - behind;
        let own_squared = match self.gyration_fraction {
            None => flap_chord * flap_chord / 12.0,
            Some(about_hinge) => ((about_hinge * flap_chord).powi(2) - cg * cg).max(0.0),
        };
        let gyration = own_squared.sqrt();
        FlapInertia {
            first_moment: self.mass_fraction * cg,
            arm_moment: self.mass_fraction * (hinge + cg) * cg,
            own: match self.gyration_fraction {
                None => self.mass_fraction * flap_chord * flap_chord / 12.0,
                Some(_) => self.mass_fraction * own_squared,
            },
            mass: self.mass,
            body: FlapBody { mass: self.mass_fraction, hinge, cg, gyration },
        }
    }
}
