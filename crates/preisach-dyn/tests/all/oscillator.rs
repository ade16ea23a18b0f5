//! The oscillator with Bouc-Wen hysteresis in its spring, against its equation.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use preisach_dyn::{
    ActuatorLaw, Calibration, HysteresisLaw, HystereticOscillator, LinkageStage, OscillatorMemory,
    OscillatorParameters, Resonance, StartState, VoltageRange,
};
use std::f64::consts::TAU;

use crate::common::plain;

const GAIN: f64 = 0.1;

fn parameters(share: f64, loading_per_deg: f64, unloading_per_deg: f64) -> OscillatorParameters {
    OscillatorParameters {
        range_volt: VoltageRange::new(-100.0, 100.0).unwrap(),
        gain_deg_per_volt: GAIN,
        frequency_hz: 40.0,
        damping_ratio: 0.05,
        hysteretic_share: share,
        loading_per_deg,
        unloading_per_deg,
        offset_deg: 0.0,
    }
}

fn law(share: f64, loading_per_deg: f64, unloading_per_deg: f64) -> HystereticOscillator {
    HystereticOscillator::new(parameters(share, loading_per_deg, unloading_per_deg)).unwrap()
}

/// Outputs from rest at the first voltage.
fn outputs(law: &HystereticOscillator, volts: &[f64], step_s: f64) -> Vec<f64> {
    let (mut memory, first) = law.start(volts[0], StartState::Rest);
    let rest = volts[1..].iter().map(|volt| law.step(&mut memory, *volt, step_s));
    std::iter::once(first).chain(rest).collect()
}

/// A ramp of 40 V over a part of the time, then held: straight between samples, whatever their number.
fn ramp(seconds: f64, part: u32, samples: u32) -> (Vec<f64>, f64) {
    let volt = |i: u32| 40.0 * f64::from(i * part).min(f64::from(samples)) / f64::from(samples);
    ((0..=samples).map(volt).collect(), seconds / f64::from(samples))
}

/// Errors at the end of a ramp in growing numbers of steps, against 16 times the largest.
fn errors(seconds: f64, part: u32, samples: [u32; 3]) -> [f64; 3] {
    let law = law(0.6, 0.2, 0.5);
    let at_end = |samples: u32| {
        let (volts, step_s) = ramp(seconds, part, samples);
        // one step of the integration a sample
        assert!(TAU * 40.0 * step_s <= 0.1 + 1e-12);
        *outputs(&law, &volts, step_s).last().unwrap()
    };
    let exact = at_end(16 * samples[2]);
    samples.map(|samples| (at_end(samples) - exact).abs())
}

/// A period of the mode is 251 steps of a tenth of 1 / w.
#[test]
fn the_integration_is_of_fourth_order_and_of_second_where_the_motion_turns() {
    let one_way = errors(0.01, 1, [26, 52, 104]);
    let turning = errors(0.06, 4, [160, 320, 640]);
    let order = |e: [f64; 3]| [(e[0] / e[1]).log2(), (e[1] / e[2]).log2()];
    println!("one way {one_way:?}, orders {:?}", order(one_way));
    println!("turning {turning:?}, orders {:?}", order(turning));
    for own in order(one_way) {
        assert!((3.7..4.5).contains(&own), "{own}");
    }
    // at a turn the error depends on where in a step it lies: over two halvings
    let turned = 0.5 * (turning[0] / turning[2]).log2();
    assert!((1.5..3.5).contains(&turned), "{turned}");
    assert!(one_way[0] < 5e-6 && turning[0] < 1e-3, "{} {}", one_way[0], turning[0]);
}

/// Without hysteresis it is the mode behind a gain, which has an exact step.
#[test]
fn without_hysteresis_it_is_a_mode_behind_a_gain() {
    let law = law(0.0, 0.2, 0.5);
    let volts: Vec<f64> = (0..600).map(|i| 60.0 * (0.1 * f64::from(i)).sin()).collect();
    let mut linear = plain(ActuatorLaw::Linear(preisach_dyn::LinearGain {
        gain_deg_per_volt: GAIN,
        bias_volt: 0.0,
    }));
    let OscillatorParameters { frequency_hz, damping_ratio, .. } = *law.parameters();
    let mode = Resonance { frequency_hz, damping_ratio };
    linear.range_volt = law.parameters().range_volt;
    linear.calibration = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
    linear.linkage.push(LinkageStage::Resonance(mode));
    for step_s in [2e-4, 2e-3, 7e-3] {
        let exact = linear.simulate(&volts, step_s).unwrap().output_deg;
        for (own, exact) in outputs(&law, &volts, step_s).iter().zip(&exact) {
            assert!((own - exact).abs() < 1e-5 * 6.0, "{own} {exact}");
        }
    }
}

