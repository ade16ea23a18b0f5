//! The sections of a case: trim, actuator and control.

use super::HandedT;
use super::field::{Value, is_default, section, values, variant_names};
use crate::Bias;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What the rotor is trimmed to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum TrimValues {
    /// Level flight of the helicopter: six equations.
    Propulsive(PropulsiveTrim),
    /// Thrust and hub moments at a given shaft tilt: three equations.
    WindTunnel(WindTunnelTrim),
    /// Controls are given, nothing is solved.
    Prescribed(PrescribedTrim),
}

impl Default for TrimValues {
    fn default() -> Self {
        Self::Propulsive(PropulsiveTrim::default())
    }
}

impl TrimValues {
    /// Thrust or weight over solidity that is trimmed to; none where controls are given.
    pub fn ct_sigma(&self) -> Option<f64> {
        match self {
            Self::Propulsive(p) => Some(p.ct_sigma),
            Self::WindTunnel(w) => Some(w.ct_sigma),
            Self::Prescribed(_) => None,
        }
    }

    /// Collective of given controls, rad; 0 where the trim finds it.
    pub fn collective_rad(&self) -> f64 {
        match self {
            Self::Prescribed(p) => p.theta0_deg.to_radians(),
            Self::Propulsive(_) | Self::WindTunnel(_) => 0.0,
        }
    }

    /// Path of the field that sets the thrust.
    pub fn loading_field(&self) -> &'static str {
        match self {
            Self::Prescribed(_) => "trim.theta0_deg",
            Self::Propulsive(_) | Self::WindTunnel(_) => "trim.ct_sigma",
        }
    }
}

section! {
    /// `trim: Propulsive(...)`: level flight, six equations. Lengths are in the frame of the hub.
    #[serde(deny_unknown_fields, default)]
    pub struct PropulsiveTrim {
        /// Weight as `C_W / sigma`.
        pub ct_sigma: f64 = 0.07, Within(1e-3, 0.5), "", "the paper's rotor has 0.07; beyond 0.5 no blade lifts";
        /// Flat-plate drag area of the fuselage over the disk area, `f/A`.
        pub drag_area: f64 = 0.01, Within(0.0, 1.0), "", "0.01 disk areas is usual";
        /// Centre of gravity below the hub.
        pub cg_below_hub_r: f64 = 0.2, Within(0.0, 2.0), "R", "0.2 R is usual";
        /// Hub behind the centre of gravity.
        pub hub_aft_of_cg_r: f64 = 0.0, Within(-1.0, 1.0), "R", "aft is positive";
        /// Hub to starboard of the centre of gravity.
        pub hub_starboard_of_cg_r: f64 = 0.0, Within(-1.0, 1.0), "R", "starboard is positive";
        /// Tail rotor behind the centre of gravity.
        pub tail_rotor_arm_r: f64 = 1.2, Within(0.1, 5.0), "R", "1.2 R is usual";
        /// Tail rotor above the centre of gravity.
        pub tail_rotor_height_r: f64 = 0.2, Within(-2.0, 2.0), "R", "above the centre of gravity is positive";
        /// Horizontal tail; without area by default.
        #[serde(skip_serializing_if = "is_default")]
        pub horizontal_tail: HorizontalTailValues = HorizontalTailValues::default(), Any, "", "";
    }
}

section! {
    /// A horizontal tail in the undisturbed stream.
    #[derive(Copy)]
    #[serde(deny_unknown_fields, default)]
    pub struct HorizontalTailValues {
        /// Area over the disk area; 0 is none.
        pub area: f64 = 0.0, Within(0.0, 0.2), "", "0.01 disk areas is usual; 0 is none";
        /// Behind the centre of gravity.
        pub arm_r: f64 = 1.2, Within(-5.0, 5.0), "R", "1.2 R is usual";
        /// Above the centre of gravity.
        pub height_r: f64 = 0.0, Within(-2.0, 2.0), "R", "above the centre of gravity is positive";
        /// Incidence against the plane normal to the shaft, nose up positive.
        pub incidence_deg: f64 = 0.0, Within(-28.0, 28.0), "deg",
            "nose up is positive; the tail does not stall in this model";
        /// Lift slope.
        pub lift_slope: f64 = 4.0, Within(0.0, 10.0), "1/rad", "4 is usual";
    }
}

