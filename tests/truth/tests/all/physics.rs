//! The actuator as a whole: amplitudes, loop width, asymmetry, minor loops.
#![expect(clippy::unwrap_used, reason = "a helper that fails fails its test")]

use approx::assert_relative_eq;
use truth::actuator::ActuatorParameters;
use truth::bench;
use truth::command::Command;
use truth::error::TruthError;
use truth::measure::{half_peak_to_peak, loop_width, phasor};
use truth::record::{INTERNAL_RATE_HZ, Record, Run};
use truth::stage::Stage;

/// A sine from rest at the bias, 1000 samples a cycle.
fn sine(frequency_hz: f64, amplitude_volt: f64, sample_rate_hz: u32) -> Run {
    Run {
        id: format!("sine_{frequency_hz}hz_{amplitude_volt}v"),
        note: String::new(),
        sample_rate_hz,
        rest_s: 0.0,
        command: Command::Sine { frequency_hz, amplitude_volt, cycles: 6 },
    }
}

/// The last cycle of a slow sine through the rate-independent stage: voltage and displacement.
fn static_loop(actuator: &ActuatorParameters, amplitude_volt: f64) -> (Vec<f64>, Vec<f64>) {
    let run = sine(1.0, amplitude_volt, 1000);
    let mut chain = actuator.hysteresis_chain().unwrap();
    last_cycle(&run.pass_through(&mut chain, actuator, INTERNAL_RATE_HZ).unwrap(), 1000)
}

fn last_cycle(record: &Record, length: usize) -> (Vec<f64>, Vec<f64>) {
    let end = record.command_volt.len() - 1;
    let range = end - length..end;
    (record.command_volt[range.clone()].to_vec(), record.displacement_um[range].to_vec())
}

#[test]
fn flap_moves_10_deg_at_0p2_hz_and_about_4_deg_at_15_hz() {
    let data = bench::generate(ActuatorParameters::apa500l(), bench::SEED).unwrap();
    let amplitude_deg = |id: &str| {
        let bench = data.runs.iter().find(|bench| bench.run.id == id).unwrap();
        let steady = bench::steady_window(&bench.run, &bench.exact.displacement_um);
        data.flap_deg_per_um * half_peak_to_peak(steady)
    };
    assert_relative_eq!(amplitude_deg("major_0p2hz"), 10.0, epsilon = 1e-9);
    let fast = amplitude_deg("sine_15hz_85v");
    assert!((fast - 4.0).abs() <= 0.3, "{fast} deg at 15 Hz");
    let stroke_um = 20.0 / data.flap_deg_per_um;
    assert!((stroke_um - 500.0).abs() < 10.0, "stroke {stroke_um} um");
}

#[test]
fn the_rested_actuator_responds_faster_when_the_relaxation_is_removed() {
    let mut actuator = ActuatorParameters::apa500l();
    let amplitude = |actuator: &ActuatorParameters| {
        let run = sine(15.0, 85.0, 2000);
        let mut chain = actuator.chain().unwrap();
        let record = run.pass_through(&mut chain, actuator, INTERNAL_RATE_HZ).unwrap();
        half_peak_to_peak(&last_cycle(&record, 400).1)
    };
    let with = amplitude(&actuator);
    for channel in &mut actuator.relaxation.channels {
        channel.time_constant_s = 1e-6;
    }
    let without = amplitude(&actuator);
    assert!(without > 2.3 * with, "{with} um with, {without} um without relaxation");
}

#[test]
fn loop_is_12_to_15_percent_wide_at_full_scale() {
    let actuator = ActuatorParameters::apa500l();
    let run = sine(0.2, 85.0, 200);
    let mut chain = actuator.chain().unwrap();
    let record = run.pass_through(&mut chain, &actuator, INTERNAL_RATE_HZ).unwrap();
    let (u, y) = last_cycle(&record, 1000);
    let width = loop_width(&u, &y);
    assert!((0.12..=0.15).contains(&width), "{width}");
}

#[test]
fn loops_are_relatively_narrower_at_small_amplitude() {
    let actuator = ActuatorParameters::apa500l();
    let widths = [85.0, 55.0, 25.0, 10.0, 5.0].map(|amplitude_volt| {
        let (u, y) = static_loop(&actuator, amplitude_volt);
        loop_width(&u, &y)
    });
    assert!(widths.windows(2).all(|pair| pair[0] > pair[1]), "{widths:?}");
    assert!(widths[0] > 0.10 && widths[2] < 0.7 * widths[0] && widths[4] < 0.02, "{widths:?}");
}

#[test]
fn loop_is_asymmetric_about_the_bias() {
    let mut actuator = ActuatorParameters::apa500l();
    let second_harmonic = |actuator: &ActuatorParameters| {
        let (_, y) = static_loop(actuator, 85.0);
        phasor(&y, 2.0 / 1000.0).amplitude / phasor(&y, 1.0 / 1000.0).amplitude
    };
    let shipped = second_harmonic(&actuator);
    assert!(shipped > 0.02, "{shipped}");
    actuator.hysteresis.langevin_centre_volt = actuator.bias_volt;
    actuator.hysteresis.pinning_imprint = 0.0;
    // What is left is the memory of the first cycle's direction.
    let symmetric = second_harmonic(&actuator);
    assert!(symmetric < 2e-4, "{symmetric}");
}

