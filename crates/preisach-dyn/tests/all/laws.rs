//! Every law: storing and taking up, shift, starting states; Prandtl-Ishlinskii and Bouc-Wen
//! against exact solutions.
#![expect(clippy::float_cmp, reason = "results are claimed to be equal to the last bit")]

use crate::common;

use approx::assert_abs_diff_eq;
use common::{HIGH, LOW, bouc_wen, every_law, plain, plays, stored};
use preisach_dyn::{
    ActuatorLaw, BoucWen, BoucWenParameters, Envelope, HysteresisLaw, PrandtlIshlinskii,
    PreisachError, StartState, WeightedPlay,
};
use proptest::prelude::*;
use std::f64::consts::TAU;

const STATES: [StartState; 3] =
    [StartState::Rest, StartState::RisingFromLowest, StartState::FallingFromHighest];

proptest! {
    #[test]
    fn a_law_stored_midway_goes_on_with_the_same_bits(
        past in prop::collection::vec(LOW..HIGH, 1..30),
        future in prop::collection::vec(LOW..HIGH, 1..30),
        step_s in 1e-4..1e-2_f64,
    ) {
        for law in every_law() {
            let (mut memory, _) = law.start(past[0], StartState::Rest);
            for &u in &past {
                law.step(&mut memory, u, step_s);
            }
            let (restored_law, mut restored) = (stored(&law), stored(&memory));
            prop_assert_eq!(&restored, &memory, "{}", law.name());
            prop_assert_eq!(&restored_law, &law);
            prop_assert!(restored_law.check_memory(&restored).is_ok());
            for &u in &future {
                let (a, b) = (law.step(&mut memory, u, step_s), restored_law.step(&mut restored, u, step_s));
                prop_assert_eq!(a.to_bits(), b.to_bits(), "{}", law.name());
            }
        }
    }

    #[test]
    fn static_laws_know_no_time(past in prop::collection::vec(LOW..HIGH, 2..30)) {
        for law in every_law().into_iter().filter(|l| !l.name().contains("dynamic") && !l.name().contains("Prandtl")) {
            let (mut slow, _) = law.start(past[0], StartState::Rest);
            let (mut fast, _) = law.start(past[0], StartState::Rest);
            for &u in &past {
                prop_assert_eq!(law.step(&mut slow, u, 10.0), law.step(&mut fast, u, 1e-6));
            }
        }
    }

    #[test]
    fn no_output_falls_while_the_voltage_rises(
        past in prop::collection::vec(LOW..HIGH, 1..30),
        u in LOW..HIGH,
    ) {
        // at one rate of the voltage; the dynamic law has its own inertia
        for law in every_law().into_iter().filter(|l| !l.name().contains("dynamic")) {
            let (mut memory, mut before) = law.start(past[0], StartState::Rest);
            for &v in &past {
                before = law.step(&mut memory, v, 1e6);
            }
            let last = *past.last().unwrap();
            let after = law.step(&mut memory, u, 1e6);
            prop_assert!((after - before) * (u - last) >= -1e-12, "{}", law.name());
        }
    }

    #[test]
    fn bouc_wen_dissipates_on_every_path(
        path in prop::collection::vec(LOW..HIGH, 2..12),
        exponent in prop::sample::select(vec![1.0, 1.4, 2.0, 3.0]),
        sigma in 0.5..1.5_f64,
    ) {
        // work put into the hysteretic variable less the energy stored in it, rise w^2 / 2
        let law = bouc_wen(exponent, sigma);
        let rise = law.parameters().rise_volt;
        let (mut w, mut lost) = (0.0, 0.0);
        for ends in path.windows(2) {
            let parts = 400_u32;
            let change = (ends[1] - ends[0]) / f64::from(parts);
            for _ in 0..parts {
                let next = law.hysteretic_variable(w, change);
                let step = 0.5 * (w + next) * change - 0.5 * rise * (next * next - w * w);
                // the trapezium is off by the third power of the step
                prop_assert!(step >= -(change / rise).abs().powi(3) * rise, "{step:e} at {w}");
                lost += step;
                w = next;
            }
        }
        let travel: f64 = path.windows(2).map(|e| (e[1] - e[0]).abs()).sum();
        prop_assert!(lost > 0.0 || travel < 1.0, "{lost:e}");
    }
}

#[test]
fn a_law_shifted_is_the_law_with_a_constant_added() {
    for law in every_law() {
        let moved = law.clone().shifted(-1.5);
        let (mut a, first) = law.start(40.0, StartState::Rest);
        let (mut b, second) = moved.start(40.0, StartState::Rest);
        assert_abs_diff_eq!(second - first, -1.5, epsilon = 1e-12);
        for u in [50.0, 120.0, -3.0, 66.0] {
            let (y, z) = (law.step(&mut a, u, 1e-2), moved.step(&mut b, u, 1e-2));
            assert_abs_diff_eq!(z - y, -1.5, epsilon = 1e-9);
        }
    }
}

