//! The cause library of the actuator bench: one file per cause.
//!
//! A cause says what it is in physical terms, where it enters the chain of an actuator, what a data set
//! must contain before it can be seen, and where a search for its parameters should begin.

mod amplifier_current_limit;
mod amplifier_gain;
mod backlash;
mod cause;
mod chain;
mod coulomb_friction;
mod creep;
mod depolarisation;
mod design;
mod dielectric_heating;
mod electrical_lag;
mod gain_rise;
mod hysteresis;
mod load_stiffness;
mod mains_hum;
mod mechanical_resonance;
mod rate_dependence;
mod reading;
mod reading_range;
mod reading_rate;
mod sensor_filter;
mod sensor_nonlinearity;
mod transport_delay;
mod voltage_saturation;

pub(crate) use cause::BenchCause;
pub(crate) use chain::{Chain, Command, FrontStages, Loops, Rate, RearStages};
pub(crate) use design::Design;
pub(crate) use hysteresis::{StaticHysteresis, looped};
pub(crate) use rate_dependence::rate_dependent;

use model_gap::{Candidate, Effect};

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

/// Decoys: what can be wrong on a bench without being a cause of the library. They are candidates too, so that data
/// which show one of them are not given the name of a similar cause.
pub(crate) fn decoys() -> Vec<Box<dyn BenchCause>> {
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
                decoy: cause.decoy(),
            }
        })
        .collect()
}

/// The chain under effects of a library.
pub(crate) fn chain_under(library: &[Box<dyn BenchCause>], effects: &[Effect]) -> Chain {
    let mut chain = Chain::default();
    for effect in effects {
        library[effect.candidate].apply(&mut chain, &effect.values);
    }
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Record;

    fn design() -> Design {
        let input: Vec<f64> = (0..4000)
            .map(|i| 65.0 + 80.0 * (0.02 * f64::from(i)).sin() * (0.0031 * f64::from(i)).cos())
            .collect();
        let output = input.iter().map(|u| 2.5 * u).collect();
        let run = Record::new("a", 0.01, input, output);
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
                load: Some(load.collect()),
                ..Record::new("a", 0.01, output.clone(), output.clone())
            };
            load_stiffness::Load.refuted(&Design::of(&[&run], true, true)).is_some()
        };
        assert_eq!([0.0, 0.002, -0.002].map(refuted), [true, false, false]);
        assert!(load_stiffness::Load.refuted(&design()).is_none(), "no load cell says nothing");
    }

    #[test]
    fn one_frequency_says_nothing_about_rate() {
        let input: Vec<f64> = (0..4000).map(|i| 150.0 * (0.0628 * f64::from(i)).sin()).collect();
        let run = Record::new("a", 0.01, input.clone(), input);
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
