//! Experiments, their stimulus, their split, and the summary of both sets.

use crate::{noise, wave};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use model_gap::{
    Channel, Experiment, FirstHarmonicError, GapError, Misfit, Role, RunError, SplitRule, Stimulus,
    Summary, Use,
};
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;

const STEP_S: f64 = 1e-3;

fn record(id: &str, role: Role, input: Vec<f64>) -> Experiment {
    let output =
        Channel::new("displacement", "um", input.iter().map(|v| 0.5 * v).collect()).unwrap();
    let input = Channel::new("command", "V", input).unwrap();
    Experiment::new(id, role, STEP_S, input, output).unwrap()
}

fn sine(id: &str, frequency_hz: f64, amplitude: f64) -> Experiment {
    let input = wave(&[(amplitude, 1.2)], frequency_hz, STEP_S, 3000);
    record(id, Role::Measured, input.iter().map(|v| v + 65.0).collect())
}

/// A triangle of a given rate about 65 V, 3 s long.
fn triangle(id: &str, rate_v_s: f64) -> Experiment {
    let input = (0..3000)
        .map(|i| 65.0 + rate_v_s * STEP_S * f64::from((i % 1000 - 500_i32).abs()))
        .collect();
    record(id, Role::Reference, input)
}

/// The set of a bench: slow sine and reversals, five frequencies at three amplitudes, a mixed
/// signal, a step.
fn bench() -> Vec<Experiment> {
    let slow = wave(&[(85.0, 0.0)], 0.5, STEP_S, 4000);
    let mut set = vec![record("slow", Role::Reference, slow), triangle("reversals", 68.0)];
    for hz in [20.0, 1.0, 10.0, 5.0, 15.0] {
        for amplitude in [85.0, 20.0, 50.0] {
            set.push(sine(&format!("{hz}Hz-{amplitude}V"), hz, amplitude));
        }
    }
    let mixed = wave(&[(0.0, 0.0), (20.0, 0.1), (30.0, 2.0), (15.0, 1.0)], 5.0, STEP_S, 3000);
    set.push(record("mixed", Role::Measured, mixed));
    let step = (0..1000).map(|i| f64::from(u8::from(i > 500))).collect();
    set.push(record("step", Role::Measured, step));
    set.push(triangle("fast triangle", 300.0));
    set
}

fn trained(set: &[Experiment]) -> Vec<&str> {
    let uses = SplitRule::SlowAndTwoFrequencies.split(set).unwrap();
    set.iter().zip(&uses).filter(|(_, u)| **u == Use::Train).map(|(e, _)| e.id()).collect()
}

#[test]
fn slow_records_and_two_frequencies_train() {
    let expected = ["slow", "reversals", "1Hz-85V", "1Hz-20V", "10Hz-85V", "10Hz-20V"];
    assert_eq!(trained(&bench()), expected);
    let few = [sine("a", 0.5, 1.0), sine("b", 1.0, 1.0), sine("c", 2.0, 1.0)];
    assert_eq!(trained(&few), ["a", "b"]);
    assert_eq!(trained(&few[..1]), ["a"]);
}

#[test]
fn the_split_does_not_depend_on_the_order() {
    let mut set = bench();
    let rule = SplitRule::SlowAndTwoFrequencies;
    let by_id = |set: &[Experiment]| {
        let mut pairs: Vec<(String, Use)> =
            set.iter().map(|e| e.id().to_string()).zip(rule.split(set).unwrap()).collect();
        pairs.sort();
        pairs
    };
    let before = by_id(&set);
    set.reverse();
    assert_eq!(by_id(&set), before);
}

#[test]
fn a_stated_use_takes_precedence() {
    let mut set = bench();
    set[2] = set[2].clone().with_use(Use::Train); // 20 Hz
    set[0] = set[0].clone().with_use(Use::HeldOut);
    let uses = SplitRule::SlowAndTwoFrequencies.split(&set).unwrap();
    assert_eq!((uses[2], uses[0]), (Use::Train, Use::HeldOut));

    let stated: Vec<Experiment> =
        set.into_iter().zip(&uses).map(|(e, used)| e.with_use(*used)).collect();
    assert_eq!(SplitRule::Stated.split(&stated).unwrap(), uses);
}

