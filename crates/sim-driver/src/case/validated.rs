//! The validated case: plain values in radians and rotor units, handed down to the models.

use super::{
    BasisChoice, BladeTablesFile, CompressibilityChoice, ControlActuator, ControllerChoice,
    CouplingsChoice, DynamicStallChoice, EffortChoice, FlapMassChoice, GravityChoice,
    HorizontalTailFile, InflowChoice, LoadScaleChoice, LoadWeightsFile, ResponseFile,
    ReverseFlowChoice, RootFile, SectionModelChoice, StrokeChoice, TInflowChoice, TolerancesFile,
    TwistAngleChoice, UnlikeBladeFile, UntwistChoice,
};
use crate::files::Folder;
use flap_aero::AirfoilSpan;
use rotor_base::RotorScales;
use std::sync::Arc;

/// A case whose every value is in range.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// One line about the case.
    pub title: String,
    /// Advance ratio `mu = V cos(alpha_s) / (Omega R)`, 0 to 0.5.
    pub advance_ratio: f64,
    /// Rotor speed, radius and mass per length that make loads nondimensional.
    pub scales: RotorScales,
    /// Number of blades.
    pub blades: usize,
    /// Chord over radius.
    pub chord: f64,
    /// Lock number; the air density follows from it (`a = 2 pi`).
    pub lock_number: f64,
    /// The blade.
    pub blade: BladeValues,
    /// Trailing-edge flaps from root to tip.
    pub flaps: Vec<FlapValues>,
    /// Section aerodynamics.
    pub section: SectionValues,
    /// Inflow model.
    pub inflow: InflowChoice,
    /// What the rotor is trimmed to.
    pub trim: TrimValues,
    /// Actuator of the flaps.
    pub actuator: ActuatorValues,
    /// Higher harmonic control.
    pub control: ControlValues,
    /// Discretisation of the response, counts in range.
    pub response: ResponseFile,
    /// Tolerances, positive.
    pub tolerances: TolerancesFile,
}

impl Case {
    /// Hover tip Mach number `Omega R / a`.
    pub fn tip_mach(&self) -> f64 {
        self.scales.tip_speed_m_s() / self.section.speed_of_sound_m_s
    }

    /// Frequency of a harmonic in the actuator's time, Hz: harmonic x `bench_rev_hz`.
    pub fn bench_frequency_hz(&self, harmonic: usize) -> f64 {
        harmonic as f64 * self.actuator.bench_rev_hz
    }
}

/// A blade. Stiffness in `m0 Omega^2 R^4` (`ea` in `m0 Omega^2 R^2`), lengths in R.
#[derive(Debug, Clone, PartialEq)]
pub struct BladeValues {
    /// Flap bending stiffness.
    pub ei_flap: f64,
    /// Lag bending stiffness.
    pub ei_lag: f64,
    /// Torsion stiffness.
    pub gj: f64,
    /// Axial stiffness.
    pub ea: f64,
    /// Mass radius of gyration about the chord line.
    pub km1: f64,
    /// Mass radius of gyration about the normal to the chord.
    pub km2: f64,
    /// Area radius of gyration.
    pub ka: f64,
    /// Linear twist from root to tip, rad, zero at 0.75 R.
    pub twist_rad: f64,
    /// Precone, rad.
    pub precone_rad: f64,
    /// Aerodynamic root cut-out.
    pub root_cutout: f64,
    /// Damping of every mode over critical.
    pub modal_damping: f64,
    /// Beam elements.
    pub elements: usize,
    /// Flap, lag and torsion modes.
    pub modes: [usize; 3],
    /// The shapes behind them.
    pub basis: BasisChoice,
    /// Terms of the equations.
    pub couplings: CouplingsChoice,
    /// Tension on the built-in twist, of `Moderate`.
    pub untwist: UntwistChoice,
    /// The twist angle, of `Moderate`.
    pub twist_angle: TwistAngleChoice,
    /// Radial station of the root.
    pub root_offset: f64,
    /// How the root is held.
    pub root: RootFile,
    /// Mass centre ahead of the elastic axis.
    pub mass_centre: f64,
    /// Tension centre ahead of the elastic axis.
    pub tension_centre: f64,
    /// Aerodynamic centre ahead of the elastic axis.
    pub aerodynamic_centre: f64,
    /// Axis of the blade ahead of the rotor centre.
    pub torque_offset: f64,
    /// Weight of the blades.
    pub gravity: GravityChoice,
    /// Values along the span in place of uniform ones, as in the file.
    pub tables: BladeTablesFile,
    /// Blades unlike the rest.
    pub unlike: Vec<UnlikeBladeFile>,
}

