//! The chain around a law: order, load, bench, batch, storing and taking up, refused input.
#![expect(clippy::float_cmp, reason = "results are claimed to be equal to the last bit")]

use crate::common;

use approx::assert_abs_diff_eq;
use common::{
    HIGH, LOW, amplifier, effects, every_law, largest_difference, linear_law, linkage, measured,
    plain, sampled, sensor, static_law, stored, unit,
};
use preisach_dyn::{
    ActuatorModel, AmplifierStage, Backlash, Calibration, CurrentLimit, Delay, Depolarisation,
    DielectricHeating, Drive, KelvinVoigt, KelvinVoigtElement, Lag, LinkageStage, LoadStiffness,
    LogCreep, PreisachError, Quantisation, Resonance, Saturation, SensorStage, StartState,
};
use proptest::prelude::*;
use std::f64::consts::TAU;

#[test]
fn a_load_takes_its_share() {
    let stage = LoadStiffness { stiffness_ratio: 0.25, compliance_um_per_newton: 0.9 };
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 3.0 };
    let model =
        ActuatorModel { linkage: vec![LinkageStage::LoadStiffness(stage)], ..plain(linear_law()) };
    let volts = sampled(200, 1e-3, |t| 65.0 + 80.0 * (TAU * 10.0 * t).sin());
    let moments = sampled(200, 1e-3, |t| 0.5 * (TAU * 20.0 * t).cos());
    let loads: Vec<f64> = moments.iter().map(|&m| calibration.load_newton(m)).collect();
    let free = plain(linear_law()).simulate(&volts, 1e-3).unwrap().output_deg;
    let drive = Drive { loads_newton: &loads, ..Drive::new(&volts, 1e-3) };
    let loaded = model.simulate_drive(&drive).unwrap().output_deg;
    for ((free, loaded), load) in free.iter().zip(&loaded).zip(&loads) {
        let exact = (free - 0.04 * 0.9 * load) / 1.25;
        assert_abs_diff_eq!(*loaded, exact, epsilon = 1e-12);
    }
    // virtual work: what the moment does on the angle, the load does on the displacement
    let (angle_rad, way_m) = (0.04_f64.to_radians(), 1e-6);
    assert_abs_diff_eq!(calibration.load_newton(0.5) * way_m, 0.5 * angle_rad, epsilon = 1e-15);
    // a load nobody feels is an error, not silence
    let error = plain(linear_law()).simulate_drive(&drive).unwrap_err();
    assert!(matches!(error, PreisachError::NoLoadStage));
    let short = Drive { loads_newton: &loads[1..], ..drive };
    let error = model.simulate_drive(&short).unwrap_err();
    assert!(matches!(error, PreisachError::OutOfRange { value: 199.0, .. }));
    // sample by sample: the same bits
    let stepper = model.stepper(1e-3).unwrap();
    let mut memory = model.start_loaded(volts[0], loads[0], StartState::Rest).unwrap();
    for i in 1..200 {
        assert_eq!(stepper.step(&mut memory, volts[i], loads[i]).unwrap(), loaded[i]);
    }
}

/// Every stage at once around a law.
fn full(law: preisach_dyn::ActuatorLaw) -> ActuatorModel {
    let effects = effects();
    ActuatorModel {
        amplifier: effects.iter().flat_map(|m| m.amplifier.clone()).collect(),
        linkage: effects.iter().flat_map(|m| m.linkage.clone()).collect(),
        sensor: effects.iter().flat_map(|m| m.sensor.clone()).collect(),
        ..plain(law)
    }
}

