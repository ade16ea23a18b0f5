//! The blade's structural and inertial properties, and the tension rotation puts into it.

use rotor_base::gauss_legendre;

use crate::beam::distribution::Allowed;
use crate::error::check_parameters;
use crate::{Distribution, FemError, RootSupport};

/// Built-in twist along the radius, rad, nose up positive.
#[derive(Debug, Clone, PartialEq)]
pub enum Twist {
    /// `rate (r/R - 0.75)`: zero at three quarters of the radius.
    Linear {
        /// Twist per radius, rad; negative is washout.
        rate_rad: f64,
    },
    /// A table of twist angles in rad.
    Table(Distribution),
}

impl Twist {
    /// No twist.
    pub const NONE: Self = Self::Linear { rate_rad: 0.0 };

    /// Twist angle at station r/R, rad.
    pub fn value_rad(&self, station: f64) -> f64 {
        match self {
            Self::Linear { rate_rad } => rate_rad * (station - 0.75),
            Self::Table(table) => table.value(station),
        }
    }

    /// Rate of twist at station r/R, rad per radius.
    pub fn rate_rad(&self, station: f64) -> f64 {
        match self {
            Self::Linear { rate_rad } => *rate_rad,
            Self::Table(table) => table.slope(station),
        }
    }

    fn breaks(&self) -> &[f64] {
        match self {
            Self::Linear { .. } => &[],
            Self::Table(table) => table.breaks(),
        }
    }
}

/// A blade as its user describes it, in rotor units: length R, mass m0 R, time 1/Omega.
///
/// | field | symbol | divided by |
/// |---|---|---|
/// | stiffnesses | `EI_y`, `EI_z`, GJ | m0 Omega^2 R^4 |
/// | `axial_stiffness` | EA | m0 Omega^2 R^2 |
/// | `mass` | m | m0 |
/// | radii of gyration | `k_m1`, `k_m2`, `k_A` | R |
///
/// [`BladeProperties::new`] checks it.
#[derive(Debug, Clone, PartialEq)]
pub struct BladeSpec {
    /// Bending stiffness `EI_y` about the chord line: flap bending at zero pitch.
    pub flap_stiffness: Distribution,
    /// Bending stiffness `EI_z` about the section's normal: lag bending at zero pitch.
    pub lag_stiffness: Distribution,
    /// Torsional stiffness GJ.
    pub torsion_stiffness: Distribution,
    /// Axial stiffness EA.
    pub axial_stiffness: Distribution,
    /// Mass per length m.
    pub mass: Distribution,
    /// Mass radius of gyration `k_m1` of the thickness distribution: about the chord line.
    pub thickness_gyration_radius: Distribution,
    /// Mass radius of gyration `k_m2` of the chordwise distribution: about the section's normal.
    pub chord_gyration_radius: Distribution,
    /// Mass per length on the elastic axis beside that of the sections, over m0: it adds to no radius of gyration.
    pub axis_mass: Distribution,
    /// Polar radius of gyration `k_A` of the load-carrying area.
    pub area_gyration_radius: Distribution,
    /// Built-in twist.
    pub twist: Twist,
    /// Pitch angle of the undeformed blade at zero twist, rad, nose up.
    pub pitch_rad: f64,
    /// Precone, rad, tip up.
    pub precone_rad: f64,
    /// Radial station of the blade's root; the tip is at 1, and nothing moves or weighs inboard.
    pub root_offset: f64,
    /// How the root is held.
    pub root: RootSupport,
    /// Rotor speed over the nominal one that the rotor units refer to.
    pub rotor_speed: f64,
}

impl BladeSpec {
    /// The blade of Table 1 of the paper, with an assumed axial stiffness and 8 deg of linear twist, nose
    /// down toward the tip.
    ///
    /// Source: S. R. Viswamurthy, R. Ganguli, stiffnesses of Table 1; the paper gives no axial stiffness and no
    /// twist.
    pub fn table_1() -> Self {
        let twist = Twist::Linear { rate_rad: (-8.0_f64).to_radians() };
        Self { twist, ..Self::uniform(0.0108, 0.0268, 0.006_15, 1000.0) }
    }

