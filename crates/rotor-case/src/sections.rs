//! The sections of a case: the whole, structure, aerodynamics, inflow, numerics.
//!
//! Field names carry their unit; a name without unit is a pure number or a stiffness in the paper's
//! nondimensional form, as its unit says. Most defaults are the paper's values.

use super::field::{is_default, section, values};
use super::{
    ActuatorValues, ControlValues, FlapValues, FlightValues, FreeWakeValues, MeasuredFiles,
    RotorValues, TrimValues, UncertainField,
};
use flap_aero::{AirfoilSpan, AttachedFlowModel, StallAirfoil};
use rotor_base::RotorScales;
use rotor_fem::{ModalBasis, TwistAngle, Untwist};
use rotor_response::ReverseFlow;
use rotor_wake::{InflowModel, LinearInflow, PittPeters};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::Arc;

section! {
    /// A whole case: a rotor, its flight condition, its actuators and the control wanted.
    #[serde(deny_unknown_fields, default)]
    pub struct Case {
        /// One line about the case.
        pub title: String = "Untitled case: whatever the file leaves out is the paper rotor's".to_owned(),
            Any, "", "one line about the case";
        /// Advance ratio `mu = V cos(alpha_s) / (Omega R)`; 0 is hover.
        pub advance_ratio: f64 = 0.30,
            Within(0.0, 0.5), "", "the attached-flow rotor model ends at 0.5; 0 is hover";
        /// The rotor.
        pub rotor: RotorValues = RotorValues::default(), Any, "", "";
        /// Trailing-edge flaps, listed from root to tip.
        pub flaps: Vec<FlapValues> = vec![
            FlapValues { start_r: 0.70, end_r: 0.75, ..FlapValues::default() },
            FlapValues { start_r: 0.80, end_r: 0.85, ..FlapValues::default() },
        ], Any, "", "";
        /// Structural model of the blade.
        pub structure: StructureValues = StructureValues::default(), Any, "", "";
        /// Section aerodynamics.
        pub aerodynamics: AerodynamicsValues = AerodynamicsValues::default(), Any, "", "";
        /// Inflow.
        pub inflow: InflowValues = InflowValues::default(), Any, "", "";
        /// What the rotor is trimmed to.
        pub trim: TrimValues = TrimValues::default(), Any, "", "";
        /// Actuator of the flaps.
        pub actuator: ActuatorValues = ActuatorValues::default(), Any, "", "";
        /// Higher harmonic control.
        pub control: ControlValues = ControlValues::default(), Any, "", "";
        /// Discretisation of the periodic response.
        pub response: ResponseValues = ResponseValues::default(), Any, "", "";
        /// Tolerances of the solvers.
        pub tolerances: ToleranceValues = ToleranceValues::default(), Any, "", "";
        /// A flight in time, for `hhc fly`; `()` is one with every default.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub flight: Option<FlightValues> = None, Any, "", "";
        /// Measured data of the flight.
        #[serde(skip_serializing_if = "is_default")]
        pub measured: MeasuredFiles = MeasuredFiles::default(), Any, "", "";
        /// Inputs that are not known well, for `hhc diagnose`; left out, the usual ones of a rotor.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub uncertain: Vec<UncertainField> = vec![], Any, "", "";
    }
}

impl Case {
    /// Rotor speed, radius and mass per length that make loads nondimensional.
    pub fn scales(&self) -> RotorScales {
        let r = &self.rotor;
        RotorScales::of_checked(r.omega_rpm * TAU / 60.0, r.radius_m, r.mass_kg_m)
    }

    /// Hover tip Mach number `Omega R / a`.
    pub fn tip_mach(&self) -> f64 {
        self.scales().tip_speed_m_s() / self.aerodynamics.speed_of_sound_m_s
    }

    /// What a rotor at rest in trim, and its T, depend on; all else is as in a case that says nothing. Cases that are equal in
    /// this share both.
    #[must_use]
    pub fn of_rotor(&self) -> Self {
        let mut own = self.clone();
        (own.title, own.flight, own.uncertain, own.actuator, own.measured) = Default::default();
        let ControlValues { harmonics, t_step_deg, t_inflow, .. } = own.control;
        own.control = ControlValues { harmonics, t_step_deg, t_inflow, ..Default::default() };
        own
    }

