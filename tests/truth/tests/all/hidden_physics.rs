//! The stages of the hidden effects, each against its own theory: a parameter means what the answer says.

use std::f64::consts::TAU;

use approx::assert_relative_eq;
use truth::hidden::{
    Amplifier, BaseActuator, BoucWen, BoucWenParameters, Cause, Ceramic, Character, Family, Hidden,
    Mechanics, Physics, RelayParameters, Relays, Sensor, Waveform, creep,
};
use truth::measure::phasor;
use truth::stage::Stage;

const DT_S: f64 = 1.0 / 8000.0;

/// A sine of 65 V + 40 V or of 40 um, two seconds.
fn sine(mean: f64, frequency_hz: f64) -> Vec<f64> {
    (0..=16_000).map(|i| mean + 40.0 * (TAU * frequency_hz * DT_S * f64::from(i)).sin()).collect()
}

/// Gain and lag (s) at a frequency, from the last second.
fn response(input: &[f64], output: &[f64], frequency_hz: f64) -> (f64, f64) {
    let part = |signal: &[f64]| phasor(&signal[signal.len() - 8000..], frequency_hz * DT_S);
    let (u, y) = (part(input), part(output));
    let lag_deg = truth::measure::wrap_deg(u.phase_deg - y.phase_deg);
    (y.amplitude / u.amplitude, lag_deg / 360.0 / frequency_hz)
}

fn relay_parameters() -> RelayParameters {
    RelayParameters {
        relays: 400,
        stroke_um: 200.0,
        half_width_volt: 20.0,
        centre_volt: 65.0,
        spread_volt: (40.0, 60.0),
        reach_volt: 110.0,
    }
}

#[test]
fn sorted_relays_do_what_relays_one_by_one_do() {
    // A relay by its definition, from one that the stage reports when saturated down and up.
    let parameters = relay_parameters();
    let mut stage = Relays::new(&parameters, 65.0);
    assert_relative_eq!(stage.step(300.0, 0.0), 100.0, max_relative = 1e-12);
    assert_relative_eq!(stage.step(-300.0, 0.0), -100.0, max_relative = 1e-12);
    // Single relays of the same parameters: a stage of one relay after another differs by its weight.
    let plastic = 1.324_717_957_244_746_f64;
    let mut naive: Vec<(f64, f64, f64, f64)> = (0..parameters.relays)
        .map(|k| {
            let n = f64::from(k) + 0.5;
            let (r, c) = (
                110.0 * (n / plastic).fract(),
                110.0 * (2.0 * (n / plastic.powi(2)).fract() - 1.0),
            );
            let spread = if c < 0.0 { 40.0 } else { 60.0 };
            let weight = (-0.5 * ((r / 20.0).powi(2) + (c / spread).powi(2))).exp();
            (65.0 + c + r, 65.0 + c - r, weight, -1.0)
        })
        .collect();
    let total: f64 = naive.iter().map(|relay| relay.2).sum();
    let mut voltage = -300.0;
    for step in 0..3000 {
        voltage += 37.0 * (f64::from(step) * 0.37).sin() + 21.0 * (f64::from(step) * 1.93).cos();
        voltage = voltage.clamp(-60.0, 190.0);
        let mut expected = 0.0;
        for (rise, fall, weight, state) in &mut naive {
            if voltage >= *rise {
                *state = 1.0;
            } else if voltage <= *fall {
                *state = -1.0;
            }
            expected += 100.0 * *weight * *state / total;
        }
        let found = stage.step(voltage, 0.0);
        assert!((found - expected).abs() < 1e-9, "step {step}: {found} instead of {expected}");
    }
}

#[test]
fn a_bouc_wen_element_follows_its_closed_form_and_lags() {
    // b = 1/2, loading from rest: dz/du = 1 - (z/Z)^2, so z = Z tanh(u/Z).
    let parameters = BoucWenParameters {
        stroke_um: 10.0,
        elements: vec![(1.0, 20.0)],
        shape: 0.5,
        asymmetry: 0.0,
    };
    let mut element = BoucWen::new(parameters, 65.0);
    assert_relative_eq!(element.step(95.0, 0.0), -10.0 * 1.5_f64.tanh(), max_relative = 1e-4);
    // Unloading with b = 1/2: straight, dz/du = 1, until z = 0.
    let before = element.step(95.0, 0.0);
    assert_relative_eq!(element.step(85.0, 0.0) - before, 5.0, max_relative = 1e-9);
}

