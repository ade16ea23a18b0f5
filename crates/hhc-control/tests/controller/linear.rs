//! Linear plants: the optimum, and how the loop finds it with a wrong T0.

use crate::plants::{Problem, as_t, relative_error};
use hhc_control::{
    Acceptance, AllowedIncrease, ControlError, FeedbackController, FeedbackSettings, LoadWeights,
    RunError, StopReason, identify_t,
};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const LOADS: usize = 12;

/// Random problems of 1 or 2 flaps and 1 to 3 harmonics: 2 to 12 controls.
fn problems() -> impl Strategy<Value = Problem> {
    (1..=2_usize, 1..=3_usize).prop_flat_map(|(flaps, count)| {
        let controls = 2 * flaps * count;
        let numbers = prop::collection::vec(-1.0..1.0_f64, LOADS * controls);
        let baseline = prop::collection::vec(-1.0..1.0_f64, LOADS);
        (numbers, baseline).prop_map(move |(numbers, baseline)| {
            let t = DMatrix::from_vec(LOADS, controls, numbers);
            let harmonics: Vec<u32> = (2..).take(count).collect();
            Problem::new(flaps, &harmonics, t, &baseline)
        })
    })
}

/// Random problems of 1 or 2 flaps at one or two harmonics, T near a multiple of a rotation.
fn well_conditioned_problems() -> impl Strategy<Value = Problem> {
    (1..=2_usize, 1..=2_usize).prop_flat_map(|(flaps, count)| {
        let controls = 2 * flaps * count;
        let numbers = prop::collection::vec(-0.1..0.1_f64, LOADS * controls);
        let baseline = prop::collection::vec(-1.0..1.0_f64, LOADS);
        (numbers, baseline).prop_map(move |(numbers, baseline)| {
            let t =
                DMatrix::from_vec(LOADS, controls, numbers) + DMatrix::identity(LOADS, controls);
            let harmonics: Vec<u32> = (2..).take(count).collect();
            Problem::new(flaps, &harmonics, t, &baseline)
        })
    })
}

/// Largest over smallest singular value.
fn condition(problem: &Problem) -> f64 {
    let singular_values = problem.t.clone().svd(false, false).singular_values;
    singular_values.max() / singular_values.min()
}

/// A well-conditioned problem of two flaps at 3/rev with orthogonal columns.
fn orthogonal() -> Problem {
    let t = DMatrix::from_fn(LOADS, 4, |i, j| if i == 3 * j { 0.25 } else { 0.0 });
    let z0: Vec<f64> = (0..LOADS).map(|i| (1.3 * i as f64 + 0.4).cos()).collect();
    Problem::new(2, &[3], t, &z0)
}

