//! From an effect and its strength to physics and true parameters.

use crate::actuator::Actuator;
use crate::catalogue::Effect;
use crate::draw::Draw;
use crate::effect::{Amplifier, Ceramic, Mechanics, Physics, Sensor};
use crate::runs::RANGE_VOLT;

/// A true parameter: name and unit as a diagnosis gives them.
pub(crate) type Parameter = (&'static str, f64, &'static str);

/// What an effect puts into the bench.
#[derive(Debug, Clone, Default)]
pub(crate) struct Built {
    /// In the measured runs.
    pub(crate) measured: Vec<Physics>,
    /// In reference and measured runs alike.
    pub(crate) always: Vec<Physics>,
    /// Parameters that are well defined.
    pub(crate) parameters: Vec<Parameter>,
}

/// Ratio of the spring of [`Effect::SpringAlways`].
const SPRING_ALWAYS: f64 = 0.08;

/// An effect on a bench (actuator and seed), of a strength in the unit of its parameter: share per decade, time (s), 1/slew rate, volts cut off at the top,
/// 1/frequency^2, width or amplitude (um), ratio, or the size of an everyday error.
pub(crate) fn built(effect: Effect, strength: f64, (actuator, seed): (&Actuator, u64)) -> Built {
    let mut draw = Draw::new("shape", &[seed, effect as u64]);
    let (first, second) = (draw.uniform(0.0, 1.0), draw.uniform(0.0, 1.0));
    let between = |low: f64, high: f64| low + (high - low) * first;
    let x = strength;
    let amplifier = |amplifier| Physics::Amplifier(amplifier);
    let (physics, parameters): (Physics, Vec<Parameter>) = match effect {
        Effect::Creep => {
            let creep = Ceramic::Creep { per_decade: x, key: seed };
            (Physics::Ceramic(creep), vec![("rate_per_decade", x, "1")])
        }
        Effect::RateDependence => {
            (Physics::Ceramic(Ceramic::Late { tau_s: x }), vec![("tau", x, "s")])
        }
        Effect::ElectricalLag => (amplifier(Amplifier::Lag(x)), vec![("tau", x, "s")]),
        Effect::CurrentLimit => {
            (amplifier(Amplifier::Slew(1.0 / x)), vec![("slew_rate", 1.0 / x, "V/s")])
        }
        Effect::VoltageSaturation => {
            let (low_volt, high_volt) = (RANGE_VOLT.0 + x * between(0.4, 0.9), RANGE_VOLT.1 - x);
            let clip = Amplifier::Clip { low_volt, high_volt };
            (amplifier(clip), vec![("v_max", high_volt, "V"), ("v_min", low_volt, "V")])
        }
        Effect::Resonance => {
            let (frequency_hz, damping_ratio) = (1.0 / x.sqrt(), between(0.01, 0.05));
            let mode = Mechanics::Resonance { frequency_hz, damping_ratio };
            let own = [("frequency", frequency_hz, "Hz"), ("damping_ratio", damping_ratio, "1")];
            (Physics::Mechanics(mode), own.to_vec())
        }
        Effect::TransportDelay => (Physics::Sensor(Sensor::Delay(x)), vec![("delay", x, "s")]),
        Effect::Backlash => {
            (Physics::Mechanics(Mechanics::Backlash { width_um: x }), vec![("width", x, "um")])
        }
        // its width changes with speed by a fifth: no one number is true
        Effect::Friction => (Physics::Mechanics(Mechanics::Friction { width_um: x }), vec![]),
        Effect::Heating => {
            let (time_constant_s, per_kelvin) = (between(6.0, 20.0), 0.001 + 0.002 * second);
            let heating =
                Ceramic::Heating { time_constant_s, per_kelvin, rise_kelvin: x / per_kelvin };
            let own = [("time_constant", time_constant_s, "s"), ("coefficient", per_kelvin, "1/K")];
            (Physics::Ceramic(heating), own.to_vec())
        }
        Effect::LoadStiffness => {
            let spring = Mechanics::Spring { ratio: x };
            (Physics::Mechanics(spring), vec![("stiffness_ratio", x, "1")])
        }
        Effect::Depolarisation => {
            let threshold_volt = between(-10.0, 8.0);
            let change = Ceramic::Depolarisation { threshold_volt, strength: x };
            (Physics::Ceramic(change), vec![("threshold", threshold_volt, "V")])
        }
        Effect::SensorFilter => (Physics::Sensor(Sensor::Filter(x)), vec![("tau", x, "s")]),
        Effect::SensorNonlinearity => (Physics::Sensor(Sensor::Bent(x)), vec![]),
        Effect::MainsHum => {
            let frequency_hz = between(49.9, 50.1);
            let hum = Sensor::Hum { amplitude_um: x, frequency_hz };
            (Physics::Sensor(hum), vec![("amplitude", x, "um"), ("frequency", frequency_hz, "Hz")])
        }
        other => return everyday(other, x, actuator.top_um),
    };
    Built { measured: vec![physics], always: vec![], parameters }
}