#[test]
fn the_chain_acts_in_its_order() {
    // clip then lag is not lag then clip
    let clip = AmplifierStage::Saturation(Saturation::sharp(-20.0, 90.0));
    let lag = AmplifierStage::Lag(Lag { tau_s: 0.02 });
    let input = sampled(200, 1e-3, |t| 65.0 + 80.0 * (TAU * 8.0 * t).sin());
    let a = measured(&ActuatorModel { amplifier: vec![clip, lag], ..unit() }, &input, 1e-3);
    let b = measured(&ActuatorModel { amplifier: vec![lag, clip], ..unit() }, &input, 1e-3);
    assert!(largest_difference(&a, &b) > 1.0);
    let clipped = measured(&amplifier(clip), &input, 1e-3);
    assert!(largest_difference(&a, &measured(&amplifier(lag), &clipped, 1e-3)) < 1e-12);
    // the amplifier turns the hysteresis earlier than the linkage does
    let with = |amplifier, linkage| ActuatorModel { amplifier, linkage, ..plain(static_law()) };
    let before = with(vec![lag], vec![]).simulate(&input, 1e-3).unwrap().output_deg;
    let element = KelvinVoigtElement { compliance_ratio: 0.5, time_constant_s: 0.02 };
    let chain = KelvinVoigt { elements: vec![element] };
    let after = with(vec![], vec![LinkageStage::KelvinVoigt(chain)]);
    assert!(largest_difference(&before, &after.simulate(&input, 1e-3).unwrap().output_deg) > 0.1);
}

#[test]
fn the_rotor_sees_the_flap_and_the_bench_the_sensor() {
    let model = full(static_law());
    let input = sampled(300, 1e-3, |t| 65.0 + 80.0 * (TAU * 8.0 * t).sin());
    let bench = model.simulate_bench(&Drive::new(&input, 1e-3)).unwrap();
    let blind = ActuatorModel { sensor: vec![], ..model.clone() };
    assert_eq!(bench.output_deg, blind.simulate(&input, 1e-3).unwrap().output_deg);
    assert_eq!(bench.output_deg, model.simulate(&input, 1e-3).unwrap().output_deg);
    assert!(largest_difference(&bench.output_deg, &bench.measured_deg) > 0.1);
    // the monitor shows the terminals, behind lag, limit and clip
    assert!(bench.terminal_volt.iter().all(|v| (-5.0..=120.0).contains(v)));
    assert_eq!(bench.temperature_k.len(), input.len());
}

#[test]
fn a_batch_gives_the_bits_of_single_runs_whatever_the_threads() {
    let model = full(common::dynamic_law(preisach_dyn::RateForm::WellPosed));
    let records: Vec<Vec<f64>> = (0..9_u32)
        .map(|k| sampled(400, 1e-3, |t| 65.0 + 9.0 * f64::from(k) * (TAU * 6.0 * t).sin()))
        .collect();
    let drives: Vec<Drive> = records.iter().map(|r| Drive::new(r, 1e-3)).collect();
    let single: Vec<_> = drives.iter().map(|d| model.simulate_drive(d).unwrap()).collect();
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let batch = pool.install(|| model.simulate_batch(&drives)).unwrap();
        assert_eq!(batch, single);
    }
    // the first bad drive is the error
    let bad = [65.0, f64::NAN];
    let mut with_bad = drives.clone();
    with_bad[3] = Drive::new(&bad, 1e-3);
    with_bad[7] = Drive::new(&[], 1e-3);
    let error = model.simulate_batch(&with_bad).unwrap_err();
    assert!(matches!(error, PreisachError::NotFinite { index: 1, .. }), "{error}");
}

