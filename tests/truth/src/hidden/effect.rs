//! A hidden effect: which physics, how strong, with which true parameters.

use super::amplifier::Amplifier;
use super::catalogue::{Cause, Hidden, Outside};
use super::ceramic::Ceramic;
use super::design::RANGE_VOLT;
use super::draw::{Draw, Purpose};
use super::mechanics::Mechanics;
use super::sensor::Sensor;
use crate::relaxation::{RelaxationChannel, RelaxationParameters};

/// A Kelvin-Voigt element: compliance (share of the displacement) and retardation time (s).
pub type Element = (f64, f64);

/// The physics of an effect, by the place where it sits.
#[derive(Debug, Clone, PartialEq)]
pub enum Physics {
    /// Between command and terminal voltage.
    Amplifier(Amplifier),
    /// In the ceramic.
    Ceramic(Ceramic),
    /// Relaxation of the whole motion.
    Relaxation(RelaxationParameters),
    /// Creep of the whole motion.
    Creep(Vec<Element>),
    /// Between ceramic and sensor.
    Mechanics(Mechanics),
    /// In the sensor.
    Sensor(Sensor),
}

/// A parameter of the truth: name, value, unit.
pub type Parameter = (&'static str, f64, &'static str);

/// What an effect is, drawn once; its strength is put in afterwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Character {
    kind: Kind,
    /// Two numbers, each uniform in 0..1.
    shape: [f64; 2],
    /// Compliances of the creep elements relative to their mean.
    creep: [f64; 5],
}

/// What a character belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Library(Cause),
    Outside(Outside),
}

impl Character {
    /// The characters of all effects that a seed hides; none for null.
    pub fn of_seed(hidden: Hidden, seed: u64) -> Vec<Self> {
        let mut draw = Draw::new(Purpose::Effect, &[seed]);
        match hidden {
            Hidden::Other(effect) => vec![Self::draw(Kind::Outside(effect), &mut draw)],
            known => {
                let kinds = known.causes().into_iter().map(Kind::Library);
                kinds.map(|kind| Self::draw(kind, &mut draw)).collect()
            }
        }
    }

    fn draw(kind: Kind, draw: &mut Draw) -> Self {
        let shape = [draw.uniform(0.0, 1.0), draw.uniform(0.0, 1.0)];
        let mut creep = [0.0; 5].map(|_: f64| draw.uniform(0.85, 1.15));
        let mean = creep.iter().sum::<f64>() / 5.0;
        for c in &mut creep {
            *c /= mean;
        }
        Self { kind, shape, creep }
    }

    /// Range of the strength, in the unit of [`Character::with_strength`]; the effect grows with it.
    pub fn strength_range(&self) -> (f64, f64) {
        match self.kind {
            Kind::Library(cause) => match cause {
                Cause::Creep => (5e-4, 0.3),
                Cause::RateDependence | Cause::ElectricalLag => (1e-5, 8e-3),
                Cause::AmplifierCurrentLimit => (2e-5, 1e-2),
                Cause::VoltageSaturation => (0.3, 80.0),
                Cause::MechanicalResonance => (1.0 / 800.0_f64.powi(2), 1.0 / 60.0_f64.powi(2)),
                Cause::TransportDelay | Cause::SensorFilter => (1e-5, 5e-3),
                Cause::Backlash
                | Cause::CoulombFriction
                | Cause::SensorNonlinearity
                | Cause::MainsHum => (0.05, 80.0),
                Cause::DielectricHeating | Cause::LoadStiffness => (1e-3, 1.0),
                Cause::Depolarisation => (1e-3, 3.0),
            },
            Kind::Outside(effect) => match effect {
                Outside::QuadraticViscous => (1e-9, 1e-4),
                Outside::RandomJumps => (0.05, 80.0),
                Outside::CubicSpring => (1e-3, 2.0),
                Outside::IntermittentDropout => (1e-3, 0.2),
                Outside::TimeVaryingDelay => (1e-5, 5e-3),
                Outside::SecondMode => (1e-3, 0.3),
            },
        }
    }

    /// The effect with a strength.
    ///
    /// The strength is the parameter itself (creep per decade, time constants, delay, widths, amplitudes,
    /// stiffness ratio, scale of the depolarisation), `1/slew rate`, volts cut off at the more
    /// limited end, `1/frequency^2`, or the gain of the heated ceramic.
    pub fn with_strength(&self, strength: f64) -> (Physics, Vec<Parameter>) {
        match self.kind {
            Kind::Library(cause) => self.cause(cause, strength),
            Kind::Outside(effect) => (self.outside(effect, strength), Vec::new()),
        }
    }

    fn between(&self, index: usize, low: f64, high: f64) -> f64 {
        low + (high - low) * self.shape[index]
    }