#[test]
fn a_memory_of_another_law_is_refused() {
    let laws = every_law();
    for (i, law) in laws.iter().enumerate() {
        for (j, other) in laws.iter().enumerate() {
            let (memory, _) = other.start(65.0, StartState::Rest);
            assert_eq!(
                law.check_memory(&memory).is_ok(),
                i == j,
                "{} {}",
                law.name(),
                other.name()
            );
        }
    }
}

#[test]
fn the_starting_states_stand_in_order() {
    // coming from above there is more left than coming from below; at rest it is between
    for law in every_law() {
        let [rest, mut rising, mut falling] = STATES.map(|state| law.start(70.0, state).1);
        if matches!(law, ActuatorLaw::PrandtlStop(_)) {
            // it leads: coming from below there is more
            std::mem::swap(&mut rising, &mut falling);
        }
        assert!(rising <= rest && rest <= falling, "{}: {rising} {rest} {falling}", law.name());
        if law.name() != "linear gain" {
            assert!(rising < falling, "{}", law.name());
        }
    }
}

// ---- Prandtl-Ishlinskii ----

#[test]
fn one_play_under_a_triangle_has_the_area_of_its_parallelogram() {
    // loop of play r under amplitude A: 4 r (A - r); under a ramp the half-width grows by b |rate|
    let (r, amplitude) = (12.0, 60.0);
    let law = PrandtlIshlinskii::new(common::prandtl(
        vec![WeightedPlay { threshold_volt: r, weight_deg_per_volt: 0.1 }],
        2e-3,
        Envelope::default(),
    ))
    .unwrap();
    for rate_volt_s in [0.0, 500.0, 4000.0] {
        // triangle of constant rate: the half-width is constant but at the turns
        let half = r + 2e-3 * rate_volt_s;
        let samples = 2000_u32;
        let step_s = if rate_volt_s == 0.0 {
            1e9
        } else {
            2.0 * amplitude / f64::from(samples) / rate_volt_s
        };
        let (mut memory, _) = law.start(65.0 - amplitude, StartState::Rest);
        let (mut area, mut last) = (0.0, (65.0 - amplitude, f64::NAN));
        for _ in 0..3 {
            area = 0.0;
            for i in 1..=2 * samples {
                let x = f64::from(i) / f64::from(samples);
                let u = 65.0 - amplitude + 2.0 * amplitude * if x <= 1.0 { x } else { 2.0 - x };
                let y = law.step(&mut memory, u, step_s);
                area += 0.5 * (u + last.0) * (y - last.1);
                last = (u, y);
            }
        }
        let exact = 0.1 * 4.0 * half * (amplitude - half);
        assert!((area / exact - 1.0).abs() < 0.02, "{rate_volt_s} V/s: {area} against {exact}");
    }
}

#[test]
fn thresholds_that_grow_widen_the_loop_with_frequency() {
    let width = |growth_s: f64, hz: f64| -> f64 {
        let law = PrandtlIshlinskii::new(common::prandtl(plays(), growth_s, Envelope::default()))
            .unwrap();
        let (mut memory, _) = law.start(65.0, StartState::Rest);
        let n = 400_u32;
        let step_s = 1.0 / hz / f64::from(n);
        let mut at_middle = Vec::new();
        for i in 0..3 * n {
            let u = 65.0 + 60.0 * (TAU * f64::from(i) / f64::from(n)).sin();
            let y = law.step(&mut memory, u, step_s);
            if i >= 2 * n && i % (n / 2) == 0 {
                at_middle.push(y);
            }
        }
        at_middle[1] - at_middle[0]
    };
    assert_abs_diff_eq!(width(0.0, 0.2), width(0.0, 20.0), epsilon = 1e-12);
    assert!(width(1e-3, 20.0) > 1.5 * width(1e-3, 0.2));
}

#[test]
fn an_envelope_makes_the_loop_asymmetric() {
    // width of the loop at 30 V below and above the middle
    let widths = |envelope: Envelope| -> [f64; 2] {
        let law = PrandtlIshlinskii::new(common::prandtl(plays(), 0.0, envelope)).unwrap();
        [35.0, 95.0].map(|u| {
            let up = law.start(u, StartState::RisingFromLowest).1;
            law.start(u, StartState::FallingFromHighest).1 - up
        })
    };
    let [low, high] = widths(Envelope::default());
    assert_abs_diff_eq!(low, high, epsilon = 1e-12);
    let [low, high] = widths(Envelope { quadratic: 0.3, ..Envelope::default() });
    assert!(high > 1.2 * low, "{low} {high}");
}

