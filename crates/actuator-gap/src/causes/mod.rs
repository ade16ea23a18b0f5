//! The cause library of the actuator bench: one file per cause.
//!
//! A cause says what it is in physical terms, where it enters the chain of an actuator, what a data set
//! must contain before it can be seen, and where a search for its parameters should begin.

mod amplifier_current_limit;
mod amplifier_delay;
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
mod hysteresis;
mod load_stiffness;
mod mains_hum;
mod mechanical_resonance;
mod monitor_calibration;
mod rate_dependence;
mod reading;
mod reading_range;
mod reading_rate;
mod sensor_filter;
mod sensor_gain;
mod sensor_nonlinearity;
mod sensor_zero;
mod transport_delay;
mod voltage_saturation;

pub(crate) use cause::BenchCause;
pub(crate) use chain::{Chain, Command, FrontStages, Loops, Rate, RearStages};
pub(crate) use design::{Design, reads_load};
pub(crate) use hysteresis::looped;
pub(crate) use rate_dependence::rate_dependent;

use model_gap::{Candidate, Class, Effect};

/// Every cause of the library.
pub(crate) const LIBRARY: [BenchCause; 19] = [
    creep::CAUSE,
    rate_dependence::CAUSE,
    electrical_lag::CAUSE,
    amplifier_current_limit::CAUSE,
    voltage_saturation::CAUSE,
    mechanical_resonance::CAUSE,
    transport_delay::CAUSE,
    backlash::CAUSE,
    coulomb_friction::CAUSE,
    dielectric_heating::CAUSE,
    load_stiffness::CAUSE,
    depolarisation::CAUSE,
    sensor_filter::CAUSE,
    sensor_nonlinearity::CAUSE,
    mains_hum::CAUSE,
    amplifier_gain::CAUSE,
    sensor_gain::CAUSE,
    sensor_zero::CAUSE,
    monitor_calibration::CAUSE,
];

/// Decoys: what can be wrong on a bench without being a cause of the library. They are candidates too, so that data
/// which show one of them are not given the name of a similar cause.
pub(crate) const DECOYS: [BenchCause; 3] =
    [amplifier_delay::CAUSE, reading_range::CAUSE, reading_rate::CAUSE];

/// Hysteresis, a candidate where the base model has none.
pub(crate) const HYSTERESIS: BenchCause = hysteresis::CAUSE;

/// Causes made ready for one data set; a search begins nowhere for those that it cannot show.
pub(crate) fn candidates(causes: &[BenchCause], design: &Design) -> Vec<Candidate> {
    let one = |cause: &BenchCause| {
        let own = (cause.candidate)(design);
        let starts = if own.blocked.is_some() { Vec::new() } else { own.starts };
        let class = match own.class {
            // the terminal voltage alone says where a lag is
            Class::LagBeforeTerminals | Class::LagBehindTerminals if design.monitored_runs == 0 => {
                Class::Lag
            }
            class => class,
        };
        Candidate { starts, class, ..own }
    };
    causes.iter().map(one).collect()
}