#[test]
fn every_family_lags_its_voltage_and_has_a_loop_of_a_piezo_stack() {
    for base in 0..12 {
        let actuator = BaseActuator::new(base);
        let command: Vec<f64> =
            (0..24_000).map(|i| 65.0 + 85.0 * (TAU * f64::from(i) / 8000.0).sin()).collect();
        let motion = actuator.hysteresis(&command).unwrap();
        let (up, down) = (motion[16_000], motion[20_000]);
        let stroke = motion[18_000] - motion[22_000];
        assert!((400.0..650.0).contains(&stroke), "base {base}: {stroke} um");
        let width = (down - up) / stroke;
        assert!((0.05..0.20).contains(&width), "base {base}: width {width}");
    }
    let family = |base| BaseActuator::new(base).family;
    assert!(matches!(family(0), Family::Relays(_)));
    assert!(matches!(family(1), Family::BoucWen(_)));
    assert!(matches!(family(3), Family::DomainWalls(_)));
}

#[test]
fn lag_delay_and_filter_delay_a_slow_signal_by_their_parameter() {
    let slow = 2.0;
    let mut voltage = sine(65.0, slow);
    Amplifier::Lag { tau_s: 1e-3 }.apply(DT_S, &mut voltage);
    let (gain, lag_s) = response(&sine(65.0, slow), &voltage, slow);
    assert_relative_eq!(lag_s, 1e-3, max_relative = 1e-3);
    assert_relative_eq!(gain, 1.0, max_relative = 1e-3);
    for sensor in [Sensor::Filter { tau_s: 1e-3 }, Sensor::Delay { delay_s: 1e-3 }] {
        let mut motion = sine(0.0, slow);
        sensor.apply(DT_S, 1, &mut motion);
        // The delay jitters by 2 % about its mean, 1.3 times a second.
        let (gain, lag_s) = response(&sine(0.0, slow), &motion, slow);
        assert_relative_eq!(lag_s, 1e-3, max_relative = 0.01);
        assert_relative_eq!(gain, 1.0, max_relative = 1e-3);
    }
    // At 100 Hz a delay keeps the gain, two poles of 0.8 and 0.2 do not.
    let mut motion = sine(0.0, 100.0);
    Sensor::Filter { tau_s: 1e-3 }.apply(DT_S, 1, &mut motion);
    let (gain, _) = response(&sine(0.0, 100.0), &motion, 100.0);
    let pole = |share: f64| 1.0 / (TAU * 100.0 * share * 1e-3).hypot(1.0);
    assert_relative_eq!(gain, pole(0.8) * pole(0.2), max_relative = 5e-3);
}

#[test]
fn the_current_limit_holds_and_lets_slow_commands_pass() {
    let slew = 5000.0;
    let limit = Amplifier::CurrentLimit { slew_volt_per_s: slew };
    let mut fast = sine(65.0, 60.0);
    limit.apply(DT_S, &mut fast);
    let rate =
        |signal: &[f64]| signal.windows(2).map(|w| (w[1] - w[0]).abs() / DT_S).fold(0.0, f64::max);
    assert!(rate(&fast) <= slew * (1.0 + 1e-9) && rate(&fast) > 0.98 * slew, "{}", rate(&fast));
    // Five hertz need a quarter of the current: the voltage stays within the loop's error.
    let command = sine(65.0, 5.0);
    let mut slow = command.clone();
    limit.apply(DT_S, &mut slow);
    let error = slow.iter().zip(&command).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(error < 0.06, "{error} V");
}

#[test]
fn saturation_ends_at_its_asymptotes() {
    let clip = Amplifier::Saturation { low_volt: -10.0, high_volt: 140.0, knee_volt: 1.5 };
    let mut ends = vec![-60.0, 65.0, 200.0];
    clip.apply(DT_S, &mut ends);
    for (found, expected) in ends.iter().zip([-10.0, 65.0, 140.0]) {
        assert_relative_eq!(*found, expected, epsilon = 1e-9);
    }
}