    /// A uniform, untwisted blade of mass m0 per length, clamped at the rotor centre, at zero pitch and
    /// nominal speed.
    ///
    /// The radii of gyration are those of the hingeless rotor of the UMARC family, `k_m1` 0.0132, `k_m2`
    /// 0.0247, `k_A` 0.029: recalled, not taken from a document; they give the first torsion mode
    /// at 4.588 per rev with GJ 0.00615.
    pub fn uniform(
        flap_stiffness: f64,
        lag_stiffness: f64,
        torsion_stiffness: f64,
        axial_stiffness: f64,
    ) -> Self {
        Self {
            flap_stiffness: flap_stiffness.into(),
            lag_stiffness: lag_stiffness.into(),
            torsion_stiffness: torsion_stiffness.into(),
            axial_stiffness: axial_stiffness.into(),
            mass: 1.0.into(),
            thickness_gyration_radius: 0.0132.into(),
            chord_gyration_radius: 0.0247.into(),
            axis_mass: 0.0.into(),
            area_gyration_radius: 0.029.into(),
            twist: Twist::NONE,
            pitch_rad: 0.0,
            precone_rad: 0.0,
            root_offset: 0.0,
            root: RootSupport::CLAMPED,
            rotor_speed: 1.0,
        }
    }
}

/// A blade whose properties have been checked, with the tension of its rotation.
///
/// Every method takes a station r/R between the root offset and 1 and answers in rotor units.
#[derive(Debug, Clone, PartialEq)]
pub struct BladeProperties {
    spec: BladeSpec,
    breaks: Vec<f64>,
    /// Integral of `m r dr` from each break to the tip.
    outboard_moment: Vec<f64>,
}

impl BladeProperties {
    /// Checks a blade.
    ///
    /// # Errors
    /// [`FemError`] naming the field, station and value of the first fault found.
    pub fn new(spec: BladeSpec) -> Result<Self, FemError> {
        let ranges = [
            ("root_offset", spec.root_offset, 0.0, 0.95, "0 to 0.95 (r/R)"),
            ("rotor_speed", spec.rotor_speed, 0.0, 1e6, "0 to 1e6 times the nominal speed"),
            ("pitch_rad", spec.pitch_rad, -10.0, 10.0, "-10 to 10 rad"),
            ("precone_rad", spec.precone_rad, -0.8, 0.8, "-0.8 to 0.8 rad"),
        ];
        check_parameters(ranges.map(|(field, value, least, most, expected)| {
            (field, value, (least..=most).contains(&value), expected)
        }))?;
        spec.root.check()?;
        let root = spec.root_offset;
        let fields = [
            ("flap_stiffness", &spec.flap_stiffness, Allowed::Positive),
            ("lag_stiffness", &spec.lag_stiffness, Allowed::Positive),
            ("torsion_stiffness", &spec.torsion_stiffness, Allowed::Positive),
            ("axial_stiffness", &spec.axial_stiffness, Allowed::Positive),
            ("mass", &spec.mass, Allowed::Positive),
            ("thickness_gyration_radius", &spec.thickness_gyration_radius, Allowed::NotNegative),
            ("chord_gyration_radius", &spec.chord_gyration_radius, Allowed::Positive),
            ("area_gyration_radius", &spec.area_gyration_radius, Allowed::NotNegative),
            ("axis_mass", &spec.axis_mass, Allowed::NotNegative),
        ];
        for (field, distribution, allowed) in fields {
            distribution.check(field, root, allowed)?;
        }
        match &spec.twist {
            Twist::Linear { rate_rad } => {
                Distribution::Uniform(*rate_rad).check("twist", root, Allowed::Finite)?;
            }
            Twist::Table(table) => table.check("twist", root, Allowed::Finite)?,
        }
        let mut breaks: Vec<f64> = fields
            .iter()
            .flat_map(|(_, distribution, _)| distribution.breaks())
            .chain(spec.twist.breaks())
            .copied()
            .filter(|b| *b > root && *b < 1.0)
            .chain([root, 1.0])
            .collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
        let mut this = Self { outboard_moment: vec![0.0; breaks.len()], spec, breaks };
        for i in (1..this.breaks.len()).rev() {
            this.outboard_moment[i - 1] =
                this.outboard_moment[i] + this.moment_between(this.breaks[i - 1], this.breaks[i]);
        }
        Ok(this)
    }

