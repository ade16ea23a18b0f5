//! What a rotor is made of: validated parameters handed down by the drivers.

use crate::error::check;
use crate::{Camber, NonlinearSections, ResponseError, TrailingEdgeFlap};
use flap_aero::AttachedFlowModel;
use rotor_base::HarmonicSeries;
use rotor_base::gauss_legendre;
use rotor_fem::{Distribution, ModalBasis, PitchMotion, TorsionTerms};
use serde::{Deserialize, Serialize};

/// Largest local Mach number handed to the section models, where linear theory ends.
pub(crate) const MACH_LIMIT: f64 = 0.9;

/// Which nonlinear structural and inertial terms the modal equations carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Couplings {
    /// Small deflections: tension of the undeformed blade, no lag-axial Coriolis term, bending in
    /// flap and lag apart, propeller moment linearised in the pitch angle.
    Linear,
    /// Second order: tension with the Coriolis part, foreshortening rate in the lag equation,
    /// flap-lag coupling through the pitch angle, torsion driven by `(EI_z - EI_y) kappa_z kappa_y`.
    Full,
    /// Moderate deflections: the exact modal equations of the Hodges-Dowell energies with the axial
    /// motion condensed ([`rotor_fem::ModalBlade`]). Beyond `Full`: all foreshortening terms in the tension, the
    /// axial part of the air loads, bending-torsion coupling `GJ (phi_x + w_x v_xx)`, full gyroscopic
    /// terms of the section, and the terms of torsion that are named here.
    Moderate(TorsionTerms),
}

/// How the local Mach number enters the section aerodynamics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Compressibility {
    /// Mach number zero everywhere.
    None,
    /// Local Mach number `M_tip |x + mu sin psi|`, at most 0.9.
    LocalMach {
        /// Hover tip Mach number.
        tip_mach: f64,
    },
}

/// How the circulation of a section, and with it the in-plane part of its lift, changes sense where
/// the tangential speed does.
///
/// ```text
/// F_y = -s (L / |U_T|) U_P - (rho c / 2) c_d0 |U_T| U_T
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ReverseFlow {
    /// `s = U_T / sqrt(U_T^2 + U_P^2)`, the cosine of the inflow angle: as the flow turns normal to the
    /// chord the edge at which the circulation is fixed changes, and the circulation passes through
    /// zero. Continuous, so that the loads converge with the mesh; equal to the small-angle form to
    /// `(U_P / U_T)^2 / 2`.
    #[default]
    Gradual,
    /// `s = sgn(x + mu sin psi)` of the rigid blade: the small-angle form, whose in-plane load jumps by
    /// `2 (L / |U_T|) U_P` at the edge of the reverse-flow region. The 4/rev loads then converge slowly
    /// with the mesh. It follows the rigid blade because a jump that moves with the motion keeps the
    /// response from converging.
    Abrupt,
}

/// Centres of a section ahead of its elastic axis, and the blade's axis ahead of the hub's centre, radius R;
/// the same all along the blade.
///
/// Mass and tension centre are known to the equations of [`Couplings::Moderate`] alone, the torque offset to
/// those of `Linear` and `Full`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SectionOffsets {
    /// Mass centre, `e_g`.
    pub mass_centre: f64,
    /// Tension centre, `e_A`.
    pub tension_centre: f64,
    /// Aerodynamic centre (the quarter chord), `e_d`. Lift there turns the section nose up, and a section
    /// that pitches about its elastic axis moves it: `U_P` holds `e_d om`.
    pub aerodynamic_centre: f64,
    /// Torque offset: how far the axis of the blade at rest passes ahead of the rotor centre, toward the
    /// leading edge. Centrifugal force then has a part along the lag motion, and the rotation gives the air
    /// a speed along the blade.
    pub torque: f64,
}