    /// Step of the T matrix, V.
    pub fn t_step_volt(&self) -> f64 {
        let control = &self.control;
        control.t_step_deg * control.amplitude_volt / self.actuator.ideal_amplitude_deg
    }

    /// Frequency of a harmonic in the actuator's time, Hz: harmonic x `bench_rev_hz`.
    pub fn bench_frequency_hz(&self, harmonic: usize) -> f64 {
        harmonic as f64 * self.actuator.bench_rev_hz
    }
}

/// Which nonlinear terms the blade equations carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CouplingsChoice {
    /// Small deflections, flap and lag apart.
    Linear,
    /// Coriolis, foreshortening, propeller moment and pitch-flap-lag coupling.
    Full,
    /// Exact modal equations of the moderately deflected blade.
    Moderate,
}

section! {
    /// Structural model of the blade.
    #[serde(deny_unknown_fields, default)]
    pub struct StructureValues {
        /// Beam elements.
        pub elements: usize = 10, Count(2, 200), "", "the paper uses 10";
        /// Modes kept in the response.
        pub modes: ModeNumbers = ModeNumbers::default(), Any, "", "";
        /// Shapes of the modes. `Completed`: the last mode of each family is replaced by the static
        /// response of all modes left out, for root moments from curvature.
        #[serde(skip_serializing_if = "is_default")]
        pub basis: ModalBasis = ModalBasis::Natural, Any, "", "";
        /// Nonlinear terms of the blade equations. `Linear`: small deflections, flap and lag apart.
        /// `Full`: Coriolis, foreshortening, propeller moment, pitch-flap-lag coupling. `Moderate`: exact
        /// modal equations of moderate deflections.
        pub couplings: CouplingsChoice = CouplingsChoice::Full, Any, "", "";
        /// Moment of the tension on the built-in twist, `N k_A^2 th_x`; `couplings: Moderate` only.
        /// Some published formulations drop it; 4/rev loads then differ by a tenth (V-MOD-19).
        #[serde(skip_serializing_if = "is_default")]
        pub untwist: Untwist = Untwist::Included, Rule("`Neglected` with `couplings: Moderate` only"), "", "";
        /// Twist of a section; `couplings: Moderate` only. `Rotation`: bending in two planes twists it,
        /// `kappa_x = phi_x + w_x v_xx`. `Elastic`: `phi_x` alone (V-MOD-18).
        #[serde(skip_serializing_if = "is_default")]
        pub twist_angle: TwistAngle = TwistAngle::Rotation, Rule("`Elastic` with `couplings: Moderate` only"), "", "";
    }
}

section! {
    /// Number of modes of each kind. The paper keeps 4, 4, 2, with which the vibratory yawing moment has not
    /// converged (1.5 % off).
    #[serde(deny_unknown_fields, default)]
    pub struct ModeNumbers {
        /// Flap modes.
        pub flap: usize = 5, Rule("1 to twice `elements`"), "", "";
        /// Lag modes.
        pub lag: usize = 4, Rule("1 to twice `elements`"), "", "";
        /// Torsion modes.
        pub torsion: usize = 2, Rule("1 to twice `elements`"), "", "";
    }
}

impl ModeNumbers {
    /// Flap, lag and torsion modes.
    pub fn as_array(&self) -> [usize; 3] {
        [self.flap, self.lag, self.torsion]
    }
}

impl From<[usize; 3]> for ModeNumbers {
    fn from([flap, lag, torsion]: [usize; 3]) -> Self {
        Self { flap, lag, torsion }
    }
}

/// How the Mach number enters the sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CompressibilityChoice {
    /// Mach 0 everywhere.
    None,
    /// Local Mach number; a Prandtl-Glauert factor in the quasi-steady model.
    LocalMach,
}

section! {
    /// An aerofoil table along the span.
    #[serde(deny_unknown_fields)]
    pub struct AirfoilStation {
        /// Station; between two stations both tables are blended linearly.
        pub station_r: f64 = 0.0, Rule("0 to 1, each beyond the one before"), "R", "";
        /// C81 file, relative to the case file.
        pub table: String = String::new(), Any, "", "a C81 file, relative to the case file";
    }
}

