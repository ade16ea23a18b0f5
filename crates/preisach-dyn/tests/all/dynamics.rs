//! Dynamic Preisach, equation (5): exact special cases, order of accuracy, well-posedness.
#![expect(clippy::float_cmp, reason = "results are claimed to be equal to the last bit")]
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use approx::assert_abs_diff_eq;
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, Calibration, Drive, DynamicParameters, DynamicPreisach,
    HysteresisLaw, OutputRate, PlayMap, PlayMemory, PreisachError, PreisachGrid, RateForm,
    StartState, StepCounts, TimeOrder, VoltageRange, output_rate,
};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;

fn grid(levels: usize) -> PreisachGrid {
    PreisachGrid::new(VoltageRange::amplified_stack(), levels).unwrap()
}

fn rises(grid: &PreisachGrid, f: impl Fn(f64, f64) -> f64) -> Vec<Vec<f64>> {
    let n = grid.levels();
    (0..n)
        .map(|j| {
            (0..n - j)
                .map(|k| f((2 * k + j + 1) as f64 / n as f64 - 1.0, j as f64 / n as f64))
                .collect()
        })
        .collect()
}

/// Hysteretic, with a relaxation time that depends on the state and a quadratic term.
fn parameters(time_order: TimeOrder) -> DynamicParameters {
    let grid = grid(16);
    let mut g1_s = PlayMap::from_rises(
        &grid,
        -0.020,
        &rises(&grid, |s, r| 4e-4 * (3.0 * s).sin() * (1.0 - r)),
    )
    .unwrap();
    g1_s.constant = -0.020;
    DynamicParameters {
        grid,
        g0_deg: PlayMap::from_rises(
            &grid,
            0.0,
            &rises(&grid, |s, r| 0.2 * (-2.0 * r).exp() * (1.1 + s * s)),
        )
        .unwrap(),
        g1_s,
        g2_s2_per_deg: PlayMap::from_rises(&grid, 2e-6, &rises(&grid, |s, _| 1e-7 * s)).unwrap(),
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 600.0,
        time_order,
    }
}

fn actuator(parameters: DynamicParameters) -> ActuatorModel {
    let range_volt = parameters.grid.range();
    let law = ActuatorLaw::DynamicPreisach(DynamicPreisach::new(parameters).unwrap());
    ActuatorModel::new(law, range_volt, Calibration { deg_per_um: 0.04, zero_um: 0.0 })
}

/// A linear static part of 0.1 deg/V (the reversible play alone), zero at 65 V, behind a lag.
fn linear_with_lag(lag_s: f64, time_order: TimeOrder) -> ActuatorModel {
    let grid = grid(4);
    let mut g0_deg = PlayMap::constant(&grid, 0.0);
    g0_deg.nodes[0] = (0..5).map(|k| -8.5 + 4.25 * f64::from(k)).collect();
    actuator(DynamicParameters {
        grid,
        g0_deg,
        g1_s: PlayMap::constant(&grid, -lag_s),
        g2_s2_per_deg: PlayMap::constant(&grid, 0.0),
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 1e6,
        time_order,
    })
}

#[test]
fn with_the_voltage_held_the_state_relaxes_with_minus_g1() {
    let p = parameters(TimeOrder::Second);
    let model = DynamicPreisach::new(DynamicParameters {
        g2_s2_per_deg: PlayMap::constant(&p.grid, 0.0),
        ..p
    })
    .unwrap();
    let (mut memory, start) = model.start(30.0, StartState::Rest);
    let [settled, g1, _] = model.apply(&mut memory.plays, 110.0);
    let step_s = 1e-5;
    for i in 1..=4000 {
        let output = model.step(&mut memory, 110.0, step_s);
        let exact = settled + (start - settled) * (f64::from(i) * step_s / g1).exp();
        assert_abs_diff_eq!(output, exact, epsilon = 1e-3 * (settled - start).abs());
    }
}

/// Exact response of `tau y' + y = x` to `x = amplitude (1 - cos w t)` from rest.
fn exact_lag(amplitude: f64, lag_s: f64, omega: f64, t: f64) -> f64 {
    let p = omega * lag_s;
    let steady = ((omega * t).cos() + p * (omega * t).sin()) / (1.0 + p * p);
    amplitude * (1.0 - steady - (1.0 - 1.0 / (1.0 + p * p)) * (-t / lag_s).exp())
}

