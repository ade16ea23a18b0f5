//! The T matrix by central differences.

use crate::plants::{Problem, as_t};
use hhc_control::{ControlLayout, Measurement, Plant, identify_t};
use nalgebra::{DMatrix, DVector};
use std::convert::Infallible;

/// `Z = T u + Q u^2 + K u^3`, element by element, measured in threads.
#[derive(Clone)]
struct CubicPlant {
    layout: ControlLayout,
    t: DMatrix<f64>,
    q: DMatrix<f64>,
    k: DMatrix<f64>,
    threads: usize,
}

impl CubicPlant {
    fn example(threads: usize) -> Self {
        let layout = ControlLayout::new(2, vec![3, 4]).unwrap();
        let part = |seed: f64| DMatrix::from_fn(12, 8, |i, j| (seed + (8 * i + j) as f64).sin());
        Self { layout, t: part(0.1), q: part(0.2), k: part(0.3), threads }
    }

    fn loads(&self, control_volt: &[f64]) -> Vec<f64> {
        let u = DVector::from_column_slice(control_volt);
        let (u2, u3) = (u.map(|v| v * v), u.map(|v| v * v * v));
        (&self.t * u + &self.q * u2 + &self.k * u3).iter().copied().collect()
    }

    fn answer(&self, control_volt: &[f64]) -> Measurement {
        Measurement {
            outputs: self.loads(control_volt),
            flap_motion_deg: self.layout.voltages_volt(control_volt).unwrap(),
            mean_flap_deg: vec![0.0; 2],
        }
    }
}

impl Plant for CubicPlant {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Self::Error> {
        Ok(self.answer(control_volt))
    }

    fn measure_many(
        &mut self,
        controls_volt: &[Vec<f64>],
    ) -> Result<Vec<Measurement>, Self::Error> {
        let share = controls_volt.len().div_ceil(self.threads);
        let this = &*self;
        Ok(std::thread::scope(|scope| {
            let workers: Vec<_> = controls_volt
                .chunks(share)
                .map(|part| scope.spawn(|| part.iter().map(|u| this.answer(u)).collect::<Vec<_>>()))
                .collect();
            workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
        }))
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Self::Error> {
        Ok(self.layout.amplitudes_volt(control_volt).unwrap())
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        vec![f64::INFINITY; 4]
    }
}

#[test]
fn central_differences_are_of_second_order() {
    let mut plant = CubicPlant::example(1);
    let exact = as_t(&plant.t);
    let error = |plant: &mut CubicPlant, step: f64| {
        identify_t(plant, &[step; 8]).unwrap().relative_difference(&exact).unwrap()
    };
    let errors: Vec<f64> =
        [0.4, 0.2, 0.1, 0.05].iter().map(|&step| error(&mut plant, step)).collect();
    for pair in errors.windows(2) {
        // the even part cancels, the cubic part leaves K h^2
        assert!((pair[0] / pair[1] - 4.0).abs() < 1e-9, "{errors:?}");
    }
    assert!(errors[3] > 1e-3);
}

#[test]
fn every_column_has_its_own_step() {
    let mut plant = CubicPlant::example(1);
    let steps: Vec<f64> = (1..=8).map(|i| 0.1 * f64::from(i)).collect();
    let t = identify_t(&mut plant, &steps).unwrap();
    for (control, step) in steps.iter().enumerate() {
        for load in 0..12 {
            let exact = plant.t[(load, control)] + plant.k[(load, control)] * step * step;
            assert!((t.at(load, control).unwrap() - exact).abs() < 1e-12);
        }
    }
}

#[test]
fn threads_change_no_bit() {
    let one = identify_t(&mut CubicPlant::example(1), &[0.3; 8]).unwrap();
    for threads in [2, 3, 16] {
        let many = identify_t(&mut CubicPlant::example(threads), &[0.3; 8]).unwrap();
        assert_eq!(one, many);
    }
}

#[test]
fn a_linear_plant_does_not_feel_the_step() {
    let t = DMatrix::from_fn(12, 4, |i, j| ((i + 12 * j) as f64).sin());
    let mut problem = Problem::new(2, &[3], t, &[0.3; 12]);
    let [t0, wide] =
        [0.5, 1.0].map(|step_volt| identify_t(&mut problem.plant, &[step_volt; 4]).unwrap());
    assert!(wide.relative_difference(&t0).unwrap() < 1e-14);
    assert!(t0.relative_difference(&as_t(&problem.t)).unwrap() < 1e-14);
    let linearised = problem.plant.linearised_t(&[0.0; 4]).unwrap().unwrap();
    assert!(t0.relative_difference(&linearised).unwrap() < 1e-4);
}

#[test]
fn impossible_steps_are_refused() {
    let mut plant = CubicPlant::example(1);
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(identify_t(&mut plant, &[step; 8]).is_err());
    }
    assert!(identify_t(&mut plant, &[0.1; 7]).is_err());
}