/// Dynamic stall of the sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum DynamicStallChoice {
    /// None: without a table the flow stays attached, with one the stall is static.
    #[default]
    Off,
    /// Leishman and Beddoes with their constants of the NACA 0012, Mach 0.3 to 0.8.
    Naca0012,
    /// The same with constants fitted to measured loops of the NACA 0012, which they follow better.
    Naca0012Measured,
    /// With constants fitted to measured loops of the AMES-01.
    Ames01,
    /// With constants fitted to measured loops of the NACA 23012A, the section of the Bo 105.
    Naca23012a,
}

impl DynamicStallChoice {
    /// Whose constants; none without a stall.
    pub fn airfoil(self) -> Option<StallAirfoil> {
        match self {
            Self::Off => None,
            Self::Naca0012 => Some(StallAirfoil::Naca0012),
            Self::Naca0012Measured => Some(StallAirfoil::Naca0012Measured),
            Self::Ames01 => Some(StallAirfoil::Ames01),
            Self::Naca23012a => Some(StallAirfoil::Naca23012a),
        }
    }
}

values!(CouplingsChoice, CompressibilityChoice, DynamicStallChoice);

section! {
    /// Section aerodynamics.
    #[serde(deny_unknown_fields, default)]
    pub struct AerodynamicsValues {
        /// Section model. `QuasiSteady`: no lag, no apparent mass. `Incompressible`: Theodorsen, Mach 0.
        /// `HariharanLeishman`: a reconstruction of the published form. `Calibrated`: fitted to exact
        /// linear theory, for flap chords of 0.1 to 0.4.
        pub model: AttachedFlowModel = AttachedFlowModel::Calibrated, Any, "", "";
        /// Mach number of the sections; `Incompressible` needs `None`.
        pub compressibility: CompressibilityChoice = CompressibilityChoice::LocalMach, Any, "", "";
        /// Circulation at the edge of the reverse-flow region. `Gradual`: it passes through zero.
        /// `Abrupt`: it jumps as in small-angle theory, and converges slowly with the mesh.
        pub reverse_flow: ReverseFlow = ReverseFlow::Gradual, Any, "", "";
        /// Profile drag coefficient, where there is no table.
        pub drag_coefficient: f64 = 0.01, Within(0.0, 1.0), "", "0.01 is usual";
        /// Incidence of zero lift, nose up, where there is no table: below 0 of sections that are convex above.
        #[serde(skip_serializing_if = "is_default")]
        pub zero_lift_deg: f64 = 0.0, Within(-10.0, 10.0), "deg", "-1.3 is usual for a NACA 23012";
        /// Moment coefficient about the quarter chord at zero lift, nose up, where there is no table.
        #[serde(skip_serializing_if = "is_default")]
        pub zero_lift_moment: f64 = 0.0, Within(-0.3, 0.3), "", "-0.01 is usual for a NACA 23012";
        /// Speed of sound; the tip stays below Mach 0.95.
        pub speed_of_sound_m_s: f64 = 340.3, Rule("tip speed / 0.95 to 2000"), "m/s", "";
        /// Aerofoil tables (C81) from root to tip. They replace the linear static lift and moment and
        /// `drag_coefficient`; lags and flap stay those of `model`.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub airfoils: Vec<AirfoilStation> = vec![], Any, "", "";
        /// Dynamic stall: Leishman and Beddoes. `Naca0012`: with their constants. The others: with constants fitted to
        /// measured loops; incidences count from zero lift, camber is the matter of `airfoils`.
        #[serde(skip_serializing_if = "is_default")]
        pub dynamic_stall: DynamicStallChoice = DynamicStallChoice::Off, Any, "", "";
        /// Tip loss factor B: outboard of it a section has drag but no lift.
        #[serde(skip_serializing_if = "is_one")]
        pub tip_loss: f64 = 1.0, Rule("0.5, or the cut-out, to 1"), "R", "";
    }
    apart {
        /// The tables that `airfoils` names, put here by who has read them.
        pub tables: Option<Arc<AirfoilSpan>> = None;
    }
}

/// Whether a factor changes nothing: not written then.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
#[expect(clippy::float_cmp, reason = "one as it is written")]
fn is_one(factor: &f64) -> bool {
    *factor == 1.0
}

