//! Each stage against its own exact solution, and what is read off records.
#![expect(clippy::unwrap_used, reason = "a helper that fails fails its test")]

use std::f64::consts::TAU;

use approx::assert_relative_eq;
use truth::creep::{Creep, CreepParameters};
use truth::hysteresis::{DomainWallHysteresis, DomainWallParameters, WallPopulation, langevin};
use truth::lvdt::{Lvdt, LvdtParameters};
use truth::measure::{golden_section, half_peak_to_peak, loop_width, nrmse, phasor, wrap_deg};
use truth::relaxation::{Relaxation, RelaxationChannel, RelaxationParameters};
use truth::stage::{Chain, Stage, first_order_hold};

#[test]
fn first_order_hold_is_exact_on_a_ramp_whatever_the_step() {
    // tau x' = s t - x, x(0) = 0:  x = s (t - tau) + s tau exp(-t/tau).
    let (slope, tau) = (3.0, 0.025);
    for steps in [1, 7, 200] {
        let dt_s = 0.1 / f64::from(steps);
        let mut x = 0.0;
        for i in 0..steps {
            let from = slope * dt_s * f64::from(i);
            x = first_order_hold(x, from, from + slope * dt_s, dt_s, tau);
        }
        let exact = slope * (0.1 - tau) + slope * tau * (-0.1_f64 / tau).exp();
        assert_relative_eq!(x, exact, max_relative = 1e-13);
    }
}

#[test]
fn single_lag_has_the_gain_and_phase_of_theory() {
    let (tau, frequency_hz, rate) = (0.024, 15.0, 48_000.0);
    let mut lag = Relaxation::single(tau).unwrap();
    lag.settle(0.0);
    let mut output = Vec::new();
    for step in 1..=48_000 {
        let y = lag.step((TAU * frequency_hz * f64::from(step) / rate).sin(), 1.0 / rate);
        output.push(y);
    }
    let steady = phasor(&output[output.len() - 9_600..], frequency_hz / rate);
    let omega_tau = TAU * frequency_hz * tau;
    assert_relative_eq!(steady.amplitude, 1.0 / omega_tau.hypot(1.0), max_relative = 1e-5);
    // Sample 1 was stored first: the phase is that of one step later.
    let lead_deg = 360.0 * frequency_hz / rate;
    let lag_deg = -(steady.phase_deg - lead_deg);
    assert_relative_eq!(lag_deg, omega_tau.atan().to_degrees(), epsilon = 1e-3);
}

#[test]
fn relaxation_time_grows_with_extension_and_shrinks_with_deviation() {
    let parameters = RelaxationParameters {
        channels: vec![RelaxationChannel { weight: 1.0, time_constant_s: 0.02 }],
        reference_um: 250.0,
        position_sensitivity: 0.1,
        deviation_sensitivity: 0.2,
    };
    assert_relative_eq!(parameters.time_constant_s(0.02, 0.0, 0.0), 0.02);
    assert_relative_eq!(parameters.time_constant_s(0.02, 250.0, 250.0), 0.022);
    assert_relative_eq!(parameters.time_constant_s(0.02, 0.0, -250.0), 0.02 / 1.2);
    // Held at 100 um: x' = (h - x)/tau(x) must show in the slope of the response.
    let mut stage = Relaxation::new(parameters.clone()).unwrap();
    stage.settle(0.0);
    let mut before = stage.step(100.0, 1e-9);
    for _ in 0..200 {
        let after = stage.step(100.0, 1e-5);
        let tau = parameters.time_constant_s(0.02, 0.5 * (before + after), 100.0);
        let rate = (100.0 - 0.5 * (before + after)) / tau;
        assert_relative_eq!((after - before) / 1e-5, rate, max_relative = 1e-6);
        before = after;
    }
}

#[test]
fn creep_grows_by_the_stated_share_per_decade() {
    let parameters = CreepParameters {
        growth_per_decade: 0.014,
        first_time_s: 0.1,
        elements_per_decade: 2,
        elements: 7,
    };
    let mut creep = Creep::new(parameters).unwrap();
    creep.settle(0.0);
    creep.step(100.0, 1e-9);
    let at_1_s = creep.step(100.0, 1.0);
    let at_10_s = creep.step(100.0, 9.0);
    let growth = (at_10_s - at_1_s) / 100.0;
    assert!((growth - 0.014).abs() < 0.0007, "{growth} per decade");
    // The end value is exact: every element fully extended.
    let settled = creep.step(100.0, 1e6);
    assert_relative_eq!(settled, 100.0 * (1.0 + 7.0 * 0.007), max_relative = 1e-6);
    assert_relative_eq!(creep.settle(100.0), 104.9, max_relative = 1e-12);
}

#[test]
fn langevin_series_meets_the_closed_form_and_both_are_odd() {
    for x in [0.049_999, 0.050_001, 0.3, 2.0] {
        // Continued fraction x/(3 + x^2/(5 + x^2/(7 + ...))).
        let fraction = (1..40).rev().fold(0.0, |tail, n| x * x / (f64::from(2 * n + 3) + tail));
        assert_relative_eq!(langevin(x), x / (3.0 + fraction), max_relative = 1e-12);
        assert_relative_eq!(langevin(-x), -langevin(x));
    }
    assert_relative_eq!(langevin(0.0), 0.0);
}

/// One population on a practically straight anhysteretic curve of slope 1 per volt.
fn one_population(pinning_volt: f64) -> DomainWallHysteresis {
    DomainWallHysteresis::new(DomainWallParameters {
        intrinsic_um_per_volt: 1e-12,
        polarisation_stroke_um: 3e6,
        reversible_share: 0.0,
        langevin_centre_volt: 0.0,
        langevin_width_volt: 1e6,
        pinning_imprint: 0.0,
        populations: vec![WallPopulation { weight: 1.0, pinning_volt }],
        bias_volt: 0.0,
    })
    .unwrap()
}