#[test]
fn a_constant_g1_is_a_first_order_lag_integrated_at_the_order_asked_for() {
    let (lag_s, omega) = (0.024, TAU * 15.0);
    for (order, expected) in [(TimeOrder::First, 1.0), (TimeOrder::Second, 2.0)] {
        let model = linear_with_lag(lag_s, order);
        let errors = [50, 100, 200, 400, 800].map(|per_cycle| {
            let step_s = TAU / omega / f64::from(per_cycle);
            let volts: Vec<f64> = (0..=3 * per_cycle)
                .map(|i| 25.0 + 40.0 * (1.0 - (omega * step_s * f64::from(i)).cos()))
                .collect();
            let outputs = model.simulate(&volts, step_s).unwrap().output_deg;
            outputs.iter().zip(0..).fold(0.0_f64, |worst, (y, i)| {
                let exact = -4.0 + exact_lag(4.0, lag_s, omega, step_s * f64::from(i));
                worst.max((y - exact).abs())
            })
        });
        for pair in errors.windows(2).skip(1) {
            let rate = (pair[0] / pair[1]).log2();
            assert!((rate - expected).abs() < 0.1, "{order:?}: {rate} ({errors:?})");
        }
    }
}

#[test]
fn a_state_dependent_lag_converges_at_the_order_asked_for() {
    // The maps have kinks at their knots and the plays turn with the voltage. A kink is a jump of
    // the second derivative of the output: it costs one step of a lower order, not the order of
    // the whole, but makes the ratio uneven; hence the mean rate over a factor of 16.
    let reference = refined_output(&actuator(parameters(TimeOrder::Second)), 51_200);
    for (order, expected) in [(TimeOrder::First, 1.0), (TimeOrder::Second, 2.0)] {
        let model = actuator(parameters(order));
        let error = |per_cycle: u32| -> f64 {
            let outputs = refined_output(&model, per_cycle);
            let squares: f64 = outputs.iter().zip(&reference).map(|(a, b)| (a - b).powi(2)).sum();
            (squares / outputs.len() as f64).sqrt()
        };
        let (coarse, fine) = (error(200), error(3200));
        let rate = (coarse / fine).log2() / 4.0;
        assert!((rate - expected).abs() < 0.15, "{order:?}: {rate} ({coarse:e} {fine:e})");
    }
}

/// Output at 50 instants per cycle over 3 cycles of 10 Hz.
fn refined_output(model: &ActuatorModel, per_cycle: u32) -> Vec<f64> {
    let step_s = 0.1 / f64::from(per_cycle);
    let volts: Vec<f64> = (0..=3 * per_cycle)
        .map(|i| 65.0 - 80.0 * (TAU * f64::from(i) / f64::from(per_cycle)).sin())
        .collect();
    let outputs = model.simulate(&volts, step_s).unwrap().output_deg;
    outputs.iter().step_by(per_cycle as usize / 50).copied().collect()
}

#[test]
fn uneven_steps_keep_the_second_order() {
    let (lag_s, omega) = (0.024, TAU * 15.0);
    let model = linear_with_lag(lag_s, TimeOrder::Second);
    let error = |count: u32| -> f64 {
        let mut memory = model.start(25.0, StartState::Rest).unwrap();
        let mut worst = 0.0_f64;
        let mut t = 0.0;
        for i in 0..count {
            let step_s = 0.2 / f64::from(count) * (1.0 + 0.5 * (f64::from(i % 3) - 1.0));
            t += step_s;
            let u = 25.0 + 40.0 * (1.0 - (omega * t).cos());
            let y = model.stepper(step_s).unwrap().step(&mut memory, u, 0.0).unwrap();
            worst = worst.max((y + 4.0 - exact_lag(4.0, lag_s, omega, t)).abs());
        }
        worst
    };
    let rate = (error(300) / error(2400)).log2() / 3.0;
    assert!((rate - 2.0).abs() < 0.15, "{rate}");
}

