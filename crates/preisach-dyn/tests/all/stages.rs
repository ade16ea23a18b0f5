//! Every stage alone: its identity, and its exact solution.
#![expect(clippy::float_cmp, reason = "results are claimed to be equal to the last bit")]

use crate::common;

use approx::assert_abs_diff_eq;
use common::{amplifier, effects, largest_difference, linkage, measured, sampled, sensor};
use preisach_dyn::{
    Accommodation, ActuatorModel, AmplifierStage, Backlash, CoulombFriction, CurrentLimit, Delay,
    Depolarisation, DielectricHeating, Drive, KelvinVoigt, KelvinVoigtElement, Lag, LinkageStage,
    LoadStiffness, LogCreep, MainsHum, Nonlinearity, NonlinearityShape, Quantisation, Relaxation,
    RelaxationElement, Resonance, Saturation, SensorStage, StartState,
};
use std::f64::consts::{PI, TAU};

fn share_of(share: f64) -> RelaxationElement {
    RelaxationElement { share, time_constant_s: 0.02 }
}

/// The stages of the bench at values that mean nothing happens.
fn identities() -> Vec<ActuatorModel> {
    let none = KelvinVoigtElement { compliance_ratio: 0.0, time_constant_s: 3.0 };
    vec![
        amplifier(AmplifierStage::Lag(Lag { tau_s: 0.0 })),
        amplifier(AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: 1e9 })),
        amplifier(AmplifierStage::Saturation(Saturation::sharp(-1e5, 1e5))),
        amplifier(AmplifierStage::Delay(Delay { delay_s: 0.0 })),
        amplifier(AmplifierStage::DielectricHeating(DielectricHeating::new(30.0, 0.0))),
        amplifier(AmplifierStage::Depolarisation(Depolarisation::new(-1e5))),
        linkage(LinkageStage::LogCreep(LogCreep::new(0.0))),
        linkage(LinkageStage::KelvinVoigt(KelvinVoigt { elements: vec![none, none] })),
        linkage(LinkageStage::Relaxation(Relaxation::default())),
        linkage(LinkageStage::Relaxation(Relaxation { elements: vec![share_of(0.0)] })),
        linkage(LinkageStage::Resonance(Resonance { frequency_hz: 1e16, damping_ratio: 0.7 })),
        linkage(LinkageStage::Backlash(Backlash { width_um: 0.0 })),
        linkage(LinkageStage::CoulombFriction(CoulombFriction { width_um: 0.0 })),
        linkage(LinkageStage::Accommodation(Accommodation { share: 0.0, travel_um: 60.0 })),
        linkage(LinkageStage::LoadStiffness(LoadStiffness {
            stiffness_ratio: 0.0,
            compliance_um_per_newton: 0.0,
        })),
        sensor(SensorStage::Filter(Lag { tau_s: 0.0 })),
        sensor(SensorStage::Nonlinearity(Nonlinearity {
            amplitude_um: 0.0,
            half_range_um: 100.0,
            shape: NonlinearityShape::Cubic,
        })),
        sensor(SensorStage::Quantisation(Quantisation { step_um: 0.0 })),
        sensor(SensorStage::Delay(Delay { delay_s: 0.0 })),
        sensor(SensorStage::MainsHum(MainsHum {
            amplitude_um: 0.0,
            frequency_hz: 50.0,
            phase_rad: 1.0,
        })),
    ]
}

#[test]
fn every_stage_has_its_identity_and_its_effect() {
    let step_s = 1e-3;
    let input = sampled(1500, step_s, |t| 65.0 + 80.0 * (TAU * 11.0 * t).sin() * (TAU * t).cos());
    for model in identities() {
        let off = largest_difference(&measured(&model, &input, step_s), &input);
        assert!(off < 1e-12, "{off:e}: {model:?}");
    }
    for model in effects() {
        let off = largest_difference(&measured(&model, &input, step_s), &input);
        assert!(off > 0.05, "{off:e}: {model:?}");
    }
}

type Family = Box<dyn Fn(f64) -> ActuatorModel>;

