//! Actuator files: reading with places, writing, and what is unlikely about them.

use crate::BenchError;
use actuator_gap::{Doubt, Weight};
pub use actuator_gap::{
    GainRule, HarmonicResponse, StoredActuator, StoredChannels, StoredFit, StoredKind,
};
use measured_data::problem::{Fault, Place, Problem, Problems};
use measured_data::{DataError, RonFile, Source, read_ron, ron_text, write_atomic};
use preisach_dyn::{ActuatorLaw, PreisachError};
use std::path::Path;

/// What is unlikely about an actuator, each in a sentence at its place; `place` knows where a field such as
/// `model.calibration.deg_per_um` stands.
pub fn actuator_warnings(stored: &StoredActuator, place: impl Fn(&str) -> Place) -> Vec<String> {
    let unlikely = stored.doubts().into_iter().filter(|doubt| doubt.weight == Weight::Unlikely);
    let mut warnings: Vec<(String, String)> =
        unlikely.map(|doubt| (format!("model.{}", doubt.field), in_words(&doubt))).collect();
    let how = match stored.gain {
        Some(GainRule::Assumed) => Some("was assumed"),
        Some(GainRule::WidestSlowLoop) => Some("makes the widest slow loop +-10 deg"),
        _ => None,
    };
    if let Some(how) = how {
        let message = format!(
            "{} deg/um {how}, expected the gain of the linkage; flap angles, hinge moments and loads are off by its error: give flap_deg_per_um in dataset.ron and identify again",
            stored.model.calibration.deg_per_um
        );
        warnings.push(("model.calibration.deg_per_um".into(), message));
    }
    let said = |(field, message): (String, String)| {
        Problem::new(place(&field).field(field), Fault::Other(message)).to_string()
    };
    warnings.into_iter().map(said).collect()
}

/// Writes an actuator file atomically.
///
/// # Errors
/// [`BenchError::Data`].
pub fn write_actuator(stored: &StoredActuator, path: &Path) -> Result<(), BenchError> {
    let text = ron_text(stored)
        .map_err(|e| DataError::NotWritten { path: path.to_owned(), reason: e.to_string() })?;
    let (what, units) = match &stored.channels {
        Some(channels) => (
            format!("Model of {} to {}", channels.input, channels.output),
            format!(
                "// Of its names, volt stands for the unit of {}, deg (and um) for that of {}.\n",
                channels.input, channels.output
            ),
        ),
        None => ("Actuator".to_owned(), String::new()),
    };
    let comment = format!(
        "// {what} identified by hhc {} from: {}\n{units}// Made of the data; `hhc identify` or `hhc diagnose` again rather than edit.\n",
        stored.program_version, stored.title
    );
    let text = text.replacen('\n', &format!("\n{comment}"), 1);
    Ok(write_atomic(path, text.as_bytes())?)
}

const CALIBRATION_REMEDY: &str = "give the flap angle per displacement of the actuator, deg/um";
const GAIN_REMEDY: &str =
    "give the flap angle per volt, negative if the flap falls with a rising voltage";

fn in_words(doubt: &Doubt) -> String {
    format!("{}, expected {}; {}", doubt.found, doubt.expected, doubt.remedy)
}