#[test]
fn the_step_satisfies_equation_5() {
    let p = parameters(TimeOrder::First);
    let model = DynamicPreisach::new(p).unwrap();
    let (mut memory, _) = model.start(65.0, StartState::Rest);
    let step_s = 5e-4;
    for i in 0..2000_u32 {
        let u = 65.0 + 80.0 * (TAU * 12.0 * step_s * f64::from(i)).sin();
        let before = memory.history.output_deg;
        let output = model.step(&mut memory, u, step_s);
        let [g0, g1, g2] = model.maps(&memory.plays);
        let d = (output - before) / step_s;
        assert_abs_diff_eq!(output, g0 + d * g1 + d * d * g2, epsilon = 1e-10);
    }
    assert_eq!(memory.counts, StepCounts { steps: 2000, g1_not_negative: 0, folds: 0 });
}

#[test]
fn past_the_fold_the_rate_is_that_of_the_fold() {
    // b = h - G1 = 0.021, fold at q = b^2 / (4 G2)
    let (h, g1, g2) = (1e-3, -0.02, 1e-5);
    let b: f64 = h - g1;
    let limit = b * b / (4.0 * g2);
    let inside = output_rate([limit * (1.0 - 1e-9), g1, g2], 0.0, h);
    let outside = output_rate([limit * 1.5, g1, g2], 0.0, h);
    assert!(!inside.folded && outside.folded);
    assert_abs_diff_eq!(outside.rate_deg_s, b / (2.0 * g2), epsilon = 1e-9);
    assert_abs_diff_eq!(inside.rate_deg_s, outside.rate_deg_s, epsilon = 0.05);
    // the branch is the one that stays finite as G2 vanishes
    let flat = output_rate([1.0, g1, 1e-30], 0.0, h);
    assert_abs_diff_eq!(flat.rate_deg_s, 1.0 / b, epsilon = 1e-12);
    assert_eq!(output_rate([0.0, h, 0.0], 0.0, h).rate_deg_s, 0.0);
}

#[test]
fn a_jump_of_the_voltage_folds_and_is_counted() {
    let p = parameters(TimeOrder::First);
    let g2_s2_per_deg = PlayMap::constant(&p.grid, 1.1e-5);
    let model = actuator(DynamicParameters { g2_s2_per_deg, ..p });
    let volts: Vec<f64> = (0..100).map(|i| if i < 50 { -20.0 } else { 150.0 }).collect();
    let simulation = model.simulate(&volts, 1e-4).unwrap();
    assert!(simulation.counts.folds > 0, "{:?}", simulation.counts);
    assert!(simulation.output_deg.iter().all(|y| y.is_finite()));
}

#[test]
fn what_is_not_well_posed_is_refused_or_counted() {
    let p = parameters(TimeOrder::First);
    // G1 > 0 near the lower corner
    let mut g1_s = PlayMap::from_rises(&p.grid, 0.0, &rises(&p.grid, |_, _| -3e-4)).unwrap();
    let broken = DynamicParameters { g1_s: g1_s.clone(), ..p.clone() };
    assert!(matches!(
        DynamicPreisach::new(broken.clone()),
        Err(PreisachError::OutOfRange { quantity: "largest G1 (s)", value, .. }) if value > 0.01
    ));
    let literal = actuator(DynamicParameters { form: RateForm::Literal, ..broken });
    let volts: Vec<f64> =
        (0..500).map(|i| 65.0 - 80.0 * (TAU * f64::from(i) / 250.0).sin()).collect();
    match literal.simulate(&volts, 4e-4) {
        Ok(simulation) => assert!(simulation.counts.g1_not_negative > 0),
        Err(error) => assert!(
            matches!(error, PreisachError::Diverged { bad_steps, .. } if bad_steps > 0),
            "{error}"
        ),
    }
    // a large constant makes it well posed again
    g1_s.constant = -0.1;
    assert!(DynamicPreisach::new(DynamicParameters { g1_s, ..p.clone() }).is_ok());
    // folding below the promised rate
    let early = DynamicParameters { unfolded_rate_deg_s: 1e5, ..p };
    assert!(matches!(
        DynamicPreisach::new(early),
        Err(PreisachError::OutOfRange { value, .. }) if value > 0.0
    ));
}

