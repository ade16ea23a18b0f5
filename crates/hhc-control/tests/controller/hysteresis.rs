//! An actuator whose gain and phase depend on the amplitude.

use crate::plants::RayleighPlant;
use hhc_control::{
    ControlLayout, FeedbackController, FeedbackSettings, LoadWeights, Measurement, Plant,
    StopReason, StrokeStatus, identify_t, lag_deg,
};
use nalgebra::{DMatrix, DVector};

/// Two flaps at 3/rev; about 40 deg of lag and 4 deg of stroke at 85 V, more gain at larger
/// amplitude.
fn plant() -> RayleighPlant {
    let loads_per_deg = DMatrix::from_fn(12, 4, |i, j| {
        1e-4 * ((2.3 * i as f64 + 0.9 * j as f64).sin() + if i == 3 * j { 1.0 } else { 0.0 })
    });
    let wanted = DVector::from_vec(vec![-2.5, 1.0, 1.0, 2.0]);
    let rest = DVector::from_fn(12, |i, _| 1.5e-4 * (1.7 * i as f64).cos());
    let z0 = rest - &loads_per_deg * wanted;
    RayleighPlant {
        layout: ControlLayout::new(2, vec![3]).unwrap(),
        loads_per_deg,
        z0,
        a_deg_per_volt: 0.03,
        b_deg_per_volt2: 1.8e-4,
        lag_rad: 0.5,
        stroke_limit_deg: 4.0,
    }
}

const STEP_VOLT: [f64; 4] = [12.0; 4];

fn loads_cost(measurement: &Measurement) -> f64 {
    measurement.outputs.iter().map(|z| z * z).sum()
}

#[test]
fn t_depends_on_the_step_as_the_describing_function_does() {
    let mut plant = plant();
    let [t0, wide] =
        [STEP_VOLT, [36.0; 4]].map(|step_volt| identify_t(&mut plant, &step_volt).unwrap());
    let (small, large) = (plant.gains(12.0), plant.gains(36.0));
    let exact = (large.0 - small.0).hypot(large.1 - small.1) / small.0.hypot(small.1);
    assert!((wide.relative_difference(&t0).unwrap() - exact).abs() < 1e-12);
    assert!(exact > 0.1);
}

#[test]
fn feedback_takes_back_what_ignoring_hysteresis_costs() {
    let mut plant = plant();
    let t0 = identify_t(&mut plant, &STEP_VOLT).unwrap();
    let controller =
        FeedbackController::new(&t0, &LoadWeights::Identity, FeedbackSettings::default()).unwrap();
    let fed_back = controller.run_within_stroke(&mut plant).unwrap();
    assert_eq!(fed_back.run.stop, StopReason::Converged);
    assert!(fed_back.largest_stroke_ratio <= 1.0);

    // the ideal actuator: no hysteresis, no lag, the gain of full scale
    let (in_phase, late) = plant.gains(85.0);
    let mut ideal = RayleighPlant {
        a_deg_per_volt: in_phase.hypot(late),
        b_deg_per_volt2: 0.0,
        lag_rad: 0.0,
        ..plant.clone()
    };
    let t_ideal = identify_t(&mut ideal, &STEP_VOLT).unwrap();
    let settings = FeedbackSettings::default();
    let on_ideal = FeedbackController::new(&t_ideal, &LoadWeights::Identity, settings)
        .unwrap()
        .run_within_stroke(&mut ideal)
        .unwrap();
    let ignored = plant.measure(&on_ideal.run.last().control_volt).unwrap();

    let before = fed_back.run.start.cost.loads;
    let (ideal_cost, with_feedback, without) =
        (on_ideal.run.last().cost.loads, fed_back.run.last().cost.loads, loads_cost(&ignored));
    assert!(with_feedback < 0.5 * before, "{with_feedback:e} of {before:e}");
    assert!(without > 1.5 * with_feedback, "{without:e} against {with_feedback:e}");
    assert!((with_feedback / ideal_cost - 1.0).abs() < 0.05, "{with_feedback:e} {ideal_cost:e}");

    // the flap lags its voltage by the describing function and the pure lag
    let last = fed_back.run.last();
    let voltages = plant.layout.voltages_volt(&last.control_volt).unwrap();
    for (voltage, flap) in voltages.iter().zip(&last.measurement.flap_motion_deg) {
        let (in_phase, late) = plant.gains(voltage.amplitude());
        let exact = (late.atan2(in_phase) + 0.5).to_degrees();
        assert!((lag_deg(*voltage, *flap) - exact).abs() < 1e-9);
    }
}

#[test]
fn the_fixed_point_and_the_limit_hold_together() {
    for stroke_limit_deg in [0.5, 1.0, 2.0] {
        let mut plant = RayleighPlant { stroke_limit_deg, ..plant() };
        let t0 = identify_t(&mut plant, &STEP_VOLT).unwrap();
        let controller =
            FeedbackController::new(&t0, &LoadWeights::Identity, FeedbackSettings::default())
                .unwrap();
        let found = controller.run_within_stroke(&mut plant).unwrap();
        assert_eq!(found.status, StrokeStatus::AtLimit);
        assert!((0.999..=1.0).contains(&found.largest_stroke_ratio));
        if found.run.stop == StopReason::Converged {
            let u = DVector::from_column_slice(&found.run.last().control_volt);
            let z = DVector::from_column_slice(&found.run.last().measurement.outputs);
            let residual = &u * found.rho + t0.as_matrix().transpose() * z;
            assert!(residual.norm() <= 1e-3 * found.rho * u.norm());
        }
        println!(
            "limit {stroke_limit_deg} deg: rho {:.3e}, {:?}, {} steps, {} halvings, {} trials, {} measurements, J {:.4}",
            found.rho,
            found.run.stop,
            found.run.steps.len(),
            found.run.backtracks,
            found.trials.len(),
            found.measurements,
            found.run.last().cost.loads / found.run.start.cost.loads,
        );
        assert!(found.measurements <= 40, "{}", found.measurements);
        assert!(found.trials.len() <= 2);
    }
}

#[test]
fn the_same_run_twice_is_the_same_to_the_bit() {
    let run = || {
        let mut plant = RayleighPlant { stroke_limit_deg: 2.0, ..plant() };
        let t0 = identify_t(&mut plant, &STEP_VOLT).unwrap();
        FeedbackController::new(&t0, &LoadWeights::Identity, FeedbackSettings::default())
            .unwrap()
            .run_within_stroke(&mut plant)
            .unwrap()
    };
    assert_eq!(run(), run());
}
