//! Inputs that are one sine.

use crate::{noise, wave};
use approx::assert_relative_eq;
use model_gap::Sine;
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;

const STEP_S: f64 = 1e-3;

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
        let Some(Sine { frequency_hz: hz, amplitude: a, mean: m, .. }) = Sine::of(&shifted, STEP_S)
        else { return Err(TestCaseError::fail("no sine")) };
        prop_assert!((hz / frequency_hz - 1.0).abs() < 1e-8, "{hz} {frequency_hz}");
        prop_assert!((a / amplitude - 1.0).abs() < 1e-6);
        prop_assert!((m - mean).abs() < 1e-6 * amplitude.max(mean.abs()));

        let noisy: Vec<f64> = shifted
            .iter()
            .zip(noise(seed, 3000))
            .map(|(v, e)| v + 0.01 * amplitude * e)
            .collect();
        let Some(Sine { frequency_hz: hz, .. }) = Sine::of(&noisy, STEP_S) else {
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
        let Some(Sine { frequency_hz, amplitude, mean, samples }) = Sine::of(&record, STEP_S)
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
        assert_eq!(Sine::of(&samples, STEP_S), None);
    }
}
