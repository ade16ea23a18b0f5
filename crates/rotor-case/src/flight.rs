//! The section of a case that describes a flight in time.

use super::field::{Value, section, values, variant_names};
use preisach_dyn::ActuatorModel;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// How a controller knows T along a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FlightController {
    /// T of the start, held.
    Fixed,
    /// T over the advance ratio, interpolated.
    Scheduled,
    /// T of the start, then estimated with Z0 and the noise.
    Adaptive,
}

impl FlightController {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Scheduled => "scheduled",
            Self::Adaptive => "adaptive",
        }
    }
}

/// Whether a controller is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Notice {
    /// It is.
    Told,
    /// It is not.
    Untold,
}

/// Blades on which a flap fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FailedOn {
    /// All of them, which stay alike.
    EveryBlade,
    /// One, the others go on.
    OneBlade,
}

values!(Notice, FailedOn);

impl Value for Vec<FlightController> {
    fn choices() -> &'static [&'static str] {
        variant_names::<FlightController>()
    }
}

section! {
    /// A flight in time, for `hhc fly`: speed, thrust, a flap that fails, noise, and controllers side by side.
    #[serde(deny_unknown_fields, default)]
    pub struct FlightValues {
        /// Length of the flight.
        pub duration_s: f64 = 60.0, Within(1.0, 3600.0), "s", "60 s is usual";
        /// Advance ratio at the start.
        pub start_advance_ratio: f64 = 0.15, Within(0.0, 0.5), "", "the attached-flow rotor model ends at 0.5; 0 is hover";
        /// Advance ratio at the end.
        pub end_advance_ratio: f64 = 0.30, Within(0.0, 0.5), "", "the attached-flow rotor model ends at 0.5; 0 is hover";
        /// When the advance ratio begins to change.
        pub ramp_at_s: f64 = 10.0, Within(0.0, 3600.0), "s", "counted from the start of the flight";
        /// Time in which it changes, linearly; 0 is a step.
        pub ramp_s: f64 = 20.0, Within(0.0, 3600.0), "s", "20 s is usual; 0 is a step";
        /// Advance ratios at which the rotor is trimmed and linearised, evenly from start to end. Loads are linear
        /// in between.
        pub knots: usize = 21, Count(2, 100), "", "21 from 0.15 to 0.30 keep J within 2 % of J0";
        /// A step of the thrust, such as `(at_s: 40, ratio: 1.1)`; left out, none.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub thrust_step: Option<ThrustStep> = None, Any, "", "";
        /// A flap that fails, such as `(flap: 1, at_s: 50)`; left out, none.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub failed_flap: Option<FailedFlap> = None, Any, "", "";
        /// Flaps with an actuator of their own, such as `(flap: 2, path: "outboard.ron")`; the others have that of the case.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub flap_actuators: Vec<FlapActuator> = vec![], Any, "", "";
        /// Standard deviation of the noise of a load in one revolution, over the root mean square of the loads
        /// at the start.
        pub noise_percent: f64 = 3.0, Within(0.0, 100.0), "%", "3.16 % are 30 dB, 10 % are 20 dB";
        /// Seed of the noise, the same for all controllers.
        pub seed: usize = 1, Count(0, 4_294_967_295), "", "any whole number up to 2^32 - 1";
        /// Harmonics, commanded all at once.
        pub harmonics: Vec<usize> = vec![2, 3, 4, 5], Rule("1 to 10, each once"), "1/rev", "";
        /// Controllers, each flown on its own. `Fixed`: T of the start, held. `Scheduled`: T over the advance
        /// ratio. `Adaptive`: T estimated on the way.
        pub controllers: Vec<FlightController> =
            vec![FlightController::Fixed, FlightController::Scheduled, FlightController::Adaptive], Rule("each once"), "", "";
        /// Revolutions of a cycle that let the rotor settle.
        pub settling_rev: usize = 1, Count(0, 100), "", "1 is usual";
        /// Revolutions of a cycle that are measured.
        pub window_rev: usize = 2, Count(1, 100), "", "2 is usual";
        /// Part of the way to the optimum that a cycle goes.
        pub gain: f64 = 0.5, Within(1e-3, 1.0), "", "0.5 is usual; 1 is the whole way";
        /// Largest voltage amplitude of a flap at a harmonic.
        pub amplitude_limit_volt as "amplitude_limit_V": f64 = 20.0, UpTo(1e4), "V",
            "20 V for each of four harmonics leave the full scale of 85 V to all of them";
        /// Largest change of it in a cycle.
        pub rate_limit_volt as "rate_limit_V": f64 = 10.0, UpTo(1e4), "V", "10 V is usual";
        /// Weight `s` of the change of the control in a cycle: `s du'du` beside `J`. The square of the largest singular
        /// value of T is its scale, some 1e-12 to 1e-10.
        pub rate_weight: f64 = 0.0, Within(0.0, 1e6), "1/V^2", "0 leaves it out";
        /// Chance that a flap acts, which the control counts on: below 100 % flaps lean less on each other.
        pub flap_survival_percent: f64 = 90.0, Within(1.0, 100.0), "%", "90 % is usual; 100 % counts on flaps that never fail";
        /// Largest `J` that any one flap that stops may leave, over that without control: the control turns away from
        /// its optimum where it would leave more.
        pub dead_flap_percent: f64 = 110.0, Within(100.0, 1e6), "%", "110 % keeps below 120 % with hysteresis and noise; 1e6 % leaves it out";
        /// Whether the adaptive controller is told `noise_percent`. `Untold`: it estimates the noise.
        pub noise_notice: Notice = Notice::Untold, Any, "", "";
        /// Change of Z0 that the adaptive controller expects from cycle to cycle, over the loads.
        pub z0_walk_percent: f64 = 10.0, Within(1e-2, 100.0), "%", "10 % for manoeuvres, 1 % for steady flight";
        /// Change of the trend of Z0 that it expects, likewise: Z0 goes on by its trend from cycle to cycle.
        pub z0_trend_percent: f64 = 5.0, Within(0.0, 100.0), "%", "5 % for ramps, 0 for steady flight";
        /// What the adaptive controller takes T0 for at the start: its error over itself. T may change by half of that
        /// over full scale.
        pub t0_error_percent: f64 = 10.0, Within(1e-2, 200.0), "%", "10 % for a T0 of a model that is right, 50 % for one that may be far off";
        /// Angle by which it turns every voltage harmonic to and fro, so that T is learnt where limits hold the control.
        pub dither_deg: f64 = 0.0, Within(0.0, 20.0), "deg", "3 deg where the amplitudes are at their limits, 0 for none";
    }
}