/// Reads an actuator file and checks its model.
///
/// # Errors
/// Every problem of the file, with its line.
pub fn read_actuator(source: &Source) -> Result<StoredActuator, Problems> {
    let RonFile { value, index, mut problems } = read_ron::<StoredActuator>(source);
    if let Some(stored) = &value {
        let calibration = stored.model.calibration;
        let finite = "expected a finite number";
        let not_zero = "expected a finite number other than 0";
        let mut numbers = vec![
            ("calibration.deg_per_um", calibration.deg_per_um, not_zero, CALIBRATION_REMEDY),
            ("calibration.zero_um", calibration.zero_um, finite, "correct it"),
        ];
        if let ActuatorLaw::Linear(gain) = &stored.model.law {
            let (slope, bias) = (gain.gain_deg_per_volt, gain.bias_volt);
            numbers.push(("law.gain_deg_per_volt", slope, not_zero, GAIN_REMEDY));
            numbers.push(("law.bias_volt", bias, finite, "correct it"));
        }
        for (field, value, expected, remedy) in numbers {
            if !value.is_finite() || (value == 0.0 && expected == not_zero) {
                let name = field.rsplit('.').next().unwrap_or(field);
                let message = format!("{name} is {value}, {expected}; {remedy}");
                problems.push(index.place(&format!("model.{field}")), Fault::Refused { message });
            }
        }
        for error in stored.model.refused_stages() {
            let (place, message) = match error {
                PreisachError::Stage { list, index: i, stage, source } => {
                    let at = format!("model.{list}[{i}]");
                    (index.place(&at).field(format!("{at} ({stage})")), source.to_string())
                }
                other => (index.place("model"), other.to_string()),
            };
            problems.push(place, Fault::Refused { message });
        }
        if problems.is_empty() {
            for doubt in stored.doubts().into_iter().filter(|d| d.weight == Weight::Impossible) {
                let place = index.place(&format!("model.{}", doubt.field));
                problems.push(place, Fault::Refused { message: in_words(&doubt) });
            }
        }
    }
    problems.into_result(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use measured_data::RonIndex;
    use preisach_dyn::{AmplifierStage, LinkageStage, SensorStage};

    fn source(text: &str) -> Source {
        Source { name: "actuator.ron".into(), text: text.into() }
    }

    const BY_HAND: &str = r#"(
    kind: Actuator,
    title: "written by hand",
    model: (
        law: BoucWen(
            range_volt: (-20, 150), gain_deg_per_volt: 0.12,
            half_height_deg: 0.9, rise_volt: 30, sigma: 0.8, exponent: 2,
        ),
        range_volt: (-20, 150),
        calibration: (deg_per_um: 0.04, zero_um: 0),
        amplifier: [
            Lag(tau_s: 0.0005),
            CurrentLimit(slew_rate_volt_per_s: 2000),
            Saturation(v_min_volt: -20, v_max_volt: 150),
            Delay(delay_s: 0.0003),
            DielectricHeating(time_constant_s: 120, coefficient_per_k: 0.001),
            Depolarisation(threshold_volt: -15, repoling_volt: 60),
        ],
        linkage: [
            LogCreep(rate_per_decade: 0.015),
            KelvinVoigt(elements: [(compliance_ratio: 0.01, time_constant_s: 2)]),
            Resonance(frequency_hz: 150, damping_ratio: 0.02),
            Backlash(width_um: 1),
            CoulombFriction(width_um: 1),
            LoadStiffness(stiffness_ratio: 0.1),
        ],
        sensor: [
            Filter(tau_s: 0.0001),
            Nonlinearity(amplitude_um: 0.5, half_range_um: 250),
            Quantisation(step_um: 0.01),
            Delay(delay_s: 0.0002),
            MainsHum(amplitude_um: 0.1, frequency_hz: 50),
        ],
    ),
)"#;

    #[test]
    fn an_actuator_written_by_hand_has_its_law_and_stages() {
        let stored = read_actuator(&source(BY_HAND)).unwrap();
        let model = &stored.model;
        assert!(matches!(model.law, ActuatorLaw::BoucWen(_)));
        assert!(matches!(model.amplifier[4], AmplifierStage::DielectricHeating(_)));
        assert!(matches!(model.linkage[2], LinkageStage::Resonance(_)));
        assert!(matches!(model.sensor[4], SensorStage::MainsHum(_)));
        assert_eq!((model.amplifier.len(), model.linkage.len(), model.sensor.len()), (6, 6, 5));
        // written and read again: the same
        let text = ron_text(&stored).unwrap();
        assert_eq!(read_actuator(&source(&text)).unwrap(), stored);
    }

    #[test]
    fn the_impossible_is_a_problem_and_the_unlikely_a_warning() {
        assert_eq!(
            actuator_warnings(&read_actuator(&source(BY_HAND)).unwrap(), |_| Place::default()),
            Vec::<String>::new()
        );
        let with = |good: &str, bad: &str| {
            let text = BY_HAND.replacen(good, bad, 1);
            assert_ne!(text, BY_HAND);
            read_actuator(&source(&text))
        };
        let load = "LoadStiffness(stiffness_ratio: 0.1)";
        let problems = with(load, &format!("{load}, {load}")).unwrap_err();
        assert!(format!("{problems:?}").contains("2 LoadStiffness stages"), "{problems:?}");
        let stored = with("v_min_volt: -20, v_max_volt: 150", "v_min_volt: -200, v_max_volt: 500");
        let warnings = actuator_warnings(&stored.unwrap(), |_| Place::file("actuator.ron"));
        assert!(warnings.len() == 1 && warnings[0].contains("model.amplifier[2]"), "{warnings:?}");
    }

    #[test]
    fn an_assumed_gain_is_said_where_it_stands() {
        let text = BY_HAND.replace("kind: Actuator,", "kind: Actuator,\n    gain: Some(Assumed),");
        let from = source(&text);
        let index = RonIndex::new(&from.name, &from.text);
        let stored = read_actuator(&from).unwrap();
        let warnings = actuator_warnings(&stored, |field| index.place(field));
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        let (place, rest) = warnings[0].split_once(": model.calibration.deg_per_um: ").unwrap();
        let line = text.lines().position(|line| line.contains("deg_per_um")).unwrap() + 1;
        assert!(place.starts_with(&format!("actuator.ron:{line}:")), "{place}");
        assert!(rest.contains("was assumed") && rest.contains("flap_deg_per_um"), "{rest}");
    }

    #[test]
    fn every_refused_stage_is_named_with_its_list_index_and_range() {
        let text = BY_HAND
            .replace("Lag(tau_s: 0.0005)", "Lag(tau_s: -1)")
            .replace("rate_per_decade: 0.015", "rate_per_decade: 0.015, from_s: 10, to_s: 1");
        let all = read_actuator(&source(&text)).unwrap_err().to_string();
        for part in [
            "actuator.ron:12:13: model.amplifier[0] (Lag)",
            "tau_s is -1, expected a finite number that is not negative",
            "model.linkage[0] (LogCreep)",
            "to_s is 1, expected a finite number at least ten times from_s (100)",
        ] {
            assert!(all.contains(part), "{part}: {all}");
        }
    }

    #[test]
    fn a_gain_of_zero_is_refused_with_what_is_expected() {
        let text = "(kind: Actuator, title: \"\", model: (
            law: Linear(gain_deg_per_volt: 0, bias_volt: 65),
            range_volt: (-20, 150), calibration: (deg_per_um: 0, zero_um: 0)))";
        let all = read_actuator(&source(text)).unwrap_err().to_string();
        for part in [
            "model.law.gain_deg_per_volt: is refused: gain_deg_per_volt is 0, expected a finite number other than 0; give the flap angle per volt",
            "model.calibration.deg_per_um: is refused: deg_per_um is 0, expected a finite number other than 0; give the flap angle per displacement",
        ] {
            assert!(all.contains(part), "{part}: {all}");
        }
    }

    #[test]
    fn a_stage_or_law_outside_its_range_is_a_problem_of_the_file() {
        for (good, bad, name) in [
            ("tau_s: 0.0005", "tau_s: -0.0005", "tau_s"),
            ("damping_ratio: 0.02", "damping_ratio: 0", "damping_ratio"),
            ("sigma: 0.8", "sigma: 0.3", "less gives energy"),
            ("width_um: 1)", "breadth_um: 1)", "breadth_um"),
        ] {
            let text = BY_HAND.replacen(good, bad, 1);
            assert_ne!(text, BY_HAND);
            let problems = read_actuator(&source(&text)).unwrap_err();
            let all = format!("{problems:?}");
            assert!(all.contains(name), "{name}: {all}");
        }
    }
}