/// Where the blade departs from a rectangle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Planform {
    /// Chord along the span, radius R; none: [`RotorModel::chord`] everywhere.
    pub chord: Option<Distribution>,
    /// How far the sections, with their mass and aerodynamic centres, are set back behind the straight elastic axis,
    /// radius R, aft positive; none: nowhere. Its slope is the tangent of the sweep angle, aft positive. Known to
    /// [`Couplings::Moderate`] alone, and not with tables of airfoils or dynamic stall.
    ///
    /// A swept section is a section across the swept line (simple sweep theory): the velocity normal to its surface is that
    /// of the unswept one; speed, Mach number and chord are those across the line.
    ///
    /// ```text
    /// U = U_T + U_S tan L,   M = M_tip U cos L,   rho -> rho cos L
    /// ```
    /// `U_S` is the speed along the blade, outboard. Assumes: a straight elastic axis; the pull of the lift along the span and
    /// the bending part of the section's own moment are left out; the wake leaves the unswept line.
    /// Source: R. T. Jones, NACA Report 863 (1947), for the independence of flow along the span.
    pub set_back: Option<Distribution>,
}

impl Planform {
    /// Tangent of the sweep angle at a station, aft positive.
    pub fn sweep_tangent(&self, station: f64) -> f64 {
        self.set_back.as_ref().map_or(0.0, |line| line.slope(station))
    }

    /// Distance of the sections behind the elastic axis at a station, radius R.
    pub fn set_back_at(&self, station: f64) -> f64 {
        self.set_back.as_ref().map_or(0.0, |line| line.value(station))
    }

    /// Stations where the planform has a kink.
    pub fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.chord.iter().chain(&self.set_back).flat_map(Distribution::breaks).copied()
    }
}

/// The rotor apart from the structure of its blades. Rotor units: length R, mass per length `m0`,
/// time 1/Omega.
#[derive(Debug, Clone, PartialEq)]
pub struct RotorModel {
    /// Number of blades.
    pub blades: usize,
    /// Reference chord over radius: that of the Lock number, and of the blade where the planform says no other.
    pub chord: f64,
    /// Chord along the span.
    pub planform: Planform,
    /// Lock number `gamma = rho a c R^4 / I_b` with `a = 2 pi` and `I_b = m0 R^3 / 3`; the air density
    /// follows from it.
    pub lock_number: f64,
    /// Profile drag coefficient.
    pub drag_coefficient: f64,
    /// Camber of the sections, where they have no tables.
    pub camber: Camber,
    /// Aerodynamic root cut-out, radius R.
    pub root_cutout: f64,
    /// Tip loss factor B, radius R: outboard of it a section drags but does not lift; 1 for none.
    pub tip_loss: f64,
    /// Acceleration of gravity over `Omega^2 R`, zero without gravity.
    pub gravity: f64,
    /// Mass and tension centre off the elastic axis.
    pub offsets: SectionOffsets,
    /// Modal damping over critical.
    pub modal_damping: f64,
    /// Viscous damper of the lag rotation at the root, moment per rate, `m0 Omega R^3`: it acts where the blade's lag
    /// joint turns.
    pub lag_damper: f64,
    /// Terms of the structural equations.
    pub couplings: Couplings,
    /// Section aerodynamics.
    pub section_model: AttachedFlowModel,
    /// Mach number.
    pub compressibility: Compressibility,
    /// Circulation at the edge of the reverse-flow region.
    pub reverse_flow: ReverseFlow,
    /// Trailing-edge flaps from root to tip.
    pub flaps: Vec<TrailingEdgeFlap>,
    /// Tables and dynamic stall of the sections; none by default.
    pub nonlinear: NonlinearSections,
}

impl RotorModel {
    /// The rotor of Table 1 of the paper: quasi-steady sections, incompressible, no flaps; cut-out, drag and
    /// damping, which the paper leaves open, as in the shipped case.
    ///
    /// Source: S. R. Viswamurthy, R. Ganguli, Table 1.
    pub fn table_1(couplings: Couplings) -> Self {
        Self {
            blades: 4,
            chord: 0.055,
            planform: Planform::default(),
            lock_number: 5.2,
            drag_coefficient: 0.01,
            camber: Camber::default(),
            root_cutout: 0.2,
            tip_loss: 1.0,
            gravity: 0.0,
            offsets: SectionOffsets::default(),
            modal_damping: 0.005,
            lag_damper: 0.0,
            couplings,
            section_model: AttachedFlowModel::QuasiSteady,
            compressibility: Compressibility::None,
            reverse_flow: ReverseFlow::default(),
            flaps: vec![],
            nonlinear: NonlinearSections::default(),
        }
    }

