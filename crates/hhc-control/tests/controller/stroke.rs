//! The stroke limit: the Lagrange multiplier, and why not to clip.

use crate::plants::{Counted, Problem, as_t, relative_error};
use hhc_control::{
    ControlLayout, Controller, FeedbackController, FeedbackSettings, LinearPlant, LoadWeights,
    Measurement, Plant, StopReason, StrokeLimitedRun, StrokeStatus,
};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use std::convert::Infallible;
use std::f64::consts::TAU;

const GAIN_DEG_PER_VOLT: f64 = 0.05;

fn settings(stroke_tolerance: f64) -> FeedbackSettings {
    FeedbackSettings { stroke_tolerance, step_tolerance: 1e-10, ..FeedbackSettings::default() }
}

fn limited(problem: &Problem, limit_volt: f64, tolerance: f64) -> StrokeLimitedRun {
    let controller =
        FeedbackController::new(&as_t(&problem.t), &LoadWeights::Identity, settings(tolerance))
            .unwrap();
    let mut plant = problem
        .plant
        .clone()
        .with_actuator(GAIN_DEG_PER_VOLT, 0.7)
        .and_then(|plant| plant.with_stroke_limit_deg(GAIN_DEG_PER_VOLT * limit_volt))
        .unwrap();
    controller.run_within_stroke(&mut plant).unwrap()
}

