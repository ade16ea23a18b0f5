//! Harmonics by least squares, first harmonic errors.

use crate::{noise, wave};
use approx::assert_abs_diff_eq;
use model_gap::{FirstHarmonicError, GapError, HarmonicFit};
use proptest::prelude::*;

const STEP_S: f64 = 1e-3;

proptest! {
    #[test]
    fn a_broken_number_of_cycles_is_no_obstacle(
        frequency_hz in 3.0..30.0_f64,
        harmonics in prop::collection::vec((0.1..2.0_f64, -3.0..3.0_f64), 9),
        count in 700..1500_usize,
        mean in -5.0..5.0_f64,
    ) {
        let record: Vec<f64> =
            wave(&harmonics, frequency_hz, STEP_S, count).iter().map(|v| v + mean).collect();
        let fit = HarmonicFit::of(&record, STEP_S, frequency_hz, 9).unwrap();
        prop_assert!((fit.mean - mean).abs() < 1e-9);
        for (found, (amplitude, phase)) in fit.harmonics.iter().zip(&harmonics) {
            prop_assert!((found.amplitude() - amplitude).abs() < 1e-9);
            let off = (found.phase_rad() - phase).sin();
            prop_assert!(off.abs() < 1e-7, "{off:e}");
        }
    }
}

#[test]
fn amplitude_and_phase_errors_are_exact() {
    for (ratio, late_rad) in [(1.0, 0.0), (0.8, 0.05), (1.3, -2.0), (0.4, 3.1)] {
        // the measured wave is distorted and the cycles broken: 15 Hz in 350 samples
        let measured = wave(&[(4.0, 0.3), (0.5, 1.0), (0.2, -1.0)], 15.0, STEP_S, 350);
        let simulated = wave(&[(4.0 * ratio, 0.3 + late_rad), (0.1, 0.0)], 15.0, STEP_S, 350);
        let first = FirstHarmonicError::of(&measured, &simulated, STEP_S, 15.0).unwrap();
        assert_abs_diff_eq!(first.amplitude_ratio, ratio, epsilon = 1e-12);
        assert_abs_diff_eq!(first.phase_error_deg, late_rad.to_degrees(), epsilon = 1e-10);
        assert_abs_diff_eq!(first.measured.amplitude(), 4.0, epsilon = 1e-12);
    }
}

#[test]
fn noise_moves_the_harmonics_as_little_as_theory_says() {
    // the coefficients of a fit to N samples scatter by sigma sqrt(2 / N)
    let (count, sigma) = (4000, 0.2);
    let clean = wave(&[(1.0, 0.5)], 10.0, STEP_S, count);
    let mut square = 0.0;
    for seed in 0..50 {
        let record: Vec<f64> =
            clean.iter().zip(noise(seed, count)).map(|(v, e)| v + sigma * e).collect();
        let found = HarmonicFit::of(&record, STEP_S, 10.0, 3).unwrap().fundamental();
        square += (found.cosine - 0.5_f64.cos()).powi(2) + (found.sine - 0.5_f64.sin()).powi(2);
    }
    let scatter = (square / 100.0).sqrt() / (sigma * (2.0 / f64::from(4000)).sqrt());
    assert!((scatter - 1.0).abs() < 0.25, "{scatter}");
}

#[test]
fn what_has_no_harmonics_is_refused() {
    let record = wave(&[(1.0, 0.0)], 10.0, STEP_S, 500);
    let fit = |samples: &[f64], step, hz, count| HarmonicFit::of(samples, step, hz, count);
    assert!(matches!(fit(&record[..99], STEP_S, 10.0, 1), Err(GapError::TooFewCycles { .. })));
    assert!(fit(&record[..100], STEP_S, 10.0, 1).is_ok());
    assert!(matches!(
        fit(&record, STEP_S, 60.0, 9),
        Err(GapError::AboveNyquist { harmonic: 9, .. })
    ));
    // the ninth harmonic 1 Hz from its alias, seen for 40 ms
    assert!(matches!(fit(&record[..40], STEP_S, 55.5, 9), Err(GapError::NotSeparable { .. })));
    assert!(fit(&record[..60], STEP_S, 55.5, 9).is_ok());
    for (step, hz) in [(0.0, 10.0), (STEP_S, -1.0), (f64::NAN, 10.0), (STEP_S, f64::INFINITY)] {
        assert!(matches!(fit(&record, step, hz, 1), Err(GapError::OutOfRange { .. })));
    }
    assert!(fit(&record, STEP_S, 10.0, 0).is_err());
    let still = FirstHarmonicError::of(&[0.0; 500], &record, STEP_S, 10.0);
    assert!(matches!(still, Err(GapError::Constant { .. })));
    assert!(FirstHarmonicError::of(&record, &record[1..], STEP_S, 10.0).is_err());
}

#[test]
fn near_nyquist_fewer_harmonics_guard_the_first() {
    let record = wave(&[(1.0, 0.4)], 300.0, STEP_S, 333);
    let first = FirstHarmonicError::of(&record, &record, STEP_S, 300.0).unwrap();
    assert_abs_diff_eq!(first.measured.phase_rad(), 0.4, epsilon = 1e-11);
}