fn calibration(gain_error: f64, zero_volt: f64) -> Vec<Parameter> {
    vec![("gain_error", gain_error, "1"), ("zero", zero_volt, "V")]
}

fn everyday(effect: Effect, x: f64, top_um: f64) -> Built {
    let sensor = |sensor| Physics::Sensor(sensor);
    let (physics, parameters): (Physics, Vec<Parameter>) = match effect {
        Effect::AmplifierGain => (Physics::Amplifier(Amplifier::Gain(x)), calibration(x, 0.0)),
        Effect::AmplifierZero => (Physics::Amplifier(Amplifier::Zero(x)), calibration(0.0, x)),
        Effect::SensorGain => (sensor(Sensor::Gain(x)), vec![("gain_error", x, "1")]),
        Effect::SensorZero => (sensor(Sensor::Zero(x)), vec![("zero", x, "um")]),
        Effect::SensorZeroDrift => (sensor(Sensor::WanderingZero(x)), vec![]),
        Effect::SensorGainDrift => (sensor(Sensor::WanderingGain(x)), vec![]),
        Effect::MonitorGain => (Physics::Monitor { gain: x, zero_volt: 0.0 }, calibration(x, 0.0)),
        Effect::MonitorZero => (Physics::Monitor { gain: 0.0, zero_volt: x }, calibration(0.0, x)),
        Effect::MonitorBoth => {
            let always = vec![Physics::Monitor { gain: x, zero_volt: 0.0 }];
            return Built { always, ..Built::default() };
        }
        Effect::SpringAlways => {
            let spring = Mechanics::Spring { ratio: SPRING_ALWAYS };
            return Built {
                measured: vec![sensor(Sensor::Gain(x))],
                always: vec![Physics::Mechanics(spring)],
                parameters: vec![("gain_error", x, "1")],
            };
        }
        Effect::LoadOneSided => {
            (Physics::Mechanics(Mechanics::OneSidedSpring { ratio: x }), vec![])
        }
        // the size is how far below the highest motion it stands
        Effect::EndStop => (Physics::Mechanics(Mechanics::Stop { at_um: top_um - x }), vec![]),
        Effect::HumWithCommand => (sensor(Sensor::HumWithCommand(x)), vec![]),
        Effect::CreepOnce => (sensor(Sensor::Drift(x)), vec![]),
        Effect::SensorCubic => (sensor(Sensor::Cubic(x)), vec![]),
        Effect::AmplifierSecondOrder => {
            let (frequency_hz, damping_ratio) = (x, 0.6);
            let stage = Amplifier::SecondOrder { frequency_hz, damping_ratio };
            (Physics::Amplifier(stage), vec![])
        }
        Effect::AmplifierDelay => (Physics::Amplifier(Amplifier::Delay(x)), vec![]),
        // foreign and small reference runs change the reference folder, not the bench
        _ => return Built::default(),
    };
    Built { measured: vec![physics], always: vec![], parameters }
}
