//! What the plant and the caller can do wrong.

use crate::plants::{Problem, as_t};
use hhc_control::{
    Acceptance, ControlError, ControlLayout, FeedbackController, FeedbackLaw, FeedbackSettings,
    LinearPlant, LoadWeights, Measurement, Plant, RunError, TMatrix, identify_t,
};
use nalgebra::DMatrix;

#[derive(Debug, thiserror::Error)]
#[error("the blade flew away")]
struct FlewAway;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    Fails,
    NanLoad,
    ShortLoads,
    ShortFlaps,
    NanMean,
    NanStroke,
    ShortStrokes,
    FailsStrokes,
    ZeroLimit,
    NanLimit,
    AdmitsNothing,
    StrokeAtRest,
}

/// A linear plant that goes wrong at its `at`-th measurement.
struct Faulty {
    plant: LinearPlant,
    fault: Fault,
    at: usize,
    calls: usize,
}

impl Plant for Faulty {
    type Error = FlewAway;

    fn layout(&self) -> &ControlLayout {
        self.plant.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, FlewAway> {
        self.calls += 1;
        let mut answer = self.plant.measure(control_volt).map_err(|_| FlewAway)?;
        if self.calls >= self.at {
            match self.fault {
                Fault::Fails => return Err(FlewAway),
                Fault::NanLoad => answer.outputs[3] = f64::NAN,
                Fault::ShortLoads => answer.outputs.truncate(11),
                Fault::ShortFlaps => answer.flap_motion_deg.clear(),
                Fault::NanMean => answer.mean_flap_deg[0] = f64::NAN,
                _ => {}
            }
        }
        Ok(answer)
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, FlewAway> {
        let strokes = self.plant.strokes_deg(control_volt).map_err(|_| FlewAway)?;
        match self.fault {
            Fault::NanStroke => Ok(vec![f64::NAN; strokes.len()]),
            Fault::ShortStrokes => Ok(vec![]),
            Fault::FailsStrokes => Err(FlewAway),
            Fault::StrokeAtRest => Ok(strokes.iter().map(|s| s + 5.0).collect()),
            _ => Ok(strokes),
        }
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        match self.fault {
            Fault::ZeroLimit => vec![0.0; 2],
            Fault::NanLimit => vec![f64::NAN; 2],
            _ => vec![0.5; 2],
        }
    }

    fn admits(&self, _: &[f64]) -> bool {
        self.fault != Fault::AdmitsNothing
    }
}

fn problem() -> Problem {
    let t = DMatrix::from_fn(12, 4, |i, j| (1.1 * i as f64 + 5.0 * j as f64).sin());
    let z0: Vec<f64> = (0..12).map(|i| (0.7 * f64::from(i)).cos()).collect();
    Problem::new(2, &[3], t, &z0)
}

fn faulty(fault: Fault, at: usize) -> Faulty {
    Faulty { plant: problem().plant, fault, at, calls: 0 }
}

fn controller(gain: f64) -> FeedbackController {
    let t0 = problem().distorted_t(gain, 0.0);
    FeedbackController::new(&t0, &LoadWeights::Identity, FeedbackSettings::default()).unwrap()
}

#[test]
fn a_failing_plant_is_quoted_with_the_history() {
    let error = controller(1.3).run(&mut faulty(Fault::Fails, 4), 0.0).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("after 3 recorded control steps"), "{text}");
    let source = std::error::Error::source(&error).unwrap().to_string();
    assert_eq!(source, "the blade flew away");
    let RunError::Plant { call: "measured", history, .. } = error else {
        panic!("{text}");
    };
    assert_eq!(history.len(), 3);
    assert!(history[2].cost.total() < history[0].cost.total());

    let error = identify_t(&mut faulty(Fault::Fails, 3), &[0.1; 4]).unwrap_err();
    assert!(matches!(
        error,
        RunError::Plant { call: "measured for T, step by step about the control", .. }
    ));
}

#[test]
fn bad_measurements_are_named() {
    for at in [1, 2] {
        for (fault, part) in [
            (Fault::NanLoad, "measured outputs: element 3 (from 0) is NaN"),
            (Fault::ShortLoads, "measured outputs: found 11 numbers, expected 12"),
            (Fault::ShortFlaps, "measured flap harmonics: found 0 numbers, expected 2"),
            (Fault::NanMean, "mean flap angle (deg): element 0 (from 0) is NaN"),
        ] {
            let text = controller(1.0).run(&mut faulty(fault, at), 0.0).unwrap_err().to_string();
            assert!(text.contains(part), "{text}");
        }
    }
    for (fault, at) in [(Fault::NanLoad, 5), (Fault::ShortLoads, 5)] {
        assert!(identify_t(&mut faulty(fault, at), &[0.1; 4]).is_err());
    }
}

#[test]
fn bad_strokes_and_limits_are_named() {
    for (fault, part) in [
        (Fault::NanStroke, "stroke (deg): element 0 (from 0) is NaN"),
        (Fault::ShortStrokes, "strokes: found 0 numbers, expected 2"),
        (Fault::FailsStrokes, "asked for its strokes"),
        (Fault::ZeroLimit, "stroke limit (deg) is 0"),
        (Fault::NanLimit, "stroke limit (deg): element 0 (from 0) is NaN"),
        (Fault::AdmitsNothing, "no part of the first control step"),
        (Fault::StrokeAtRest, "is the stroke zero at zero voltage?"),
    ] {
        let error = controller(1.0).run_within_stroke(&mut faulty(fault, 1)).unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
    }
}

#[test]
fn a_plant_of_another_size_is_refused() {
    let t = DMatrix::from_fn(12, 2, |i, j| (i + j) as f64);
    let mut other = Problem::new(1, &[3], t, &[1.0; 12]).plant;
    let error = controller(1.0).run(&mut other, 0.0).unwrap_err();
    assert!(matches!(error, RunError::Control(ControlError::Length { found: 2, expected: 4, .. })));
}

#[test]
fn bad_arguments_are_refused() {
    let mut plant = problem().plant;
    for effort in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(controller(1.0).run(&mut plant, effort).is_err());
    }
    assert!(controller(1.0).run_from(&mut plant, 0.0, &[0.0, f64::NAN, 0.0, 0.0]).is_err());
    assert!(controller(1.0).run_from(&mut plant, 0.0, &[0.0; 3]).is_err());

