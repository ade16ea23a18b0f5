//! What the moderately deflected blade is made of.

use crate::beam::distribution::Allowed;
use crate::{BladeProperties, BladeSpec, Distribution, FemError};
use serde::{Deserialize, Serialize};

use super::inertia::SectionMass;
use super::section_shape::SectionShape;
use super::strain::{STRAIN_VARIABLES, SectionStiffness, Turn, at};

/// Whether tension turns the built-in twist straight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Untwist {
    /// The moment `N k_A^2 th_x` acts, as the energy says.
    #[default]
    Included,
    /// Tension stiffens the elastic twist only, `N k_A^2 phi_x`.
    Neglected,
}

/// What the degree of freedom phi is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum TwistAngle {
    /// The last of three rotations (lag, flap, pitch): the section's pitch. Bending in two planes twists
    /// it, `kappa_x = phi_x + w_x v_xx`.
    #[default]
    Rotation,
    /// The elastic twist, taken for the pitch: `kappa_x = phi_x`.
    Elastic,
}

/// Terms of second order in torsion that published formulations keep or drop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TorsionTerms {
    /// Tension on the built-in twist.
    pub untwist: Untwist,
    /// The twist angle.
    pub angle: TwistAngle,
}

/// A blade for moderate deflections as its user describes it, rotor units (as [`BladeSpec`]).
///
/// Offsets are over R, positive toward the leading edge. Mass radii `k_m1`, `k_m2` are about the elastic
/// axis, stiffnesses `EI_y`, `EI_z` about the tension centre, the area radius `k_A` about the elastic axis.
#[derive(Debug, Clone, PartialEq)]
pub struct ModerateSpec {
    /// Stiffness, mass, twist, pitch, precone, root, rotor speed.
    pub blade: BladeSpec,
    /// Mass centre ahead of the elastic axis, `e_g`.
    pub mass_centre: Distribution,
    /// Tension centre ahead of the elastic axis, `e_A`.
    pub tension_centre: Distribution,
    /// Terms of second order in torsion.
    pub torsion: TorsionTerms,
}

impl From<BladeSpec> for ModerateSpec {
    /// The same blade with mass and tension centre on the elastic axis.
    fn from(blade: BladeSpec) -> Self {
        Self {
            blade,
            mass_centre: 0.0.into(),
            tension_centre: 0.0.into(),
            torsion: TorsionTerms::default(),
        }
    }
}

/// A blade for moderate deflections whose properties have been checked.
#[derive(Debug, Clone, PartialEq)]
pub struct ModerateBlade {
    spec: ModerateSpec,
    properties: BladeProperties,
    breaks: Vec<f64>,
}

impl ModerateBlade {
    /// Checks a blade.
    ///
    /// # Errors
    /// [`FemError`] naming field, station and value of the first fault found: those of
    /// [`BladeProperties::new`]; an offset table with a fault; `chord_gyration_radius` below the offset
    /// of the mass centre.
    pub fn new(spec: ModerateSpec) -> Result<Self, FemError> {
        let properties = BladeProperties::new(spec.blade.clone())?;
        let root = spec.blade.root_offset;
        spec.mass_centre.check("mass_centre", root, Allowed::Finite)?;
        spec.tension_centre.check("tension_centre", root, Allowed::Finite)?;
        let offsets = spec.mass_centre.breaks().iter().chain(spec.tension_centre.breaks());
        let mut breaks: Vec<f64> = offsets
            .copied()
            .filter(|b| *b > root && *b < 1.0)
            .chain(properties.breaks().iter().copied())
            .collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
        let this = Self { spec, properties, breaks };
        for pair in this.breaks.windows(2) {
            let inset = 1e-9 * (pair[1] - pair[0]);
            for station in [pair[0] + inset, pair[1] - inset] {
                let value = this.spec.blade.chord_gyration_radius.value(station);
                if value < this.spec.mass_centre.value(station).abs() * (1.0 - 1e-12) {
                    return Err(FemError::Property {
                        field: "chord_gyration_radius",
                        station,
                        value,
                        expected: "at least the offset mass_centre: the radius is about the \
                                   elastic axis, so add the offset's square to the square of the \
                                   radius about the mass centre",
                    });
                }
            }
        }
        Ok(this)
    }

