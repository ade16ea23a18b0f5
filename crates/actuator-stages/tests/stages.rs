//! Every stage by itself: refused parameters, whole signals, memories, the gain, loads.
#![expect(clippy::float_cmp, reason = "results are claimed to be equal to the last bit")]

use actuator_stages::{
    Accommodation, AmplifierStage, Backlash, Calibration, CoulombFriction, CurrentLimit, Delay,
    Depolarisation, DielectricHeating, KelvinVoigt, KelvinVoigtElement, Lag, LinkageStage,
    LoadStiffness, LogCreep, MainsHum, Nonlinearity, NonlinearityShape, Quantisation, Relaxation,
    RelaxationElement, Resonance, Saturation, SensorStage, StageError, StageMemory, StageStep,
    Step,
};
use approx::assert_abs_diff_eq;

const STEP_S: f64 = 1e-3;
const CALIBRATION: Calibration = Calibration { deg_per_um: -0.04, zero_um: 3.0 };

fn amplifier() -> [AmplifierStage; 6] {
    [
        AmplifierStage::Lag(Lag { tau_s: 2e-3 }),
        AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: 300.0 }),
        AmplifierStage::Saturation(Saturation {
            v_min_volt: -5.0,
            v_max_volt: 8.0,
            knee_volt: 2.0,
        }),
        AmplifierStage::Delay(Delay { delay_s: 2.5e-3 }),
        AmplifierStage::DielectricHeating(DielectricHeating {
            time_constant_s: 0.3,
            coefficient_per_k: 0.02,
            rise_k_per_volt2_hz: 0.01,
        }),
        AmplifierStage::Depolarisation(Depolarisation {
            threshold_volt: -2.0,
            loss_per_volt: 0.02,
            loss_per_volt_second: 0.5,
            repoling_volt: Some(30.0),
        }),
    ]
}

fn linkage() -> [LinkageStage; 8] {
    let slow = KelvinVoigtElement { compliance_ratio: 0.05, time_constant_s: 0.4 };
    let late = RelaxationElement { share: 0.3, time_constant_s: 0.02 };
    [
        LinkageStage::LogCreep(LogCreep::new(0.02)),
        LinkageStage::KelvinVoigt(KelvinVoigt { elements: vec![slow, slow] }),
        LinkageStage::Relaxation(Relaxation { elements: vec![late] }),
        LinkageStage::Accommodation(Accommodation { share: 0.2, travel_um: 60.0 }),
        LinkageStage::Resonance(Resonance { frequency_hz: 60.0, damping_ratio: 0.05 }),
        LinkageStage::Backlash(Backlash { width_um: 20.0 }),
        LinkageStage::CoulombFriction(CoulombFriction { width_um: 30.0 }),
        LinkageStage::LoadStiffness(LoadStiffness {
            stiffness_ratio: 0.25,
            compliance_um_per_newton: 0.1,
        }),
    ]
}

fn sensor() -> [SensorStage; 5] {
    [
        SensorStage::Filter(Lag { tau_s: 1e-3 }),
        SensorStage::Nonlinearity(Nonlinearity {
            amplitude_um: 4.0,
            half_range_um: 300.0,
            shape: NonlinearityShape::CubicAbout { straight: 0.4 },
        }),
        SensorStage::Quantisation(Quantisation { step_um: 1.5 }),
        SensorStage::Delay(Delay { delay_s: 7e-4 }),
        SensorStage::MainsHum(MainsHum { amplitude_um: 5.0, frequency_hz: 50.0, phase_rad: 1.0 }),
    ]
}

/// All stages made ready.
fn steps() -> Vec<StageStep> {
    let front = amplifier().map(|stage| stage.prepared(STEP_S));
    let rear = linkage().map(|stage| stage.prepared(STEP_S, &CALIBRATION));
    let bench = sensor().map(|stage| stage.prepared(STEP_S, &CALIBRATION));
    front.into_iter().chain(rear).chain(bench).collect()
}

/// Two tones, at rest for the first samples.
fn signal() -> Vec<f64> {
    let tones = |t: f64| 9.0 * (40.0 * t).sin() + 3.0 * (170.0 * t).sin();
    (0..600_i32).map(|i| 1.0 + tones(STEP_S * f64::from((i - 5).max(0)))).collect()
}

