//! The case file as users write it: trim, actuator and control.

use serde::{Deserialize, Serialize};

/// What the rotor is trimmed to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum TrimFile {
    /// Level flight of the helicopter: six equations.
    Propulsive(PropulsiveTrimFile),
    /// Thrust and zero hub moments at a given shaft tilt: three equations.
    WindTunnel(WindTunnelTrimFile),
    /// Controls are given, nothing is solved.
    Prescribed(PrescribedTrimFile),
}

impl Default for TrimFile {
    fn default() -> Self {
        Self::Propulsive(PropulsiveTrimFile::default())
    }
}

/// Level flight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PropulsiveTrimFile {
    /// Weight as `C_W / sigma`.
    pub ct_sigma: f64,
    /// Flat-plate drag area of the fuselage over the disk area, `f/A`.
    pub drag_area: f64,
    /// Centre of gravity below the hub, radius R.
    pub cg_below_hub_r: f64,
    /// Hub behind the centre of gravity, radius R.
    pub hub_aft_of_cg_r: f64,
    /// Hub to starboard of the centre of gravity, radius R.
    pub hub_starboard_of_cg_r: f64,
    /// Tail rotor behind the centre of gravity, radius R.
    pub tail_rotor_arm_r: f64,
    /// Tail rotor above the centre of gravity, radius R.
    pub tail_rotor_height_r: f64,
    /// Horizontal tail; none of area by default.
    #[serde(skip_serializing_if = "HorizontalTailFile::is_none")]
    pub horizontal_tail: HorizontalTailFile,
}

/// A horizontal tail in the undisturbed stream.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HorizontalTailFile {
    /// Area over the disk area.
    pub area: f64,
    /// Behind the centre of gravity, radius R.
    pub arm_r: f64,
    /// Above the centre of gravity, radius R.
    pub height_r: f64,
    /// Incidence against the plane normal to the shaft, deg, nose up positive.
    pub incidence_deg: f64,
    /// Lift slope, per rad.
    pub lift_slope: f64,
}

impl Default for HorizontalTailFile {
    fn default() -> Self {
        Self { area: 0.0, arm_r: 1.2, height_r: 0.0, incidence_deg: 0.0, lift_slope: 4.0 }
    }
}

impl HorizontalTailFile {
    /// Whether there is none: not written then.
    fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

impl Default for PropulsiveTrimFile {
    fn default() -> Self {
        Self {
            ct_sigma: 0.07,
            drag_area: 0.01,
            cg_below_hub_r: 0.2,
            hub_aft_of_cg_r: 0.0,
            hub_starboard_of_cg_r: 0.0,
            tail_rotor_arm_r: 1.2,
            tail_rotor_height_r: 0.2,
            horizontal_tail: HorizontalTailFile::default(),
        }
    }
}

/// Moment trim in the wind tunnel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WindTunnelTrimFile {
    /// Thrust as `C_T / sigma`.
    pub ct_sigma: f64,
    /// Shaft tilt, deg, forward positive.
    pub shaft_tilt_deg: f64,
}

impl Default for WindTunnelTrimFile {
    fn default() -> Self {
        Self { ct_sigma: 0.07, shaft_tilt_deg: 5.0 }
    }
}

/// Given controls.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PrescribedTrimFile {
    /// Collective at 0.75 R, deg.
    pub theta0_deg: f64,
    /// Lateral cyclic, deg.
    pub theta1c_deg: f64,
    /// Longitudinal cyclic, deg.
    pub theta1s_deg: f64,
    /// Shaft tilt, deg, forward positive.
    pub shaft_tilt_deg: f64,
}

/// Where the actuator model comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ActuatorChoice {
    /// The ideal linear actuator alone: no bench, no hysteresis.
    Ideal,
    /// Identified from bench data when the case is run.
    Bench(BenchFile),
    /// An actuator file written by `hhc identify`.
    File(StoredActuatorFile),
}

/// Name of the data set inside the program.
pub(super) const SHIPPED_DATASET: &str = "shipped:apa500l_synthetic";

/// A bench data folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BenchFile {
    /// Folder of `dataset.ron`, relative to the case file; `shipped:apa500l_synthetic` is the one
    /// inside the program.
    pub dataset: String,
}

impl Default for BenchFile {
    fn default() -> Self {
        Self { dataset: SHIPPED_DATASET.to_owned() }
    }
}

/// A stored actuator model.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StoredActuatorFile {
    /// File written by `hhc identify`, relative to the case file.
    pub path: String,
}

/// Actuator of the flaps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ActuatorFile {
    /// The model.
    pub model: ActuatorChoice,
    /// Flap amplitude of the ideal linear actuator at full-scale voltage, deg.
    pub ideal_amplitude_deg: f64,
    /// Revolutions per second that one second of the bench stands for.
    pub bench_rev_hz: f64,
    /// Voltages the actuator may see, V, lower limit first.
    #[serde(rename = "range_V")]
    pub range_volt: (f64, f64),
}

impl Default for ActuatorFile {
    fn default() -> Self {
        Self {
            model: ActuatorChoice::Bench(BenchFile::default()),
            ideal_amplitude_deg: 10.0,
            bench_rev_hz: 5.0,
            range_volt: (-20.0, 150.0),
        }
    }
}