/// In its own letters `m x'' + c x' + k x + z = u`, by another method: midpoint steps a hundred times finer.
#[test]
fn it_satisfies_its_equation_in_the_letters_of_the_literature() {
    let (m, c, k, alpha, beta, gamma, delta) = (2.0, 10.0, 5e4, 5e4, 1e3, 0.8, -1.1);
    let range_volt = VoltageRange::new(-200.0, 200.0).unwrap();
    // a volt is a newton, a degree a metre
    let law = HystereticOscillator::new(OscillatorParameters {
        range_volt,
        gain_deg_per_volt: 1.0 / (k + alpha),
        frequency_hz: ((k + alpha) / m).sqrt() / TAU,
        damping_ratio: c / (2.0 * ((k + alpha) * m).sqrt()),
        hysteretic_share: alpha / (k + alpha),
        loading_per_deg: beta * (gamma + delta),
        unloading_per_deg: beta * (gamma - delta),
        offset_deg: 0.0,
    })
    .unwrap();
    let step_s = 1.0 / 750.0;
    let force = |i: u32| 80.0 * (TAU * 33.0 * f64::from(i) * step_s).sin();
    let volts: Vec<f64> = (0..1500).map(force).collect();
    let own = outputs(&law, &volts, step_s);
    let slope = |[x, v, z]: [f64; 3], u: f64| {
        let z_rate = alpha * v - beta * (gamma * v.abs() * z + delta * v * z.abs());
        [v, (u - c * v - k * x - z) / m, z_rate]
    };
    let mut y = [0.0; 3];
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    for (i, pair) in volts.windows(2).enumerate() {
        const FINER: u32 = 100;
        let h = step_s / f64::from(FINER);
        for part in 0..FINER {
            let at = |t: f64| pair[0] + (pair[1] - pair[0]) * t / f64::from(FINER);
            let a = slope(y, at(f64::from(part)));
            let half: [f64; 3] = std::array::from_fn(|i| y[i] + 0.5 * h * a[i]);
            let b = slope(half, at(f64::from(part) + 0.5));
            (0..3).for_each(|i| y[i] += h * b[i]);
        }
        worst = worst.max((own[i + 1] - y[0]).abs());
        most = most.max(y[0].abs());
    }
    println!("worst {worst:.2e} of {most:.2e} m");
    assert!(most > 1e-3 && worst < 1e-3 * most, "{worst} {most}");
}

/// The work of the voltage on a closed slow path is not negative, hardening springs included; without
/// unloading it is more than it was with straight unloading.
#[test]
fn every_closed_slow_path_takes_energy() {
    let work = |law: &HystereticOscillator| {
        let path: Vec<f64> = (0..=4000).map(|i| 90.0 * (1e-3 * TAU * f64::from(i)).sin()).collect();
        let y = outputs(law, &path, 10.0);
        let last = path[3000..].windows(2).zip(y[3000..].windows(2));
        last.map(|(u, y)| 0.5 * (u[0] + u[1]) * (y[1] - y[0])).sum::<f64>()
    };
    let softening = work(&law(0.7, 0.1, 0.1));
    let hardening = work(&law(0.7, -0.03, 0.19));
    let elastic = work(&law(0.7, -0.05, 0.05));
    println!("work {softening} {hardening} {elastic} V deg");
    assert!(softening > 1.0 && hardening > 1.0 && elastic.abs() < 1e-6, "{softening} {hardening}");
}

/// A long step leads to the place of rest, as many short ones do.
#[test]
fn a_held_voltage_ends_at_rest_whatever_the_steps() {
    let law = law(0.6, 0.2, 0.5);
    let mut ends = Vec::new();
    for step_s in [1e-2, 1e3] {
        let (mut memory, _) = law.start(0.0, StartState::Rest);
        // up in a crawl: nothing turns
        let slow = |i: u32| 60.0 * f64::from(i) / 2000.0;
        let up = (1..=2000).map(|i| law.step(&mut memory, slow(i), step_s));
        ends.push(up.last().unwrap());
    }
    assert!((ends[0] - ends[1]).abs() < 2e-3 * ends[1], "{ends:?}");
}

/// Model and memory written out, read back and continued give the same bits.
#[test]
fn it_can_be_stored_midway() {
    let law = law(0.6, -0.1, 0.5);
    let volt = |i: u32| 60.0 * (0.13 * f64::from(i)).sin();
    let (mut memory, _) = law.start(0.0, StartState::RisingFromLowest);
    for i in 1..200 {
        law.step(&mut memory, volt(i), 1e-3);
    }
    let text = serde_json::to_string(&(law, memory)).unwrap();
    let (read, mut again): (HystereticOscillator, OscillatorMemory) =
        serde_json::from_str(&text).unwrap();
    assert_eq!((read, again), (law, memory));
    read.check_memory(&again).unwrap();
    for i in 200..300 {
        let next = [law.step(&mut memory, volt(i), 1e-3), read.step(&mut again, volt(i), 1e-3)];
        assert_eq!(next[0].to_bits(), next[1].to_bits());
    }
}

#[test]
fn numbers_that_give_energy_or_no_rest_are_refused() {
    let refused = |change: &dyn Fn(&mut OscillatorParameters)| {
        let mut own = parameters(0.5, 0.1, 0.2);
        change(&mut own);
        HystereticOscillator::new(own).unwrap_err().to_string()
    };
    assert!(refused(&|p| p.loading_per_deg = -0.3).contains("loading_per_deg"));
    assert!(refused(&|p| p.loading_per_deg = f64::NAN).contains("loading_per_deg"));
    assert!(refused(&|p| p.unloading_per_deg = -0.1).contains("unloading_per_deg"));
    assert!(refused(&|p| p.hysteretic_share = 1.0).contains("0 to 0.99"));
    assert!(refused(&|p| p.damping_ratio = 0.0).contains("0.001 to 2"));
    assert!(refused(&|p| p.frequency_hz = 0.0).contains("frequency_hz"));
    assert!(refused(&|p| p.gain_deg_per_volt = f64::INFINITY).contains("gain_deg_per_volt"));
}