    /// The description this blade was made from.
    pub fn spec(&self) -> &BladeSpec {
        &self.spec
    }

    /// The same blade at another pitch angle, rad.
    ///
    /// # Errors
    /// [`FemError::Parameter`] beyond 10 rad or for a NaN.
    pub fn with_pitch_rad(&self, pitch_rad: f64) -> Result<Self, FemError> {
        Self::new(BladeSpec { pitch_rad, ..self.spec.clone() })
    }

    /// The same blade at another rotor speed, over the nominal one.
    ///
    /// # Errors
    /// [`FemError::Parameter`] for a negative speed or a NaN.
    pub fn with_rotor_speed(&self, rotor_speed: f64) -> Result<Self, FemError> {
        Self::new(BladeSpec { rotor_speed, ..self.spec.clone() })
    }

    /// The same blade at zero pitch, without twist and precone.
    pub(crate) fn straightened(&self) -> Self {
        let spec =
            BladeSpec { twist: Twist::NONE, pitch_rad: 0.0, precone_rad: 0.0, ..self.spec.clone() };
        Self { spec, ..self.clone() }
    }

    /// Root, tip and every station between them where a property jumps or has a kink.
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Bending stiffness `EI_y` (flap at zero pitch), over m0 Omega^2 R^4.
    pub fn flap_stiffness(&self, station: f64) -> f64 {
        self.spec.flap_stiffness.value(station)
    }

    /// Bending stiffness `EI_z` (lag at zero pitch), over m0 Omega^2 R^4.
    pub fn lag_stiffness(&self, station: f64) -> f64 {
        self.spec.lag_stiffness.value(station)
    }

    /// Torsional stiffness GJ, over m0 Omega^2 R^4.
    pub fn torsion_stiffness(&self, station: f64) -> f64 {
        self.spec.torsion_stiffness.value(station)
    }

    /// Axial stiffness EA, over m0 Omega^2 R^2.
    pub fn axial_stiffness(&self, station: f64) -> f64 {
        self.spec.axial_stiffness.value(station)
    }

    /// Mass per length, over m0: of the sections and on the elastic axis.
    pub fn mass(&self, station: f64) -> f64 {
        self.section_mass(station) + self.spec.axis_mass.value(station)
    }

    /// Mass per length of the sections alone, over m0.
    pub fn section_mass(&self, station: f64) -> f64 {
        self.spec.mass.value(station)
    }

    /// Squares of the mass radii of gyration, `[k_m1^2, k_m2^2]`, over R^2: `m k^2` is that of the sections, whatever
    /// weighs on the axis.
    pub fn squared_mass_radii(&self, station: f64) -> [f64; 2] {
        let share = match self.spec.axis_mass.value(station) {
            0.0 => 1.0,
            _ => self.section_mass(station) / self.mass(station),
        };
        let square = |d: &Distribution| share * d.value(station).powi(2);
        [square(&self.spec.thickness_gyration_radius), square(&self.spec.chord_gyration_radius)]
    }

    /// Square of the polar mass radius of gyration, `k_m^2 = k_m1^2 + k_m2^2`, over R^2.
    pub fn squared_polar_radius(&self, station: f64) -> f64 {
        self.squared_mass_radii(station).iter().sum()
    }