fn tight() -> FeedbackSettings {
    FeedbackSettings { max_steps: 400, step_tolerance: 1e-11, ..FeedbackSettings::default() }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn one_step_reaches_the_analytic_optimum(
        problem in problems(),
        weights in prop::collection::vec(0.1..10.0_f64, LOADS),
        effort in prop_oneof![Just(0.0), 1e-4..1.0_f64],
    ) {
        // the normal equations of the oracle lose the square of the condition number
        prop_assume!(condition(&problem) < 1e3);
        let mut plant = problem.plant.clone();
        let steps = vec![0.5; problem.t.ncols()];
        let t0 = identify_t(&mut plant, &steps).unwrap();
        let load_weights = LoadWeights::Diagonal(weights.clone());
        let controller =
            FeedbackController::new(&t0, &load_weights, FeedbackSettings::default()).unwrap();
        let run = controller.run(&mut plant, effort).unwrap();
        prop_assert_eq!(run.stop, StopReason::Converged);
        prop_assert_eq!((run.steps.len(), run.measurements), (1, 2));
        let exact = problem.optimum(&weights, effort);
        let error = relative_error(&run.last().control_volt, &exact);
        prop_assert!(error <= 1e-8, "relative error {error:e}");
    }

    #[test]
    fn a_t_wrong_by_20_percent_or_30_degrees_still_leads_there(
        problem in well_conditioned_problems(),
        (gain, phase_deg) in prop_oneof![
            Just((0.8, 0.0)), Just((1.2, 0.0)), Just((1.0, 30.0)), Just((1.0, -30.0)),
            Just((0.8, 30.0)), Just((1.2, -30.0)),
        ],
    ) {
        // the steps of a T turned by 30 deg are downhill if 30 deg < 2 arctan(1 / k)
        prop_assume!(condition(&problem) < 3.7);
        let mut plant = problem.plant.clone();
        let t0 = problem.distorted_t(gain, phase_deg);
        let controller = FeedbackController::new(&t0, &LoadWeights::Identity, tight()).unwrap();
        let run = controller.run(&mut plant, 0.0).unwrap();
        prop_assert_eq!(run.stop, StopReason::Converged);
        prop_assert!(run.steps.len() > 3);
        let exact = problem.optimum(&[1.0; LOADS], 0.0);
        let error = relative_error(&run.last().control_volt, &exact);
        prop_assert!(error <= 1e-8, "relative error {error:e}");
    }

    #[test]
    fn no_recorded_step_raises_the_cost(
        problem in problems(),
        gain in 0.3..3.0_f64,
        phase_deg in -85.0..85.0_f64,
        effort in 0.0..2.0_f64,
    ) {
        let mut plant = problem.plant.clone();
        let t0 = problem.distorted_t(gain, phase_deg);
        let acceptance = Acceptance::NonMonotone { allowed_increase: 0.0, largest_cost: 0.0 };
        let settings = FeedbackSettings { acceptance, ..FeedbackSettings::default() };
        let controller = FeedbackController::new(&t0, &LoadWeights::Identity, settings).unwrap();
        let history: Vec<_> = match controller.run(&mut plant, effort) {
            Ok(run) => run.history().cloned().collect(),
            Err(RunError::Control(ControlError::Diverges { history, .. })) => history,
            Err(other) => return Err(TestCaseError::fail(other.to_string())),
        };
        for pair in history.windows(2) {
            let slack = 1e-13 * history[0].cost.total();
            prop_assert!(pair[1].cost.total() <= pair[0].cost.total() + slack);
            prop_assert!(pair[0].rho.to_bits() == pair[1].rho.to_bits());
        }
    }
}

#[test]
fn the_error_shrinks_as_theory_says() {
    let problem = orthogonal();
    let exact = problem.optimum(&[1.0; LOADS], 0.0);
    for (gain, phase_deg) in [(0.8, 0.0), (1.2, 0.0), (1.0, 30.0), (1.25, -40.0)] {
        let t0 = problem.distorted_t(gain, phase_deg);
        let controller = FeedbackController::new(&t0, &LoadWeights::Identity, tight()).unwrap();
        let run = controller.run(&mut problem.plant.clone(), 0.0).unwrap();
        let phase = f64::to_radians(phase_deg);
        let theory = (1.0 - phase.cos() / gain).hypot(phase.sin() / gain);
        let errors: Vec<f64> =
            run.history().map(|step| relative_error(&step.control_volt, &exact)).collect();
        for pair in errors.windows(2).take_while(|pair| pair[1] > 1e-9) {
            assert!((pair[1] / pair[0] - theory).abs() < 1e-5, "{gain} {phase_deg}: {errors:?}");
        }
        assert_eq!((run.stop, run.backtracks), (StopReason::Converged, 0));
        assert!(errors[errors.len() - 1] <= 1e-8);
    }
}

