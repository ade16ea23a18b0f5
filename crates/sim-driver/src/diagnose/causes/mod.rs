//! The cause library of the actuator bench: one file per cause.
//!
//! A cause says what it is in physical terms, where it enters the chain of an actuator, what a data set
//! must contain before it can be seen, and where a search for its parameters should begin.

mod amplifier_current_limit;
mod amplifier_gain;
mod backlash;
mod coulomb_friction;
mod creep;
mod depolarisation;
mod dielectric_heating;
mod electrical_lag;
mod gain_rise;
mod hysteresis;
mod load_stiffness;
mod mains_hum;
mod mechanical_resonance;
mod rate_dependence;
mod reading_range;
mod reading_rate;
mod sensor_filter;
mod sensor_nonlinearity;
mod transport_delay;
mod voltage_saturation;

pub(crate) use hysteresis::{StaticHysteresis, looped};
pub(crate) use rate_dependence::rate_dependent;
pub(crate) use reading_range::Reading;

use super::base::variance;
use super::record::Record;
use model_gap::{Candidate, Cause, Parameter, Scale, Stimulus};
use preisach_dyn::{AmplifierStage, Depolarisation, DielectricHeating, LinkageStage, SensorStage};

/// Part of its effect by which the model of a cause is usually wrong: no lag is of one pole, no joint dry
/// alone.
const FORM_ERROR: f64 = 0.05;

/// What a cause switches on in the chain of an actuator.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Part {
    /// A stage before the law.
    Amplifier(AmplifierStage),
    /// A stage behind it.
    Linkage(LinkageStage),
    /// Stages of the bench sensor.
    Sensor(Vec<SensorStage>),
    /// Heating, whose temperature a thermometer may show; and the point its gain acts about, from 0 V
    /// (0) to the middle of the range (1).
    Heating(DielectricHeating, f64),
    /// Loss of polarisation, and the same point.
    Depolarisation(Depolarisation, f64),
    /// Relaxation of the law whose time depends on its state.
    RateDependence {
        /// Mean relaxation time, s.
        tau_s: f64,
        /// Its relative growth per spread of the output.
        position: f64,
    },
    /// Loops, where the base model has none.
    Hysteresis {
        /// Share of the output that follows through plays.
        share: f64,
        /// Half-width of the widest, output's unit.
        widest: f64,
    },
    /// A command that reaches the terminals by another gain.
    Command {
        /// The gain.
        gain: f64,
        /// Terminal voltage of no command, V.
        zero_volt: f64,
    },
    /// What the sensor can read.
    Reading(Reading),
    /// Every output larger by one factor.
    Gain {
        /// The factor less one.
        rise: f64,
    },
    /// A line whose phase is that of each record.
    Hum {
        /// Amplitude, output's unit.
        amplitude: f64,
        /// Frequency, Hz.
        frequency_hz: f64,
    },
}

/// One cause of the bench.
pub(crate) trait BenchCause: Sync + Send {
    /// What it is.
    fn cause(&self, design: &Design) -> Cause;
    /// Where a search begins.
    fn starts(&self, design: &Design) -> Vec<Vec<f64>>;
    /// Why these data cannot show it, seen before any fit.
    fn blocked(&self, design: &Design) -> Option<String>;
    /// Why these data show that it is not there, seen before any fit.
    fn refuted(&self, _: &Design) -> Option<String> {
        None
    }
    /// What it would be, where no cause of the library does it.
    fn nameless(&self) -> Option<&'static str> {
        None
    }
    /// What it switches on.
    fn part(&self, values: &[f64]) -> Part;
}