    fn cause(&self, cause: Cause, x: f64) -> (Physics, Vec<Parameter>) {
        match cause {
            Cause::Creep => {
                // Five elements, each five times slower than the one before: 0.7 decades apart.
                let times = [0.03, 0.15, 0.75, 3.75, 18.75];
                let compliance = x * 5.0_f64.log10();
                let elements = self.creep.iter().zip(times).map(|(c, t)| (compliance * c, t));
                (Physics::Creep(elements.collect()), vec![("rate_per_decade", x, "1")])
            }
            Cause::RateDependence => {
                let channel =
                    |weight, time_constant_s| RelaxationChannel { weight, time_constant_s };
                let physics = Physics::Relaxation(RelaxationParameters {
                    channels: vec![channel(0.7, 0.7 * x), channel(0.3, 1.7 * x)],
                    reference_um: 250.0,
                    position_sensitivity: self.between(0, 0.2, 0.4),
                    deviation_sensitivity: 0.5,
                });
                (physics, vec![("tau", x, "s")])
            }
            Cause::ElectricalLag => {
                (Physics::Amplifier(Amplifier::Lag { tau_s: x }), vec![("tau", x, "s")])
            }
            Cause::AmplifierCurrentLimit => {
                let slew_volt_per_s = 1.0 / x;
                let physics = Physics::Amplifier(Amplifier::CurrentLimit { slew_volt_per_s });
                (physics, vec![("slew_rate", slew_volt_per_s, "V/s")])
            }
            Cause::VoltageSaturation => {
                let lesser = x * self.between(0, 0.5, 0.9);
                let (top, bottom) = if self.shape[1] < 0.5 { (x, lesser) } else { (lesser, x) };
                let (low_volt, high_volt) = (RANGE_VOLT.0 + bottom, RANGE_VOLT.1 - top);
                // A knee of 1.5 V, and a weak one where hardly anything is cut off.
                let knee_volt = (0.2 * lesser).min(1.5);
                let clip = Amplifier::Saturation { low_volt, high_volt, knee_volt };
                (
                    Physics::Amplifier(clip),
                    vec![("v_max", high_volt, "V"), ("v_min", low_volt, "V")],
                )
            }
            Cause::MechanicalResonance => {
                let (frequency_hz, damping_ratio) = (1.0 / x.sqrt(), self.between(0, 0.01, 0.05));
                let mode = Mechanics::Resonance { frequency_hz, damping_ratio };
                let parameters =
                    vec![("frequency", frequency_hz, "Hz"), ("damping_ratio", damping_ratio, "1")];
                (Physics::Mechanics(mode), parameters)
            }
            Cause::TransportDelay => {
                (Physics::Sensor(Sensor::Delay { delay_s: x }), vec![("delay", x, "s")])
            }
            Cause::Backlash => {
                (Physics::Mechanics(Mechanics::Backlash { width_um: x }), vec![("width", x, "um")])
            }
            Cause::CoulombFriction => {
                (Physics::Mechanics(Mechanics::Friction { width_um: x }), vec![("width", x, "um")])
            }
            Cause::DielectricHeating => {
                let time_constant_s = self.between(0, 10.0, 25.0);
                let coefficient_per_kelvin = self.between(1, 0.001, 0.003);
                let rise_kelvin = x / coefficient_per_kelvin;
                let heating =
                    Ceramic::Heating { time_constant_s, coefficient_per_kelvin, rise_kelvin };
                let parameters = vec![
                    ("time_constant", time_constant_s, "s"),
                    ("coefficient", coefficient_per_kelvin, "1/K"),
                ];
                (Physics::Ceramic(heating), parameters)
            }
            Cause::LoadStiffness => (
                Physics::Mechanics(Mechanics::Load { ratio: x }),
                vec![("stiffness_ratio", x, "1")],
            ),
            Cause::Depolarisation => {
                let threshold_volt = self.between(0, -10.0, 8.0);
                let change = Ceramic::Depolarisation { threshold_volt, strength: x };
                (Physics::Ceramic(change), vec![("threshold", threshold_volt, "V")])
            }
            Cause::SensorFilter => {
                (Physics::Sensor(Sensor::Filter { tau_s: x }), vec![("tau", x, "s")])
            }
            Cause::SensorNonlinearity => (
                Physics::Sensor(Sensor::Nonlinearity { amplitude_um: x }),
                vec![("amplitude", x, "um")],
            ),
            Cause::MainsHum => {
                let mains_hz = if self.shape[0] < 0.7 { 50.0 } else { 60.0 };
                let frequency_hz = mains_hz + 0.1 * (self.shape[1] - 0.5);
                let hum = Sensor::Hum { amplitude_um: x, frequency_hz };
                (
                    Physics::Sensor(hum),
                    vec![("amplitude", x, "um"), ("frequency", frequency_hz, "Hz")],
                )
            }
        }
    }

    fn outside(&self, effect: Outside, x: f64) -> Physics {
        match effect {
            Outside::QuadraticViscous => {
                Physics::Mechanics(Mechanics::QuadraticViscous { coefficient: x })
            }
            Outside::RandomJumps => Physics::Sensor(Sensor::Jumps { deviation_um: x }),
            Outside::CubicSpring => Physics::Mechanics(Mechanics::CubicSpring { coefficient: x }),
            Outside::IntermittentDropout => Physics::Sensor(Sensor::Dropout { hold_s: x }),
            Outside::TimeVaryingDelay => Physics::Sensor(Sensor::BreathingDelay { delay_s: x }),
            Outside::SecondMode => {
                let frequency_hz = self.between(0, 14.0, 28.0);
                Physics::Mechanics(Mechanics::SecondMode { frequency_hz, share: x })
            }
        }
    }
}