/// Inflow models.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(clippy::large_enum_variant, reason = "a case has one")]
pub enum InflowChoice {
    /// Glauert's momentum theory, uniform.
    Uniform,
    /// Momentum theory with Drees's gradients.
    Drees,
    /// A given uniform induced inflow.
    Prescribed {
        /// `lambda_i`, tip speed, positive down.
        lambda_i: f64,
    },
    /// Pitt and Peters: mean and gradients follow thrust and its first harmonics.
    PittPeters,
    /// The free wake of the rolled-up vortices, converged together with the trim.
    FreeWake(FreeWakeValues),
}

impl InflowChoice {
    /// The model; none of a free wake, which converges together with the trim.
    pub fn model(&self) -> Option<Arc<dyn InflowModel>> {
        Some(match *self {
            Self::Uniform => Arc::new(LinearInflow::Uniform),
            Self::Drees => Arc::new(LinearInflow::Drees),
            Self::Prescribed { lambda_i: induced_inflow } => {
                Arc::new(LinearInflow::Prescribed { induced_inflow })
            }
            Self::PittPeters => Arc::new(PittPeters),
            Self::FreeWake(_) => return None,
        })
    }

    /// The free wake; none of another inflow.
    pub fn free_wake(&self) -> Option<FreeWakeValues> {
        if let Self::FreeWake(values) = *self { Some(values) } else { None }
    }
}

values!(InflowChoice { FreeWake });

section! {
    /// Inflow.
    #[serde(deny_unknown_fields, default)]
    pub struct InflowValues {
        /// Inflow model. `Uniform`: Glauert. `Drees`: with gradients. `PittPeters`: mean and gradients follow
        /// thrust and hub moments. `Prescribed(lambda_i: 0.01)`: given, tip speed, -0.2 to 0.2, down
        /// positive. `FreeWake()`: converged together with the trim; control then works in the wake held
        /// still.
        pub model: InflowChoice = InflowChoice::Drees, Any, "", "";
    }
}

section! {
    /// Discretisation of the periodic response.
    #[serde(deny_unknown_fields, default)]
    pub struct ResponseValues {
        /// Finite elements in time over one revolution.
        pub time_elements: usize = 8, Count(4, 200), "", "the paper uses 8 elements of order 5";
        /// Polynomial order of the time elements.
        pub time_order: usize = 5, Count(2, 12), "", "the paper uses 8 elements of order 5";
        /// Gauss points per time element.
        pub time_gauss_points: usize = 8, Rule("`time_order` to 32"), "", "";
        /// Gauss points in each spanwise piece between element ends, cut-out and flap edges; pieces between
        /// cut-out and 0.5 R are halved.
        pub span_points_per_piece: usize = 4, Count(1, 16), "", "4 is usual";
        /// Highest harmonic of the loads kept in results.
        pub load_harmonics: usize = 12, Rule("number of blades to 64"), "", "";
        /// Stations at which the loads of the blade are given; left out: root, 0.25, 0.5 and 0.75; `[]` for
        /// none.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub load_stations_r: Option<Vec<f64>> = None, Rule("`root_offset_r` to 1, each once"), "R", "";
        /// Planes of constant `Y` (starboard of the hub positive) in which a free wake's tip vortices are given; left out:
        /// 0.4, 0.7, 0.85 and 0.97 on both sides; `[]` for none.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub vortex_planes_y_r: Option<Vec<f64>> = None, Rule("-1.5 to 1.5, each once"), "R", "";
    }
}

section! {
    /// Tolerances of the solvers, pure numbers in rotor units.
    #[serde(deny_unknown_fields, default)]
    pub struct ToleranceValues {
        /// Largest trim residual over the weight.
        pub trim: f64 = 1e-9, Within(1e-14, 1e-3), "", "tight enough to trust, loose enough for rounding: 1e-10 is usual";
        /// Newton iterations of the trim.
        pub trim_iterations: usize = 40, Count(1, 10_000), "", "40 to 60 is usual";
        /// Largest weak residual of the periodic orbit.
        pub periodicity: f64 = 1e-11, Within(1e-14, 1e-3), "", "tight enough to trust, loose enough for rounding: 1e-10 is usual";
        /// Largest mismatch of the inflow, over the tip speed.
        pub inflow: f64 = 1e-10, Within(1e-14, 1e-3), "", "tight enough to trust, loose enough for rounding: 1e-10 is usual";
        /// Inflow iterations.
        pub inflow_iterations: usize = 60, Count(1, 10_000), "", "40 to 60 is usual";
    }
}
