//! Controllers that learn T, beside the constant one.

use crate::plants::{Problem, RayleighPlant, as_t, relative_error};
use hhc_control::{
    AdaptiveSettings, ControlError, ControlLayout, ControlRun, Controller, EstimatorSettings,
    FeedbackController, FeedbackSettings, LoadWeights, RunError, StopReason, identify_t, lag_loss,
};
use nalgebra::{DMatrix, DVector};

const LOADS: usize = 12;

/// Two flaps whose effects are nearly the same: a condition number above 10.
fn ill_conditioned() -> Problem {
    let t = DMatrix::from_fn(LOADS, 4, |i, j| {
        (0.8 * i as f64 + 1.3 * (j % 2) as f64).sin() + 0.15 * (1.9 * i as f64 + j as f64).cos()
    });
    let wanted = DVector::from_vec(vec![-6.0, 4.0, 5.0, -3.0]);
    let rest = DVector::from_fn(LOADS, |i, _| 0.6 * (1.7 * i as f64).cos());
    let z0: Vec<f64> = (rest - &t * wanted).iter().copied().collect();
    Problem::new(2, &[4], t, &z0)
}

fn settings() -> FeedbackSettings {
    FeedbackSettings { step_tolerance: 1e-8, ..FeedbackSettings::default() }
}

fn ways() -> [Controller; 3] {
    [
        Controller::Global,
        Controller::Local { step_volt: vec![0.5; 4] },
        Controller::Adaptive(AdaptiveSettings::of_full_scale(8.0)),
    ]
}

fn run(problem: &Problem, phase_deg: f64, way: &Controller) -> Option<ControlRun> {
    let t0 = problem.distorted_t(1.2, phase_deg);
    FeedbackController::new(&t0, &LoadWeights::Identity, settings())
        .and_then(|c| c.with_controller(way.clone()))
        .unwrap()
        .run(&mut problem.plant.clone(), 0.0)
        .ok()
}

#[test]
fn controllers_that_learn_reach_the_optimum_where_a_constant_t_stalls() {
    let problem = ill_conditioned();
    let exact = problem.loads_cost(&problem.optimum(&[1.0; LOADS], 0.0));
    for phase_deg in [0.0, 30.0, 60.0] {
        for way in ways() {
            let run = run(&problem, phase_deg, &way);
            let excess = run.as_ref().map(|r| r.last().cost.loads / exact - 1.0);
            println!(
                "{phase_deg} deg, {}: excess {excess:?}, {:?}",
                way.name(),
                run.as_ref().map(|r| (r.stop, r.steps.len(), r.backtracks, r.measurements))
            );
            if way != Controller::Global {
                assert!(excess.unwrap() < 1e-6);
                assert_eq!(run.unwrap().stop, StopReason::Converged);
            } else if phase_deg > 50.0 {
                assert!(excess.is_none_or(|e| e > 0.1), "{excess:?}");
            }
        }
    }
}

/// Two flaps at 3/rev with strong Rayleigh hysteresis.
fn hysteretic() -> RayleighPlant {
    let problem = ill_conditioned();
    let loads_per_deg = problem.t.clone() * 1e-4;
    let z0 = &problem.z0 * 0.5e-4;
    RayleighPlant {
        layout: ControlLayout::new(2, vec![3]).unwrap(),
        loads_per_deg,
        z0,
        a_deg_per_volt: 0.03,
        b_deg_per_volt2: 1.8e-4,
        lag_rad: 0.5,
        stroke_limit_deg: 6.0,
    }
}

#[test]
fn hysteresis_the_constant_t_ends_short_those_that_learn_converge() {
    let mut plant = hysteretic();
    let t0 = identify_t(&mut plant, &[4.25; 4]).unwrap();
    let full_scale = AdaptiveSettings::of_full_scale(85.0);
    let mut costs = Vec::new();
    for way in [
        Controller::Global,
        Controller::Local { step_volt: vec![1.0; 4] },
        Controller::Adaptive(full_scale),
    ] {
        let settings = FeedbackSettings { step_tolerance: 1e-6, ..FeedbackSettings::default() };
        let run = FeedbackController::new(&t0, &LoadWeights::Identity, settings)
            .and_then(|c| c.with_controller(way.clone()))
            .unwrap()
            .run(&mut plant, 0.0)
            .unwrap();
        println!(
            "{}: J/J0 {:.6}, {:?}, {} steps, {} halvings, {} measurements",
            way.name(),
            run.last().cost.loads / run.start.cost.loads,
            run.stop,
            run.steps.len(),
            run.backtracks,
            run.measurements
        );
        if way != Controller::Global {
            assert_eq!(run.stop, StopReason::Converged);
        }
        costs.push(run.last().cost.loads);
    }
    assert!(
        costs[1] <= costs[0] * (1.0 + 1e-9) && costs[2] <= costs[0] * (1.0 + 1e-6),
        "{costs:?}"
    );
    // the optimum is one of flap motion: the same as without hysteresis
    let problem = ill_conditioned();
    let z = &problem.z0 * 0.5e-4;
    let t = problem.t * 1e-4;
    let best = (&z - &t * t.clone().svd(true, true).solve(&z, 1e-14).unwrap()).norm_squared();
    assert!((costs[1] / best - 1.0).abs() < 1e-6, "{} {best}", costs[1]);
}