#[test]
fn bad_parameters_are_refused_with_their_name() {
    let refused =
        |model: &ActuatorModel| model.start(0.0, StartState::Rest).unwrap_err().to_string();
    for (model, name) in [
        (amplifier(AmplifierStage::Lag(Lag { tau_s: -1.0 })), "tau_s"),
        (amplifier(AmplifierStage::Delay(Delay { delay_s: f64::NAN })), "delay_s"),
        (
            amplifier(AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: 0.0 })),
            "slew_rate",
        ),
        (amplifier(AmplifierStage::Saturation(Saturation::sharp(1.0, 0.0))), "empty"),
        (
            amplifier(AmplifierStage::DielectricHeating(DielectricHeating::new(0.0, 1e-3))),
            "time_constant_s",
        ),
        (
            amplifier(AmplifierStage::Depolarisation(Depolarisation {
                repoling_volt: Some(-30.0),
                ..Depolarisation::new(-20.0)
            })),
            "repoling_volt",
        ),
        (
            amplifier(AmplifierStage::Depolarisation(Depolarisation {
                loss_per_volt_second: -0.1,
                ..Depolarisation::new(-20.0)
            })),
            "loss_per_volt_second",
        ),
        (linkage(LinkageStage::LogCreep(LogCreep::new(-0.1))), "rate_per_decade"),
        (linkage(LinkageStage::LogCreep(LogCreep { to_s: 0.2, ..LogCreep::new(0.1) })), "to_s"),
        (
            linkage(LinkageStage::Resonance(Resonance { frequency_hz: 90.0, damping_ratio: 0.0 })),
            "damping_ratio",
        ),
        (linkage(LinkageStage::Backlash(Backlash { width_um: -1.0 })), "width_um"),
        (sensor(SensorStage::Quantisation(Quantisation { step_um: f64::INFINITY })), "step_um"),
    ] {
        let text = refused(&model);
        assert!(text.contains(name), "{text}");
    }
}

#[test]
fn a_memory_of_another_chain_is_refused() {
    let lagged = amplifier(AmplifierStage::Lag(Lag { tau_s: 1e-3 }));
    let mut memory = lagged.start(0.0, StartState::Rest).unwrap();
    assert!(lagged.stepper(1e-3).unwrap().step(&mut memory, 1.0, 0.0).is_ok());
    let error = unit().stepper(1e-3).unwrap().step(&mut memory, 1.0, 0.0).unwrap_err();
    assert!(matches!(error, PreisachError::MemoryMismatch { found: 1, expected: 0, .. }));
    let delayed = amplifier(AmplifierStage::Delay(Delay { delay_s: 1e-3 }));
    assert!(delayed.stepper(1e-3).unwrap().step(&mut memory, 1.0, 0.0).is_err());
    let mut creeping =
        linkage(LinkageStage::LogCreep(LogCreep::new(0.01))).start(0.0, StartState::Rest).unwrap();
    let longer = linkage(LinkageStage::LogCreep(LogCreep { to_s: 1e5, ..LogCreep::new(0.01) }));
    assert!(longer.stepper(1e-3).unwrap().step(&mut creeping, 1.0, 0.0).is_err());
}

proptest! {
    #[test]
    fn a_memory_stored_midway_goes_on_with_the_same_bits(
        past in prop::collection::vec(LOW..HIGH, 2..25),
        future in prop::collection::vec(LOW..HIGH, 1..25),
        step_s in 2e-4..5e-3_f64,
    ) {
        let law = every_law();
        let mut models: Vec<ActuatorModel> = law.into_iter().map(full).collect();
        models.extend(effects().into_iter().map(|m| ActuatorModel { law: static_law(), ..m }));
        for model in models {
            let stepper = model.stepper(step_s).unwrap();
            let mut memory = model.start(past[0], StartState::Rest).unwrap();
            for &u in &past {
                stepper.step(&mut memory, u, 0.0).unwrap();
                stepper.read(&mut memory);
            }
            let restored_model = stored(&model);
            let mut restored = stored(&memory);
            prop_assert_eq!(&restored, &memory);
            prop_assert_eq!(&restored_model, &model);
            let again = restored_model.stepper(step_s).unwrap();
            for &u in &future {
                let a = stepper.step(&mut memory, u, 0.0).unwrap();
                let b = again.step(&mut restored, u, 0.0).unwrap();
                prop_assert_eq!(a.to_bits(), b.to_bits());
                prop_assert_eq!(stepper.read(&mut memory).to_bits(), again.read(&mut restored).to_bits());
            }
            prop_assert_eq!(memory.counts(), restored.counts());
        }
    }
}