impl FlightValues {
    /// Whether the advance ratio stays as it is.
    pub fn is_level(&self) -> bool {
        self.start_advance_ratio.to_bits() == self.end_advance_ratio.to_bits()
    }
}

section! {
    /// A step of the thrust of a flight.
    #[derive(Copy)]
    #[serde(deny_unknown_fields, default)]
    pub struct ThrustStep {
        /// When it begins.
        pub at_s: f64 = 40.0, Rule("0 to `duration_s`"), "s", "";
        /// Thrust or weight after it, over that of the trim.
        pub ratio: f64 = 1.1, Within(0.5, 1.5), "", "1.1 is a tenth more";
        /// Time in which it is made, linearly.
        pub length_s: f64 = 0.5, Within(0.0, 3600.0), "s", "0 is a jump";
    }
}

section! {
    /// A flap with an actuator of its own in flight.
    #[serde(deny_unknown_fields, default)]
    pub struct FlapActuator {
        /// Its number, counted from the root.
        pub flap: usize = 1, Rule("1 to the number of flaps"), "", "";
        /// The blade whose flap it is; left out, every blade that has none of its own there.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub blade: Option<usize> = None, Rule("1 to the number of blades"), "", "";
        /// Actuator file, as `hhc identify` writes it, from the folder of the case.
        pub path: String = String::new(), Any, "", "an actuator file such as \"outboard.ron\"";
        /// Whether the T that controllers are given knows it. That T is of blades alike: an actuator of one blade is in none.
        pub notice: Notice = Notice::Told, Any, "", "";
    }
    apart {
        /// What `path` holds; none until it is read.
        pub model: Option<Arc<ActuatorModel>> = None;
    }
}

section! {
    /// A flap that stops where it is stuck, or goes on weakly, on every blade or on one.
    #[derive(Copy)]
    #[serde(deny_unknown_fields, default)]
    pub struct FailedFlap {
        /// Its number, counted from the root.
        pub flap: usize = 1, Rule("1 to the number of flaps"), "", "";
        /// When it fails.
        pub at_s: f64 = 50.0, Rule("0 to `duration_s`"), "s", "";
        /// Angle at which it is stuck, trailing edge down positive.
        pub stuck_deg: f64 = 0.0, Within(-20.0, 20.0), "deg", "the rotor is linear in its flaps: a few deg";
        /// Part of its motion that it keeps about that angle; 0: it stands.
        pub kept_percent: f64 = 0.0, Within(0.0, 100.0), "%", "80 is a flap that is 20 % weak";
        /// Whether the controller hears of it, at the end of the cycle; it then leaves that flap out on every blade.
        pub notice: Notice = Notice::Told, Any, "", "";
        /// Blades on which it fails. `OneBlade`: the others go on, and the hub feels 1/rev and other harmonics that
        /// blades alike cancel.
        pub on: FailedOn = FailedOn::EveryBlade, Any, "", "";
    }
}