/// What the measured runs of a diagnosis contain.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Design {
    /// Lowest and highest input of the measured runs.
    pub(crate) input: (f64, f64),
    /// Spread of the output over the measured runs.
    pub(crate) spread: f64,
    /// Lowest and highest output of the measured runs.
    pub(crate) output: (f64, f64),
    /// Half the range of the output over the measured runs.
    pub(crate) half_stroke: f64,
    /// Longest measured run, s.
    pub(crate) longest_s: f64,
    /// Half the highest sampling frequency, Hz: what one run carries, the data carry.
    pub(crate) nyquist_hz: f64,
    /// Rate of the input that a twentieth of the samples exceed, per s.
    pub(crate) fast_rate: f64,
    /// The only frequency of all measured runs, if they are sines of one frequency.
    pub(crate) only_hz: Option<f64>,
    /// Number of measured runs with the terminal voltage beside them.
    pub(crate) monitored_runs: usize,
    /// Whether a thermometer was read.
    pub(crate) has_temperature: bool,
    /// Load over displacement as a load cell saw it, N/um, and its standard error; none without a load cell.
    pub(crate) load_per_um: Option<(f64, f64)>,
    /// Whether it is an actuator bench, with volt and um.
    pub(crate) is_bench: bool,
    /// Whether reference runs fix the base model.
    pub(crate) has_reference: bool,
}

impl Design {
    pub(crate) fn of(runs: &[&Record], is_bench: bool, has_reference: bool) -> Self {
        let all = |f: fn(&Record) -> &[f64]| runs.iter().flat_map(move |r| f(r).iter().copied());
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
        };
        let input = range(&mut all(|r| &r.input));
        let output = range(&mut all(|r| &r.output));
        let count: usize = runs.iter().map(|r| r.output.len()).sum();
        let spread2 = runs.iter().map(|r| variance(&r.output) * r.output.len() as f64).sum::<f64>();
        let mut rates: Vec<f64> = runs
            .iter()
            .flat_map(|r| r.input.windows(2).map(|w| (w[1] - w[0]).abs() / r.step_s))
            .collect();
        rates.sort_by(f64::total_cmp);
        let fast_rate = rates.get(rates.len() * 19 / 20).copied().unwrap_or_default();
        let frequencies: Vec<Option<f64>> = runs
            .iter()
            .map(|r| match Stimulus::of(&r.input, r.step_s) {
                Stimulus::Sine { frequency_hz, .. } => Some(frequency_hz),
                Stimulus::Other => None,
            })
            .collect();
        let first = frequencies.first().copied().flatten();
        let only_hz = first
            .filter(|f| frequencies.iter().all(|g| g.is_some_and(|g| (g - f).abs() < 0.05 * f)));
        Self {
            input,
            spread: (spread2 / count.max(1) as f64).sqrt(),
            output,
            half_stroke: 0.5 * (output.1 - output.0),
            longest_s: runs.iter().map(|r| r.duration_s()).fold(0.0, f64::max),
            nyquist_hz: runs.iter().map(|r| 0.5 / r.step_s).fold(0.0, f64::max),
            fast_rate,
            only_hz,
            monitored_runs: runs.iter().filter(|r| r.amplifier.is_some()).count(),
            has_temperature: runs.iter().any(|r| r.temperature.is_some()),
            load_per_um: load_per_um(runs),
            is_bench,
            has_reference,
        }
    }

    /// Nothing about rate can be said from one frequency.
    fn one_frequency(&self) -> Option<String> {
        self.only_hz.map(|hz| {
            format!("every run is a sine of {hz:.3} Hz: nothing that depends on rate shows at one frequency")
        })
    }
}

/// Slope of the load against the displacement over all runs with a load cell, each about its means, and its
/// standard error.
fn load_per_um(runs: &[&Record]) -> Option<(f64, f64)> {
    let centred = |v: &[f64]| -> Vec<f64> {
        let mean = v.iter().sum::<f64>() / v.len().max(1) as f64;
        v.iter().map(|x| x - mean).collect()
    };
    let pairs: Vec<(f64, f64)> = runs
        .iter()
        .filter_map(|run| run.load.as_ref().map(|load| (centred(&run.output), centred(load))))
        .flat_map(|(y, load)| y.into_iter().zip(load))
        .collect();
    let sum = |f: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(f).sum::<f64>();
    let square = sum(&|p| p.0 * p.0);
    if square <= 0.0 {
        return None;
    }
    let slope = sum(&|p| p.0 * p.1) / square;
    let left = sum(&|p| (p.1 - slope * p.0).powi(2));
    Some((slope, (left / pairs.len() as f64 / square).sqrt()))
}