#[test]
fn effects_vanish_in_proportion_to_their_parameter() {
    // half the parameter, half the effect, where the effect is smooth in it
    let step_s = 1e-3;
    let input = sampled(1500, step_s, |t| 65.0 + 80.0 * (TAU * 3.0 * t).sin());
    let families: Vec<(&str, Family)> = vec![
        ("lag", Box::new(|x| amplifier(AmplifierStage::Lag(Lag { tau_s: 1e-5 * x })))),
        ("delay", Box::new(|x| amplifier(AmplifierStage::Delay(Delay { delay_s: 1e-5 * x })))),
        (
            "heat",
            Box::new(|x| {
                let heating = DielectricHeating::new(0.5, 1e-5 * x);
                amplifier(AmplifierStage::DielectricHeating(heating))
            }),
        ),
        (
            "depolarisation",
            Box::new(|x| {
                let loss_per_volt = 1e-5 * x;
                let stage = Depolarisation { loss_per_volt, ..Depolarisation::new(20.0) };
                amplifier(AmplifierStage::Depolarisation(stage))
            }),
        ),
        ("creep", Box::new(|x| linkage(LinkageStage::LogCreep(LogCreep::new(1e-4 * x))))),
        (
            "resonance",
            Box::new(|x| {
                let frequency_hz = 1e5 / x;
                linkage(LinkageStage::Resonance(Resonance { frequency_hz, damping_ratio: 1.0 }))
            }),
        ),
        (
            "backlash",
            Box::new(|x| linkage(LinkageStage::Backlash(Backlash { width_um: 1e-3 * x }))),
        ),
        (
            "friction",
            Box::new(|x| {
                linkage(LinkageStage::CoulombFriction(CoulombFriction { width_um: 1e-3 * x }))
            }),
        ),
        (
            "accommodation",
            Box::new(|x| {
                let stage = Accommodation { share: 1e-4 * x, travel_um: 60.0 };
                linkage(LinkageStage::Accommodation(stage))
            }),
        ),
        (
            "chain",
            Box::new(|x| {
                let element =
                    KelvinVoigtElement { compliance_ratio: 1e-4 * x, time_constant_s: 0.1 };
                linkage(LinkageStage::KelvinVoigt(KelvinVoigt { elements: vec![element] }))
            }),
        ),
        (
            "relaxation",
            Box::new(|x| {
                let elements = vec![share_of(1e-4 * x)];
                linkage(LinkageStage::Relaxation(Relaxation { elements }))
            }),
        ),
        ("filter", Box::new(|x| sensor(SensorStage::Filter(Lag { tau_s: 1e-5 * x })))),
        ("sensor delay", Box::new(|x| sensor(SensorStage::Delay(Delay { delay_s: 1e-5 * x })))),
        (
            "nonlinearity",
            Box::new(|x| {
                let shape = NonlinearityShape::Quadratic;
                let stage = Nonlinearity { amplitude_um: 1e-3 * x, half_range_um: 200.0, shape };
                sensor(SensorStage::Nonlinearity(stage))
            }),
        ),
        (
            "hum",
            Box::new(|x| {
                let amplitude_um = 1e-3 * x;
                let hum = MainsHum { amplitude_um, frequency_hz: 50.0, phase_rad: 1.0 };
                sensor(SensorStage::MainsHum(hum))
            }),
        ),
        (
            "load",
            Box::new(|x| {
                let stage =
                    LoadStiffness { stiffness_ratio: 1e-5 * x, compliance_um_per_newton: 0.0 };
                linkage(LinkageStage::LoadStiffness(stage))
            }),
        ),
    ];
    for (name, model) in families {
        let off = |x: f64| largest_difference(&measured(&model(x), &input, step_s), &input);
        let ratio = off(2.0) / off(1.0);
        assert!((ratio - 2.0).abs() < 0.05, "{name}: {ratio}");
    }
}

// ---- exact solutions ----

/// Samples of a piecewise straight input: breakpoints (time, value).
fn ramps(points: &[(f64, f64)], t: f64) -> f64 {
    let after = points.iter().position(|p| p.0 > t).unwrap_or(points.len());
    match (after.checked_sub(1).map(|i| points[i]), points.get(after)) {
        (Some((t0, v0)), Some((t1, v1))) => v0 + (v1 - v0) * (t - t0) / (t1 - t0),
        (Some((_, v)), None) => v,
        (None, _) => points[0].1,
    }
}

/// Exact response of a first-order lag to a piecewise straight input from rest.
fn lag_of_ramps(points: &[(f64, f64)], tau_s: f64, t: f64) -> f64 {
    // sum over kinks of the response to a unit ramp: x - tau (1 - exp(-x / tau))
    let slopes: Vec<f64> =
        points.windows(2).map(|p| (p[1].1 - p[0].1) / (p[1].0 - p[0].0)).chain([0.0]).collect();
    let mut before = 0.0;
    points.iter().zip(slopes).fold(points[0].1, |y, (&(start, _), slope)| {
        let x = (t - start).max(0.0);
        let kink = slope - before;
        before = slope;
        y + kink * (x + tau_s * (-x / tau_s).exp_m1())
    })
}

