//! The disturbances of the maps on plants whose answer to them is known in closed form.

use super::*;
use hhc_control::{
    Acceptance, ControlLayout, FeedbackController, FeedbackSettings, LinearPlant, LoadWeights,
    Plant, StopReason,
};
use nalgebra::{DMatrix, DVector};
use std::convert::Infallible;

const CONTROLS: usize = 4;

fn matrix() -> DMatrix<f64> {
    // well conditioned, of no symmetry
    DMatrix::from_fn(HUB_OUTPUTS, CONTROLS, |i, j| {
        let diagonal = if i % CONTROLS == j { 2.0 } else { 0.0 };
        let (i, j) = (i as f64, j as f64);
        (1.3 * i + 2.1 * j + 0.4 * i * j).sin() + diagonal
    })
}

fn as_t(matrix: &DMatrix<f64>) -> TMatrix {
    let columns: Vec<Vec<f64>> =
        matrix.column_iter().map(|c| c.iter().copied().collect()).collect();
    TMatrix::from_columns(&columns).unwrap()
}

fn baseline() -> Vec<f64> {
    (0..HUB_OUTPUTS).map(|i| (0.7 * i as f64 + 0.3).cos()).collect()
}

fn layout() -> ControlLayout {
    ControlLayout::new(2, vec![3]).unwrap()
}

fn settings(max_steps: usize) -> FeedbackSettings {
    FeedbackSettings {
        max_steps,
        step_tolerance: 1e-12,
        max_backtracks: 0,
        acceptance: Acceptance::NonMonotone { allowed_increase: 1e3, largest_cost: 10.0 },
        ..FeedbackSettings::default()
    }
}

/// T0 wrong by `g exp(i phi)`: `T0^+ T` is `exp(-i phi) / g`, and a full step leaves `|1 - exp(-i phi) / g|`
/// of the error. The loop converges where that is below 1: for a phase alone below 60 deg.
#[test]
fn a_wrong_t_of_the_maps_contracts_as_theory_says() {
    let t = matrix();
    let optimum = {
        let z = DVector::from_vec(baseline());
        (t.transpose() * &t).lu().solve(&(-t.transpose() * z)).unwrap()
    };
    let mut cases: Vec<(f64, f64)> =
        T_GAINS.iter().flat_map(|g| T_PHASES_DEG.map(|phase| (*g, phase))).collect();
    cases.extend([(1.0, 50.0), (0.55, 10.0), (1.0, 70.0), (0.45, 0.0)]);
    for (gain, phase_deg) in cases {
        let wrong_t = wrong_t(&as_t(&t), gain, phase_deg.to_radians()).unwrap();
        let mut plant = LinearPlant::new(layout(), baseline(), as_t(&t)).unwrap();
        let controller =
            FeedbackController::new(&wrong_t, &LoadWeights::Identity, settings(4)).unwrap();
        let (sin, cos) = phase_deg.to_radians().sin_cos();
        let factor = (1.0 - cos / gain).hypot(sin / gain);
        let run = match controller.run(&mut plant, 0.0) {
            Ok(run) => run,
            // no step at all: the first one makes things worse
            Err(error) => {
                assert!(factor >= 1.0, "gain {gain}, phase {phase_deg}: {error}");
                continue;
            }
        };
        if factor >= 1.0 {
            assert_ne!(run.stop, StopReason::Converged, "gain {gain}, phase {phase_deg}");
        }
        let error = |u: &[f64]| (DVector::from_column_slice(u) - &optimum).norm();
        let errors: Vec<f64> = run.history().map(|step| error(&step.control_volt)).collect();
        assert!(errors.len() > 2 || factor == 0.0 || factor >= 1.0, "{errors:?}");
        for pair in errors.windows(2).filter(|pair| pair[0] > 1e-9 * errors[0]) {
            let found = pair[1] / pair[0];
            assert!((found - factor).abs() <= 1e-9, "{gain} {phase_deg}: {found} {factor}");
        }
    }
}

/// A plant under the noise of the maps.
struct Noisy {
    plant: LinearPlant,
    deviation: f64,
    random: ChaCha8Rng,
}