/// Every cause of the library.
pub(crate) fn library() -> Vec<Box<dyn BenchCause>> {
    vec![
        Box::new(creep::Creep),
        Box::new(rate_dependence::RateDependence),
        Box::new(electrical_lag::ElectricalLag),
        Box::new(amplifier_current_limit::AmplifierCurrentLimit),
        Box::new(voltage_saturation::VoltageSaturation),
        Box::new(mechanical_resonance::MechanicalResonance),
        Box::new(transport_delay::TransportDelay),
        Box::new(backlash::BacklashInLever),
        Box::new(coulomb_friction::DryFriction),
        Box::new(dielectric_heating::Heating),
        Box::new(load_stiffness::Load),
        Box::new(depolarisation::ReverseVoltage),
        Box::new(sensor_filter::SensorFilter),
        Box::new(sensor_nonlinearity::SensorNonlinearity),
        Box::new(mains_hum::Hum),
    ]
}

/// What can be wrong on a bench without being a cause of the library: it stands among the candidates, so that data
/// which show it are not given the name of a cause that does about the same.
pub(crate) fn nameless() -> Vec<Box<dyn BenchCause>> {
    vec![
        Box::new(gain_rise::GainRise),
        Box::new(amplifier_gain::AmplifierGain),
        Box::new(reading_range::ReadingRange),
        Box::new(reading_rate::ReadingRate),
    ]
}

/// The library made ready for one data set.
pub(crate) fn candidates(library: &[Box<dyn BenchCause>], design: &Design) -> Vec<Candidate> {
    library
        .iter()
        .map(|cause| {
            let blocked = cause.blocked(design);
            let starts = if blocked.is_some() { Vec::new() } else { cause.starts(design) };
            Candidate {
                cause: cause.cause(design),
                starts,
                blocked,
                refuted: cause.refuted(design),
                nameless: cause.nameless(),
            }
        })
        .collect()
}

/// A parameter searched on a logarithmic scale.
fn logarithmic(name: &'static str, unit: &'static str, low: f64, high: f64) -> Parameter {
    Parameter { scale: Scale::Log, ..linear(name, unit, low, high) }
}

/// A parameter searched on a straight scale.
fn linear(name: &'static str, unit: &'static str, low: f64, high: f64) -> Parameter {
    Parameter {
        name,
        unit,
        low,
        high,
        scale: Scale::Linear,
        is_shape: false,
        is_amount: false,
        needs: None,
        held: None,
        step: None,
    }
}

/// An amount of an effect, which is none at zero.
fn amount(name: &'static str, unit: &'static str, low: f64, high: f64) -> Parameter {
    Parameter { is_amount: true, ..linear(name, unit, low, high) }
}

/// A parameter that only shapes the effect.
fn shape(parameter: Parameter) -> Parameter {
    Parameter { is_shape: true, ..parameter }
}

/// A parameter that is taken and not fitted, with its standard deviation.
fn held(parameter: Parameter, std: f64) -> Parameter {
    Parameter { held: Some(std), ..shape(parameter) }
}

