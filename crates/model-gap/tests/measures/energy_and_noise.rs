//! Noise from repeated cycles, and the split of the energy.

use crate::{noise, wave};
use approx::assert_abs_diff_eq;
use model_gap::{EnergySplit, GapError, Misfit, noise_variance};
use proptest::prelude::*;

const STEP_S: f64 = 1e-3;
const SHAPE: [(f64, f64); 3] = [(4.0, 0.3), (0.5, 1.0), (0.2, -1.0)];

fn noisy(frequency_hz: f64, count: usize, sigma: f64, seed: u64) -> Vec<f64> {
    wave(&SHAPE, frequency_hz, STEP_S, count)
        .iter()
        .zip(noise(seed, count))
        .map(|(v, e)| v + sigma * e)
        .collect()
}

#[test]
fn the_estimate_is_unbiased() {
    // two to five blocks of 100 samples; 15 Hz repeats after 3 cycles of 200 samples
    for (frequency_hz, count, degrees_of_freedom) in
        [(10.0, 200, 100.0_f64), (10.0, 300, 200.0), (10.0, 599, 400.0), (15.0, 400, 200.0)]
    {
        let sigma = 0.05;
        let estimate = |seed| {
            let record = noisy(frequency_hz, count, sigma, seed);
            noise_variance(&record, STEP_S, frequency_hz).unwrap()
        };
        let mean = (0..400).map(estimate).sum::<f64>() / 400.0;
        // uniform noise: the variance of a squared deviate is 0.8 sigma^4; dividing by N K instead
        // would give (K - 1) / K
        let allowed = 4.0 * (2.0 / (400.0 * degrees_of_freedom)).sqrt();
        let ratio = mean / sigma.powi(2);
        assert!((ratio - 1.0).abs() < allowed, "{ratio} +- {allowed}");
    }
}

#[test]
fn without_noise_there_is_none() {
    let record = noisy(15.0, 1000, 0.0, 0);
    assert!(noise_variance(&record, STEP_S, 15.0).unwrap() < 1e-24);
}

#[test]
fn records_that_repeat_nothing_are_refused() {
    let record = noisy(10.0, 1000, 0.1, 1);
    let estimate = |samples: &[f64], hz| noise_variance(samples, STEP_S, hz);
    assert!(matches!(estimate(&record[..199], 10.0), Err(GapError::TooFewCycles { .. })));
    assert!(estimate(&record[..200], 10.0).is_ok());
    // 3 cycles of 15 Hz fill 200 samples: 5 cycles are not two blocks
    assert!(matches!(estimate(&record[..334], 15.0), Err(GapError::TooFewCycles { .. })));
    let irrational = 10.0 * 2.0_f64.sqrt();
    assert!(matches!(estimate(&record, irrational), Err(GapError::NoRepeat { .. })));
    assert!(matches!(estimate(&[f64::NAN; 400], 10.0), Err(GapError::NotFinite { .. })));
    assert!(matches!(estimate(&record, 0.0), Err(GapError::OutOfRange { .. })));
}

#[test]
fn known_energies_are_split_as_they_are() {
    // explained 4 cos, missed 0.5 and 0.2 (harmonics 2 and 3), noise of sigma 0.1
    let measured = noisy(10.0, 20_000, 0.1, 7);
    let simulated = wave(&SHAPE[..1], 10.0, STEP_S, 20_000);
    let noise = noise_variance(&measured, STEP_S, 10.0).unwrap();
    let split = EnergySplit::of(&measured, &simulated, noise).unwrap();
    let (signal, missed) = (0.5 * 16.0, 0.5 * (0.25 + 0.04));
    let total = signal + missed + 0.01;
    assert_abs_diff_eq!(split.explained, signal / total, epsilon = 3e-4);
    assert_abs_diff_eq!(split.structured, missed / total, epsilon = 3e-4);
    assert_abs_diff_eq!(split.noise, 0.01 / total, epsilon = 3e-5);

    let complete = wave(&SHAPE, 10.0, STEP_S, 20_000);
    let split = EnergySplit::of(&measured, &complete, noise).unwrap();
    assert!(split.structured < 3e-5);
}

#[test]
fn a_negative_noise_variance_is_refused() {
    for variance in [-1.0, f64::NAN, f64::INFINITY] {
        let refused = EnergySplit::of(&[0.0, 1.0], &[0.0, 0.5], variance);
        assert!(matches!(refused, Err(GapError::OutOfRange { .. })));
    }
    assert!(EnergySplit::of(&[1.0; 5], &[0.0; 5], 0.0).is_err());
}

proptest! {
    #[test]
    fn the_parts_are_the_whole(
        measured in prop::collection::vec(-1.0..1.0_f64, 30),
        simulated in prop::collection::vec(-1.0..1.0_f64, 30),
        noise_variance in 0.0..2.0_f64,
    ) {
        let split = EnergySplit::of(&measured, &simulated, noise_variance).unwrap();
        prop_assert!((split.explained + split.noise + split.structured - 1.0).abs() < 1e-12);
        prop_assert!(split.noise >= 0.0 && split.structured >= 0.0);
        let nrmse = Misfit::of(&measured, &simulated).unwrap().nrmse;
        prop_assert!((1.0 - split.explained - nrmse.powi(2)).abs() <= 1e-9 * nrmse.powi(2).max(1.0));
    }
}