#[test]
fn numbers_outside_their_range_are_refused() {
    let negative = vec![WeightedPlay { threshold_volt: 1.0, weight_deg_per_volt: -0.1 }];
    for (plays, growth_s) in [(negative, 0.0), (plays(), -1.0), (plays(), f64::NAN)] {
        let error = PrandtlIshlinskii::new(common::prandtl(plays, growth_s, Envelope::default()));
        assert!(matches!(error, Err(PreisachError::OutOfRange { .. })), "{error:?}");
    }
    for envelope in [
        Envelope { quadratic: 0.51, ..Envelope::default() },
        Envelope { cubic: -0.34, ..Envelope::default() },
        // falls between the ends only
        Envelope { quadratic: -1.5, cubic: 0.7, ..Envelope::default() },
    ] {
        let error = PrandtlIshlinskii::new(common::prandtl(plays(), 0.0, envelope));
        assert!(matches!(error, Err(PreisachError::OutOfRange { value, .. }) if value < 0.0));
    }
    let good = *bouc_wen(2.0, 0.8).parameters();
    let refused = |parameters| BoucWen::new(parameters).unwrap_err();
    assert!(matches!(
        refused(BoucWenParameters { sigma: 0.49, ..good }),
        PreisachError::OutOfRange { quantity: "sigma", .. }
    ));
    assert!(matches!(
        refused(BoucWenParameters { exponent: 0.9, ..good }),
        PreisachError::OutOfRange { quantity: "exponent", .. }
    ));
    assert!(matches!(
        refused(BoucWenParameters { half_height_deg: 4.0, ..good }),
        PreisachError::OutOfRange { quantity: "steepest slope of the loop (deg/V)", .. }
    ));
    assert!(matches!(
        refused(BoucWenParameters { rise_volt: 0.0, ..good }),
        PreisachError::OutOfRange { .. }
    ));
    // what is stored is checked when it is read
    let text = serde_json::to_string(&bouc_wen(2.0, 0.8)).unwrap();
    let broken = text.replace("\"sigma\":0.8", "\"sigma\":0.2");
    assert_ne!(text, broken);
    assert!(serde_json::from_str::<BoucWen>(&broken).is_err());
}

// ---- Bouc-Wen ----

#[test]
fn the_loading_branch_of_bouc_wen_is_its_closed_form() {
    // from rest, rising: n = 1: 1 - exp(-x), n = 2: tanh x, whatever sigma
    for (exponent, exact) in
        [(1.0, (|x: f64| 1.0 - (-x).exp()) as fn(f64) -> f64), (2.0, |x: f64| x.tanh())]
    {
        let law = bouc_wen(exponent, 0.9);
        for volt in [0.3, 5.0, 40.0] {
            let w = law.hysteretic_variable(0.0, volt);
            assert_abs_diff_eq!(w, exact(volt / law.parameters().rise_volt), epsilon = 1e-14);
            assert_abs_diff_eq!(law.hysteretic_variable(0.0, -volt), -w, epsilon = 1e-15);
        }
    }
}

#[test]
fn one_bouc_wen_step_is_many_small_ones_at_every_exponent() {
    // path independence of the closed forms, through the zero of the variable and both signs;
    // for other exponents the error of the Runge-Kutta steps
    for (exponent, bound) in [(1.0, 1e-12), (2.0, 1e-12), (1.5, 3e-6), (3.0, 1e-7)] {
        for sigma in [0.5, 0.8, 1.7] {
            let law = bouc_wen(exponent, sigma);
            for start in [-0.9, -0.3, 0.0, 0.5] {
                for change in [-60.0, -7.0, 3.0, 30.0] {
                    let whole = law.hysteretic_variable(start, change);
                    let parts = 4000_u32;
                    let many = (0..parts)
                        .fold(start, |w, _| law.hysteretic_variable(w, change / f64::from(parts)));
                    assert!(
                        (whole - many).abs() < bound,
                        "n {exponent} sigma {sigma}: {whole} {many}"
                    );
                }
            }
        }
    }
}

#[test]
fn bouc_wen_satisfies_its_equation() {
    // dw / du by central differences against the right side
    for exponent in [1.0, 1.5, 2.0, 3.0] {
        let sigma = 0.8;
        let law = bouc_wen(exponent, sigma);
        let rise = law.parameters().rise_volt;
        for w in [-0.8_f64, -0.2, 0.3, 0.9] {
            for sign in [1.0_f64, -1.0] {
                let h = 1e-4 * sign;
                let slope = (law.hysteretic_variable(w, h) - w) / h;
                let exact = (1.0 - sigma * sign * w.abs().powf(exponent - 1.0) * w
                    + (sigma - 1.0) * w.abs().powf(exponent))
                    / rise;
                assert!((slope - exact).abs() < 1e-5 * (1.0 / rise), "{slope} {exact}");
            }
        }
    }
}

#[test]
fn an_actuator_without_stages_is_its_law() {
    let volts: Vec<f64> = (0..500_u32).map(|i| 65.0 + 70.0 * (f64::from(i) * 0.37).sin()).collect();
    for law in every_law() {
        let outputs = plain(law.clone()).simulate(&volts, 1e-3).unwrap().output_deg;
        let (mut memory, first) = law.start(volts[0], StartState::Rest);
        assert_eq!(outputs[0], first);
        for (u, output) in volts[1..].iter().zip(&outputs[1..]) {
            assert_eq!(law.step(&mut memory, *u, 1e-3), *output);
        }
    }
}