#[test]
fn the_bound_on_the_phase_error_is_sharp() {
    // singular values 3 and 1, turned across the pair of one voltage harmonic
    let t = DMatrix::from_fn(LOADS, 2, |i, j| match (i, j) {
        (0, 0) => 3.0,
        (1, 1) => 1.0,
        _ => 0.0,
    });
    let limit_deg = 2.0 * (1.0_f64 / 3.0).atan().to_degrees();
    // the error of the control for which the direction is the worst
    let worst = |sign: f64| {
        let turned = f64::to_radians(sign * limit_deg);
        let rotation = DMatrix::from_row_slice(
            2,
            2,
            &[turned.cos(), -turned.sin(), turned.sin(), turned.cos()],
        );
        let form = rotation * t.transpose() * &t;
        let symmetric = (&form + form.transpose()).symmetric_eigen();
        let smallest = symmetric.eigenvalues.imin();
        symmetric.eigenvectors.column(smallest).into_owned()
    };
    for sign in [1.0, -1.0] {
        let optimum = worst(sign);
        let z0: Vec<f64> = (-(&t * &optimum)).iter().copied().collect();
        let problem = Problem::new(1, &[3], t.clone(), &z0);
        let run_over = |phase_deg: f64, largest_cost: f64| {
            let acceptance = Acceptance::NonMonotone { allowed_increase: 1e-2, largest_cost };
            let t0 = problem.distorted_t(1.0, phase_deg);
            let settings = FeedbackSettings { max_backtracks: 40, acceptance, ..tight() };
            FeedbackController::new(&t0, &LoadWeights::Identity, settings)
                .unwrap()
                .run(&mut problem.plant.clone(), 0.0)
        };
        let run = |phase_deg: f64| run_over(phase_deg, 0.0);
        assert!(run(sign * (limit_deg - 0.5)).is_ok());
        assert!(matches!(
            run(sign * (limit_deg + 0.5)),
            Err(RunError::Control(ControlError::Diverges { .. }))
        ));
        // full steps contract all the same, by 2 sin(phi/2): over a hill they reach the optimum
        let over = run_over(sign * (limit_deg + 0.5), 10.0).unwrap();
        assert_eq!(over.stop, StopReason::Converged);
        assert!(
            relative_error(&over.last().control_volt, &problem.optimum(&[1.0; LOADS], 0.0)) <= 1e-8
        );
        let first = &over.steps[0];
        assert_eq!(first.allowed_increase, AllowedIncrease::NonMonotone);
        assert!(first.cost.total() > over.start.cost.total(), "there is no hill");
        let factor = 2.0 * (0.5 * (limit_deg + 0.5).to_radians()).sin();
        for pair in over.steps.windows(2).take(20) {
            assert!((pair[1].asked_volt / pair[0].asked_volt - factor).abs() < 1e-3);
        }
        // with too low a ceiling the same is an error again
        let highest = over.steps.iter().map(|step| step.cost.total()).fold(0.0, f64::max);
        let low = 0.99 * highest / over.start.cost.total();
        assert!(matches!(
            run_over(sign * (limit_deg + 0.5), low),
            Err(RunError::Control(ControlError::Diverges { .. }))
        ));
    }
}

#[test]
fn beyond_60_degrees_halving_saves_the_loop() {
    let problem = orthogonal();
    let exact = problem.optimum(&[1.0; LOADS], 0.0);
    let t0 = problem.distorted_t(1.0, 65.0);
    // the cost, by which steps are judged, tells controls apart to the root of rounding only
    let settings = FeedbackSettings { step_tolerance: 1e-6, ..tight() };
    let controller =
        FeedbackController::new(&t0, &LoadWeights::Identity, settings.clone()).unwrap();
    let run = controller.run(&mut problem.plant.clone(), 0.0).unwrap();
    assert_eq!(run.stop, StopReason::Converged);
    assert!(run.backtracks > 0);
    assert!(relative_error(&run.last().control_volt, &exact) <= 2e-6);

    // without halving the same loop is lost
    let unhalved = FeedbackSettings { max_backtracks: 0, ..tight() };
    let controller = FeedbackController::new(&t0, &LoadWeights::Identity, unhalved).unwrap();
    let lost = controller.run(&mut problem.plant.clone(), 0.0);
    assert!(matches!(lost, Err(RunError::Control(ControlError::Diverges { .. }))));
}

#[test]
fn beyond_90_degrees_the_loop_diverges_and_says_so() {
    let problem = orthogonal();
    for phase_deg in [95.0, 120.0, 180.0, -100.0] {
        let t0 = problem.distorted_t(1.0, phase_deg);
        let controller = FeedbackController::new(&t0, &LoadWeights::Identity, tight()).unwrap();
        let error = controller.run(&mut problem.plant.clone(), 0.0).unwrap_err();
        let text = error.to_string();
        let RunError::Control(ControlError::Diverges { divisor, start, shortest, history, .. }) =
            error
        else {
            panic!("{text}");
        };
        assert_eq!((divisor, history.len()), (64, 1));
        assert!(shortest.total() > start.total());
        assert!(text.contains("identify it again"), "{text}");
    }
}

#[test]
fn with_weighted_control_a_wrong_t_moves_the_fixed_point() {
    let problem = orthogonal();
    let effort = 0.03;
    let exact = problem.optimum(&[1.0; LOADS], effort);
    let t0 = problem.distorted_t(1.0, 20.0);
    let acceptance = Acceptance::NonMonotone { allowed_increase: 1.0, largest_cost: 10.0 };
    let settings = FeedbackSettings { acceptance, ..tight() };
    let controller = FeedbackController::new(&t0, &LoadWeights::Identity, settings).unwrap();
    let run = controller.run(&mut problem.plant.clone(), effort).unwrap();
    assert_eq!(run.stop, StopReason::Converged);
    // the fixed point solves rho u = -T0' W Z with the measured Z
    let u = DVector::from_column_slice(&run.last().control_volt);
    let z = DVector::from_column_slice(&run.last().measurement.outputs);
    let residual = &u * effort + t0.as_matrix().transpose() * z;
    assert!(residual.norm() <= 1e-8 * effort * u.norm());
    assert!(relative_error(&run.last().control_volt, &exact) > 0.05);
}