#[test]
fn a_whole_signal_gives_the_numbers_of_sample_by_sample() {
    for step in steps() {
        let (mut memory, first) = step.start(signal()[0]);
        let later = signal();
        let later = later[1..].iter().map(|&input| step.advance(&mut memory, input));
        let single: Vec<f64> = std::iter::once(first).chain(later).collect();
        let mut whole = signal();
        step.pass(&mut whole);
        // lags are summed in another order there
        let largest = single.iter().zip(&whole).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(largest < 1e-13, "{largest:e}: {step:?}");
        let moved = whole.iter().zip(signal()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let scales = matches!(step, StageStep::Heating(_) | StageStep::Depolarisation(_));
        assert!(scales != (moved > 0.01), "{moved}: {step:?}");
    }
}

#[test]
fn a_memory_stored_midway_goes_on_with_the_same_bits() {
    let signal = signal();
    for step in steps() {
        let (mut memory, _) = step.start(signal[0]);
        for &input in &signal[1..300] {
            step.advance(&mut memory, input);
        }
        let text = serde_json::to_string(&memory).unwrap();
        let mut stored: StageMemory = serde_json::from_str(&text).unwrap();
        assert_eq!(stored, memory);
        for &input in &signal[300..] {
            assert_eq!(step.advance(&mut memory, input), step.advance(&mut stored, input));
        }
        assert_eq!(step.gain(&memory), step.gain(&stored));
    }
}

#[test]
fn a_memory_belongs_to_stages_of_its_kind_and_size_alone() {
    let steps = steps();
    let memories: Vec<StageMemory> = steps.iter().map(|step| step.start(1.0).0).collect();
    for (step, own) in steps.iter().zip(&memories) {
        assert!(step.owns(own), "{step:?}");
        for other in &memories {
            let alike = std::mem::discriminant(own) == std::mem::discriminant(other);
            assert!(alike || !step.owns(other), "{step:?} owns {other:?}");
            assert!(alike || step.advance(&mut other.clone(), 1.0).is_nan());
        }
    }
    // creep of eight lags is not that of one
    let (eight, one) = (&steps[6], &steps[8]);
    assert!(!one.owns(&memories[6]) && !eight.owns(&memories[8]));
}

#[test]
fn heat_and_loss_of_polarisation_act_on_the_gain_alone() {
    for (step, sign) in [(&steps()[4], 1.0), (&steps()[5], -1.0)] {
        let (mut memory, first) = step.start(1.0);
        assert_eq!((first, step.gain(&memory)), (1.0, 1.0));
        for &input in &signal()[1..] {
            assert_eq!(step.advance(&mut memory, input), input);
        }
        let change = step.gain(&memory) - 1.0;
        assert!(sign * change > 0.01, "{change}");
        if let StageMemory::Heating(heat) = &memory {
            assert_abs_diff_eq!(0.02 * heat.temperature_k(), change, epsilon = 1e-14);
        }
    }
}

#[test]
fn slow_states_are_taken_to_where_a_period_leaves_them() {
    // a lag of 20 periods: from two values a period apart to the steady oscillation
    let (period_s, samples) = (0.05, 50_i32);
    let element = RelaxationElement { share: 1.0, time_constant_s: 20.0 * period_s };
    let stage = LinkageStage::Relaxation(Relaxation { elements: vec![element] });
    let step = stage.prepared(STEP_S, &CALIBRATION);
    let input =
        |i: i32| 1.0 + (std::f64::consts::TAU * f64::from(i) / f64::from(samples)).sin().abs();
    let (before, _) = step.start(input(0));
    let period = |memory: &mut StageMemory| {
        (1..=samples).map(|i| step.advance(memory, input(i))).last().unwrap()
    };
    let mut now = before.clone();
    let first = period(&mut now);
    step.settle(&before, &mut now, period_s);
    let settled = period(&mut now);
    let again = period(&mut now);
    assert_abs_diff_eq!(settled, again, epsilon = 1e-12);
    assert!((settled - first).abs() > 0.1, "{first} {settled}");
}

#[test]
fn a_load_bends_the_linkage_in_proportion() {
    let [.., load] = linkage();
    let StageStep::Load(step) = load.prepared(STEP_S, &CALIBRATION) else {
        panic!("{load:?} is no load")
    };
    let own = StageStep::Load(step).start(2.0).1;
    assert_eq!(own, step.under(2.0, 0.0));
    assert_abs_diff_eq!(own, 2.0 / 1.25, epsilon = 1e-15);
    // 0.1 um/N on -0.04 deg/um, against a growing displacement
    assert_abs_diff_eq!(step.under(2.0, 50.0) - own, 0.2 / 1.25, epsilon = 1e-14);
}

#[test]
fn bad_parameters_are_refused_with_their_name() {
    for stage in amplifier() {
        assert_eq!(stage.checked().1, Ok(()), "{stage:?}");
    }
    for stage in linkage() {
        assert_eq!(stage.checked().1, Ok(()), "{stage:?}");
    }
    for stage in sensor() {
        assert_eq!(stage.checked().1, Ok(()), "{stage:?}");
    }
    let refused = |(name, checked): (&str, Result<(), StageError>)| {
        format!("{name}: {}", checked.unwrap_err())
    };
    let empty = AmplifierStage::Saturation(Saturation::sharp(8.0, 8.0));
    assert_eq!(
        refused(empty.checked()),
        "Saturation: end of a range is 8, expected above its lower end 8: the range is empty or not finite"
    );
    let threshold = AmplifierStage::Depolarisation(Depolarisation::new(f64::NAN));
    assert_eq!(
        refused(threshold.checked()),
        "Depolarisation: threshold_volt at index 0 is NaN, expected a finite number"
    );
    let share = Accommodation { share: 0.6, travel_um: 60.0 };
    assert_eq!(
        refused(LinkageStage::Accommodation(share).checked()),
        "Accommodation: share of the accommodation is 0.6, expected 0 to 0.5"
    );
    let filter = SensorStage::Filter(Lag { tau_s: -1.0 });
    assert_eq!(
        refused(filter.checked()),
        "Filter: tau_s is -1, expected a finite number that is not negative"
    );
}