proptest! {
    #[test]
    fn a_well_posed_model_has_a_negative_g1_and_no_fold_up_to_its_rate(
        history in prop::collection::vec(-20.0..150.0_f64, 1..200)
    ) {
        let model = DynamicPreisach::new(parameters(TimeOrder::First)).unwrap();
        let covered = model.parameters().unfolded_rate_deg_s;
        let mut memory = PlayMemory::new(model.grid(), 65.0, StartState::Rest);
        for u in history {
            let [g0, g1, g2] = model.apply(&mut memory, u);
            prop_assert!(g1 < 0.0);
            // an output that moves at the covered rate, either way, is no fold
            for (rate, h) in [(covered, 1e-9), (-covered, 1e-9), (covered, 1e-3)] {
                let base = g0 + rate * g1 + rate * rate * g2 - rate * h;
                let found = output_rate([g0, g1, g2], base, h);
                prop_assert!(!found.folded);
                prop_assert!((found.rate_deg_s - rate).abs() < 1e-4 * covered);
            }
        }
    }

    #[test]
    fn stopping_and_going_on_changes_nothing(
        volts in prop::collection::vec(-20.0..150.0_f64, 2..60),
        cut in 0.0..1.0_f64,
    ) {
        let model = actuator(parameters(TimeOrder::Second));
        let whole = model.simulate(&volts, 1e-3).unwrap();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in 1..len")]
        let at = 1 + (cut * (volts.len() - 1) as f64) as usize;
        let mut memory = model.start(volts[0], StartState::Rest).unwrap();
        let first = model.continue_drive(&mut memory, &Drive::new(&volts[1..at], 1e-3)).unwrap();
        let mut restored = memory.clone();
        let second = model.continue_drive(&mut restored, &Drive::new(&volts[at..], 1e-3)).unwrap();
        let parts = [vec![whole.output_deg[0]], first, second].concat();
        prop_assert_eq!(parts, whole.output_deg);
        prop_assert_eq!(restored.counts(), whole.counts);
    }
}

/// A million steps to random voltages, some small, some over the whole range, at steps of 0.05 to
/// 5 ms: what `each` sees of every step is `G`, base and weight of its quadratic, and the rate.
fn a_million_random_steps(
    model: &DynamicPreisach,
    mut each: impl FnMut([f64; 3], f64, f64, OutputRate),
) -> StepCounts {
    let mut random = chacha20::ChaCha8Rng::seed_from_u64(20_260_117);
    let (mut memory, _) = model.start(65.0, StartState::Rest);
    let mut u = 65.0_f64;
    for _ in 0..1_000_000 {
        let reach = 10.0_f64.powf(random.random_range(-2.0..2.0));
        u = (u + reach * random.random_range(-1.0..1.0)).clamp(-20.0, 150.0);
        let step_s = 5e-5 * 10.0_f64.powf(random.random_range(0.0..2.0));
        let before = memory.history.output_deg;
        let output = model.step(&mut memory, u, step_s);
        assert!(output.is_finite());
        // implicit Euler, so base and weight are the output before and the step
        let g = model.maps(&memory.plays);
        each(g, before, step_s, output_rate(g, before, step_s));
    }
    memory.counts
}

#[test]
fn a_well_posed_model_keeps_its_promise_over_a_million_random_steps() {
    let model = DynamicPreisach::new(parameters(TimeOrder::First)).unwrap();
    let covered = model.parameters().unfolded_rate_deg_s;
    let (mut largest_g1, mut least_discriminant, mut folds) = (f64::MIN, f64::MAX, 0);
    let counts = a_million_random_steps(&model, |[g0, g1, g2], base, h, found| {
        largest_g1 = largest_g1.max(g1);
        let b = h - g1;
        let discriminant = b * b - 4.0 * g2 * (g0 - base);
        // rates of the output up to the covered one belong to a positive discriminant
        if found.rate_deg_s.abs() <= covered {
            least_discriminant = least_discriminant.min(discriminant / (b * b));
        }
        // beyond it the fold is taken, at b / (2 G2), and counted
        if discriminant < 0.0 {
            folds += 1;
            assert!(found.folded && (found.rate_deg_s - b / (2.0 * g2)).abs() < 1e-9);
            assert!(found.rate_deg_s.abs() > covered);
        }
    });
    println!(
        "largest G1 {largest_g1:.4} s, least relative discriminant up to {covered} deg/s: {least_discriminant:.3}, folds {folds}"
    );
    assert!(largest_g1 < 0.0, "{largest_g1}");
    assert!(least_discriminant >= 0.0, "{least_discriminant}");
    assert_eq!(counts, StepCounts { steps: 1_000_000, g1_not_negative: 0, folds });
}