/// The best control of amplitude `limit` for one flap at one harmonic: a scan over the phase, then
/// bisection of the slope of the cost.
fn best_on_circle(problem: &Problem, limit: f64) -> DVector<f64> {
    let control = |phase: f64| DVector::from_vec(vec![limit * phase.cos(), limit * phase.sin()]);
    let cost = |phase: f64| problem.loads_cost(&control(phase));
    let slope = |phase: f64| {
        let z = &problem.z0 + &problem.t * control(phase);
        (&problem.t * control(phase + 0.25 * TAU)).dot(&z)
    };
    let scan = (0..720).map(|i| TAU * f64::from(i) / 720.0);
    let start = scan.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap();
    let (mut low, mut high) = (start - 0.01, start + 0.01);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        let end = if slope(middle) < 0.0 { &mut low } else { &mut high };
        *end = middle;
    }
    control(f64::midpoint(low, high))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn one_flap_gets_the_constrained_optimum(
        numbers in prop::collection::vec(-1.0..1.0_f64, 24),
        baseline in prop::collection::vec(-1.0..1.0_f64, 12),
        fraction in 0.05..0.95_f64,
    ) {
        let problem = Problem::new(1, &[3], DMatrix::from_vec(12, 2, numbers), &baseline);
        let free = problem.optimum(&[1.0; 12], 0.0);
        prop_assume!(free.norm() > 1e-2);
        let limit = fraction * free.norm();
        let found = limited(&problem, limit, 1e-9);
        prop_assert_eq!(found.status, StrokeStatus::AtLimit);
        let exact = best_on_circle(&problem, limit);
        prop_assert!(relative_error(&found.run.last().control_volt, &exact) < 1e-7);
        // rho is the multiplier of the constraint: T' Z + rho u = 0
        let z = &problem.z0 + &problem.t * &exact;
        let multiplier = -exact.dot(&(problem.t.transpose() * z)) / limit.powi(2);
        prop_assert!((found.rho / multiplier - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_larger_stroke_ends_at_its_limit_and_never_above(
        numbers in prop::collection::vec(-1.0..1.0_f64, 12 * 8),
        baseline in prop::collection::vec(-1.0..1.0_f64, 12),
        limit in 0.01..3.0_f64,
    ) {
        let problem = Problem::new(2, &[3, 4], DMatrix::from_vec(12, 8, numbers), &baseline);
        let found = limited(&problem, limit, 1e-3);
        prop_assert!(found.largest_stroke_ratio <= 1.0);
        match found.status {
            StrokeStatus::AtLimit => prop_assert!(found.largest_stroke_ratio >= 0.999),
            StrokeStatus::Free => prop_assert_eq!(found.rho, 0.0),
            StrokeStatus::BelowJump => prop_assert!(false, "a linear plant does not jump"),
        }
        // exactly what the law gives for that weight
        let exact = problem.optimum(&[1.0; 12], found.rho);
        prop_assert!(relative_error(&found.run.last().control_volt, &exact) < 1e-8);
        prop_assert_eq!((found.trials.len(), found.run.steps.len()), (1, 1));
    }
}

#[test]
fn two_flaps_alike_get_the_constrained_optimum() {
    // equal, independent authority and equal demand: both limits have the same multiplier
    let t = DMatrix::from_fn(12, 4, |i, j| if i == 2 * j { 0.3 } else { 0.0 });
    let z0: Vec<f64> = (0..12).map(|i| [0.9, 0.2, -0.4, 0.1][i % 4]).collect();
    let problem = Problem::new(2, &[3], t, &z0);
    let free = problem.optimum(&[1.0; 12], 0.0);
    let amplitude = free[0].hypot(free[1]);
    assert!((amplitude - free[2].hypot(free[3])).abs() < 1e-12);
    let found = limited(&problem, 0.4 * amplitude, 1e-9);
    let exact = &free * 0.4; // orthogonal equal columns: the circle is met along the ray
    assert!(relative_error(&found.run.last().control_volt, &exact) < 1e-8);
    let multiplier = 0.3_f64.powi(2) * (1.0 / 0.4 - 1.0);
    assert!((found.rho / multiplier - 1.0).abs() < 1e-8);
}

/// Two flaps whose effects nearly cancel, and loads that only their difference can reach.
fn opposed() -> Problem {
    let t = DMatrix::from_fn(12, 4, |load, control| match (load, control) {
        (0, 0) | (1, 1) => 1.0,
        (0, 2) | (1, 3) => 2.0,
        (2, 2) | (3, 3) => 0.1,
        _ => 0.0,
    });
    let mut z0 = [0.0; 12];
    (z0[2], z0[3]) = (0.8, 0.6);
    Problem::new(2, &[4], t, &z0)
}

/// Each flap brought back to its circle, phase kept.
fn clipped(control: &DVector<f64>, limit: f64) -> DVector<f64> {
    let mut control = control.clone();
    for pair in control.as_mut_slice().chunks_exact_mut(2) {
        let amplitude = pair[0].hypot(pair[1]);
        for value in pair.iter_mut().filter(|_| amplitude > limit) {
            *value *= limit / amplitude;
        }
    }
    control
}

/// The optimum with each flap inside its own circle, by projected gradients.
fn constrained_optimum(problem: &Problem, limit: f64) -> DVector<f64> {
    let step = 1.0 / (problem.t.transpose() * &problem.t).norm();
    let mut control = DVector::zeros(problem.t.ncols());
    for _ in 0..200_000 {
        let gradient = problem.t.transpose() * (&problem.z0 + &problem.t * &control);
        control = clipped(&(control - gradient * step), limit);
    }
    control
}

#[test]
fn the_clipped_step_is_a_trap() {
    let (problem, limit) = (opposed(), 2.0);
    let free = problem.optimum(&[1.0; 12], 0.0);
    let before = problem.loads_cost(&DVector::zeros(4));
    let clipped_cost = problem.loads_cost(&clipped(&free, limit));
    let best_cost = problem.loads_cost(&constrained_optimum(&problem, limit));
    let found = limited(&problem, limit, 1e-3);
    let weighted_cost = found.run.last().cost.loads;

    // unconstrained all is cancelled; clipped it is more than four times the uncontrolled cost
    assert!(problem.loads_cost(&free) < 1e-20 * before);
    assert!(clipped_cost > 4.0 * before, "{clipped_cost} of {before}");
    assert!(weighted_cost < 0.85 * before, "{weighted_cost} of {before}");
    assert!(best_cost <= weighted_cost && weighted_cost < 1.05 * best_cost);
}

#[test]
fn one_weight_for_two_flaps_is_not_the_optimum_under_separate_limits() {
    // the first flap needs less than the second: it could still move when the second is at its limit
    let t = DMatrix::from_fn(12, 4, |load, control| match (load == control, control < 2) {
        (true, true) => 1.0,
        (true, false) => 0.5,
        _ => 0.0,
    });
    let problem =
        Problem::new(2, &[3], t, &[1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let found = limited(&problem, 0.8, 1e-9);
    let best = constrained_optimum(&problem, 0.8);
    let (weighted, constrained) = (found.run.last().cost.loads, problem.loads_cost(&best));
    // by hand: rho = 0.375, first flap 1 / 1.375; constrained both at 0.8
    assert!((found.rho - 0.375).abs() < 1e-6);
    assert!((weighted - ((0.375_f64 / 1.375).powi(2) + 0.36)).abs() < 1e-6);
    assert!((constrained - 0.40).abs() < 1e-9);
    // and the amplitudes are not equal
    let strokes_deg = problem.plant.clone().strokes_deg(&found.run.last().control_volt).unwrap();
    assert!((strokes_deg[0] / strokes_deg[1] - 1.0 / 1.1).abs() < 1e-6);
}

#[test]
fn a_wide_limit_leaves_the_control_free() {
    let problem = opposed();
    let free = problem.optimum(&[1.0; 12], 0.0);
    let largest = free[0].hypot(free[1]).max(free[2].hypot(free[3]));
    let found = limited(&problem, 1.01 * largest, 1e-3);
    assert_eq!((found.status, found.rho), (StrokeStatus::Free, 0.0));
    assert!((found.largest_stroke_ratio - 1.0 / 1.01).abs() < 1e-9);
    assert!(relative_error(&found.run.last().control_volt, &free) < 1e-8);
}

#[test]
fn the_weight_is_found_with_two_measurements() {
    let problem = opposed();
    let mut plant = Counted::new(problem.plant.clone().with_stroke_limit_deg(2.0).unwrap());
    let controller =
        FeedbackController::new(&as_t(&problem.t), &LoadWeights::Identity, settings(1e-3)).unwrap();
    let found = controller.run_within_stroke(&mut plant).unwrap();
    // the baseline and one step with rho adjusted
    assert_eq!((found.measurements, plant.measurements), (2, 2));
    assert_eq!(found.run.measurements, 2);
    assert!(plant.stroke_calls <= 12, "{}", plant.stroke_calls);
}

#[test]
fn a_wrong_t_is_no_obstacle() {
    let problem = opposed();
    for (gain, phase_deg) in [(0.8, 0.0), (1.2, 0.0), (1.0, 30.0), (0.9, -20.0)] {
        let t0 = problem.distorted_t(gain, phase_deg);
        let controller =
            FeedbackController::new(&t0, &LoadWeights::Identity, FeedbackSettings::default())
                .unwrap();
        let mut plant = problem.plant.clone().with_stroke_limit_deg(2.0).unwrap();
        let found = controller.run_within_stroke(&mut plant).unwrap();
        assert_eq!(found.status, StrokeStatus::AtLimit, "{gain} {phase_deg}");
        assert!((0.999..=1.0).contains(&found.largest_stroke_ratio));
        assert!(found.run.last().cost.loads < found.run.start.cost.loads);
        assert!(found.measurements <= 60, "{gain} {phase_deg}: {}", found.measurements);
    }
}

/// A linear plant with an actuator whose stroke jumps, or has no answer beyond a voltage.
struct Odd {
    plant: LinearPlant,
    beyond_volt: f64,
    stroke_beyond_deg: f64,
    range_volt: f64,
}

impl Plant for Odd {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        self.plant.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Self::Error> {
        assert!(self.admits(control_volt), "measured outside the range");
        self.plant.measure(control_volt)
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Self::Error> {
        let amplitudes = self.layout().amplitudes_volt(control_volt).unwrap();
        let stroke = |volt| {
            if volt > self.beyond_volt { self.stroke_beyond_deg } else { volt }
        };
        Ok(amplitudes.into_iter().map(stroke).collect())
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        vec![2.0; self.layout().pairs()]
    }

    fn admits(&self, control_volt: &[f64]) -> bool {
        let amplitudes = self.layout().amplitudes_volt(control_volt).unwrap();
        amplitudes.iter().all(|&volt| volt <= self.range_volt)
    }
}

fn odd(beyond_volt: f64, stroke_beyond_deg: f64, range_volt: f64) -> Odd {
    Odd { plant: opposed().plant, beyond_volt, stroke_beyond_deg, range_volt }
}

#[test]
fn a_jump_of_the_stroke_is_approached_from_below() {
    let controller =
        FeedbackController::new(&as_t(&opposed().t), &LoadWeights::Identity, settings(1e-3))
            .unwrap();
    let found = controller.run_within_stroke(&mut odd(1.5, 2.5, 100.0)).unwrap();
    assert_eq!(found.status, StrokeStatus::BelowJump);
    assert!((found.largest_stroke_ratio - 0.75).abs() < 1e-9);
}

#[test]
fn an_actuator_without_answer_beyond_full_scale_is_met_there() {
    let controller =
        FeedbackController::new(&as_t(&opposed().t), &LoadWeights::Identity, settings(1e-3))
            .unwrap();
    let found = controller.run_within_stroke(&mut odd(2.0, f64::INFINITY, 2.0)).unwrap();
    assert_eq!(found.status, StrokeStatus::AtLimit);
    assert!((0.999..=1.0).contains(&found.largest_stroke_ratio));
}

#[test]
fn steps_out_of_range_are_halved() {
    // T0 sees 0.45 of the authority, so the first step overshoots out of the range
    let problem = opposed();
    let t0 = problem.distorted_t(0.45, 0.0);
    let weights = &LoadWeights::Identity;
    let controller = FeedbackController::new(&t0, weights, FeedbackSettings::default()).unwrap();
    let found = controller.run_within_stroke(&mut odd(f64::INFINITY, 0.0, 2.001)).unwrap();
    assert_eq!(found.status, StrokeStatus::AtLimit);
    assert!((0.999..=1.0).contains(&found.largest_stroke_ratio));
    assert!(found.run.backtracks > 0);

    // with a smaller weight the loop is led out of the range: no result to call free of the limit
    let run = controller.run(&mut odd(f64::INFINITY, 0.0, 2.001), 0.1 * found.rho).unwrap();
    assert_eq!(run.stop, StopReason::OutOfRange);
    let lost = controller.run(&mut odd(f64::INFINITY, 0.0, 0.1), 0.0).unwrap_err();
    assert!(lost.to_string().contains("no part of the first control step"), "{lost}");
}

#[test]
fn a_local_controller_at_the_edge_of_the_range_goes_on_with_the_t_it_has() {
    let problem = opposed();
    let weights = &LoadWeights::Identity;
    let settings = FeedbackSettings::default();
    let global = FeedbackController::new(&as_t(&problem.t), weights, settings).unwrap();
    let wanted = global.run_within_stroke(&mut odd(f64::INFINITY, 0.0, 2.001)).unwrap();
    // five volt to any side are outside, so T cannot be measured there
    let step_volt = vec![5.0; problem.t.ncols()];
    let local = global.clone().with_controller(Controller::Local { step_volt }).unwrap();
    let run = local.run(&mut odd(f64::INFINITY, 0.0, 2.001), wanted.rho).unwrap();
    assert_eq!((run.stop, run.identifications), (StopReason::Converged, 0));
    let reached = (&run.last().control_volt, &wanted.run.last().control_volt);
    let apart = reached.0.iter().zip(reached.1).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-3, "{apart} V");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50))]

    /// The control of least size that makes a reduction: its gradient of `J_Z` is along itself.
    #[test]
    fn a_given_reduction_is_made_with_the_least_control(
        numbers in prop::collection::vec(-1.0..1.0_f64, 48),
        baseline in prop::collection::vec(-1.0..1.0_f64, 12),
        share in 0.05..0.95_f64,
    ) {
        let problem = Problem::new(2, &[3], DMatrix::from_vec(12, 4, numbers), &baseline);
        let t = as_t(&problem.t);
        let controller =
            FeedbackController::new(&t, &LoadWeights::Identity, settings(1e-3)).unwrap();
        let mut plant = problem.plant.clone();
        let free = controller.run(&mut plant, 0.0).unwrap();
        let [before, least] = [&free.start, free.last()].map(|step| step.cost.loads);
        let wanted = before - share * (before - least);
        let (run, rho) = controller.run_to_cost(&mut plant, wanted).unwrap();
        prop_assert!((run.last().cost.loads - wanted).abs() < 2e-5 * (before - wanted));
        let u = DVector::from_column_slice(&run.last().control_volt);
        let slope = problem.t.tr_mul(&(&problem.z0 + &problem.t * &u));
        prop_assert!((&slope + &u * rho).norm() < 1e-7 * slope.norm());
        // more than the plant can do is answered by all that it can do, no reduction is none to ask for
        let (most, rho) = controller.run_to_cost(&mut plant, 0.5 * least).unwrap();
        prop_assert!(rho == 0.0 && (most.last().cost.loads - least).abs() < 1e-9 * before);
        prop_assert!(controller.run_to_cost(&mut plant, before).is_err());
    }
}