#[test]
fn a_resonance_has_the_response_of_two_modes() {
    let mode = Mechanics::Resonance { frequency_hz: 150.0, damping_ratio: 0.03 };
    for frequency in [10.0, 100.0, 150.0, 180.0] {
        let mut motion = sine(0.0, frequency);
        mode.apply(DT_S, &mut motion);
        let (gain, lag_s) = response(&sine(0.0, frequency), &motion, frequency);
        let receptance = |natural: f64| {
            let r = frequency / natural;
            let (re, im) = (1.0 - r * r, 2.0 * 0.03 * r);
            let square = re * re + im * im;
            (re / square, -im / square)
        };
        let ((a, b), (c, d)) = (receptance(150.0), receptance(2.7 * 150.0));
        let (re, im): (f64, f64) = (0.95 * a + 0.05 * c, 0.95 * b + 0.05 * d);
        // The input runs in straight lines: sinc^2 of its frequency over the rate, 0.2 % at 180 Hz.
        assert_relative_eq!(gain, re.hypot(im), max_relative = 5e-3);
        let phase_deg = 360.0 * frequency * lag_s;
        assert!((phase_deg + im.atan2(re).to_degrees()).abs() < 0.2, "{frequency} Hz: {phase_deg}");
    }
}

/// Width of the loop that a stage makes of a large slow sine, um.
fn loop_width(mechanics: Mechanics) -> f64 {
    let input = sine(0.0, 1.0);
    let mut output = input.clone();
    mechanics.apply(DT_S, &mut output);
    // Through zero at 1 s rising and at 1.5 s falling.
    output[12_000] - output[8_000]
}

#[test]
fn play_and_friction_have_the_width_stated() {
    assert_relative_eq!(
        loop_width(Mechanics::Backlash { width_um: 6.0 }),
        6.0,
        max_relative = 1e-3
    );
    // At 250 um/s the friction is still 15 % above that of fast motion: 1 + 0.15 exp(-1/64).
    let expected = 6.0 * (1.0 + 0.15 * (-(TAU * 40.0 / 2000.0_f64).powi(2)).exp());
    assert_relative_eq!(
        loop_width(Mechanics::Friction { width_um: 6.0 }),
        expected,
        max_relative = 1e-2
    );
}

#[test]
fn load_and_cubic_spring_balance_their_forces() {
    for x in [5.0, 100.0, 250.0] {
        let mut y = vec![0.0, x];
        Mechanics::Load { ratio: 0.2 }.apply(DT_S, &mut y);
        let ratio = 0.2 * (1.0 + 0.1 * (y[1] / 250.0_f64).powi(2));
        assert_relative_eq!(y[1] * (1.0 + ratio), x, max_relative = 1e-9);
        let mut y = vec![0.0, x];
        Mechanics::CubicSpring { coefficient: 0.5 }.apply(DT_S, &mut y);
        assert_relative_eq!(y[1] + 0.5 * y[1].powi(3) / 62_500.0, x, max_relative = 1e-9);
    }
}

#[test]
fn quadratic_drag_balances_too() {
    // A ramp of v: in the end y lags by c v^2.
    let (speed, coefficient) = (1000.0, 1e-6);
    let mut y: Vec<f64> = (0..16_000).map(|i| speed * DT_S * f64::from(i)).collect();
    let last = *y.last().unwrap();
    Mechanics::QuadraticViscous { coefficient }.apply(DT_S, &mut y);
    assert_relative_eq!(last - y.last().unwrap(), coefficient * speed * speed, max_relative = 1e-6);
}

#[test]
fn heat_follows_the_square_of_the_rate_and_its_time_constant() {
    let heating =
        Ceramic::Heating { time_constant_s: 0.3, coefficient_per_kelvin: 0.002, rise_kelvin: 20.0 };
    // 75 V at 20 Hz is the nominal drive: in the end 20 K.
    let drive: Vec<f64> =
        (0..32_000).map(|i| 65.0 + 75.0 * (TAU * 20.0 * DT_S * f64::from(i)).sin()).collect();
    let rise = heating.temperature_rise(DT_S, &drive);
    let mean = |from: usize| rise[from..from + 4000].iter().sum::<f64>() / 4000.0;
    assert_relative_eq!(mean(28_000), 20.0, max_relative = 2e-3);
    // Over the first 0.5 s the mean is 1 - (tau/T)(1 - e^(-T/tau)) of it.
    let exact = 20.0 * (1.0 - 0.6 * (1.0 - (-0.5_f64 / 0.3).exp()));
    assert_relative_eq!(mean(0), exact, max_relative = 5e-3);
}