    /// Square of the area radius of gyration, `k_A^2`, over R^2.
    pub fn squared_area_radius(&self, station: f64) -> f64 {
        self.spec.area_gyration_radius.value(station).powi(2)
    }

    /// Built-in twist, rad, nose up.
    pub fn twist_rad(&self, station: f64) -> f64 {
        self.spec.twist.value_rad(station)
    }

    /// Rate of the built-in twist, rad per radius.
    pub fn twist_rate_rad(&self, station: f64) -> f64 {
        self.spec.twist.rate_rad(station)
    }

    /// Pitch of the undeformed section, pitch angle plus twist, rad.
    pub fn section_pitch_rad(&self, station: f64) -> f64 {
        self.spec.pitch_rad + self.twist_rad(station)
    }

    /// Steady tension of the undeformed rotating blade, over m0 Omega^2 R^2.
    ///
    /// ```text
    /// T(x) = Omega^2 cos^2(precone) integral_x^1 m r dr
    /// ```
    /// Assumes: no axial stretch in the arm r.
    pub fn tension(&self, station: f64) -> f64 {
        let spec = &self.spec;
        let next = self.breaks.partition_point(|b| *b <= station).max(1);
        let moment = self.breaks.get(next).map_or(0.0, |end| {
            self.outboard_moment[next]
                + self.moment_between(station.max(self.breaks[next - 1]), *end)
        });
        (spec.rotor_speed * spec.precone_rad.cos()).powi(2) * moment
    }

    /// `integral m r dr` where `m` is a straight line: exact with two Gauss points.
    fn moment_between(&self, from: f64, to: f64) -> f64 {
        let (half, mid) = (0.5 * (to - from), 0.5 * (to + from));
        let rule = gauss_legendre(2);
        let points = rule.nodes.iter().zip(&rule.weights);
        points
            .map(|(s, w)| {
                let r = mid + half * s;
                w * half * self.mass(r) * r
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn spec() -> BladeSpec {
        BladeSpec::uniform(0.0108, 0.0268, 0.00615, 200.0)
    }

    #[test]
    fn tension_of_a_uniform_and_of_a_stepped_blade() {
        let uniform = BladeProperties::new(spec()).unwrap();
        for x in [0.0_f64, 0.3, 0.77, 1.0] {
            assert_abs_diff_eq!(uniform.tension(x), 0.5 * (1.0 - x * x), epsilon = 1e-15);
        }
        let mass =
            Distribution::PiecewiseConstant { edges: vec![0.1, 0.6, 1.0], values: vec![2.0, 1.0] };
        let stepped =
            BladeProperties::new(BladeSpec { mass, root_offset: 0.1, rotor_speed: 2.0, ..spec() })
                .unwrap();
        let exact = |x: f64| 4.0 * (0.5 * (1.0 - x.max(0.6).powi(2)) + (0.36 - x.min(0.6).powi(2)));
        for x in [0.1, 0.3, 0.6, 0.9, 1.0] {
            assert_abs_diff_eq!(stepped.tension(x), exact(x), epsilon = 1e-14);
        }
    }

    #[test]
    fn bad_blades_are_named() {
        let message = |spec: BladeSpec| BladeProperties::new(spec).unwrap_err().to_string();
        assert!(
            message(BladeSpec { lag_stiffness: (-1.0).into(), ..spec() }).contains("lag_stiff")
        );
        assert!(message(BladeSpec { mass: 0.0.into(), ..spec() }).contains("mass"));
        assert!(message(BladeSpec { root_offset: 1.0, ..spec() }).contains("root_offset"));
        assert!(message(BladeSpec { pitch_rad: f64::NAN, ..spec() }).contains("pitch_rad"));
        assert!(message(BladeSpec { rotor_speed: -1.0, ..spec() }).contains("rotor_speed"));
        let twist = Twist::Linear { rate_rad: f64::INFINITY };
        assert!(message(BladeSpec { twist, ..spec() }).contains("twist"));
    }
}