/// How an actuator takes part in a control study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ControlActuator {
    /// Ideal linear actuator.
    Ideal,
    /// The ideal actuator's optimal voltage applied to the real one.
    Ignored,
    /// Feedback to convergence on the real one.
    Hysteretic,
    /// The ideal actuator's optimal flap motion, made by the real one under the voltage that an inverse
    /// of its model gives.
    Inverse,
}

impl ControlActuator {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ideal => "ideal",
            Self::Ignored => "ignored",
            Self::Hysteretic => "hysteretic",
            Self::Inverse => "inverse",
        }
    }
}

/// Stroke limit of a flap.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum StrokeChoice {
    /// The amplitude the actuator reaches at full scale at the frequency of the harmonic.
    FromActuator,
    /// A given amplitude.
    Given {
        /// Amplitude, deg.
        amplitude_deg: f64,
    },
}

/// Weight of the control effort, `W_u = rho I`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum EffortChoice {
    /// `rho` such that the larger flap amplitude meets the stroke limit; 0 if it stays below.
    MeetStroke,
    /// None: the optimum within the stroke of every flap at every harmonic and the range of the total
    /// voltage, by a cone program at every step.
    Limits,
    /// A given `rho`, per V^2.
    Given {
        /// `rho`, 1/V^2 on nondimensional loads.
        rho: f64,
    },
}

/// What the controller of the real actuator knows of T. That of the ideal actuator is constant: it is
/// the same everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ControllerChoice {
    /// T0 about zero control, held: the paper's.
    #[default]
    Global,
    /// T about the present control, from the linearised rotor and the actuator's own tangent.
    Local,
    /// T followed by a filter on the measured pairs.
    Adaptive,
}

/// The inflow in the T of the linearised rotor: that of the local controller and of the forecasts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum TInflowChoice {
    /// Settles on the moved loading, as it does in every measured response; a free wake keeps its geometry.
    #[default]
    Settled,
    /// Stays as it is in trim: a wake slower than the controller.
    Frozen,
    /// The geometry of the free wake converges anew as well, at the controlled harmonics: by central
    /// differences. In the other inflows the same as `Settled`.
    Reconverged,
}

/// What the load weights multiply.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum LoadScaleChoice {
    /// The nondimensional loads.
    #[default]
    Nondimensional,
    /// Each load over its own amplitude without control.
    Baseline,
}

/// Weights of the six hub loads in `W_Z`, on nondimensional loads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LoadWeightsFile {
    /// Longitudinal force.
    pub fx: f64,
    /// Lateral force.
    pub fy: f64,
    /// Vertical force.
    pub fz: f64,
    /// Rolling moment.
    pub mx: f64,
    /// Pitching moment.
    pub my: f64,
    /// Yawing moment.
    pub mz: f64,
}

impl Default for LoadWeightsFile {
    fn default() -> Self {
        Self { fx: 1.0, fy: 1.0, fz: 1.0, mx: 1.0, my: 1.0, mz: 1.0 }
    }
}

/// Higher harmonic control.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ControlFile {
    /// Sets of harmonics per rev, each controlled on its own.
    pub harmonics: Vec<Vec<usize>>,
    /// Actuators, each with every set of harmonics.
    pub actuators: Vec<ControlActuator>,
    /// Full-scale voltage: bias, V.
    #[serde(rename = "bias_V")]
    pub bias_volt: f64,
    /// Full-scale voltage: amplitude, V.
    #[serde(rename = "amplitude_V")]
    pub amplitude_volt: f64,
    /// Step of the T matrix: the voltage that gives this flap angle quasi-statically, deg.
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
    #[serde(skip_serializing_if = "inflow_settles")]
    pub t_inflow: TInflowChoice,
    /// Largest mean power that the actuators of one blade give, none taken back, W; with `effort: Limits`.
    #[serde(rename = "power_limit_W", skip_serializing_if = "Option::is_none")]
    pub power_limit_watt: Option<f64>,
    /// Weight of that power in the cost, per W of one blade, on nondimensional loads squared.
    #[serde(rename = "power_weight_per_W", skip_serializing_if = "is_zero")]
    pub power_weight_per_watt: f64,
    /// Control steps allowed.
    pub max_steps: usize,
    /// Relative change of the voltages at which the control has settled.
    pub step_tolerance: f64,
}

/// Whether the inflow of T is left out of a written case.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "the form that serde asks for")]
fn inflow_settles(choice: &TInflowChoice) -> bool {
    *choice == TInflowChoice::Settled
}

/// Whether a weight is left out of a written case.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "the form that serde asks for")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Default for ControlFile {
    fn default() -> Self {
        Self {
            harmonics: vec![vec![2], vec![3], vec![4]],
            actuators: vec![
                ControlActuator::Ideal,
                ControlActuator::Ignored,
                ControlActuator::Hysteretic,
            ],
            bias_volt: 65.0,
            amplitude_volt: 85.0,
            t_step_deg: 0.5,
            stroke_limit: StrokeChoice::FromActuator,
            load_weights: LoadWeightsFile::default(),
            load_scale: LoadScaleChoice::default(),
            effort: EffortChoice::MeetStroke,
            controller: ControllerChoice::default(),
            t_inflow: TInflowChoice::default(),
            power_limit_watt: None,
            power_weight_per_watt: 0.0,
            max_steps: 40,
            step_tolerance: 1e-4,
        }
    }
}