/// Starts of a single parameter.
fn singles(values: &[f64]) -> Vec<Vec<f64>> {
    values.iter().map(|&v| vec![v]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design() -> Design {
        let input: Vec<f64> = (0..4000)
            .map(|i| 65.0 + 80.0 * (0.02 * f64::from(i)).sin() * (0.0031 * f64::from(i)).cos())
            .collect();
        let run = Record {
            id: "a".into(),
            is_reference: false,
            step_s: 0.01,
            output: input.iter().map(|u| 2.5 * u).collect(),
            input,
            amplifier: None,
            temperature: None,
            load: None,
        };
        Design::of(&[&run], true, true)
    }

    /// The names and units other programs read; parameters of form are not among them.
    const REPORTED: [(&str, &[(&str, &str)]); 15] = [
        ("creep", &[("rate_per_decade", "1")]),
        ("rate-dependence", &[("tau", "s")]),
        ("electrical-lag", &[("tau", "s")]),
        ("amplifier-current-limit", &[("slew_rate", "V/s")]),
        ("voltage-saturation", &[("v_max", "V"), ("v_min", "V")]),
        ("mechanical-resonance", &[("frequency", "Hz"), ("damping_ratio", "1")]),
        ("transport-delay", &[("delay", "s")]),
        ("backlash", &[("width", "um")]),
        ("coulomb-friction", &[("width", "um")]),
        ("dielectric-heating", &[("time_constant", "s"), ("coefficient", "1/K")]),
        ("load-stiffness", &[("stiffness_ratio", "1")]),
        ("depolarisation", &[("threshold", "V")]),
        ("sensor-filter", &[("tau", "s")]),
        ("sensor-nonlinearity", &[("amplitude", "um")]),
        ("mains-hum", &[("amplitude", "um"), ("frequency", "Hz")]),
    ];

    #[test]
    fn every_cause_has_its_name_units_and_starts_inside_its_range() {
        let design = design();
        let library = library();
        assert_eq!(library.len(), REPORTED.len());
        for (cause, (id, parameters)) in library.iter().zip(REPORTED) {
            let own = cause.cause(&design);
            assert_eq!(own.id, id);
            let reported: Vec<(&str, &str)> =
                own.parameters.iter().filter(|p| !p.is_shape).map(|p| (p.name, p.unit)).collect();
            assert_eq!(reported, parameters);
            for other in own.confused_with {
                assert!(REPORTED.iter().any(|r| r.0 == *other), "{id}: {other}");
            }
            if cause.blocked(&design).is_some() {
                continue;
            }
            let starts = cause.starts(&design);
            assert!(!starts.is_empty(), "{id}");
            for start in starts {
                assert_eq!(start.len(), own.parameters.len(), "{id}");
                for (value, p) in start.iter().zip(&own.parameters) {
                    assert!((p.low..=p.high).contains(value), "{id}: {} = {value}", p.name);
                }
            }
        }
    }

    /// A load cell refutes a load only where it reads none: noise alone, not a spring of either sign.
    #[test]
    fn a_load_cell_that_reads_nothing_refutes_a_load() {
        let output: Vec<f64> = (0..2000).map(|i| 80.0 * (0.03 * f64::from(i)).sin()).collect();
        let refuted = |newton_per_um: f64| {
            let noise = |i: usize| 0.4 * ((i * 7919 % 1013) as f64 / 506.0 - 1.0);
            let load = output.iter().enumerate().map(|(i, y)| newton_per_um * y + noise(i));
            let run = Record {
                id: "a".into(),
                is_reference: false,
                step_s: 0.01,
                input: output.clone(),
                output: output.clone(),
                amplifier: None,
                temperature: None,
                load: Some(load.collect()),
            };
            load_stiffness::Load.refuted(&Design::of(&[&run], true, true)).is_some()
        };
        assert_eq!([0.0, 0.002, -0.002].map(refuted), [true, false, false]);
        assert!(load_stiffness::Load.refuted(&design()).is_none(), "no load cell says nothing");
    }

    #[test]
    fn one_frequency_says_nothing_about_rate() {
        let input: Vec<f64> = (0..4000).map(|i| 150.0 * (0.0628 * f64::from(i)).sin()).collect();
        let run = Record {
            id: "a".into(),
            is_reference: false,
            step_s: 0.01,
            output: input.clone(),
            input,
            amplifier: None,
            temperature: None,
            load: None,
        };
        let design = Design::of(&[&run], true, false);
        for cause in library() {
            let id = cause.cause(&design).id;
            let about_rate = [
                "creep",
                "rate-dependence",
                "electrical-lag",
                "amplifier-current-limit",
                "mechanical-resonance",
                "transport-delay",
                "sensor-filter",
            ];
            if about_rate.contains(&id) {
                assert!(cause.blocked(&design).is_some(), "{id}");
            }
        }
    }
}
