//! NRMSE, rms, bias, largest error.

use crate::wave;
use approx::assert_abs_diff_eq;
use model_gap::{GapError, Misfit};
use proptest::prelude::*;

#[test]
fn two_sines_differ_by_their_phasors() {
    // whole cycles: the error is the sine of phasor 2 - 2.2 exp(-0.3 i)
    let measured = wave(&[(2.0, 0.0)], 5.0, 1e-3, 1000);
    let simulated = wave(&[(2.2, 0.3)], 5.0, 1e-3, 1000);
    let misfit = Misfit::of(&measured, &simulated).unwrap();
    let amplitude = (2.0_f64 - 2.2 * 0.3_f64.cos()).hypot(2.2 * 0.3_f64.sin());
    assert_abs_diff_eq!(misfit.rms, amplitude / 2.0_f64.sqrt(), epsilon = 1e-12);
    assert_abs_diff_eq!(misfit.nrmse, amplitude / 2.0, epsilon = 1e-12);
    assert_abs_diff_eq!(misfit.bias, 0.0, epsilon = 1e-14);
}

#[test]
fn knowing_only_the_mean_is_an_error_of_100_percent() {
    let measured: Vec<f64> = wave(&[(2.0, 0.4), (0.3, 1.0)], 4.0, 1e-3, 777);
    let mean = measured.iter().sum::<f64>() / 777.0;
    let misfit = Misfit::of(&measured, &vec![mean; 777]).unwrap();
    assert_abs_diff_eq!(misfit.nrmse, 1.0, epsilon = 1e-12);
}

#[test]
fn a_simulation_that_lies_too_low_has_a_positive_bias() {
    let measured = wave(&[(1.0, 0.0)], 1.0, 1e-2, 100);
    let mut simulated: Vec<f64> = measured.iter().map(|v| v - 0.5).collect();
    simulated[37] += 3.0;
    let misfit = Misfit::of(&measured, &simulated).unwrap();
    assert_abs_diff_eq!(misfit.bias, 0.5 - 0.03, epsilon = 1e-12);
}

#[test]
fn records_that_cannot_be_compared_are_refused() {
    let good = [0.0, 1.0, 0.5];
    assert!(matches!(Misfit::of(&good, &good[..2]), Err(GapError::Length { found: 2, .. })));
    assert!(matches!(Misfit::of(&good[..1], &good[..1]), Err(GapError::TooShort { .. })));
    let nan = [0.0, f64::NAN, 0.5];
    assert!(matches!(Misfit::of(&nan, &good), Err(GapError::NotFinite { index: 1, .. })));
    let error = Misfit::of(&good, &[0.0, 0.0, f64::INFINITY]).unwrap_err();
    assert!(error.to_string().contains("simulated output: sample 2 (from 0) is inf"), "{error}");
    let constant = Misfit::of(&[0.1; 30], &[0.2; 30]).unwrap_err();
    assert!(constant.to_string().contains("0.1 throughout"), "{constant}");
}

proptest! {
    #[test]
    fn nrmse_knows_no_unit_and_no_offset(
        measured in prop::collection::vec(-1.0..1.0_f64, 20),
        simulated in prop::collection::vec(-1.0..1.0_f64, 20),
        scale in prop_oneof![-1e3..-1e-3_f64, 1e-3..1e3_f64],
        offset in -1.0..1.0_f64,
    ) {
        let plain = Misfit::of(&measured, &simulated).unwrap();
        let changed = |v: &[f64]| v.iter().map(|x| scale * (x + offset)).collect::<Vec<f64>>();
        let other = Misfit::of(&changed(&measured), &changed(&simulated)).unwrap();
        prop_assert!((other.nrmse - plain.nrmse).abs() <= 1e-9 * plain.nrmse);
        prop_assert!((other.bias - scale * plain.bias).abs() <= 1e-9 * scale.abs());
    }

    #[test]
    fn bias_and_scatter_make_up_the_rms(
        measured in prop::collection::vec(-1.0..1.0_f64, 20),
        simulated in prop::collection::vec(-1.0..1.0_f64, 20),
    ) {
        let misfit = Misfit::of(&measured, &simulated).unwrap();
        let scatter: f64 = measured
            .iter()
            .zip(&simulated)
            .map(|(m, s)| (m - s - misfit.bias).powi(2))
            .sum::<f64>() / 20.0;
        prop_assert!((misfit.rms.powi(2) - misfit.bias.powi(2) - scatter).abs() < 1e-12);
        prop_assert!(misfit.rms >= misfit.bias.abs());
    }

    #[test]
    fn a_perfect_simulation_has_no_error(measured in prop::collection::vec(-1e6..1e6_f64, 2..50)) {
        prop_assume!(measured.iter().any(|v| v.to_bits() != measured[0].to_bits()));
        let misfit = Misfit::of(&measured, &measured).unwrap();
        prop_assert!(misfit.nrmse == 0.0 && misfit.rms == 0.0);
    }
}