/// Cycles of 8 V about 100 V, on the way down from 150 V; displacement at the top of each.
fn minor_loop_tops(cycles: usize) -> Vec<f64> {
    let mut chain = ActuatorParameters::apa500l().hysteresis_chain().unwrap();
    chain.settle(65.0);
    sweep(&mut chain, 65.0, 150.0);
    sweep(&mut chain, 150.0, 92.0);
    (0..cycles)
        .map(|_| {
            let top = sweep(&mut chain, 92.0, 108.0);
            sweep(&mut chain, 108.0, 92.0);
            top
        })
        .collect()
}

/// Moves the voltage in steps of about 0.05 V; returns the displacement at the end.
fn sweep(chain: &mut dyn Stage, from_volt: f64, to_volt: f64) -> f64 {
    let steps = ((to_volt - from_volt).abs() / 0.05).ceil();
    let mut output = 0.0;
    let mut step = 0.0;
    while step < steps {
        step += 1.0;
        output = chain.step(from_volt + (to_volt - from_volt) * step / steps, 1.0);
    }
    output
}

#[test]
fn minor_loops_settle_and_close() {
    // Shares of the whole stroke, 500 um; the loop itself is 37 um high.
    let tops: Vec<f64> = minor_loop_tops(400).into_iter().map(|top| top / 500.0).collect();
    let drift: Vec<f64> = tops.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    assert!(drift[0] < 0.003, "the first repetition opens by {}", drift[0]);
    assert!(drift[19] < 0.0002, "the 20th repetition opens by {}", drift[19]);
    assert!(drift[398] < 1e-7, "the last repetition opens by {}", drift[398]);
    assert!(drift.windows(2).all(|pair| pair[1] <= pair[0] + 1e-12), "the drift always shrinks");
    let total = (tops[399] - tops[0]).abs();
    assert!(total < 0.01, "399 repetitions together move it by {total}");
    // It drifts: this is no Preisach operator, whose minor loops would close at once.
    assert!(total > 0.001, "399 repetitions together move it by {total}");
}

#[test]
fn slope_is_never_below_the_intrinsic_gain_and_the_output_is_bounded() {
    let actuator = ActuatorParameters::apa500l();
    let gain = actuator.hysteresis.intrinsic_um_per_volt;
    let bound_um = 85.0 * gain + 2.0 * actuator.hysteresis.polarisation_stroke_um;
    let mut chain = actuator.hysteresis_chain().unwrap();
    let (mut voltage, mut displacement) = (65.0, chain.settle(65.0));
    // Turning points from a linear congruential sequence: large and small moves in any order.
    let mut state: u64 = 1;
    for _ in 0..3000 {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let target =
            -20.0 + 170.0 * f64::from(u32::try_from(state >> 33).unwrap()) / 2_147_483_648.0;
        for step in 1..=20 {
            let next = voltage + (target - voltage) * f64::from(step) / 20.0;
            let output = chain.step(next, 1.0);
            let (rise, travel) = (output - displacement, next - voltage);
            assert!(
                rise * travel.signum() >= gain * travel.abs() - 1e-9,
                "{rise} um in {travel} V"
            );
            assert!(output.abs() < bound_um, "{output} um");
            (voltage, displacement) = (next, output);
        }
    }
}

#[test]
fn hysteresis_does_not_know_how_fast_it_is_driven() {
    let actuator = ActuatorParameters::apa500l();
    let loops = [0.5, 5.0].map(|frequency_hz| {
        let run = sine(frequency_hz, 85.0, if frequency_hz < 1.0 { 200 } else { 2000 });
        let mut chain = actuator.hysteresis_chain().unwrap();
        // The same number of internal steps a cycle at both speeds.
        let internal = if frequency_hz < 1.0 { 1600 } else { 16_000 };
        run.pass_through(&mut chain, &actuator, internal).unwrap().displacement_um
    });
    for (slow, fast) in loops[0].iter().zip(&loops[1]) {
        assert_relative_eq!(slow, fast, epsilon = 1e-7);
    }
}

#[test]
fn bad_runs_and_parameters_are_named() {
    let mut actuator = ActuatorParameters::apa500l();
    let mut chain = actuator.chain().unwrap();
    let too_large = sine(1.0, 86.0, 1000).pass_through(&mut chain, &actuator, INTERNAL_RATE_HZ);
    assert!(
        matches!(too_large, Err(TruthError::CommandRange { voltage_volt, .. }) if voltage_volt > 150.0)
    );
    let coarse = sine(1.0, 85.0, 1000).pass_through(&mut chain, &actuator, 2000);
    assert!(matches!(coarse, Err(TruthError::Rate { record_hz: 1000, .. })));
    let uneven = sine(1.0, 85.0, 3000).pass_through(&mut chain, &actuator, 16_000);
    assert!(matches!(uneven, Err(TruthError::Rate { record_hz: 3000, .. })));
    let nan = sine(1.0, f64::NAN, 1000).pass_through(&mut chain, &actuator, INTERNAL_RATE_HZ);
    assert!(matches!(nan, Err(TruthError::CommandRange { .. })));
    actuator.hysteresis.populations[1].pinning_volt = -1.0;
    let message = actuator.chain().unwrap_err().to_string();
    assert!(message.contains("pinning_volt = -1") && message.contains("positive"), "{message}");
    actuator = ActuatorParameters::apa500l();
    actuator.relaxation.channels[0].time_constant_s = f64::NAN;
    assert!(matches!(
        actuator.chain(),
        Err(TruthError::Parameter { parameter: "time_constant_s", .. })
    ));
    actuator = ActuatorParameters::apa500l();
    actuator.lvdt.bits = 0;
    let refused = bench::generate(actuator, 1);
    assert!(matches!(refused, Err(TruthError::Parameter { parameter: "bits", .. })));
}