section! {
    /// `trim: WindTunnel(...)`: thrust and hub moments at a given shaft tilt, three equations.
    #[serde(deny_unknown_fields, default)]
    pub struct WindTunnelTrim {
        /// Thrust as `C_T / sigma`.
        pub ct_sigma: f64 = 0.07, Within(1e-3, 0.5), "", "the paper's rotor has 0.07; beyond 0.5 no blade lifts";
        /// Shaft tilt, forward positive.
        pub shaft_tilt_deg: f64 = 5.0, Within(-45.0, 45.0), "deg", "forward tilt is positive; 5 deg is usual at mu 0.3";
        /// Mean moment of all blades on the hub about the aft axis, starboard side up positive.
        #[serde(skip_serializing_if = "is_default")]
        pub hub_mx_n_m: f64 = 0.0, Within(-1e6, 1e6), "N m", "0 is usual";
        /// The same about the starboard axis, nose up positive.
        #[serde(skip_serializing_if = "is_default")]
        pub hub_my_n_m: f64 = 0.0, Within(-1e6, 1e6), "N m", "0 is usual";
    }
}

section! {
    /// `trim: Prescribed(...)`: given controls, nothing is solved.
    #[serde(deny_unknown_fields, default)]
    pub struct PrescribedTrim {
        /// Collective at 0.75 R.
        pub theta0_deg: f64 = 0.0, Within(-34.0, 34.0), "deg", "the linear section models mean nothing beyond";
        /// Lateral cyclic.
        pub theta1c_deg: f64 = 0.0, Within(-34.0, 34.0), "deg", "the linear section models mean nothing beyond";
        /// Longitudinal cyclic.
        pub theta1s_deg: f64 = 0.0, Within(-34.0, 34.0), "deg", "the linear section models mean nothing beyond";
        /// Shaft tilt, forward positive.
        pub shaft_tilt_deg: f64 = 0.0, Within(-45.0, 45.0), "deg", "forward tilt is positive; 5 deg is usual at mu 0.3";
    }
}

values!(TrimValues { Propulsive, WindTunnel, Prescribed }, ActuatorChoice { Bench, File });

/// Where the actuator model comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ActuatorChoice {
    /// The ideal linear actuator alone: no bench, no hysteresis.
    Ideal,
    /// Identified from bench data when the case is run.
    Bench(BenchFolder),
    /// An actuator file written by `hhc identify`.
    File(ActuatorPath),
}

section! {
    /// `model: Bench(...)`: identified from bench data when the case is run.
    #[serde(deny_unknown_fields, default)]
    pub struct BenchFolder {
        /// Folder of `dataset.ron`, relative to the case file; `shipped:apa500l_synthetic` is the one inside
        /// the program.
        pub dataset: String = "shipped:apa500l_synthetic".to_owned(), Any, "",
            "the folder of dataset.ron, relative to the case file";
    }
}

section! {
    /// `model: File(...)`: a stored actuator.
    #[serde(deny_unknown_fields, default)]
    pub struct ActuatorPath {
        /// File written by `hhc identify`, relative to the case file.
        pub path: String = String::new(), Any, "",
            "a file written by `hhc identify`, relative to the case file";
    }
}

