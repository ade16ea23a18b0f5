//! What is refused, and what the reader is told to do.

use crate::common::{linear, prandtl, statics};
use actuator_export::{ExportError, Target, export, remarks};
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, Backlash, Delay, Depolarisation, DielectricHeating,
    HystereticOscillator, Lag, LinkageStage, OscillatorParameters, TrainedRange, VoltageRange,
};

const TARGETS: [Target; 4] = [Target::C, Target::Python, Target::Matlab, Target::Json];

fn refused(model: &ActuatorModel, name: &str, time_step_s: f64) -> ExportError {
    let mut errors =
        TARGETS.map(|target| export(model, name, time_step_s, target).unwrap_err()).into_iter();
    let first = errors.next().unwrap();
    // NaN is not equal to itself: the messages are compared
    assert!(errors.all(|error| error.to_string() == first.to_string()));
    println!("{first}");
    first
}

#[test]
fn names_that_would_not_compile_are_refused_with_a_remedy() {
    let model = statics(5);
    for name in [
        "",
        "2nd",
        "_flap",
        "Flap",
        "my flap",
        "flap-1",
        "flügel",
        "double",
        "def",
        "classdef",
        "yield",
        "law_step",
        "numbers",
        "a_name_that_is_longer_than_compilers_tell_apart",
    ] {
        let message = refused(&model, name, 1e-3).to_string();
        assert!(message.contains(&format!("`{name}`")) && message.contains("flap_actuator"));
    }
    for name in ["flap", "a", "left_flap_2"] {
        assert!(TARGETS.iter().all(|target| export(&model, name, 1e-3, *target).is_ok()), "{name}");
    }
}

#[test]
fn time_steps_that_are_none_are_refused() {
    for time_step_s in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        let error = refused(&statics(5), "flap", time_step_s);
        assert!(matches!(error, ExportError::TimeStep { .. }));
        assert!(error.to_string().contains("positive"));
    }
}

#[test]
fn an_oscillator_is_refused_by_name_with_the_remedy() {
    let law = HystereticOscillator::new(OscillatorParameters {
        range_volt: VoltageRange::amplified_stack(),
        gain_deg_per_volt: 0.1,
        frequency_hz: 150.0,
        damping_ratio: 0.05,
        hysteretic_share: 0.3,
        loading_per_deg: 0.1,
        unloading_per_deg: 0.1,
        offset_deg: 0.0,
    });
    let law = ActuatorLaw::HystereticOscillator(law.unwrap());
    let error = refused(&ActuatorModel { law, ..linear() }, "flap", 1e-3);
    assert!(matches!(error, ExportError::Law { .. }));
    assert!(error.to_string().contains("Bouc-Wen oscillator"), "{error}");
    assert!(error.to_string().contains("--model"), "{error}");
}

#[test]
fn stages_that_are_not_written_are_named_with_the_remedy() {
    let heating = AmplifierStage::DielectricHeating(DielectricHeating::new(0.2, 2e-3));
    let loss = AmplifierStage::Depolarisation(Depolarisation::new(-10.0));
    for (stage, name) in [(heating, "DielectricHeating"), (loss, "Depolarisation")] {
        let lag = AmplifierStage::Lag(Lag { tau_s: 1e-3 });
        let model = ActuatorModel { amplifier: vec![lag, stage], ..statics(5) };
        let message = refused(&model, "flap", 1e-3).to_string();
        assert!(message.contains(&format!("amplifier[1] ({name})")), "{message}");
        assert!(message.contains("--model"), "{message}");
    }
}

#[test]
fn a_delay_of_too_many_samples_says_which_time_step_would_do() {
    let delay = AmplifierStage::Delay(Delay { delay_s: 0.5 });
    let model = ActuatorModel { amplifier: vec![delay], ..statics(5) };
    let ExportError::Delay { factor, .. } = refused(&model, "flap", 1e-5) else { panic!() };
    assert!(export(&model, "flap", 1e-5 * factor, Target::C).is_ok(), "{factor}");
}

#[test]
fn what_the_actuator_itself_may_not_have_is_refused() {
    let gap = LinkageStage::Backlash(Backlash { width_um: -1.0 });
    let model = ActuatorModel { linkage: vec![gap], ..statics(5) };
    assert!(refused(&model, "flap", 1e-3).to_string().contains("linkage[0] (Backlash)"));
    let mut model = linear();
    let ActuatorLaw::Linear(law) = &mut model.law else { panic!("law") };
    law.bias_volt = f64::NAN;
    assert!(refused(&model, "flap", 1e-3).to_string().contains("bias_volt"));
}

#[test]
fn remarks_say_what_is_done_only_nearly() {
    assert_eq!(remarks(&statics(5)), Vec::<String>::new());
    let trained = TrainedRange {
        least_amplitude_volt: 25.0,
        largest_amplitude_volt: 85.0,
        lowest_hz: 0.2,
        highest_hz: 10.0,
        bench_highest_hz: 20.0,
    };
    let said = remarks(&ActuatorModel { trained: Some(trained), ..prandtl(1e-3) });
    assert!(said[0].contains("85.000 V") && said[1].contains("no exact inverse"), "{said:?}");
    let delay = AmplifierStage::Delay(Delay { delay_s: 1e-3 });
    let said = remarks(&ActuatorModel { amplifier: vec![delay], ..statics(5) });
    assert!(said.len() == 1 && said[0].contains("delay"), "{said:?}");
}