    /// The description this blade was made from.
    pub fn spec(&self) -> &ModerateSpec {
        &self.spec
    }

    /// Its properties but for the offsets.
    pub fn properties(&self) -> &BladeProperties {
        &self.properties
    }

    /// Root, tip and every station between them where a property jumps or has a kink.
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Moments in a section that is bent and twisted and carries a tension: flapwise (tip up), lagwise (tip
    /// forward), twisting (nose up), the forces on `w_xx`, `v_xx`, `phi_x`. Unit: m0 Omega^2 R^3.
    ///
    /// ```text
    /// d/ds [ EI_z kz^2 + EI_y ky^2 + GJ kx^2 ] / 2 + N de/ds,   s = w_xx, v_xx, phi_x
    /// ```
    /// `pitch_rad` is the pitch without the built-in twist. A pure function of its arguments.
    pub fn section_moments(
        &self,
        station: f64,
        pitch_rad: f64,
        shape: &SectionShape,
        tension: f64,
    ) -> [f64; 3] {
        let stiffness = self.stiffness(station);
        let theta = pitch_rad + self.properties.twist_rad(station);
        let [v_x, w_x, v_xx, w_xx, phi, phi_x] = shape.strain();
        let strain: [f64; STRAIN_VARIABLES] = [0.0, v_x, w_x, v_xx, w_xx, phi, phi_x];
        let force = stiffness.elastic_force(Turn::of(theta, &strain), &strain, tension);
        [at::W_XX, at::V_XX, at::PHI_X].map(|k| force[k])
    }

    pub(crate) fn stiffness(&self, station: f64) -> SectionStiffness {
        let p = &self.properties;
        SectionStiffness {
            flap: p.flap_stiffness(station),
            lag: p.lag_stiffness(station),
            torsion: p.torsion_stiffness(station),
            axial: p.axial_stiffness(station),
            area_radius_squared: p.squared_area_radius(station),
            tension_centre: self.spec.tension_centre.value(station),
            twist_rate: match self.spec.torsion.untwist {
                Untwist::Included => p.twist_rate_rad(station),
                Untwist::Neglected => 0.0,
            },
            bending_twist: match self.spec.torsion.angle {
                TwistAngle::Rotation => 1.0,
                TwistAngle::Elastic => 0.0,
            },
        }
    }

    /// The radial motion of the mass centre by the slopes of bending carries inertia, that of points off it does
    /// not: a slender blade.
    pub(crate) fn mass(&self, station: f64) -> SectionMass {
        let m = self.properties.mass(station);
        let offset = self.spec.mass_centre.value(station);
        let first = self.properties.section_mass(station) * offset;
        let [thickness, chord] = self.properties.squared_mass_radii(station).map(|k| m * k);
        let centre = first * offset;
        let flat_chord = (chord - centre).max(0.0);
        SectionMass { mass: m, first, centre, flat_chord, flat_thickness: thickness }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What weighs on the axis is mass alone: moments about the axis are those of the sections.
    #[test]
    fn mass_on_the_axis_has_no_moment_about_it() {
        let line =
            Distribution::PiecewiseLinear { stations: vec![0.0, 1.0], values: vec![1.2, 0.8] };
        let of = |axis_mass: f64| {
            let blade = BladeSpec {
                mass: line.clone(),
                axis_mass: axis_mass.into(),
                ..BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 200.0)
            };
            let spec = ModerateSpec { mass_centre: (-0.01).into(), ..blade.into() };
            ModerateBlade::new(spec).unwrap().mass(0.3)
        };
        let (bare, laden) = (of(0.0), of(0.25));
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-15;
        assert!(near(laden.mass, bare.mass + 0.25) && near(bare.mass, 1.08));
        assert!(near(laden.first, bare.first) && near(bare.first, -0.0108));
        assert!(near(laden.centre, bare.centre) && near(bare.centre, 1.08e-4));
        assert!(near(laden.flat_chord, bare.flat_chord) && bare.flat_chord > 0.0);
        assert!(near(laden.flat_thickness, bare.flat_thickness) && bare.flat_thickness > 0.0);
    }
}