    let t = as_t(&problem().t);
    let good = FeedbackSettings::default();
    for settings in [
        FeedbackSettings { step_tolerance: 0.0, ..good.clone() },
        FeedbackSettings { stroke_tolerance: f64::NAN, ..good.clone() },
        FeedbackSettings {
            acceptance: Acceptance::NonMonotone { allowed_increase: -1.0, largest_cost: 0.0 },
            ..good.clone()
        },
        FeedbackSettings {
            acceptance: Acceptance::Monotone { cost_tolerance: 0.0 },
            ..good.clone()
        },
        FeedbackSettings { max_backtracks: 61, ..good.clone() },
    ] {
        assert!(FeedbackController::new(&t, &LoadWeights::Identity, settings).is_err());
    }
    let unweighted = LoadWeights::Diagonal(vec![0.0; 12]);
    assert_eq!(FeedbackLaw::new(&t, &unweighted), Err(ControlError::NoAuthority));
    let zero = TMatrix::from_columns(&vec![vec![0.0; 12]; 4]).unwrap();
    assert_eq!(FeedbackLaw::new(&zero, &LoadWeights::Identity), Err(ControlError::NoAuthority));
}

#[test]
fn baseline_sizes_must_fit() {
    let layout = ControlLayout::new(2, vec![3]).unwrap();
    let t = as_t(&problem().t);
    assert!(LinearPlant::new(layout.clone(), vec![0.0; 11], t.clone()).is_err());
    let single = ControlLayout::new(1, vec![3]).unwrap();
    assert!(LinearPlant::new(single, vec![0.0; 12], t.clone()).is_err());
    let plant = LinearPlant::new(layout, vec![0.0; 12], t).unwrap();
    assert!(plant.clone().with_actuator(0.0, 0.0).is_err());
    assert!(plant.clone().with_actuator(1.0, f64::NAN).is_err());
    assert!(plant.with_stroke_limit_deg(-1.0).is_err());
}