section! {
    /// Actuator of the flaps.
    #[serde(deny_unknown_fields, default)]
    pub struct ActuatorValues {
        /// The model: the ideal linear one alone, one identified from a bench data folder,
        /// `Bench(dataset: "DIR")`, or a stored one, `File(path: "ACTUATOR.ron")`; paths relative to the case.
        pub model: ActuatorChoice = ActuatorChoice::Bench(BenchFolder::default()), Any, "", "";
        /// Flap amplitude of the ideal linear actuator at full-scale voltage.
        pub ideal_amplitude_deg: f64 = 10.0, Within(1e-3, 45.0), "deg",
            "flap amplitude at full-scale voltage; the paper's gain gives 10 deg";
        /// Revolutions of the rotor that one second of the bench stands for.
        pub bench_rev_hz: f64 = 5.0, Within(1e-3, 1e3), "rev/s",
            "the paper's figures use 5 rev/s, its rotor turns 6.383 rev/s";
        /// Voltages the actuator may see, lower limit first.
        pub range_volt as "range_V": (f64, f64) = (-20.0, 150.0), Rule("lower, upper limit"), "V", "";
        /// Capacitance of the piezo that drives one flap of one blade, small signal, of its data sheet; several stacks in
        /// parallel add up. Left out, no electrical power is given.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub capacitance_microfarad as "capacitance_uF": Option<f64> = None, Within(1e-6, 1e6), "uF",
            "small signal, of the data sheet of the stack; leave it out where it is not known";
        /// Blocked force of that actuator over the whole range of voltages, of its data sheet; with `free_stroke_um`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub blocked_force_newton as "blocked_force_N": Option<f64> = None, Within(1e-3, 1e6), "N",
            "of the data sheet of the actuator; leave it out where it is not known";
        /// Free stroke of that actuator over the whole range of voltages, of its data sheet; with `blocked_force_N`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub free_stroke_um: Option<f64> = None, Within(1e-3, 1e5), "um",
            "of the data sheet of the actuator; leave it out where it is not known";
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

/// Bias voltage of the actuators.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum BiasChoice {
    /// Solved so that the mean flap angle vanishes.
    #[default]
    Centred,
    /// Held at this voltage, V: the mean flap angle follows.
    Fixed(f64),
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

values!(
    ControlActuator,
    StrokeChoice,
    BiasChoice,
    EffortChoice,
    ControllerChoice,
    TInflowChoice,
    LoadScaleChoice,
);

impl Value for Vec<ControlActuator> {
    fn choices() -> &'static [&'static str] {
        variant_names::<ControlActuator>()
    }
}

section! {
    /// Weights of the six hub loads in `W_Z`.
    #[serde(deny_unknown_fields, default)]
    pub struct LoadWeights {
        /// Longitudinal force.
        pub fx: f64 = 1.0, Within(0.0, 1e12), "", "1 is the paper's identity weight";
        /// Lateral force.
        pub fy: f64 = 1.0, Within(0.0, 1e12), "", "1 is the paper's identity weight";
        /// Vertical force.
        pub fz: f64 = 1.0, Within(0.0, 1e12), "", "1 is the paper's identity weight";
        /// Rolling moment.
        pub mx: f64 = 1.0, Within(0.0, 1e12), "", "1 is the paper's identity weight";
        /// Pitching moment.
        pub my: f64 = 1.0, Within(0.0, 1e12), "", "1 is the paper's identity weight";
        /// Yawing moment.
        pub mz: f64 = 1.0, Within(0.0, 1e12), "", "1 is the paper's identity weight";
    }
}

section! {
    /// Higher harmonic control.
    #[serde(deny_unknown_fields, default)]
    pub struct ControlValues {
        /// Sets of harmonics per rev, each controlled on its own.
        pub harmonics: Vec<Vec<usize>> = vec![vec![2], vec![3], vec![4]], Rule("1 to 12, each once in a set"), "1/rev", "";
        /// Actuators, each with every set of harmonics. `Ignored`: the ideal actuator's voltage on the real
        /// one. `Hysteretic`: feedback on the real one. `Inverse`: the ideal actuator's flap motion, made by
        /// the real one. Left out with `model: Ideal`: `Ideal` alone.
        pub actuators: Vec<ControlActuator> = vec![
            ControlActuator::Ideal,
            ControlActuator::Ignored,
            ControlActuator::Hysteretic,
        ], Any, "", "";
        /// Bias of the real actuator. `Centred`: solved so that the mean flap angle vanishes. `Fixed(65)`: held by the
        /// amplifier at this voltage, V, for the ideal actuator too; the mean flap angle follows, `bias_V` is left out.
        #[serde(skip_serializing_if = "is_default")]
        pub bias: BiasChoice = BiasChoice::Centred, Any, "", "";
        /// Bias of the ideal actuator, and where the search for that of the real one starts, which centres its flap; bias and amplitude stay inside `actuator.range_V`.
        pub bias_volt as "bias_V": f64 = 65.0, Rule("inside `range_V`"), "V", "";
        /// Full-scale voltage: amplitude.
        pub amplitude_volt as "amplitude_V": f64 = 85.0, UpTo(f64::MAX), "V", "full scale is 85 V about 65 V";
        /// Step of the T matrix: the voltage that gives this flap angle quasi-statically.
        pub t_step_deg: f64 = 0.5, Within(1e-3, 10.0), "deg", "0.5 deg is usual";
        /// Stroke limit of every flap at every harmonic: the amplitude that the actuator reaches at full
        /// scale, or `Given(amplitude_deg: 4)`, 0.001 to 45 deg, which holds for the motion of the
        /// hysteretic flap itself.
        pub stroke_limit: StrokeChoice = StrokeChoice::FromActuator, Any, "", "";
        /// Weights of the loads, `W_Z`.
        pub load_weights: LoadWeights = LoadWeights::default(), Any, "", "";
        /// What `W_Z` weights: the nondimensional loads, or each load over its amplitude without control.
        pub load_scale: LoadScaleChoice = LoadScaleChoice::Nondimensional, Any, "", "";
        /// Weight of the control effort, `W_u = rho I`. `MeetStroke`: `rho` such that the larger flap
        /// amplitude meets the stroke limit; with `controller: Global` only. `Given(rho: 0)`: 0 to 1e6 per
        /// V^2. `Limits`: no weight but the optimum within stroke and voltage range, by a cone program.
        pub effort: EffortChoice = EffortChoice::MeetStroke, Any, "", "";
        /// What is known of T on the real actuator. `Global`: the paper's constant T0, identified again only
        /// where it leads nowhere. `Local`: T about the present control, from the linearised rotor.
        /// `Adaptive`: T followed by a filter on the measured pairs.
        pub controller: ControllerChoice = ControllerChoice::Global, Any, "", "";
        /// Inflow in the T of the linearised rotor, which `Local` and the forecasts use. `Settled`: follows
        /// the moved loading with the geometry of a free wake held. `Frozen`: stays as trimmed.
        /// `Reconverged`: the geometry of the free wake converges anew in the forecasts (seconds per
        /// harmonic); loops then use `Settled`.
        #[serde(skip_serializing_if = "is_default")]
        pub t_inflow: TInflowChoice = TInflowChoice::Settled, Any, "", "";
        /// T that the controller holds in place of its own: JSON or CSV as `hhc export --what t` writes it, relative to the
        /// case. The rotor stays what it is. For the real actuator, or the ideal one alone; not with `Local`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub t_file: Option<String> = None, Any, "", "a file that `hhc export --what t` wrote, relative to the case file";
        /// Largest mean power that the actuators of one blade give, none taken back; with `effort: Limits`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub power_limit_watt as "power_limit_W": Option<f64> = None, Within(1e-6, 1e6), "W",
            "a few W is usual; leave it out for no limit";
        /// Weight of that power in the cost, on nondimensional loads squared; about 1e-8 is where it shows.
        #[serde(skip_serializing_if = "is_default")]
        pub power_weight_per_watt as "power_weight_per_W": f64 = 0.0, Within(0.0, 1e6), "1/W",
            "0 for no weight; 1e-8 is where it shows on nondimensional loads";
        /// Control steps allowed.
        pub max_steps: usize = 40, Count(1, 10_000), "", "40 is usual";
        /// Relative change of the voltages at which the control has converged.
        pub step_tolerance: f64 = 1e-4, Within(1e-12, 0.1), "", "1e-4 is usual";
    }
    apart {
        /// What `t_file` holds; none without one.
        pub handed_t: Option<Arc<HandedT>> = None;
    }
}

impl ControlValues {
    /// How the bias of the actuators is set.
    pub fn drive_bias(&self) -> Bias {
        match self.bias {
            BiasChoice::Centred => Bias::Centred { guess_volt: self.bias_volt },
            BiasChoice::Fixed(volt) => Bias::Fixed { volt },
        }
    }
}