/// The chain under effects of causes.
pub(crate) fn chain_under(causes: &[BenchCause], effects: &[Effect]) -> Chain {
    let mut chain = Chain::default();
    for effect in effects {
        (causes[effect.candidate].apply)(&mut chain, &effect.values);
    }
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Record;
    use measured_data::Accuracy;

    fn design() -> Design {
        let input: Vec<f64> = (0..4000)
            .map(|i| 65.0 + 80.0 * (0.02 * f64::from(i)).sin() * (0.0031 * f64::from(i)).cos())
            .collect();
        let output = input.iter().map(|u| 2.5 * u).collect();
        let run = Record::new("a", 0.01, input, output);
        Design::of(&[&run], &[&run], &Accuracy::default(), true)
    }

    /// The names and units other programs read; parameters of form are not among them.
    const REPORTED: [(&str, &[(&str, &str)]); 19] = [
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
        ("amplifier-gain", &[("gain_error", "1"), ("zero", "V")]),
        ("sensor-gain", &[("gain_error", "1")]),
        ("sensor-zero", &[("zero", "um")]),
        ("monitor-calibration", &[("gain_error", "1"), ("zero", "V")]),
    ];

    #[test]
    fn every_cause_has_its_name_units_and_starts_inside_its_range() {
        let design = design();
        let library = candidates(&LIBRARY, &design);
        assert_eq!(library.len(), REPORTED.len());
        for (own, (id, parameters)) in library.iter().zip(REPORTED) {
            assert_eq!(own.id, id);
            let reported: Vec<(&str, &str)> =
                own.parameters.iter().filter(|p| !p.is_shape).map(|p| (p.name, p.unit)).collect();
            assert_eq!(reported, parameters);
            for other in own.confused_with {
                assert!(REPORTED.iter().any(|r| r.0 == *other), "{id}: {other}");
            }
            if own.blocked.is_some() {
                continue;
            }
            assert!(!own.starts.is_empty(), "{id}");
            for start in &own.starts {
                assert_eq!(start.len(), own.parameters.len(), "{id}");
                for (value, p) in start.iter().zip(&own.parameters) {
                    assert!((p.low..=p.high).contains(value), "{id}: {} = {value}", p.name);
                }
            }
        }
    }

    #[test]
    fn the_page_has_a_row_of_every_cause() {
        // the book is no part of the package
        let book = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/src/theory/discovery.md");
        let page = measured_data::Source::read(std::path::Path::new(book)).unwrap().text;
        let row = |own: Candidate| {
            let apart = own.separating.join(", ");
            format!("| `{}` | {} | {} | {apart} |", own.id, own.physics, own.fingerprint)
        };
        let rows: Vec<String> = candidates(&LIBRARY, &design()).into_iter().map(row).collect();
        let table = rows.join("\n");
        assert!(page.contains(&table), "the table of the section `The causes`:\n{table}");
    }

    /// A load cell refutes a load only where it reads none: noise alone, not a spring of either sign.
    #[test]
    fn a_load_cell_that_reads_nothing_refutes_a_load() {
        let output: Vec<f64> = (0..2000).map(|i| 80.0 * (0.03 * f64::from(i)).sin()).collect();
        let run = |newton_per_um: f64| {
            let noise = |i: usize| 0.4 * ((i * 7919 % 1013) as f64 / 506.0 - 1.0);
            let load = output.iter().enumerate().map(|(i, y)| newton_per_um * y + noise(i));
            Record {
                load: Some(load.collect()),
                ..Record::new("a", 0.01, output.clone(), output.clone())
            }
        };
        let mut accuracy = Accuracy::default();
        let refuted_by = |before: f64, now: f64, accuracy: &Accuracy| {
            let design = Design::of(&[&run(now)], &[&run(before)], accuracy, true);
            (load_stiffness::CAUSE.candidate)(&design).refuted.is_some()
        };
        let refuted = |before: f64, now: f64| refuted_by(before, now, &accuracy);
        assert_eq!([0.0, 0.002, -0.002].map(|now| refuted(0.0, now)), [true, false, false]);
        // a spring that was always there is no new load, and its load cell tells none
        assert_eq!([0.02, 0.025].map(|now| refuted(0.02, now)), [true, false]);
        // a load cell whose gain may be off by 10 % does not tell a quarter more
        accuracy.load_cell.gain_percent = 10.0;
        assert!(refuted_by(0.02, 0.025, &accuracy));
        let told = |before: f64| {
            let design = Design::of(&[&run(0.025)], &[&run(before)], &Accuracy::default(), true);
            (load_stiffness::CAUSE.candidate)(&design).is_told
        };
        assert_eq!([0.0, 0.02].map(told), [true, false]);
        let unseen = (load_stiffness::CAUSE.candidate)(&design());
        assert!(unseen.refuted.is_none(), "no load cell says nothing");
    }

    #[test]
    fn one_frequency_says_nothing_about_rate() {
        let input: Vec<f64> = (0..4000).map(|i| 150.0 * (0.0628 * f64::from(i)).sin()).collect();
        let run = Record::new("a", 0.01, input.clone(), input);
        let design = Design::of(&[&run], &[], &Accuracy::default(), true);
        for cause in candidates(&LIBRARY, &design) {
            let about_rate = [
                "creep",
                "rate-dependence",
                "electrical-lag",
                "amplifier-current-limit",
                "mechanical-resonance",
                "transport-delay",
                "sensor-filter",
            ];
            if about_rate.contains(&cause.id) {
                assert!(cause.blocked.is_some(), "{}", cause.id);
            }
        }
    }
}
