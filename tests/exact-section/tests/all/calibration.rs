//! The fit of poles and gains: what it imposes, and that more freedom fits better.

use exact_section::calibration::{
    FLAP_RANGE, MACH_RANGE, PoleLaw, REDUCED_FREQUENCIES, Samples, fit_gains, mach_nodes, nodes_of,
};
use num_complex::Complex64;

#[test]
fn start_and_steady_values_are_imposed() {
    let law = PoleLaw::start();
    let poles = law.poles(0.45);
    let sample = &Samples::at(0.45, &[0.23]).unwrap()[0];
    let (gains, _) = fit_gains(sample, &poles);
    for (o, row) in gains.iter().enumerate() {
        for (j, gains) in row.iter().enumerate() {
            let sum: f64 = gains.iter().sum();
            let expected = sample.steady[o][j] - sample.start[o][j];
            assert!((sum - expected).abs() <= 1e-12 * sample.start[o][j].abs(), "{o} {j}");
        }
    }
}

/// A load that *is* a sum of lags is found again.
#[test]
fn lags_are_found_again() {
    let poles = PoleLaw::start().poles(0.3);
    let mut sample = Samples::at(0.3, &[0.2]).unwrap().remove(0);
    let truth = [0.3, -0.2, 0.5, 0.1, 0.7, -0.4];
    for (k, loads) in REDUCED_FREQUENCIES.iter().zip(&mut sample.loads) {
        loads[0][2] = Complex64::from(2.0);
        for (gain, p) in truth.iter().zip(&poles) {
            loads[0][2] += gain * p / Complex64::new(*p, *k);
        }
    }
    sample.start[0][2] = 2.0;
    sample.steady[0][2] = 2.0 + truth.iter().sum::<f64>();
    let (gains, _) = fit_gains(&sample, &poles);
    for (got, exact) in gains[0][2].iter().zip(truth) {
        assert!((got - exact).abs() < 0.02, "{got} {exact}");
    }
}

#[test]
fn poles_keep_their_order_and_distance() {
    let law = PoleLaw::start();
    for i in 0..=90 {
        let poles = law.poles(0.05 + 0.01 * f64::from(i).min(85.0));
        for pair in poles.windows(2) {
            assert!(pair[0] > 1.49 * pair[1] && pair[1] > 0.0, "{poles:?}");
        }
    }
}

#[test]
fn nodes_lie_inside_the_ranges() {
    let machs = mach_nodes();
    let flaps = nodes_of(FLAP_RANGE, 4);
    assert!(machs.iter().all(|m| *m > MACH_RANGE[0] && *m < MACH_RANGE[1]), "{machs:?}");
    assert!(flaps.iter().all(|e| *e > FLAP_RANGE[0] && *e < FLAP_RANGE[1]), "{flaps:?}");
}