#[test]
fn impossible_splits_are_refused() {
    let rule = SplitRule::SlowAndTwoFrequencies;
    let twice = [sine("a", 5.0, 1.0), sine("a", 10.0, 1.0)];
    assert_eq!(rule.split(&twice), Err(GapError::DuplicateId { id: "a".into() }));
    let unstated = [sine("a", 5.0, 1.0)];
    assert_eq!(SplitRule::Stated.split(&unstated), Err(GapError::NoStatedUse { id: "a".into() }));
    let held = [sine("a", 5.0, 1.0).with_use(Use::HeldOut)];
    assert!(rule.split(&[triangle("no sine", 1.0)]).is_err());
    assert!(matches!(rule.split(&held), Err(GapError::NothingToTrain { experiments: 1, .. })));
    assert!(matches!(rule.split(&[]), Err(GapError::NothingToTrain { .. })));
}

#[test]
fn the_rule_prints_itself() {
    let words = SplitRule::SlowAndTwoFrequencies.to_string();
    assert!(
        words.contains("the lowest and the middle one") && words.contains("held out"),
        "{words}"
    );
    assert!(!words.contains("  "), "{words}");
    assert!(SplitRule::Stated.to_string().contains("states"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn sines_are_recognised(
        frequency_hz in 0.4..200.0_f64,
        amplitude in 0.1..100.0_f64,
        mean in -100.0..100.0_f64,
        phase in -3.0..3.0_f64,
        seed in 0..1000_u64,
    ) {
        let clean = wave(&[(amplitude, phase)], frequency_hz, STEP_S, 3000);
        let shifted: Vec<f64> = clean.iter().map(|v| v + mean).collect();
        let Stimulus::Sine { frequency_hz: hz, amplitude: a, mean: m, .. } =
            Stimulus::of(&shifted, STEP_S) else { return Err(TestCaseError::fail("no sine")) };
        prop_assert!((hz / frequency_hz - 1.0).abs() < 1e-8, "{hz} {frequency_hz}");
        prop_assert!((a / amplitude - 1.0).abs() < 1e-6);
        prop_assert!((m - mean).abs() < 1e-6 * amplitude.max(mean.abs()));

        let noisy: Vec<f64> = shifted
            .iter()
            .zip(noise(seed, 3000))
            .map(|(v, e)| v + 0.01 * amplitude * e)
            .collect();
        let Stimulus::Sine { frequency_hz: hz, .. } = Stimulus::of(&noisy, STEP_S) else {
            return Err(TestCaseError::fail("no sine in noise"));
        };
        // resolution 1 / duration, noise -37 dB
        prop_assert!((hz - frequency_hz).abs() < 0.003 / 3.0, "{hz} {frequency_hz}");
    }
}

#[test]
fn a_rest_before_and_after_is_left_out() {
    for phase in [0.0, 1.2, -FRAC_PI_2] {
        let mut record = vec![65.0; 250];
        record.extend(wave(&[(25.0, phase)], 10.0, STEP_S, 1200).iter().map(|v| v + 65.0));
        record.extend(vec![65.0; 100]);
        let Stimulus::Sine { frequency_hz, amplitude, mean, samples } =
            Stimulus::of(&record, STEP_S)
        else {
            panic!("no sine");
        };
        assert_relative_eq!(frequency_hz, 10.0, max_relative = 1e-4);
        assert_relative_eq!(amplitude, 25.0, max_relative = 1e-3);
        assert_relative_eq!(mean, 65.0, max_relative = 1e-3);
        // a sine that leaves the rest smoothly meets it in a sample before or after
        assert!(samples.start.abs_diff(250) <= 1 && samples.end.abs_diff(1450) <= 1);
    }
}

#[test]
fn other_signals_are_not_sines() {
    let ramp: Vec<f64> = (0..1000).map(f64::from).collect();
    let triangle: Vec<f64> = (0..1000).map(|i| f64::from((i % 200 - 100_i32).abs())).collect();
    let step: Vec<f64> = (0..1000).map(|i| f64::from(u8::from(i > 500))).collect();
    let mixed = wave(&[(0.0, 0.0), (20.0, 0.1), (30.0, 2.0)], 5.0, STEP_S, 1000);
    let part = wave(&[(1.0, 0.0)], 0.8, STEP_S, 1000);
    let swept: Vec<f64> = (0..2000).map(|i| (1e-5 * f64::from(i * i)).sin()).collect();
    for samples in [ramp, triangle, step, mixed, part, swept, vec![3.0; 100], vec![1.0]] {
        assert_eq!(Stimulus::of(&samples, STEP_S), Stimulus::Other);
    }
}

#[test]
fn channels_and_records_are_checked() {
    assert!(matches!(Channel::new("u", "V", vec![1.0]), Err(GapError::TooShort { .. })));
    let error = Channel::new("u", "V", vec![0.0, f64::NAN]).unwrap_err();
    assert!(error.to_string().starts_with("u: sample 1"), "{error}");
    let channel = |n| Channel::new("y", "um", vec![0.0; n]).unwrap();
    let of = |step, n| Experiment::new("a", Role::Measured, step, channel(9), channel(n));
    assert!(of(1e-3, 9).is_ok());
    assert!(matches!(of(1e-3, 8), Err(GapError::Length { found: 8, expected: 9, .. })));
    assert!(of(0.0, 9).is_err() && of(f64::NAN, 9).is_err());
    let good = of(1e-3, 9).unwrap();
    assert_eq!((good.output().name(), good.output().unit()), ("y", "um"));
    assert_eq!((good.time_step_s(), good.role()), (1e-3, Role::Measured));
}

#[test]
fn sets_are_summarised_apart() {
    let measured = wave(&[(2.0, 0.0)], 5.0, STEP_S, 1000);
    let run = |id: &str, used, ratio: f64, late_rad: f64| {
        let simulated = wave(&[(2.0 * ratio, late_rad)], 5.0, STEP_S, 1000);
        RunError {
            id: id.into(),
            used,
            misfit: Misfit::of(&measured, &simulated).unwrap(),
            first_harmonic: FirstHarmonicError::of(&measured, &simulated, STEP_S, 5.0).ok(),
        }
    };
    let mut errors = vec![
        run("a", Use::Train, 1.02, 0.0),
        run("b", Use::Train, 0.96, 0.01),
        run("c", Use::HeldOut, 1.0, -0.2),
        run("d", Use::HeldOut, 0.5, 0.1),
        run("e", Use::HeldOut, 1.8, 0.0),
    ];
    let trained = Summary::of(&errors, Use::Train).unwrap();
    assert_eq!((trained.experiments, trained.worst_nrmse.id.as_str()), (2, "b"));
    assert_relative_eq!(
        trained.mean_nrmse,
        0.5 * (errors[0].misfit.nrmse + errors[1].misfit.nrmse),
        max_relative = 1e-15
    );
    let held = Summary::of(&errors, Use::HeldOut).unwrap();
    assert_eq!((held.experiments, held.worst_nrmse.id.as_str()), (3, "e"));
    let phase = held.worst_phase_deg.unwrap();
    assert_eq!(phase.id, "c");
    assert_abs_diff_eq!(phase.value, -0.2_f64.to_degrees(), epsilon = 1e-9);
    assert_eq!(held.worst_amplitude_ratio.unwrap().id, "d"); // a half is farther off than 1.8

    for run in &mut errors {
        (run.used, run.first_harmonic) = (Use::Train, None);
    }
    assert_eq!(Summary::of(&errors, Use::HeldOut), None);
    assert_eq!(Summary::of(&errors, Use::Train).unwrap().worst_phase_deg, None);
}