    /// The same with the two flaps of the paper's case and sections of the form of Hariharan and Leishman at
    /// the local Mach number.
    pub fn paper_case() -> Self {
        Self {
            section_model: AttachedFlowModel::HariharanLeishman,
            compressibility: Compressibility::LocalMach { tip_mach: 0.582 },
            flaps: TrailingEdgeFlap::paper_case().to_vec(),
            ..Self::table_1(Couplings::Full)
        }
    }

    /// Checks every parameter.
    ///
    /// # Errors
    /// [`ResponseError::Parameter`] or [`ResponseError::FlapSpan`] for the first one out of range.
    pub fn validate(&self) -> Result<(), ResponseError> {
        let (cutout, quarter) = (self.root_cutout, 0.25 * self.chord);
        let SectionOffsets { mass_centre, tension_centre, aerodynamic_centre, torque } =
            self.offsets;
        let tip_mach = match self.compressibility {
            Compressibility::None => None,
            Compressibility::LocalMach { tip_mach } => Some(tip_mach),
        };
        let ranges = [
            ("blades", self.blades as f64, 1.0..=16.0, "1 to 16"),
            ("chord", self.chord, 1e-3..=0.5, "0.001 to 0.5 R"),
            ("lock_number", self.lock_number, 0.0..=50.0, "0 to 50"),
            ("drag_coefficient", self.drag_coefficient, 0.0..=1.0, "0 to 1"),
            ("camber.zero_lift_rad", self.camber.zero_lift_rad, -0.2..=0.2, "-0.2 to 0.2 rad"),
            ("camber.moment", self.camber.moment, -0.3..=0.3, "-0.3 to 0.3"),
            ("root_cutout", cutout, 0.0..=0.9, "0 to 0.9 R"),
            (
                "tip_loss",
                self.tip_loss,
                cutout.max(0.5)..=1.0,
                "0.5 to 1 R, outboard of the root cut-out",
            ),
            ("gravity", self.gravity, 0.0..=1.0, "0 to 1 Omega^2 R"),
            ("offsets.mass_centre", mass_centre, -0.1..=0.1, "-0.1 to 0.1 R"),
            ("offsets.tension_centre", tension_centre, -0.1..=0.1, "-0.1 to 0.1 R"),
            (
                "offsets.aerodynamic_centre",
                aerodynamic_centre,
                -3.0 * quarter..=quarter,
                "the elastic axis between the edges of the chord",
            ),
            ("offsets.torque", torque, -0.1..=0.1, "-0.1 to 0.1 R"),
            ("modal_damping", self.modal_damping, 0.0..=0.5, "0 to 0.5 of critical"),
            ("lag_damper", self.lag_damper, 0.0..=10.0, "0 to 10 m0 Omega R^3"),
        ];
        let tables = self.planform.chord.iter().flat_map(Distribution::breaks);
        let chords = tables
            .map(|x| ("planform.chord", self.chord_at(*x), 1e-3..=0.5, "0.001 to 0.5 R"))
            .chain(tip_mach.map(|mach| ("tip_mach", mach, 1e-3..=0.95, "0.001 to 0.95")));
        for (field, value, range, expected) in ranges.into_iter().chain(chords) {
            check(field, value, range.contains(&value), expected)?;
        }
        let moderate = matches!(self.couplings, Couplings::Moderate(_));
        for (field, offset, known, expected) in [
            ("offsets.mass_centre", mass_centre, moderate, "0 unless the couplings are Moderate"),
            (
                "offsets.tension_centre",
                tension_centre,
                moderate,
                "0 unless the couplings are Moderate",
            ),
            ("offsets.torque", torque, !moderate, "0 if the couplings are Moderate"),
        ] {
            check(field, offset, offset == 0.0 || known, expected)?;
        }
        self.validate_sweep()?;
        let mut from = cutout;
        for (index, flap) in self.flaps.iter().enumerate() {
            let (start, end) = (flap.start, flap.end);
            if !(start >= from && end > start && end <= 1.0) {
                return Err(ResponseError::FlapSpan { index, start, end, cutout });
            }
            from = end;
            flap.validate()?;
        }
        Ok(())
    }