#[test]
fn near_the_least_cost_a_wrong_t_stalls_the_strict_loop() {
    let problem = orthogonal();
    let t0 = problem.distorted_t(0.7, 50.0);
    let acceptance = Acceptance::NonMonotone { allowed_increase: 0.0, largest_cost: 10.0 };
    let settings = FeedbackSettings { acceptance, ..tight() };
    let controller = FeedbackController::new(&t0, &LoadWeights::Identity, settings).unwrap();
    let run = controller.run(&mut problem.plant.clone(), 0.05).unwrap();
    assert_eq!(run.stop, StopReason::Stalled);
    // the last search took no part of its step: its halvings count too
    let taken: u32 = run.steps.iter().map(|step| step.backtracks).sum();
    assert!(run.backtracks > taken, "{} of {taken}", run.backtracks);
    assert!(run.last().cost.total() < 0.95 * run.start.cost.total());
}

#[test]
fn a_step_limit_is_an_outcome() {
    let problem = orthogonal();
    let t0 = problem.distorted_t(1.0, 30.0);
    let settings = FeedbackSettings { max_steps: 3, ..tight() };
    let controller = FeedbackController::new(&t0, &LoadWeights::Identity, settings).unwrap();
    let run = controller.run(&mut problem.plant.clone(), 0.0).unwrap();
    assert_eq!((run.stop, run.steps.len()), (StopReason::StepLimit, 3));
}

#[test]
fn nothing_to_control_is_converged_at_once() {
    let t = DMatrix::from_fn(LOADS, 2, |i, j| f64::from(u8::from(i == j)));
    let problem = Problem::new(1, &[3], t, &[0.0; LOADS]);
    let controller = FeedbackController::new(
        &as_t(&problem.t),
        &LoadWeights::Identity,
        FeedbackSettings::default(),
    )
    .unwrap();
    let run = controller.run(&mut problem.plant.clone(), 0.0).unwrap();
    assert_eq!((run.stop, run.steps.len()), (StopReason::Converged, 0));
    assert!(run.reduction_percent().abs() < 1e-12);
}

#[test]
fn a_warm_start_ends_where_the_cold_one_does() {
    let problem = orthogonal();
    let t0 = problem.distorted_t(1.1, 15.0);
    let controller = FeedbackController::new(&t0, &LoadWeights::Identity, tight()).unwrap();
    let cold = controller.run(&mut problem.plant.clone(), 0.0).unwrap();
    let warm =
        controller.run_from(&mut problem.plant.clone(), 0.0, &[0.5, -3.0, 2.0, 1.0]).unwrap();
    let exact = DVector::from_column_slice(&cold.last().control_volt);
    assert!(relative_error(&warm.last().control_volt, &exact) < 1e-9);
    let again = controller.run_from(&mut problem.plant.clone(), 0.0, exact.as_slice()).unwrap();
    assert_eq!((again.stop, again.steps.len()), (StopReason::Converged, 0));
}

#[test]
fn controls_without_effect_get_no_voltage() {
    // the second flap moves nothing: the optimum of least voltage leaves it still
    let t = DMatrix::from_fn(LOADS, 4, |i, j| if i == j && j < 2 { 2.0 } else { 0.0 });
    let problem = Problem::new(2, &[3], t, &[1.0; LOADS]);
    let controller =
        FeedbackController::new(&as_t(&problem.t), &LoadWeights::Identity, tight()).unwrap();
    let run = controller.run(&mut problem.plant.clone(), 0.0).unwrap();
    let control = &run.last().control_volt;
    assert!((control[0] + 0.5).abs() < 1e-12 && (control[1] + 0.5).abs() < 1e-12);
    assert!(control[2].abs() < 1e-12 && control[3].abs() < 1e-12);
    let values = controller.law().singular_values();
    assert!(values[0] > 1e15 * values[values.len() - 1]);
}