const KINKS: [(f64, f64); 5] = [(0.0, 10.0), (0.1, 10.0), (0.13, 90.0), (0.2, 40.0), (0.45, 41.0)];

#[test]
fn a_lag_is_exact_at_any_step() {
    for tau_s in [1e-6, 2e-3, 0.05, 40.0] {
        for step_s in [1e-3, 1e-2] {
            let input = sampled(60, step_s, |t| ramps(&KINKS, t));
            let exact = sampled(60, step_s, |t| lag_of_ramps(&KINKS, tau_s, t));
            for model in [
                amplifier(AmplifierStage::Lag(Lag { tau_s })),
                sensor(SensorStage::Filter(Lag { tau_s })),
            ] {
                let off = largest_difference(&measured(&model, &input, step_s), &exact);
                assert!(off < 1e-10, "tau {tau_s}, step {step_s}: {off:e}");
            }
        }
    }
}

#[test]
fn a_resonance_is_exact_at_any_step() {
    // step response of the ramp kinks: from the roots of the characteristic polynomial
    for (frequency_hz, zeta) in [(90.0, 0.01), (30.0, 0.4), (20.0, 1.0), (20.0, 1.7), (5.0, 40.0)] {
        let omega = TAU * frequency_hz;
        // response of y'' + 2 zeta omega y' + omega^2 y = omega^2 t to a unit ramp from rest
        let ramp = |x: f64| -> f64 {
            if x <= 0.0 {
                return 0.0;
            }
            let lead = 2.0 * zeta / omega;
            let (decay, split) = ((-zeta * omega * x).exp(), 1.0_f64 - zeta * zeta);
            // homogeneous part: h(0) = lead, h'(0) = -1
            let homogeneous = if split > 1e-12 {
                let d = omega * split.sqrt();
                let b = (-1.0 + zeta * omega * lead) / d;
                decay * (lead * (d * x).cos() + b * (d * x).sin())
            } else if split < -1e-12 {
                let a = omega * (-split).sqrt();
                let (fast, slow) = (-zeta * omega - a, -omega * omega / (zeta * omega + a));
                let c = (-1.0 - fast * lead) / (slow - fast);
                c * (slow * x).exp() + (lead - c) * (fast * x).exp()
            } else {
                decay * (lead + (-1.0 + omega * lead) * x)
            };
            x - lead + homogeneous
        };
        let response = |t: f64| {
            let mut before = 0.0;
            let slopes = KINKS
                .windows(2)
                .map(|p| (p[1].1 - p[0].1) / (p[1].0 - p[0].0))
                .chain([0.0])
                .collect::<Vec<_>>();
            KINKS.iter().zip(slopes).fold(KINKS[0].1, |y, (&(start, _), slope)| {
                let kink = slope - before;
                before = slope;
                y + kink * ramp(t - start)
            })
        };
        let model =
            linkage(LinkageStage::Resonance(Resonance { frequency_hz, damping_ratio: zeta }));
        for step_s in [1e-3, 1e-2] {
            let input = sampled(60, step_s, |t| ramps(&KINKS, t));
            let exact = sampled(60, step_s, response);
            let off = largest_difference(&measured(&model, &input, step_s), &exact);
            assert!(off < 1e-9, "{frequency_hz} Hz, zeta {zeta}, step {step_s}: {off:e}");
        }
    }
}

#[test]
fn a_resonance_has_its_exact_harmonic_response_at_second_order() {
    // the held ramps of a sine are off by h^2: the only error
    let (frequency_hz, zeta, drive_hz) = (90.0, 0.2, 45.0);
    let model = linkage(LinkageStage::Resonance(Resonance { frequency_hz, damping_ratio: zeta }));
    let r = drive_hz / frequency_hz;
    let (real, imaginary) = (1.0 - r * r, 2.0 * zeta * r);
    let exact = |t: f64| {
        let phase = TAU * drive_hz * t;
        (real * phase.sin() - imaginary * phase.cos()) / (real * real + imaginary * imaginary)
    };
    let error = |per_cycle: u32| {
        let step_s = 1.0 / drive_hz / f64::from(per_cycle);
        let samples = 60 * per_cycle;
        let input = sampled(samples, step_s, |t| (TAU * drive_hz * t).sin());
        let output = measured(&model, &input, step_s);
        let tail = 50 * per_cycle as usize;
        largest_difference(&output[tail..], &sampled(samples, step_s, exact)[tail..])
    };
    let errors = [20, 40, 80, 160].map(error);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.1, "{order} ({errors:?})");
    }
}