#[test]
fn virgin_curve_of_one_population_is_exact_whatever_the_step() {
    // Lead e = k tanh(u/k), output u - e.
    for steps in [1, 3, 100] {
        let mut walls = one_population(20.0);
        let mut output = 0.0;
        for step in 1..=steps {
            output = walls.step(30.0 * f64::from(step) / f64::from(steps), 1.0);
        }
        assert_relative_eq!(output, 30.0 - 20.0 * 1.5_f64.tanh(), max_relative = 1e-8);
    }
}

#[test]
fn walls_stay_after_a_reversal_until_the_field_has_come_back() {
    let mut walls = one_population(20.0);
    let top = walls.step(60.0, 1.0);
    let lead_volt = 60.0 - top;
    assert_relative_eq!(walls.step(60.0 - lead_volt, 1.0), top, max_relative = 1e-8);
    // In one stretch from the reversal the result is the same as in two: the clip is exact.
    let two = walls.step(20.0, 1.0);
    let mut other = one_population(20.0);
    other.step(60.0, 1.0);
    assert_relative_eq!(other.step(20.0, 1.0), two, max_relative = 1e-8);
    assert!(two < top);
}

#[test]
fn small_loops_lose_energy_as_the_fourth_power_of_amplitude() {
    // dm ~ e^2 du/k^2: the loop of an amplitude A far below k opens as A^3.
    let opening = |amplitude: f64| {
        let mut walls = one_population(100.0);
        for target in [amplitude, -amplitude, amplitude, -amplitude] {
            walls.step(target, 1.0);
        }
        let rising = walls.step(0.0, 1.0);
        walls.step(amplitude, 1.0);
        walls.step(0.0, 1.0) - rising
    };
    let ratio = opening(2.0) / opening(1.0);
    assert!((ratio - 8.0).abs() < 0.1, "{ratio}");
}

#[test]
fn sensor_has_the_stated_noise_resolution_and_range() {
    let parameters = LvdtParameters { range_um: 500.0, noise_um: 0.25, bits: 16 };
    let mut sensor = Lvdt::new(parameters, 1, 0).unwrap();
    let n = 40_000;
    let readings: Vec<f64> = (0..n).map(|_| sensor.read_um(12.345)).collect();
    let mean = readings.iter().sum::<f64>() / f64::from(n);
    let variance = readings.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / f64::from(n);
    // Standard errors: 0.00125 um of the mean, 0.35 % of the deviation.
    assert!((mean - 12.345).abs() < 0.005, "{mean} um");
    assert!((variance.sqrt() / 0.25 - 1.0).abs() < 0.015, "{} um", variance.sqrt());
    let count = parameters.resolution_um();
    assert_relative_eq!(count, 1000.0 / 65_536.0);
    assert!(readings.iter().all(|y| (y / count - (y / count).round()).abs() < 1e-9));
    assert_relative_eq!(sensor.read_um(1e4), 500.0);
    let mut quiet = Lvdt::new(LvdtParameters { noise_um: 0.0, ..parameters }, 1, 0).unwrap();
    assert!((quiet.read_um(12.345) - 12.345).abs() <= 0.5 * count);
}

#[test]
fn an_empty_chain_passes_its_input_and_stages_act_in_order() {
    let mut empty = Chain::new();
    assert_relative_eq!(empty.settle(3.0), 3.0);
    assert_relative_eq!(empty.step(4.0, 1.0), 4.0);
    let (mut walls, mut lag) = (one_population(20.0), Relaxation::single(0.5).unwrap());
    let mut chain = Chain::new().then(walls.clone()).then(lag.clone());
    for input in [30.0, -10.0, 5.0] {
        let expected = lag.step(walls.step(input, 0.1), 0.1);
        assert_relative_eq!(chain.step(input, 0.1), expected);
    }
    let (mut walls, mut lag) = (one_population(20.0), Relaxation::single(0.5).unwrap());
    let swapped = walls.step(lag.step(30.0, 0.1), 0.1);
    chain.settle(0.0);
    assert!((chain.step(30.0, 0.1) - swapped).abs() > 0.1, "the order matters");
}

#[test]
fn measures_recover_what_was_put_in() {
    let n = 400;
    let angle = |i: i32| TAU * f64::from(i) / f64::from(n);
    let voltage: Vec<f64> = (0..n).map(|i| angle(i).sin()).collect();
    let output: Vec<f64> = (0..n).map(|i| 2.0 * (angle(i) - 0.1).sin() + 5.0).collect();
    let component = phasor(&output, 1.0 / f64::from(n));
    assert_relative_eq!(component.amplitude, 2.0, max_relative = 1e-12);
    assert_relative_eq!(component.phase_deg, -0.1_f64.to_degrees(), max_relative = 1e-10);
    assert_relative_eq!(half_peak_to_peak(&output), 2.0, max_relative = 1e-4);
    // An ellipse of lag p opens by 2 sin p of its half height, so by sin p of its height.
    assert_relative_eq!(loop_width(&voltage, &output), 0.1_f64.sin(), max_relative = 1e-3);
    assert_relative_eq!(nrmse(&output, &output), 0.0);
    let mean = vec![5.0; 400];
    assert_relative_eq!(nrmse(&mean, &output), 1.0, max_relative = 1e-12);
    assert_relative_eq!(wrap_deg(-190.0), 170.0);
    assert_relative_eq!(wrap_deg(-180.0), 180.0);
    assert_relative_eq!(golden_section(0.0, 3.0, |x| (x - 1.25).powi(2)), 1.25, epsilon = 1e-5);
}