impl Plant for Noisy {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        self.plant.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Infallible> {
        let mut measurement = self.plant.measure(control_volt)?;
        add_noise(&mut measurement.outputs, self.deviation, &mut self.random);
        Ok(measurement)
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Infallible> {
        self.plant.strokes_deg(control_volt)
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.plant.stroke_limits_deg()
    }
}

/// Noise of deviation `s` on every load: one step from a noisy start ends at `J* + |P n|^2`, `P` the projection
/// on what the controls reach, so on average `s^2` for every control above the least cost.
#[test]
fn noise_leaves_the_floor_that_theory_says() {
    let t = matrix();
    let z = DVector::from_vec(baseline());
    let optimum = (t.transpose() * &t).lu().solve(&(-t.transpose() * &z)).unwrap();
    let least = (&z + &t * optimum).norm_squared();
    let (seeds, deviation) = (600, 0.01);
    let excess: f64 = (0..seeds)
        .map(|seed| {
            let plant = LinearPlant::new(layout(), baseline(), as_t(&t)).unwrap();
            let random = ChaCha8Rng::seed_from_u64(SEED + seed);
            let mut noisy = Noisy { plant, deviation, random };
            let controller =
                FeedbackController::new(&as_t(&t), &LoadWeights::Identity, settings(1)).unwrap();
            let run = controller.run(&mut noisy, 0.0).unwrap();
            let u = DVector::from_column_slice(&run.last().control_volt);
            (&z + &t * u).norm_squared() - least
        })
        .sum();
    let floor = excess / seeds as f64 / deviation.powi(2);
    // chi-square with as many degrees of freedom: the mean of 600 is good to sqrt(8 / 600) = 0.12
    println!("floor {floor:.3} s^2 for {CONTROLS} controls");
    assert!((floor - CONTROLS as f64).abs() < 0.4, "{floor}");
}

/// The map of disturbances: each alone, every wrong T once, all together once.
#[test]
fn every_disturbance_stands_once_in_the_map() {
    let all = disturbances();
    assert_eq!(all.len(), NOISE_PERCENT.len() + T_GAINS.len() * T_PHASES_DEG.len() - 1 + 2 + 1);
    for (k, one) in all.iter().enumerate() {
        assert!(!all[..k].contains(one), "{one:?}");
    }
}

/// Without a disturbance the cell of the case's own controller is the loop of the study, to the last bit; of a limit of
/// the power it knows too.
#[test]
fn an_undisturbed_cell_is_the_loop_of_the_study() {
    let model = Some(std::sync::Arc::new(crate::control::memory_actuator()));
    let rotor = TrimmedRotor::new(&Case::default(), None).unwrap();
    let limits = {
        let mut case = Case::default();
        case.control.effort = EffortChoice::Limits;
        case.control.controller = ControllerChoice::Local;
        case
    };
    let none =
        Disturbance { noise_percent: 0.0, t_gain: 1.0, t_phase_deg: 0.0, drift_percent: 0.0 };
    for mut case in [Case::default(), limits] {
        let control = &mut case.control;
        control.harmonics = vec![vec![3]];
        control.actuators = vec![ControlActuator::Hysteretic];
        if control.effort == EffortChoice::Limits {
            control.power_limit_watt = Some(0.3);
        }
        let choice = choice_name(control.controller);
        let drives = Drives::new(&case, model.clone()).unwrap();
        let done = || ();
        let study = crate::control::control_set(&case, &rotor, &drives, &[3], &done).unwrap();
        let run = study[0].run.as_ref().unwrap();
        let cells = cells(&case, &rotor, &drives, 3, vec![none]).unwrap();
        let cell = cells.iter().find(|cell| cell.controller == choice).unwrap();
        let loads = study[0].state.rotor.hub.harmonic(case.rotor.blades);
        let bits = |loads: [f64; 12]| loads.map(f64::to_bits);
        assert_eq!(bits(cell.end.parts()), bits(loads), "{choice}");
        assert_eq!((cell.steps, cell.backtracks), (run.steps.len(), run.backtracks), "{choice}");
        assert_eq!(cell.status, stop_name(run.stop), "{choice}");
    }
}