#[test]
fn creep_is_the_sum_of_its_lags_and_the_logarithm_between_them() {
    let rate = 0.02;
    let model = linkage(LinkageStage::LogCreep(LogCreep::new(rate)));
    // a step taken over one sample, then held
    let step_s = 0.02;
    let input = sampled(10_000, step_s, |t| if t < 0.5 * step_s { 0.0 } else { 100.0 });
    let output = measured(&model, &input, step_s);
    let mut worst = 0.0_f64;
    for decade in [0.3_f64, 1.0, 3.0, 10.0, 30.0, 100.0, 190.0] {
        let index = (decade / step_s).round();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let got = output[index as usize] / 100.0 - 1.0;
        let law = rate * (decade / 0.1).log10();
        worst = worst.max((got - law).abs());
    }
    println!("creep off the logarithmic law by {:.2} % of a decade", 100.0 * worst / rate);
    assert!(worst < 0.06 * rate, "{worst}");
    // any step gives the same samples
    let coarse: Vec<f64> = input[1..].iter().step_by(100).copied().collect();
    let mut memory = model.start(0.0, StartState::Rest).unwrap();
    model.stepper(step_s).unwrap().step(&mut memory, 100.0, 0.0).unwrap();
    let late =
        model.continue_drive(&mut memory, &Drive::new(&coarse[1..], 100.0 * step_s)).unwrap();
    let fine: Vec<f64> = output[1..].iter().step_by(100).copied().collect();
    assert!(largest_difference(&late, &fine[1..]) < 1e-10);
}

#[test]
fn a_kelvin_voigt_chain_is_exact() {
    let elements = vec![
        KelvinVoigtElement { compliance_ratio: 0.03, time_constant_s: 0.02 },
        KelvinVoigtElement { compliance_ratio: 0.05, time_constant_s: 0.7 },
    ];
    let exact = |t: f64| {
        elements.iter().fold(ramps(&KINKS, t), |y, e| {
            y + e.compliance_ratio * (lag_of_ramps(&KINKS, e.time_constant_s, t) - KINKS[0].1)
        })
    };
    let model = linkage(LinkageStage::KelvinVoigt(KelvinVoigt { elements: elements.clone() }));
    for step_s in [1e-3, 1e-2] {
        let input = sampled(60, step_s, |t| ramps(&KINKS, t));
        let off =
            largest_difference(&measured(&model, &input, step_s), &sampled(60, step_s, exact));
        assert!(off < 1e-11, "{off:e}");
    }
}

#[test]
fn a_delay_moves_the_record_by_itself() {
    for step_s in [1e-3, 1e-2] {
        for delay_s in [step_s, 2.5e-3, 0.0333] {
            let input = sampled(60, step_s, |t| ramps(&KINKS, t));
            let exact = sampled(60, step_s, |t| ramps(&KINKS, t - delay_s));
            let stages = [
                amplifier(AmplifierStage::Delay(Delay { delay_s })),
                sensor(SensorStage::Delay(Delay { delay_s })),
            ];
            for model in stages {
                // kinks fall on samples: the record between them is straight
                let off = largest_difference(&measured(&model, &input, step_s), &exact);
                assert!(off < 1e-10, "{delay_s} s at {step_s} s: {off:e}");
            }
        }
    }
}