#[test]
fn folds_beyond_the_covered_rate_are_taken_and_counted() {
    // a stronger quadratic term, still unfolded up to its own smaller rate
    let p = parameters(TimeOrder::First);
    let g2_s2_per_deg = PlayMap::constant(&p.grid, 6e-5);
    let model =
        DynamicPreisach::new(DynamicParameters { g2_s2_per_deg, unfolded_rate_deg_s: 120.0, ..p })
            .unwrap();
    let mut folds = 0;
    let counts = a_million_random_steps(&model, |[_, g1, g2], _, h, found| {
        if found.folded {
            folds += 1;
            assert!((found.rate_deg_s - (h - g1) / (2.0 * g2)).abs() < 1e-9);
            assert!(found.rate_deg_s > 120.0);
        }
    });
    assert!(folds > 1000, "{folds}");
    assert_eq!(counts.folds, folds);
}

/// What the bound on `G2` is for: with `G2` larger than it allows the same walk folds at rates below the one
/// claimed. Built at all only as `Literal`, which counts every fold.
#[test]
fn without_the_bound_on_g2_the_same_walk_folds_below_the_rate() {
    let p = parameters(TimeOrder::First);
    let covered = p.unfolded_rate_deg_s;
    let g2_s2_per_deg = PlayMap::constant(&p.grid, 6e-5);
    let larger = DynamicParameters { g2_s2_per_deg, ..p };
    let refused = DynamicPreisach::new(larger.clone());
    assert!(matches!(refused, Err(PreisachError::OutOfRange { .. })), "{refused:?}");
    let literal = DynamicParameters { form: RateForm::Literal, ..larger };
    let literal = DynamicPreisach::new(literal).unwrap();
    let (mut below, mut folds) = (0, 0);
    let counts = a_million_random_steps(&literal, |_, _, _, found| {
        folds += usize::from(found.folded);
        below += usize::from(found.folded && found.rate_deg_s.abs() <= covered);
    });
    assert!(below > 1000, "{below} of {folds} folds up to {covered} deg/s");
    assert_eq!(counts, StepCounts { steps: 1_000_000, g1_not_negative: 0, folds });
}

/// An actuator with the equation as printed, written by hand, at either order in time: it runs, its memory
/// is stored midway and goes on with the same bits, and its steps are counted.
#[test]
fn a_literal_actuator_written_by_hand_runs_and_is_taken_up_again() {
    for order in ["First", "Second"] {
        let text = format!(
            r#"{{
                "law": {{"DynamicPreisach": {{
                    "grid": {{"range_volt": [-20.0, 150.0], "levels": 2}},
                    "g0_deg": {{"constant": 0.0, "nodes": [[-6.0, 0.0, 6.0], [-2.0, 2.0]]}},
                    "g1_s": {{"constant": -0.01, "nodes": [[-0.004, 0.0, 0.016], [0.0, 0.0]]}},
                    "g2_s2_per_deg": {{"constant": 1e-6, "nodes": [[0.0, 0.0, 0.0], [0.0, 0.0]]}},
                    "form": "Literal", "unfolded_rate_deg_s": 0.0, "time_order": "{order}"
                }}}},
                "range_volt": [-20.0, 150.0],
                "calibration": {{"deg_per_um": 0.04, "zero_um": 0.0}},
                "linkage": [{{"LogCreep": {{"rate_per_decade": 0.01}}}}]
            }}"#
        );
        let model: ActuatorModel = serde_json::from_str(&text).unwrap();
        let volts: Vec<f64> =
            (0..800).map(|i| 65.0 + 84.0 * (TAU * f64::from(i) / 200.0).sin()).collect();
        let whole = model.simulate(&volts, 1e-3).unwrap();
        // G1 turns positive towards the upper end, and that is said
        assert!(
            whole.counts.g1_not_negative > 0 && whole.counts.steps == 799,
            "{:?}",
            whole.counts
        );
        let mut memory = model.start(volts[0], StartState::Rest).unwrap();
        let first = model.continue_drive(&mut memory, &Drive::new(&volts[1..333], 1e-3)).unwrap();
        let file = serde_json::to_string(&memory).unwrap();
        let mut restored: preisach_dyn::ActuatorMemory = serde_json::from_str(&file).unwrap();
        let second = model.continue_drive(&mut restored, &Drive::new(&volts[333..], 1e-3)).unwrap();
        assert_eq!([vec![whole.output_deg[0]], first, second].concat(), whole.output_deg);
        assert_eq!(restored.counts(), whole.counts);
        let again: ActuatorModel =
            serde_json::from_str(&serde_json::to_string(&model).unwrap()).unwrap();
        assert_eq!(again, model);
    }
}