    /// Checks the line of a swept blade.
    fn validate_sweep(&self) -> Result<(), ResponseError> {
        let Some(line) = &self.planform.set_back else { return Ok(()) };
        let check = |value, ok, expected| check("planform.set_back", value, ok, expected);
        let tip = line.value(1.0);
        let known = matches!(self.couplings, Couplings::Moderate(_)) && self.nonlinear.is_linear();
        check(tip, known, "none unless the couplings are Moderate and the sections linear")?;
        for pair in line.breaks().windows(2) {
            let tangent = line.slope(0.5 * (pair[0] + pair[1]));
            check(tangent, tangent.abs() <= 1.0, "a sweep of 45 deg or less")?;
            let flapped = self.flaps.iter().any(|f| f.start < pair[1] && f.end > pair[0]);
            check(tangent, tangent == 0.0 || !flapped, "no sweep where a flap is")?;
        }
        line.breaks().iter().map(|x| line.value(*x)).try_for_each(|back| {
            check(back, back.abs() <= 0.2, "-0.2 to 0.2 R behind the elastic axis")
        })
    }

    /// Mass centre ahead of the elastic axis along the span, radius R: the offset less what the sweep sets it back.
    pub fn mass_centre(&self) -> Distribution {
        let ahead = self.offsets.mass_centre;
        match &self.planform.set_back {
            None => ahead.into(),
            Some(line) => {
                let stations = line.breaks().to_vec();
                let values = stations.iter().map(|x| ahead - line.value(*x)).collect();
                Distribution::PiecewiseLinear { stations, values }
            }
        }
    }

    /// Chord at a station, radius R.
    pub fn chord_at(&self, station: f64) -> f64 {
        self.planform.chord.as_ref().map_or(self.chord, |chord| chord.value(station))
    }

    /// Chord of the rectangular blade that carries the same thrust at the same lift coefficient, radius R:
    ///
    /// ```text
    /// c_T = 3 int_0^1 c x^2 dx
    /// ```
    /// with the innermost value of a table carried on to the rotor centre.
    pub fn thrust_weighted_chord(&self) -> f64 {
        let Some(chord) = &self.planform.chord else { return self.chord };
        let inside = chord.breaks().iter().copied().filter(|x| *x > 0.0 && *x < 1.0);
        let edges: Vec<f64> = [0.0].into_iter().chain(inside).chain([1.0]).collect();
        // the cubic c x^2 is integrated exactly; what the reference chord lacks, so that its own table gives itself
        let rule = gauss_legendre(2);
        let mut lacking = 0.0;
        for pair in edges.windows(2) {
            let (half, middle) = (0.5 * (pair[1] - pair[0]), 0.5 * (pair[1] + pair[0]));
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let x = middle + half * node;
                lacking += half * weight * (chord.value(x) - self.chord) * x * x;
            }
        }
        self.chord + 3.0 * lacking
    }

    /// Density group `rho c R / m0 = gamma / (3 a)`, `a = 2 pi`, of the reference chord.
    pub fn density_chord(&self) -> f64 {
        self.lock_number / (3.0 * std::f64::consts::TAU)
    }

    /// Solidity `N_b c_T / (pi R)`, thrust-weighted ([`Self::thrust_weighted_chord`]).
    pub fn solidity(&self) -> f64 {
        self.blades as f64 * self.thrust_weighted_chord() / std::f64::consts::PI
    }

    /// Thrust coefficient `C_T = T / (rho pi R^2 (Omega R)^2)` of a thrust in `m0 Omega^2 R^2`.
    pub fn thrust_coefficient(&self, thrust: f64) -> f64 {
        thrust * self.chord / (std::f64::consts::PI * self.density_chord())
    }

    /// Thrust in `m0 Omega^2 R^2` of a thrust coefficient over solidity.
    pub fn thrust_of_loading(&self, ct_sigma: f64) -> f64 {
        let planform = self.thrust_weighted_chord() / self.chord;
        ct_sigma * self.blades as f64 * self.density_chord() * planform
    }

    /// Tangential speeds, tip speed, at which the section coefficients have a kink.
    pub(crate) fn speeds_with_kinks(&self) -> Vec<f64> {
        let tip_mach = self.compressible_tip_mach();
        let within = |mach: &f64| tip_mach > 0.0 && *mach > 0.0;
        let machs = self.section_model.mach_kinks().iter().copied().chain([MACH_LIMIT]);
        machs.filter(within).map(|mach| mach / tip_mach).collect()
    }

    /// Tip Mach number used for the sections, zero without compressibility.
    pub(crate) fn compressible_tip_mach(&self) -> f64 {
        match self.compressibility {
            Compressibility::None => 0.0,
            Compressibility::LocalMach { tip_mach } => tip_mach,
        }
    }
}