#[test]
fn a_current_limit_turns_a_fast_triangle_into_a_slower_one() {
    // far above the limit the output is a triangle of the limit's slope
    let (slew, hz) = (400.0, 20.0);
    let model =
        amplifier(AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: slew }));
    let step_s = 1e-4;
    let input = sampled(20_000, step_s, |t| 80.0 * (TAU * hz * t).sin());
    let output = measured(&model, &input, step_s);
    // the mean drifts to its steady value: look at the last cycle
    let tail = &output[19_500..];
    let high = tail.iter().fold(f64::MIN, |m, y| m.max(*y));
    let low = tail.iter().fold(f64::MAX, |m, y| m.min(*y));
    // peak to peak: slew over half a period
    assert_abs_diff_eq!(high - low, slew / (2.0 * hz), epsilon = 2.0 * slew * step_s);
    assert!(output.windows(2).all(|p| (p[1] - p[0]).abs() <= slew * step_s * (1.0 + 1e-9)));
    // third harmonic of a triangle: one ninth of the first
    let harmonic = |n: f64| {
        let (c, s) = tail.iter().enumerate().fold((0.0, 0.0), |(c, s), (i, y)| {
            let phase = TAU * hz * n * i as f64 * step_s;
            (c + y * phase.cos(), s + y * phase.sin())
        });
        f64::hypot(c, s)
    };
    assert_abs_diff_eq!(harmonic(3.0) / harmonic(1.0), 1.0 / 9.0, epsilon = 2e-3);
}

#[test]
fn a_current_limit_is_exact_for_straight_pieces_at_any_step() {
    // coarse samples fall on the kinks; the fine record is the same motion, so samples must agree
    let points =
        [(0.0, 0.0), (0.1, 50.0), (0.2, -40.0), (0.3, 60.0), (0.4, 60.0), (0.5, 55.0), (0.6, 0.0)];
    for slew in [150.0, 420.0, 700.0, 5000.0] {
        let model =
            amplifier(AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: slew }));
        let run = |parts: u32| {
            let step_s = 0.1 / f64::from(parts);
            let input = sampled(6 * parts + 1, step_s, |t| ramps(&points, t));
            let output = measured(&model, &input, step_s);
            output.into_iter().step_by(parts as usize).collect::<Vec<f64>>()
        };
        let off = largest_difference(&run(1), &run(10_000));
        assert!(off < 2e-2, "{slew} V/s: {off}");
    }
}

#[test]
fn saturation_clips() {
    let stage = Saturation::sharp(-20.0, 100.0);
    let input = sampled(400, 1e-3, |t| 65.0 + 100.0 * (TAU * 5.0 * t).sin());
    let output = measured(&amplifier(AmplifierStage::Saturation(stage)), &input, 1e-3);
    for (u, y) in input.iter().zip(output) {
        assert_eq!(y, u.clamp(-20.0, 100.0));
    }
}

/// Inside the straight part nothing is changed, beyond the knee the limit stands, and between them the
/// slope falls from 1 to 0 on a straight line: checked by the integral of that slope.
#[test]
fn a_knee_bends_into_the_limit() {
    let (low, high, knee) = (-20.0, 100.0, 4.0);
    let stage = Saturation { knee_volt: knee, ..Saturation::sharp(low, high) };
    let input = sampled(40_001, 1e-3, |t| 40.0 + 4.0 * (t - 20.0));
    let output = measured(&amplifier(AmplifierStage::Saturation(stage)), &input, 1e-3);
    let slope = |u: f64| {
        let upper = (high + knee - u) / (2.0 * knee);
        let lower = (u - (low - knee)) / (2.0 * knee);
        upper.min(lower).clamp(0.0, 1.0)
    };
    let mut sum = low;
    for (i, (u, y)) in input.iter().zip(&output).enumerate() {
        if i > 0 {
            sum += 0.5 * (slope(input[i - 1]) + slope(*u)) * (u - input[i - 1]);
        }
        assert!((y - sum).abs() < 2e-4, "{u} V: {y} against {sum}");
    }
    assert_eq!((output[0], output[40_000]), (low, high));
    let bent = output.iter().zip(&input).filter(|(y, u)| y != u && **u < high && **u > low);
    assert!(bent.count() > 1000);
}