#[test]
fn an_ignored_lag_costs_what_theory_says() {
    let problem = ill_conditioned();
    let best = problem.optimum(&[1.0; LOADS], 0.0);
    let (least, before) = (problem.loads_cost(&best), problem.z0.norm_squared());
    for lag_deg in [[10.0, 10.0], [47.0, 47.0], [41.0, 36.0], [60.0, -20.0], [180.0, 180.0]] {
        let lag_rad: Vec<f64> = lag_deg.iter().map(|d: &f64| d.to_radians()).collect();
        let late = |u: &DVector<f64>| {
            let turned = u.as_slice().chunks_exact(2).zip(&lag_rad).flat_map(|(u, lag)| {
                let (s, c) = lag.sin_cos();
                [c * u[0] - s * u[1], s * u[0] + c * u[1]]
            });
            DVector::from_iterator(4, turned)
        };
        let ignored = problem.loads_cost(&late(&best));
        let measured = (ignored - least) / (before - least);
        let loss =
            lag_loss(&as_t(&problem.t), &LoadWeights::Identity, best.as_slice(), &lag_rad).unwrap();
        assert!((loss.part / measured - 1.0).abs() < 1e-8, "{loss:?} {measured}");
        println!("{lag_deg:?} deg: lost {:.4}, 4 sin^2(lag/2) = {:.4}", loss.part, loss.isotropic);
    }
    // T alike on all controls: the rule of thumb is exact
    let alike = Problem::new(1, &[3], DMatrix::identity(12, 2) * 0.3, &[1.0; 12]);
    let best = alike.optimum(&[1.0; 12], 0.0);
    let loss = lag_loss(&as_t(&alike.t), &LoadWeights::Identity, best.as_slice(), &[0.8]).unwrap();
    assert!((loss.part - loss.isotropic).abs() < 1e-14);
}

#[test]
fn settings_out_of_range_are_refused() {
    let problem = ill_conditioned();
    let controller =
        || FeedbackController::new(&as_t(&problem.t), &LoadWeights::Identity, settings()).unwrap();
    let base = EstimatorSettings::of_exact_plant(85.0);
    for bad in [
        EstimatorSettings { full_scale_volt: 0.0, ..base.clone() },
        EstimatorSettings { noise_share: Some(0.0), ..base.clone() },
        EstimatorSettings { uncertainty: 0.0, ..base.clone() },
        EstimatorSettings { baseline_drift: 0.0, ..base.clone() },
        EstimatorSettings { drift: f64::NAN, ..base },
    ] {
        let bad = AdaptiveSettings { estimator: bad, probes: 4 };
        assert!(controller().with_controller(Controller::Adaptive(bad)).is_err());
    }
    for step_volt in [vec![1.0; 3], vec![0.0; 4]] {
        assert!(controller().with_controller(Controller::Local { step_volt }).is_err());
    }
}

/// A T0 turned by 120 deg leads nowhere: held constant that is an error; identified again, once, it leads to the
/// optimum.
#[test]
fn a_constant_t_that_leads_nowhere_is_identified_again() {
    let t =
        DMatrix::from_fn(6, 4, |i, j| if i == j { 1.0 } else { 0.2 * (i as f64 - j as f64).cos() });
    let z0: Vec<f64> = (0..6).map(|i| (0.7 * f64::from(i) + 0.3).cos()).collect();
    let problem = Problem::new(2, &[3], t, &z0);
    let t0 = problem.distorted_t(1.0, 120.0);
    let controller =
        FeedbackController::new(&t0, &LoadWeights::Identity, FeedbackSettings::default()).unwrap();
    let held = controller.run(&mut problem.plant.clone(), 0.0);
    assert!(matches!(held, Err(RunError::Control(ControlError::Diverges { .. }))));
    let way = Controller::Renewed { step_volt: vec![0.1; 4], renewals: 3 };
    let run =
        controller.with_controller(way).unwrap().run(&mut problem.plant.clone(), 0.0).unwrap();
    assert_eq!((run.stop, run.identifications), (StopReason::Converged, 1));
    let exact = problem.optimum(&[1.0; 6], 0.0);
    assert!(relative_error(&run.last().control_volt, &exact) <= 1e-8);
}