#[test]
fn the_literal_form_reports_what_it_meets() {
    let p = parameters(TimeOrder::First);
    // G1 rises with the voltage, above zero towards the upper saturation
    let g1_s = PlayMap::from_rises(
        &p.grid,
        -0.006,
        &rises(&p.grid, |s, r| 1.2e-4 * (1.0 - r) * (1.5 + s)),
    )
    .unwrap();
    let refused = DynamicPreisach::new(DynamicParameters { g1_s: g1_s.clone(), ..p.clone() });
    assert!(matches!(refused, Err(PreisachError::OutOfRange { .. })));
    let literal =
        DynamicPreisach::new(DynamicParameters { g1_s, form: RateForm::Literal, ..p }).unwrap();
    let (mut memory, _) = literal.start(-20.0, StartState::Rest);
    let mut positive = 0;
    for i in 0..2000_u32 {
        let u = 65.0 - 85.0 * (TAU * f64::from(i) / 2000.0).cos();
        literal.step(&mut memory, u, 5e-3);
        positive += usize::from(literal.maps(&memory.plays)[1] >= 0.0);
    }
    assert!(positive > 0, "no step met G1 >= 0");
    assert_eq!((memory.counts.steps, memory.counts.g1_not_negative), (2000, positive));
}

#[test]
fn bad_input_is_an_error_with_its_place() {
    let model = actuator(parameters(TimeOrder::Second));
    let error = model.simulate(&[65.0, 70.0, f64::NAN], 1e-3).unwrap_err();
    assert!(matches!(error, PreisachError::NotFinite { index: 2, .. }), "{error}");
    let error = model.simulate(&[65.0, 70.0, 152.0], 1e-3).unwrap_err();
    assert!(matches!(error, PreisachError::VoltageOutOfRange { index: 2, .. }), "{error}");
    assert!(model.simulate(&[], 1e-3).is_err());
    assert!(model.simulate(&[65.0, 66.0], 0.0).is_err());
    assert!(model.simulate(&[65.0, 66.0], f64::NAN).is_err());
    let mut foreign =
        linear_with_lag(0.02, TimeOrder::First).start(65.0, StartState::Rest).unwrap();
    let error = model.stepper(1e-3).unwrap().step(&mut foreign, 65.0, 0.0).unwrap_err();
    assert!(
        matches!(error, PreisachError::MemoryMismatch { found: 4, expected: 16, .. }),
        "{error}"
    );
}

#[test]
fn models_and_memories_survive_being_stored() {
    let model = actuator(parameters(TimeOrder::Second));
    let text = serde_json::to_string(&model).unwrap();
    let restored: ActuatorModel = serde_json::from_str(&text).unwrap();
    assert_eq!(restored, model);
    let mut memory = model.start(65.0, StartState::Rest).unwrap();
    model.continue_drive(&mut memory, &Drive::new(&[80.0, 20.0, 130.0], 1e-3)).unwrap();
    let stored = serde_json::to_string(&memory).unwrap();
    let mut taken_up = serde_json::from_str(&stored).unwrap();
    assert_eq!(memory, taken_up);
    assert_eq!(
        model.stepper(1e-3).unwrap().step(&mut memory, 50.0, 0.0).unwrap(),
        restored.stepper(1e-3).unwrap().step(&mut taken_up, 50.0, 0.0).unwrap()
    );
    // what is stored is checked when it is read: a relaxation time below zero is refused
    let broken = text.replace("\"constant\":-0.02", "\"constant\":0.5");
    assert_ne!(broken, text);
    let error = serde_json::from_str::<ActuatorModel>(&broken).unwrap_err().to_string();
    assert!(error.contains("largest G1 (s) is 0.5"), "{error}");
}