#[test]
fn heating_follows_the_loss_tangent_law() {
    // steady rise f A^2 times the coefficient, whatever the bias; approach with the time constant
    let (tau_s, rise) = (2.0, 1e-4);
    let heating =
        DielectricHeating { rise_k_per_volt2_hz: rise, ..DielectricHeating::new(tau_s, 1e-3) };
    let model = amplifier(AmplifierStage::DielectricHeating(heating));
    for (amplitude, hz, bias) in [(80.0, 10.0, 65.0), (40.0, 20.0, 65.0), (80.0, 10.0, 0.0)] {
        let step_s = 1.0 / hz / 200.0;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let samples = (10.0 * tau_s / step_s) as u32;
        let input = sampled(samples, step_s, |t| bias + amplitude * (TAU * hz * t).sin());
        let bench = model.simulate_bench(&Drive::new(&input, step_s)).unwrap();
        let steady = rise * hz * amplitude * amplitude;
        let mean = |from_s: f64| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
            let from = (from_s / step_s) as usize;
            bench.temperature_k[from..from + 200].iter().sum::<f64>() / 200.0
        };
        assert!((mean(9.5 * tau_s) / steady - 1.0).abs() < 1e-3, "{}", mean(9.5 * tau_s));
        let at = mean(tau_s - 0.5 / hz) / steady;
        assert!((at - (1.0 - (-1.0_f64).exp())).abs() < 0.01, "{at}");
        // the gain acts on the law's output about that at 0 V: the last sample
        let (last, kelvin) = (input.len() - 1, *bench.temperature_k.last().unwrap());
        assert_abs_diff_eq!(
            bench.output_deg[last],
            input[last] * (1.0 + 1e-3 * kelvin),
            epsilon = 1e-9
        );
    }
}

#[test]
fn depolarisation_stays_until_the_voltage_repoles() {
    let stage = Depolarisation {
        loss_per_volt: 0.01,
        repoling_volt: Some(100.0),
        ..Depolarisation::new(-20.0)
    };
    let model = amplifier(AmplifierStage::Depolarisation(stage));
    let gain = |past: &[f64]| {
        let input: Vec<f64> = [&[50.0], past, &[50.0]].concat();
        measured(&model, &input, 1e-3).last().unwrap() / 50.0
    };
    assert_eq!(gain(&[-19.0]), 1.0);
    assert_abs_diff_eq!(gain(&[-50.0]), 0.7, epsilon = 1e-12);
    // a smaller excursion afterwards changes nothing, a deeper one adds
    assert_abs_diff_eq!(gain(&[-50.0, 10.0, -40.0]), 0.7, epsilon = 1e-12);
    assert_abs_diff_eq!(gain(&[-50.0, 10.0, -60.0]), 0.6, epsilon = 1e-12);
    // repoling: those switched last come back first
    assert_abs_diff_eq!(gain(&[-50.0, 90.0]), 0.9, epsilon = 1e-12);
    assert_abs_diff_eq!(gain(&[-50.0, 100.0]), 1.0, epsilon = 1e-12);
    // without repoling it is lost for good
    let lasting =
        amplifier(AmplifierStage::Depolarisation(Depolarisation { repoling_volt: None, ..stage }));
    let output = measured(&lasting, &[50.0, -50.0, 100.0, 50.0], 1e-3);
    assert_abs_diff_eq!(output[3], 35.0, epsilon = 1e-12);
}

#[test]
fn depolarisation_with_time_vanishes_in_proportion_to_its_rate() {
    let input = sampled(1500, 1e-3, |t| 65.0 + 80.0 * (TAU * 3.0 * t).sin());
    let effect = |loss_per_volt_second: f64| {
        let stage = Depolarisation {
            loss_per_volt: 0.0,
            loss_per_volt_second,
            ..Depolarisation::new(20.0)
        };
        let model = amplifier(AmplifierStage::Depolarisation(stage));
        largest_difference(&input, &measured(&model, &input, 1e-3))
    };
    assert!(effect(1e-4) > 0.0 && effect(0.0) == 0.0);
    assert!((effect(2e-4) / effect(1e-4) - 2.0).abs() < 1e-9);
}

#[test]
fn depolarisation_grows_with_the_time_below_the_threshold() {
    let stage = Depolarisation {
        loss_per_volt: 0.0,
        loss_per_volt_second: 0.02,
        ..Depolarisation::new(-20.0)
    };
    let model = amplifier(AmplifierStage::Depolarisation(stage));
    // 50 V down to -50 V within a second, half a second there, and back: in closed form
    let path = |t: f64| match t {
        t if t < 1.0 => 50.0 - 100.0 * t,
        t if t < 1.5 => -50.0,
        t => (-50.0 + 100.0 * (t - 1.5)).min(50.0),
    };
    let overdrive_volt_s = 2.0 * 0.5 * 30.0 * 0.3 + 0.5 * 30.0;
    // exact at any step that has the corners among its samples, and where it has not the crossings
    for (count, step_s) in [(6, 0.5), (30, 0.1), (3000, 1e-3)] {
        let input = sampled(count, step_s, path);
        let last = *measured(&model, &input, step_s).last().unwrap();
        assert_abs_diff_eq!(last, 50.0 * (1.0 - 0.02 * overdrive_volt_s), epsilon = 1e-9);
        let gains = stage.gains(&input, step_s);
        assert_abs_diff_eq!(gains[gains.len() - 1], 1.0 - 0.02 * overdrive_volt_s, epsilon = 1e-9);
    }
    // repoling takes it back, the last first
    let repoled = Depolarisation { repoling_volt: Some(100.0), ..stage };
    let gains = repoled.gains(&[50.0, -80.0, -80.0, 40.0, 88.0, 100.0], 0.5);
    let before = 1.0 - gains[3];
    assert!(before > 0.4, "{gains:?}");
    assert_abs_diff_eq!(gains[4], 0.9, epsilon = 1e-12);
    assert_eq!(gains[5], 1.0);
    // all is lost in the end, never more
    assert_eq!(stage.gains(&[-200.0; 50], 1.0).last(), Some(&0.0));
}