/// A trailing-edge flap. Lengths in R or chords as named.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlapValues {
    /// Inboard edge, R.
    pub start: f64,
    /// Outboard edge, R.
    pub end: f64,
    /// Flap chord over blade chord.
    pub chord_fraction: f64,
    /// Flap mass per length over `m0`.
    pub mass_fraction: f64,
    /// Centre of gravity behind the hinge over the flap chord.
    pub cg_fraction: f64,
    /// Radius of gyration about the hinge over the flap chord.
    pub gyration_fraction: Option<f64>,
    /// Whether the blade's mass contains the flap's.
    pub mass: FlapMassChoice,
    /// Factors on lift, moment and hinge moment.
    pub effectiveness: [f64; 3],
}

/// Section aerodynamics.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionValues {
    /// Section model.
    pub model: SectionModelChoice,
    /// Mach number.
    pub compressibility: CompressibilityChoice,
    /// Circulation at the edge of the reverse-flow region.
    pub reverse_flow: ReverseFlowChoice,
    /// Profile drag coefficient.
    pub drag_coefficient: f64,
    /// Speed of sound, m/s.
    pub speed_of_sound_m_s: f64,
    /// Aerofoil tables along the span, stations in R.
    pub airfoils: Option<Arc<AirfoilSpan>>,
    /// Dynamic stall.
    pub dynamic_stall: DynamicStallChoice,
    /// Tip loss factor, R.
    pub tip_loss: f64,
}

/// What the rotor is trimmed to. Lengths in R, angles in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrimValues {
    /// Level flight, six equations.
    Propulsive {
        /// Weight as `C_W / sigma`.
        ct_sigma: f64,
        /// Drag area over disk area.
        drag_area: f64,
        /// Centre of gravity below the hub.
        cg_below_hub: f64,
        /// Hub behind the centre of gravity.
        hub_aft_of_cg: f64,
        /// Hub to starboard of the centre of gravity.
        hub_starboard_of_cg: f64,
        /// Tail rotor behind the centre of gravity.
        tail_rotor_arm: f64,
        /// Tail rotor above the centre of gravity.
        tail_rotor_height: f64,
        /// Horizontal tail, as in the file.
        horizontal_tail: HorizontalTailFile,
    },
    /// Thrust and zero hub moments.
    WindTunnel {
        /// Thrust as `C_T / sigma`.
        ct_sigma: f64,
        /// Shaft tilt, rad, forward positive.
        shaft_tilt_rad: f64,
    },
    /// Given controls.
    Prescribed {
        /// Collective at 0.75 R, rad.
        theta0_rad: f64,
        /// Lateral cyclic, rad.
        theta1c_rad: f64,
        /// Longitudinal cyclic, rad.
        theta1s_rad: f64,
        /// Shaft tilt, rad, forward positive.
        shaft_tilt_rad: f64,
    },
}

/// Where the actuator model comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum ActuatorSource {
    /// The ideal linear actuator alone.
    Ideal,
    /// Bench data folder.
    Bench(Folder),
    /// Stored actuator file: its folder and name.
    Stored {
        /// Folder of the file.
        folder: Folder,
        /// File name, folders included.
        file: String,
    },
}

/// Actuator of the flaps.
#[derive(Debug, Clone, PartialEq)]
pub struct ActuatorValues {
    /// Where the model comes from.
    pub source: ActuatorSource,
    /// Flap amplitude of the ideal linear actuator at full-scale voltage, deg.
    pub ideal_amplitude_deg: f64,
    /// Revolutions per second that one second of the bench stands for.
    pub bench_rev_hz: f64,
    /// Voltages the actuator may see, V: lower and upper limit.
    pub range_volt: (f64, f64),
}

/// Higher harmonic control.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlValues {
    /// Sets of harmonics per rev, each controlled on its own.
    pub harmonics: Vec<Vec<usize>>,
    /// Actuators, each with every set.
    pub actuators: Vec<ControlActuator>,
    /// Bias of the full-scale voltage, V.
    pub bias_volt: f64,
    /// Amplitude of the full-scale voltage, V.
    pub amplitude_volt: f64,
    /// Quasi-static flap angle of the T-matrix step, deg.
    pub t_step_deg: f64,
    /// Stroke limit.
    pub stroke_limit: StrokeChoice,
    /// Weights of the loads.
    pub load_weights: LoadWeightsFile,
    /// What the weights multiply.
    pub load_scale: LoadScaleChoice,
    /// Weight of the effort.
    pub effort: EffortChoice,
    /// What the controller of the real actuator knows of T.
    pub controller: ControllerChoice,
    /// Inflow in the T of the linearised rotor.
    pub t_inflow: TInflowChoice,
    /// Largest mean power that the actuators of one blade give, W.
    pub power_limit_watt: Option<f64>,
    /// Weight of that power in the cost, per W.
    pub power_weight_per_watt: f64,
    /// Control steps allowed.
    pub max_steps: usize,
    /// Relative change of the voltages at which the control has settled.
    pub step_tolerance: f64,
}