/// Pitch controls at the blade root, `theta = theta0 + theta1c cos psi + theta1s sin psi`, nose up
/// positive; `theta0` is the pitch at 0.75 R when the twist is zero there.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Controls {
    /// Collective, rad.
    pub theta0_rad: f64,
    /// Lateral cyclic, rad.
    pub theta1c_rad: f64,
    /// Longitudinal cyclic, rad.
    pub theta1s_rad: f64,
}

impl Controls {
    /// Pitch at the root at an azimuth, with higher harmonics beside the controls, rad.
    pub(crate) fn root_pitch(&self, higher_rad: &HarmonicSeries, azimuth_rad: f64) -> PitchMotion {
        let (sin, cos) = azimuth_rad.sin_cos();
        let (c, s) = (self.theta1c_rad, self.theta1s_rad);
        let [angle, rate, acceleration] = higher_rad.value_and_rates(azimuth_rad);
        PitchMotion {
            angle_rad: self.theta0_rad + c * cos + s * sin + angle,
            rate: s * cos - c * sin + rate,
            acceleration: -c * cos - s * sin + acceleration,
        }
    }
}

/// How finely the rotor is resolved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Discretisation {
    /// Beam elements of the blade.
    pub blade_elements: usize,
    /// Flap, lag and torsion modes.
    pub modes: [usize; 3],
    /// Natural modes, or the last of each family replaced by a static completion.
    pub basis: ModalBasis,
    /// Gauss points in each spanwise piece.
    pub span_points_per_piece: usize,
    /// Elements of the time discretisation.
    pub time_elements: usize,
    /// Polynomial order of the time elements.
    pub time_order: usize,
    /// Gauss points per time element.
    pub time_gauss_points: usize,
    /// Highest harmonic of the loads kept in results.
    pub load_harmonics: usize,
}

impl Discretisation {
    /// The paper's: ten beam elements, 4 flap, 4 lag and 2 torsion modes, eight time elements of order 5;
    /// the rest as by default.
    ///
    /// Source: S. R. Viswamurthy, R. Ganguli, Table 1.
    pub fn paper() -> Self {
        Self { modes: [4, 4, 2], ..Self::default() }
    }
}

impl Default for Discretisation {
    /// Ten beam elements, 5 flap, 4 lag and 2 torsion modes (a flap mode more than the paper, whose
    /// yawing moment at 4/rev is 1.5 % from that of many modes; so many has the paper's blade below 22 per
    /// rev), eight time elements of order 5, four spanwise points per piece, eight time points per element.
    fn default() -> Self {
        Self {
            blade_elements: 10,
            modes: [5, 4, 2],
            basis: ModalBasis::Natural,
            span_points_per_piece: 4,
            time_elements: 8,
            time_order: 5,
            time_gauss_points: 8,
            load_harmonics: 12,
        }
    }
}