#[test]
fn accommodation_settles_with_the_way_and_not_with_time() {
    let (share, travel) = (0.2, 50.0);
    let model = linkage(LinkageStage::Accommodation(Accommodation { share, travel_um: travel }));
    // up by 80, down by 80, up by 80: the stretch after each, in closed form
    let input = [0.0, 30.0, 80.0, 80.0, 20.0, 0.0, 0.0, 0.0, 80.0];
    let output = measured(&model, &input, 1e-3);
    let left = (-80.0_f64 / travel).exp();
    let up = travel * (1.0 - left);
    let down = -travel + (up + travel) * left;
    let again = travel + (down - travel) * left;
    for (at, stretch) in [(2, up), (3, up), (5, down), (7, down), (8, again)] {
        assert_abs_diff_eq!(output[at], input[at] - share * stretch, epsilon = 1e-12);
    }
    // the same way in another time: the same bits
    assert_eq!(measured(&model, &input, 0.7), output);
    // no return-point memory: the second time at 80 gives more, and the loops close after a long way
    assert!(output[8] > output[2] + 1.0, "{output:?}");
    let cycles = sampled(40, 1.0, |i| if i.rem_euclid(2.0) < 0.5 { 0.0 } else { 80.0 });
    let tops = measured(&model, &cycles, 1.0);
    assert_abs_diff_eq!(tops[37], tops[39], epsilon = 1e-9);
    for (share, travel_um) in [(-0.1, 60.0), (0.6, 60.0), (0.1, 0.0), (f64::NAN, 60.0)] {
        let stage = LinkageStage::Accommodation(Accommodation { share, travel_um });
        assert!(linkage(stage).start(0.0, preisach_dyn::StartState::Rest).is_err());
    }
}

#[test]
fn backlash_loops_have_their_width_and_friction_approaches_it() {
    let width = 6.0;
    let input = sampled(8000, 1e-3, |t| 40.0 * (TAU * t).sin());
    let exact_play =
        measured(&linkage(LinkageStage::Backlash(Backlash { width_um: width })), &input, 1e-3);
    let friction = measured(
        &linkage(LinkageStage::CoulombFriction(CoulombFriction { width_um: width })),
        &input,
        1e-3,
    );
    // area of a backlash loop: width times the travel of the output
    let area = |output: &[f64]| -> f64 {
        let (x, y) = (&input[6999..], &output[6999..]);
        let pairs = x.windows(2).zip(y.windows(2));
        pairs.map(|(x, y)| 0.5 * (x[0] + x[1]) * (y[1] - y[0])).sum()
    };
    let closed = width * 2.0 * (40.0 - 0.5 * width);
    assert!((area(&exact_play) / closed - 1.0).abs() < 2e-3, "{} {closed}", area(&exact_play));
    for (x, y) in input.iter().zip(&exact_play) {
        assert!((x - y).abs() <= 0.5 * width + 1e-12);
    }
    // it stands still after the reversal: flat over the width
    let top = 7250;
    let flat = input[top..].iter().position(|x| *x < 40.0 - width).unwrap();
    assert!(exact_play[top..top + flat].windows(2).all(|p| (p[1] - p[0]).abs() < 1e-9));
    // friction: the closed form of a move up from the turn, by the way d of the output,
    // x - x_turn = d + (r + e)(1 - exp(-10 d / r)), e = y - x at the turn
    let r = 0.5 * width;
    let bottom = 7750;
    let both = r + friction[bottom] - input[bottom];
    assert!((both / width - 1.0).abs() < 1e-9, "the loop has its width: {both}");
    for i in bottom..bottom + 240 {
        let d = friction[i] - friction[bottom];
        let exact = input[bottom] + d + both * (1.0 - (-10.0 * d / r).exp());
        assert_abs_diff_eq!(input[i], exact, epsilon = 1e-9);
    }
    // of a small motion a share of 1/11 comes through
    let small = sampled(4000, 1e-3, |t| 0.03 * (TAU * t).sin());
    let stage = LinkageStage::CoulombFriction(CoulombFriction { width_um: width });
    let passed = measured(&linkage(stage), &small, 1e-3);
    let largest = passed.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    assert_abs_diff_eq!(largest, 0.03 / 11.0, epsilon = 2e-5);
    // it all but stands still at the reversal and never moves against its input
    let rests = (friction[top + 1] - friction[top]) / (input[top + 1] - input[top]);
    assert!((rests - 1.0 / 21.0).abs() < 2e-3, "{rests}");
    for (x, y) in input.windows(2).zip(friction.windows(2)) {
        let (way, followed) = (x[1] - x[0], y[1] - y[0]);
        assert!(way * followed >= -1e-18 && followed.abs() <= way.abs() + 1e-12, "{x:?} {y:?}");
    }
    // any sampling of the same path gives the same samples
    let coarse: Vec<f64> = input.iter().step_by(125).copied().collect();
    let sparse = measured(
        &linkage(LinkageStage::CoulombFriction(CoulombFriction { width_um: width })),
        &coarse,
        0.125,
    );
    let fine: Vec<f64> = friction.iter().step_by(125).copied().collect();
    assert!(largest_difference(&sparse, &fine) < 1e-9);
}