#[test]
fn polarisation_is_lost_below_the_threshold_and_stays_lost() {
    let loss = Ceramic::Depolarisation { threshold_volt: -5.0, strength: 0.2 };
    let gain = |low: f64| {
        let voltage = [vec![65.0; 800], vec![low; 8000], vec![65.0; 8000]].concat();
        let mut motion = vec![100.0; voltage.len()];
        loss.apply(DT_S, &voltage, &mut motion);
        (motion[799], motion[16_799])
    };
    assert_relative_eq!(gain(40.0).1, 100.0, max_relative = 1e-4);
    let (before, after) = gain(-18.0);
    assert_relative_eq!(before, 100.0, max_relative = 1e-6);
    assert!(after < 70.0, "{after} um");
}

#[test]
fn creep_grows_by_its_rate_per_decade() {
    let character = &Character::of_seed(Hidden::One(Cause::Creep), 3)[0];
    let (Physics::Creep(elements), parameters) = character.with_strength(0.04) else {
        panic!("creep is creep")
    };
    assert_eq!(parameters, vec![("rate_per_decade", 0.04, "1")]);
    let mut motion = vec![100.0; 80_000];
    motion[0] = 0.0;
    creep(&elements, DT_S, &mut motion);
    // Five elements of uneven compliance: 8 % about the mean slope from 0.1 to 5 s.
    let growth = (motion[40_000] - motion[800]) / 100.0 / 50.0_f64.log10();
    assert_relative_eq!(growth, 0.04, max_relative = 0.08);
}

#[test]
fn nonlinearity_and_hum_have_their_amplitude() {
    let mut line: Vec<f64> = (0..=1000).map(|i| f64::from(i) * 0.5 - 250.0).collect();
    let before = line.clone();
    Sensor::Nonlinearity { amplitude_um: 3.0 }.apply(DT_S, 1, &mut line);
    let largest = line.iter().zip(&before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert_relative_eq!(largest, 3.0, max_relative = 1e-3);
    let mut quiet = vec![0.0; 8000];
    Sensor::Hum { amplitude_um: 2.0, frequency_hz: 50.0 }.apply(DT_S, 1, &mut quiet);
    assert_relative_eq!(phasor(&quiet, 50.0 * DT_S).amplitude, 2.0, max_relative = 1e-9);
    assert_relative_eq!(phasor(&quiet, 150.0 * DT_S).amplitude, 0.24, max_relative = 1e-9);
}

#[test]
fn a_multisine_has_its_lines_and_its_peak_and_a_path_its_points() {
    let multisine = Waveform::Multisine {
        low_hz: 1.0,
        high_hz: 35.0,
        spacing_hz: 0.5,
        peak_volt: 70.0,
        seconds: 4.0,
        key: 3,
    };
    let samples = multisine.sample(65.0, DT_S, 32_801);
    assert!((samples[0] - 65.0).abs() < 1e-12);
    let largest = samples.iter().map(|v| (v - 65.0).abs()).fold(0.0, f64::max);
    assert!((60.0..=70.0 + 1e-9).contains(&largest), "{largest} V");
    // Two seconds are a period: lines of one height, nothing between or above.
    let deviation: Vec<f64> = samples[8000..24_000].iter().map(|v| v - 65.0).collect();
    let height = |hz: f64| phasor(&deviation, hz * DT_S).amplitude;
    for hz in [1.0, 17.5, 35.0] {
        assert_relative_eq!(height(hz), height(10.0), max_relative = 1e-6);
    }
    assert!(height(0.5) < 1e-9 && height(35.5) < 1e-9 && height(100.0) < 1e-9);
    let triangle = Waveform::triangles(65.0, 1.0, &[85.0]);
    let samples = triangle.sample(65.0, 0.05, 23);
    assert_relative_eq!(samples[7], 150.0, max_relative = 1e-12);
    assert_relative_eq!(samples[17], -20.0, max_relative = 1e-12);
}