#[test]
fn sensor_errors_are_what_they_say() {
    let input = sampled(2000, 1e-3, |t| 100.0 * (PI * t).sin());
    for shape in [NonlinearityShape::Quadratic, NonlinearityShape::Cubic] {
        let stage = Nonlinearity { amplitude_um: 0.4, half_range_um: 100.0, shape };
        let output = measured(&sensor(SensorStage::Nonlinearity(stage)), &input, 1e-3);
        // Chebyshev: cos(n arccos x), so the largest error is the amplitude
        let n = if shape == NonlinearityShape::Quadratic { 2.0 } else { 3.0 };
        for (x, y) in input.iter().zip(&output) {
            let exact = 0.4 * (n * (x / 100.0).acos()).cos();
            assert_abs_diff_eq!(y - x, exact, epsilon = 1e-12);
        }
        assert!((largest_difference(&input, &output) - 0.4).abs() < 1e-5);
    }
    let about = |straight| {
        let shape = NonlinearityShape::CubicAbout { straight };
        let stage = Nonlinearity { amplitude_um: 0.4, half_range_um: 100.0, shape };
        measured(&sensor(SensorStage::Nonlinearity(stage)), &input, 1e-3)
    };
    let cubic =
        Nonlinearity { amplitude_um: 0.4, half_range_um: 100.0, shape: NonlinearityShape::Cubic };
    let best_line = measured(&sensor(SensorStage::Nonlinearity(cubic)), &input, 1e-3);
    assert!(largest_difference(&about(0.75), &best_line) < 1e-12);
    for straight in [0.0, 0.3, 0.9, 1.0, 1.5] {
        // the amplitude is the largest error, whatever line it is taken from
        let largest = largest_difference(&input, &about(straight));
        assert!((largest - 0.4).abs() < 1e-4, "{straight}: {largest}");
    }
    let through_ends = about(1.0);
    assert_abs_diff_eq!(through_ends[500], input[500], epsilon = 1e-9);
    let stage = Quantisation { step_um: 0.25 };
    let output = measured(&sensor(SensorStage::Quantisation(stage)), &input, 1e-3);
    for (x, y) in input.iter().zip(&output) {
        assert!((x - y).abs() <= 0.125 + 1e-12 && (y / 0.25).fract() == 0.0);
    }
    let stage = MainsHum { amplitude_um: 0.3, frequency_hz: 50.02, phase_rad: 0.7 };
    let output = measured(&sensor(SensorStage::MainsHum(stage)), &input, 1e-3);
    for (i, (x, y)) in input.iter().zip(&output).enumerate() {
        let exact = 0.3 * (TAU * 50.02 * i as f64 * 1e-3 + 0.7).sin();
        assert_abs_diff_eq!(y - x, exact, epsilon = 1e-10);
    }
}
